//! Compliant contact with a stick state: the force between two surfaces from their overlap and relative motion.
//!
//! Normal: Kelvin–Voigt spring and damper that never pulls. Tangential: an elastic anchor that is carried along when the
//! Coulomb limit is reached (Cundall & Strack 1979), so that a sticking contact holds without creep.

use super::state::{Contact, Surface};
use crate::Vec2;
use crate::law::contact::{PadCompliance, StiffnessHardening};

/// Contact law of a pair of surfaces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// Normal elastic force over depth.
    pub elastic: StiffnessHardening,
    /// Normal damping, N s/m.
    pub damping_n_s_m: f64,
    /// Tangential stiffness while sticking, N/m.
    pub shear_stiffness_n_m: f64,
    /// Tangential damping while sticking, N s/m.
    pub shear_damping_n_s_m: f64,
    /// Coulomb coefficient.
    pub friction: f64,
    /// What is pressed gives, too: stiffness of a wall behind the elastic contact, N/m; zero when it is rigid.
    pub wall_n_m: f64,
}

impl Material {
    /// Hard contact: tangential stiffness and damping in proportion to the normal ones (2/3, Mindlin 1949 for common solids).
    pub fn hard(stiffness_n_m: f64, damping_n_s_m: f64, friction: f64) -> Self {
        const TANGENTIAL_SHARE: f64 = 2.0 / 3.0;
        Self {
            elastic: StiffnessHardening { k1: stiffness_n_m, ..StiffnessHardening::default() },
            damping_n_s_m,
            shear_stiffness_n_m: TANGENTIAL_SHARE * stiffness_n_m,
            shear_damping_n_s_m: TANGENTIAL_SHARE * damping_n_s_m,
            friction,
            wall_n_m: 0.0,
        }
    }

    /// Elastic force at a depth, N: pad and wall share it, each with the same force.
    #[inline]
    pub fn elastic_n(&self, depth_m: f64) -> f64 {
        if self.wall_n_m == 0.0 { self.elastic.force_n(depth_m) } else { self.in_series_n(depth_m) }
    }

    /// The pad's compression p solves pad(p) = wall (depth − p), by Newton's method from where the linear pad would have it:
    /// exact at once for linear pads, and in a few steps for those that harden.
    fn in_series_n(&self, depth_m: f64) -> f64 {
        let mut pressed_m = depth_m * PadCompliance { k: self.wall_n_m }.behind(self.elastic.k1) / self.elastic.k1;
        for _ in 0..6 {
            let miss = self.elastic.force_n(pressed_m) - self.wall_n_m * (depth_m - pressed_m);
            pressed_m -= miss / (self.elastic.stiffness_n_m(pressed_m) + self.wall_n_m);
        }
        self.wall_n_m * (depth_m - pressed_m)
    }
}

/// A place where two surfaces touch, or may touch within the tick: found once a tick, pressed in each of its parts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Touch {
    /// The contact as pictures and panels see it; its depth is below zero while the surfaces are apart.
    pub contact: Contact,
    /// From the centres of the two bodies to the point, m.
    pub arm_on_m: Vec2,
    /// The same for the body that pushes.
    pub arm_by_m: Vec2,
    /// The law between them.
    pub material: Material,
    /// True once the surfaces have met.
    pub met: bool,
}

impl Touch {
    /// Force on `contact.on`, N, from the relative velocity of `on` to `by` at the point, m/s, and the way that `on` has gone
    /// along the surface since the part before, m. Zero while the surfaces are apart.
    #[inline]
    pub fn press(&mut self, relative_velocity: Vec2, way_along_m: f64) -> Vec2 {
        let contact = &mut self.contact;
        if contact.depth_m <= 0.0 {
            (contact.shear_m, contact.normal_force_n, contact.tangent_force_n) = (0.0, 0.0, 0.0);
            self.met = false;
            return Vec2::zeros();
        }
        let material = &self.material;
        let tangent = contact.tangent();
        let opening = relative_velocity.dot(&contact.normal);
        let normal_force = (material.elastic_n(contact.depth_m) - material.damping_n_s_m * opening).max(0.0);

        let shear = contact.shear_m + way_along_m;
        let limit = material.friction * normal_force;
        let slip = relative_velocity.dot(&tangent);
        let stuck = -(material.shear_stiffness_n_m * shear + material.shear_damping_n_s_m * slip);
        let tangent_force = stuck.clamp(-limit, limit);
        contact.sliding = stuck != tangent_force;
        // The anchor slides along: the spring keeps what the limit can carry, the damper none of it.
        contact.shear_m = if contact.sliding { -tangent_force / material.shear_stiffness_n_m } else { shear };
        contact.normal_force_n = normal_force;
        contact.tangent_force_n = tangent_force;
        contact.force_n()
    }
}

/// Two surfaces of one place, before they are pressed: no shear, no force.
pub fn meeting(pair: (Surface, Surface), feature: u8, point_m: Vec2, normal: Vec2, depth_m: f64) -> Contact {
    Contact {
        on: pair.0,
        by: pair.1,
        feature,
        point_m,
        normal,
        depth_m,
        shear_m: 0.0,
        normal_force_n: 0.0,
        tangent_force_n: 0.0,
        sliding: false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wall_behind_a_hardening_pad_shares_the_force() {
        // 2500 N/m and 5e9 N/m³ before 3000 N/m, 2 mm together: p = 0.731 mm gives 2500 p + 5e9 p³ = 3.78 N = 3000 (2 − p) mm.
        let pad = StiffnessHardening { k1: 2500.0, k3: 5e9, hertz: 0.0 };
        let material = Material { elastic: pad, wall_n_m: 3000.0, ..Material::hard(1.0, 0.0, 0.5) };
        let force = material.elastic_n(2e-3);
        let pressed = 2e-3 - force / 3000.0;
        assert!((2500.0 * pressed + 5e9 * pressed.powi(3) - force).abs() < 1e-9, "{force}");
        assert!((force - 3.80).abs() < 0.02, "{force}");
        let linear = Material { elastic: StiffnessHardening { k3: 0.0, ..pad }, ..material };
        assert!((linear.elastic_n(2e-3) - 2e-3 / (1.0 / 2500.0 + 1.0 / 3000.0)).abs() < 1e-12);
    }

    #[test]
    fn friction_sticks_below_the_cone_and_slides_at_it() {
        let pair = (Surface::Block(0), Surface::Floor);
        let mut touch = Touch {
            contact: meeting(pair, 0, Vec2::zeros(), Vec2::new(0.0, 1.0), 0.001),
            arm_on_m: Vec2::zeros(),
            arm_by_m: Vec2::zeros(),
            material: Material::hard(1000.0, 0.0, 0.5),
            met: true,
        };
        // 1 N normal, so 0.5 N friction at most; the anchor gives 2/3 N per mm.
        let force = touch.press(Vec2::zeros(), 0.0003);
        assert!(!touch.contact.sliding && (force - Vec2::new(-0.2, 1.0)).norm() < 1e-12);
        let force = touch.press(Vec2::zeros(), 0.0027);
        assert!(touch.contact.sliding && (force - Vec2::new(-0.5, 1.0)).norm() < 1e-12);
        assert!((touch.contact.shear_m - 0.00075).abs() < 1e-12, "the anchor was dragged along");
    }
}
