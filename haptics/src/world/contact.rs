//! Compliant contact with a stick state: the force between two surfaces from their overlap and relative motion.
//!
//! Normal: Kelvin–Voigt spring and damper that never pulls; with a measured restitution, a damper that grows with the
//! force (Hunt & Crossley 1975), whose loss depends on no mass. Tangential: an elastic anchor that is carried along
//! when the Coulomb limit is reached (Cundall & Strack 1979), so that a sticking contact holds without creep.
//!
//! Surfaces meet and part somewhere within a part of a tick. The force of such a part is the mean over their way in it.
//! Taken at one point only, an undamped bounce would win or lose a quarter of (ω h)² of its energy, depending on the
//! phase. With the mean that share is the same at meeting and parting and cancels.

use super::contact_point::{Contact, Surface};
use crate::Vec2;
use crate::law::contact::{Cushion, PadCompliance};

/// Contact law of a pair of surfaces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// Normal elastic force over depth.
    pub elastic: Cushion,
    /// Normal damping, N s/m.
    pub damping_n_s_m: f64,
    /// Share of the elastic force that the damper adds at the speed of the impact (see [`VelocityLoss::impact_damping`]); zero
    /// where the damping is constant.
    ///
    /// [`VelocityLoss::impact_damping`]: crate::law::contact::VelocityLoss::impact_damping
    pub impact_damping: f64,
    /// Tangential stiffness while sticking, N/m.
    pub shear_stiffness_n_m: f64,
    /// Tangential damping while sticking, N s/m.
    pub shear_damping_n_s_m: f64,
    /// Coulomb coefficient.
    pub friction: f64,
    /// Stiffness of a yielding wall behind the elastic contact, N/m; zero if it is rigid.
    pub wall_n_m: f64,
}

/// Tangential stiffness and damping of a hard contact over the normal ones (Mindlin 1949, for common solids).
const TANGENTIAL_SHARE: f64 = 2.0 / 3.0;
/// Share of a slip that the tangential damper of an impact may take within one part: explicit, more of it would turn the slip round
/// where several contacts share it.
const TAKEN_IN_A_PART: f64 = 0.25;

impl Material {
    /// Hard contact: tangential stiffness and damping in proportion to the normal ones.
    pub fn hard(stiffness_n_m: f64, damping_n_s_m: f64, friction: f64) -> Self {
        Self {
            elastic: Cushion::linear(stiffness_n_m),
            damping_n_s_m,
            impact_damping: 0.0,
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

    /// The pad's compression p solves pad(p) = wall (depth − p), by Newton's method from the solution of a linear pad.
    /// It is exact at once for linear pads, and in a few steps for those that harden.
    fn in_series_n(&self, depth_m: f64) -> f64 {
        let mut pressed_m =
            depth_m * PadCompliance { k: self.wall_n_m }.behind(self.elastic.spring.k1) / self.elastic.spring.k1;
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
    /// Mobility of the surfaces under a normal force, 1/kg: 1/m + (r × n)²/I of both bodies; zero if one of them is a
    /// finger, whose motion is given.
    pub yield_1_kg: f64,
    /// The same along the surfaces where a restitution was measured; zero elsewhere.
    pub slip_yield_1_kg: f64,
    /// True once the surfaces have met.
    pub met: bool,
    /// Speed at which they closed before the last force of this tick, m/s; not a number before the first.
    pub closing_m_s: f64,
}

impl Touch {
    /// Force on `contact.on`, N, for a part of `dt_s` in whose middle the depth is that of the contact. It follows from
    /// the relative velocity of `on` to `by` at the point, m/s, and the way that `on` has gone along the surface since
    /// the part before, m. Zero while the surfaces are apart.
    #[inline]
    pub fn press(&mut self, relative_velocity: Vec2, way_along_m: f64, dt_s: f64) -> Vec2 {
        let contact = &mut self.contact;
        let closing = -relative_velocity.dot(&contact.normal);
        // The fingers' places are those of the part's end: no mean for them.
        let half_way_m = if self.yield_1_kg > 0.0 { 0.5 * closing.abs() * dt_s } else { 0.0 };
        if contact.depth_m <= -half_way_m {
            (contact.shear_m, contact.normal_force_n, contact.tangent_force_n) = (0.0, 0.0, 0.0);
            self.met = false;
            return Vec2::zeros();
        }
        if !self.met {
            (self.met, contact.met_m_s) = (true, closing);
        }
        let normal_force = self.normal_n(closing, half_way_m, dt_s);
        let shears = self.material.shear_damping_n_s_m;
        let damping = if self.material.impact_damping == 0.0 { shears } else { self.impact_shear_n_s_m(dt_s) };
        let (contact, material) = (&mut self.contact, &self.material);
        let tangent = contact.tangent();
        let shear = contact.shear_m + way_along_m;
        let limit = material.friction * normal_force;
        let slip = relative_velocity.dot(&tangent);
        let stuck = -(material.shear_stiffness_n_m * shear + damping * slip);
        let tangent_force = within(stuck, limit);
        contact.sliding = stuck != tangent_force;
        // The anchor slides along when the spring alone is beyond the limit. The spring never holds more than the way
        // of the surfaces, or it would return work that the damper took.
        contact.shear_m = if contact.sliding { within(shear, limit / material.shear_stiffness_n_m) } else { shear };
        contact.normal_force_n = normal_force;
        contact.tangent_force_n = tangent_force;
        contact.force_n()
    }

    /// Tangential damping with a measured restitution, N s/m: in proportion to the normal one, as everywhere.
    #[cold]
    #[inline(never)]
    fn impact_shear_n_s_m(&self, dt_s: f64) -> f64 {
        let (contact, material) = (&self.contact, &self.material);
        let elastic = material.elastic_n(contact.depth_m).max(0.0);
        let normal = elastic * material.impact_damping / contact.met_m_s.max(RESTING_M_S);
        let slips = self.slip_yield_1_kg * dt_s;
        let most = if slips > 0.0 { TAKEN_IN_A_PART / slips } else { f64::INFINITY };
        (TANGENTIAL_SHARE * normal).min(most)
    }

    /// Mean normal force of a part, N, ≥ 0, whose way at `closing` m/s is `half_way_m` to both sides of the depth.
    #[inline]
    fn normal_n(&mut self, closing: f64, half_way_m: f64, dt_s: f64) -> f64 {
        let material = &self.material;
        let elastic = material.elastic_n(self.contact.depth_m);
        let force = elastic + material.damping_n_s_m * closing;
        let inside = self.contact.depth_m >= half_way_m && force >= material.elastic.spring.k1 * half_way_m;
        // Most contacts just press.
        if inside && material.impact_damping == 0.0 {
            force
        } else {
            self.meeting_n(elastic, closing, half_way_m, dt_s)
        }
    }

    /// The same where the surfaces meet or part within the part, or where a restitution was measured.
    #[cold]
    #[inline(never)]
    fn meeting_n(&mut self, elastic: f64, closing: f64, half_way_m: f64, dt_s: f64) -> f64 {
        let (contact, material) = (&self.contact, &self.material);
        let spread = material.elastic.spring.k1 * half_way_m;
        if material.impact_damping > 0.0 {
            let elastic = mean_above_zero(elastic, spread);
            let damping = elastic * material.impact_damping / contact.met_m_s.max(RESTING_M_S);
            let force = self.braked(elastic, damping, closing, dt_s).max(0.0);
            self.closing_m_s = closing;
            return force;
        }
        let damper = material.damping_n_s_m * closing;
        if closing <= 0.0 {
            return mean_above_zero(elastic + damper, spread);
        }
        let touching = if contact.depth_m < half_way_m { 0.5 * (contact.depth_m / half_way_m + 1.0) } else { 1.0 };
        mean_above_zero(elastic, spread) + damper * touching
    }

    /// Spring and damper together, N, with the speed in the middle of the part. The contact brakes the closing motion
    /// within the part itself; all other forces are taken to stay as in the part before. A strong damper therefore
    /// never reverses a motion, and at rest the spring alone carries.
    fn braked(&self, elastic: f64, damping: f64, closing: f64, dt_s: f64) -> f64 {
        let contact = &self.contact;
        let share = damping * self.yield_1_kg * dt_s;
        // (1 − exp(−share))/share, to fourth order, without the exponential.
        let implicit = share * (0.5 + share / 12.0);
        // In the first part of a tick nothing is known of the change of speed: then the others are taken to balance the contact.
        let gained = if self.closing_m_s.is_finite() { closing - self.closing_m_s } else { 0.0 };
        let others = contact.normal_force_n + gained / (dt_s * self.yield_1_kg);
        (elastic + damping * closing + implicit * others) / (1.0 + implicit)
    }
}

/// Impacts slower than this are resting contact, m/s: the damper that a measured restitution asks for does not grow further.
pub(super) const RESTING_M_S: f64 = 0.01;

/// A value held between −`most` and `most`. Unlike `clamp` it does not panic on not-a-number.
#[inline]
fn within(value: f64, most: f64) -> f64 {
    if value > most {
        most
    } else if value < -most {
        -most
    } else {
        value
    }
}

/// Mean of a force that goes evenly from `middle_n` − `spread_n` to `middle_n` + `spread_n` and never below zero, N.
pub(super) fn mean_above_zero(middle_n: f64, spread_n: f64) -> f64 {
    if middle_n >= spread_n {
        return middle_n;
    }
    let above_n = (middle_n + spread_n).max(0.0);
    if spread_n > 0.0 { 0.25 * above_n * above_n / spread_n } else { 0.0 }
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
        met_m_s: 0.0,
        normal_force_n: 0.0,
        tangent_force_n: 0.0,
        sliding: false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::law::contact::{Densification, StiffnessHardening};

    #[test]
    fn a_wall_behind_a_hardening_pad_shares_the_force() {
        // 2500 N/m and 5e9 N/m³ before 3000 N/m, 2 mm together: p = 0.731 mm gives 2500 p + 5e9 p³ = 3.78 N = 3000 (2 − p) mm.
        let spring = StiffnessHardening { k1: 2500.0, k3: 5e9, hertz: 0.0 };
        let pad = Cushion { spring, end: Densification::NONE };
        let material = Material { elastic: pad, wall_n_m: 3000.0, ..Material::hard(1.0, 0.0, 0.5) };
        let force = material.elastic_n(2e-3);
        let pressed = 2e-3 - force / 3000.0;
        assert!((2500.0 * pressed + 5e9 * pressed.powi(3) - force).abs() < 1e-9, "{force}");
        assert!((force - 3.80).abs() < 0.02, "{force}");
        let linear = Material { elastic: Cushion::linear(2500.0), ..material };
        assert!((linear.elastic_n(2e-3) - 2e-3 / (1.0 / 2500.0 + 1.0 / 3000.0)).abs() < 1e-12);
    }

    #[test]
    fn friction_sticks_below_the_cone_and_slides_at_it() {
        let mut touch = on_the_floor(0.001, 0.0, Material::hard(1000.0, 0.0, 0.5));
        // 1 N normal, so 0.5 N friction at most; the anchor gives 2/3 N per mm.
        let force = touch.press(Vec2::zeros(), 0.0003, 1e-3);
        assert!(!touch.contact.sliding && (force - Vec2::new(-0.2, 1.0)).norm() < 1e-12);
        let force = touch.press(Vec2::zeros(), 0.0027, 1e-3);
        assert!(touch.contact.sliding && (force - Vec2::new(-0.5, 1.0)).norm() < 1e-12);
        assert!((touch.contact.shear_m - 0.00075).abs() < 1e-12, "the anchor was dragged along");
    }

    fn on_the_floor(depth_m: f64, yield_1_kg: f64, material: Material) -> Touch {
        Touch {
            contact: meeting((Surface::Block(0), Surface::Floor), 0, Vec2::zeros(), Vec2::new(0.0, 1.0), depth_m),
            arm_on_m: Vec2::zeros(),
            arm_by_m: Vec2::zeros(),
            material,
            yield_1_kg,
            slip_yield_1_kg: yield_1_kg,
            met: false,
            closing_m_s: f64::NAN,
        }
    }

    #[test]
    fn a_sliding_damper_does_not_load_the_spring() {
        // 0.5 N of friction at most; the damper alone would take 10 N s/m · 0.1 m/s = 1 N. The surfaces went 0.01 mm: that, and
        // not what 0.5 N would give, is what the spring has in it.
        let mut touch = on_the_floor(0.001, 0.0, Material::hard(1000.0, 10.0, 0.5));
        touch.press(Vec2::new(0.1, 0.0), 0.1 * 1e-4, 1e-4);
        assert!(touch.contact.sliding && (touch.contact.tangent_force_n + 0.5).abs() < 1e-12);
        assert!((touch.contact.shear_m - 1e-5).abs() < 1e-15, "{}", touch.contact.shear_m);
    }

    #[test]
    fn a_part_in_which_surfaces_meet_gets_its_mean_force() {
        // Closing at 0.2 m/s for 1 ms, from −0.05 to 0.15 mm: three quarters of the part in contact, in the mean 0.15 ·
        // 0.75/2 mm deep. The force is 1000 N/m · 0.05625 mm. A damper of 10 N s/m adds 2 N for three quarters of the
        // part.
        let down = Vec2::new(0.0, -0.2);
        let bare = on_the_floor(5e-5, 20.0, Material::hard(1000.0, 0.0, 0.0)).press(down, 0.0, 1e-3);
        assert!((bare.y - 0.056_25).abs() < 1e-12, "{}", bare.y);
        let damped = on_the_floor(5e-5, 20.0, Material::hard(1000.0, 10.0, 0.0)).press(down, 0.0, 1e-3);
        assert!((damped.y - 1.556_25).abs() < 1e-12, "{}", damped.y);
        // Parting it is the same without a damper, and with this one nothing: it would pull.
        let bare = on_the_floor(5e-5, 20.0, Material::hard(1000.0, 0.0, 0.0)).press(-down, 0.0, 1e-3);
        assert!((bare.y - 0.056_25).abs() < 1e-12, "{}", bare.y);
        assert_eq!(on_the_floor(5e-5, 20.0, Material::hard(1000.0, 10.0, 0.0)).press(-down, 0.0, 1e-3).y, 0.0);
    }
}
