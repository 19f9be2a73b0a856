//! Kinematics of the planar two-fingered hand (Schulteis 1997, chapter 5 and appendix A).
//!
//! Each finger has two links of equal length. Parallelogram linkages make **both link angles absolute** (measured from the
//! horizontal, counter-clockwise) and keep the fingertip upright, so the tip does not rotate.

use crate::Vec2;
use nalgebra::Matrix2;
use serde::{Deserialize, Serialize};

/// Side to which the elbow bends, seen from the base towards the tip.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Elbow {
    /// The elbow lies to the left of the line from base to tip.
    Left,
    /// The elbow lies to the right of the line from base to tip.
    Right,
}

/// Absolute link angles of one finger, rad from the horizontal.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct JointAngles {
    /// Bottom joint (the link at the base).
    pub bottom_rad: f64,
    /// Top joint (the link that carries the tip).
    pub top_rad: f64,
}

/// Joint torques of one finger, N m, positive counter-clockwise.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct JointTorques {
    /// At the bottom joint.
    pub bottom_nm: f64,
    /// At the top joint.
    pub top_nm: f64,
}

/// One finger: where it is mounted and how long its links are.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Finger {
    /// Base joint in the world, m.
    pub base_m: Vec2,
    /// Length of each of the two links, m, positive.
    pub link_m: f64,
    /// Branch of the inverse kinematics.
    pub elbow: Elbow,
}

/// Largest gravity torques of one finger's links (links horizontal), and the drive correction of the top joint.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct GravityTorque {
    /// Torque that holds the bottom link horizontal, N m.
    pub bottom_nm: f64,
    /// Torque that holds the top link horizontal, N m.
    pub top_nm: f64,
    /// The top joint's torque is divided by this factor (linkage ratio; 1 for an ideal parallelogram).
    pub top_correction: f64,
}

impl Default for GravityTorque {
    fn default() -> Self {
        Self { bottom_nm: 0.0, top_nm: 0.0, top_correction: 1.0 }
    }
}

impl Finger {
    /// Tip position in the world, m: base + L(cos qb, sin qb) + L(cos qt, sin qt).
    pub fn tip_in_world(&self, q: JointAngles) -> Vec2 {
        self.elbow_in_world(q) + self.link_m * Vec2::new(q.top_rad.cos(), q.top_rad.sin())
    }

    /// Position of the elbow joint in the world, m.
    pub fn elbow_in_world(&self, q: JointAngles) -> Vec2 {
        self.base_m + self.link_m * Vec2::new(q.bottom_rad.cos(), q.bottom_rad.sin())
    }

    /// Tip Jacobian d(x, y)/d(qb, qt), m/rad.
    pub fn jacobian(&self, q: JointAngles) -> Matrix2<f64> {
        let l = self.link_m;
        Matrix2::new(-l * q.bottom_rad.sin(), -l * q.top_rad.sin(), l * q.bottom_rad.cos(), l * q.top_rad.cos())
    }

    /// Tip velocity in the world, m/s, from joint rates (bottom, top), rad/s.
    pub fn tip_velocity(&self, q: JointAngles, rate_rad_s: Vec2) -> Vec2 {
        self.jacobian(q) * rate_rad_s
    }

    /// Joint angles that put the tip at `tip_in_world`, on this finger's elbow branch.
    ///
    /// Returns `None` outside the reach (distance from the base above two links, or at the base itself).
    pub fn joint_angles(&self, tip_in_world: Vec2) -> Option<JointAngles> {
        let reach = tip_in_world - self.base_m;
        let distance = reach.norm();
        let half = 0.5 * distance / self.link_m;
        if distance < 1e-9 || half > 1.0 {
            return None;
        }
        // An isosceles triangle: the two links open by ±alpha about the line from base to tip.
        let alpha = half.acos();
        let heading = reach.y.atan2(reach.x);
        let side = match self.elbow {
            Elbow::Left => 1.0,
            Elbow::Right => -1.0,
        };
        Some(JointAngles { bottom_rad: heading + side * alpha, top_rad: heading - side * alpha })
    }

    /// Motor torques that carry the links' weight and make the operator exert `operator_force_n` on the tip (thesis,
    /// appendix A): gravity · cos q − fy L cos q + fx L sin q. They are gravity compensation minus Jᵀf.
    pub fn torques(&self, q: JointAngles, operator_force_n: Vec2, gravity: &GravityTorque) -> JointTorques {
        let reaction = self.jacobian(q).transpose() * operator_force_n;
        JointTorques {
            bottom_nm: gravity.bottom_nm * q.bottom_rad.cos() - reaction.x,
            top_nm: (gravity.top_nm * q.top_rad.cos() - reaction.y) / gravity.top_correction,
        }
    }
}

/// The two-fingered hand. Finger 1 is the left one, finger 2 the right one.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Hand {
    /// Left (1) and right (2) finger.
    pub fingers: [Finger; 2],
    /// Region that the tips may reach.
    pub workspace: Workspace,
    /// Gravity torques of the links (the same for both fingers).
    pub gravity_torque: GravityTorque,
}

/// A disc that the tips stay in (thesis: roughly 75 mm across).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Workspace {
    /// Centre in the world, m.
    pub center_m: Vec2,
    /// Radius, m.
    pub radius_m: f64,
}

impl Workspace {
    /// Distance to the edge, m; negative outside.
    pub fn margin_m(&self, point_in_world: Vec2) -> f64 {
        self.radius_m - (point_in_world - self.center_m).norm()
    }

    /// The nearest point of the disc.
    pub fn clamp(&self, point_in_world: Vec2) -> Vec2 {
        let offset = point_in_world - self.center_m;
        let distance = offset.norm();
        if distance <= self.radius_m { point_in_world } else { self.center_m + offset * (self.radius_m / distance) }
    }
}

impl Hand {
    /// A hand with the given link length and bases; elbows point outwards, the workspace hangs below the bases.
    pub fn new(link_m: f64, base1_m: Vec2, base2_m: Vec2) -> Self {
        let center_m = 0.5 * (base1_m + base2_m) + Vec2::new(0.0, -1.25 * link_m);
        Self {
            fingers: [
                // Below the base, "outwards" is to the right of the line of sight for the left finger.
                Finger { base_m: base1_m, link_m, elbow: Elbow::Right },
                Finger { base_m: base2_m, link_m, elbow: Elbow::Left },
            ],
            workspace: Workspace { center_m, radius_m: 0.0375 },
            gravity_torque: GravityTorque::default(),
        }
    }
}

impl Default for Hand {
    /// The hand of the log specification: links of 80 mm, bases 80 mm apart.
    fn default() -> Self {
        Self::new(0.08, Vec2::new(-0.04, 0.0), Vec2::new(0.04, 0.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;
    use proptest::prelude::*;

    #[test]
    fn tip_of_a_right_angle_finger() {
        let finger = Finger { base_m: Vec2::new(0.1, 0.2), link_m: 0.08, elbow: Elbow::Left };
        let q = JointAngles { bottom_rad: std::f64::consts::FRAC_PI_2, top_rad: 0.0 };
        assert_relative_eq!(finger.tip_in_world(q), Vec2::new(0.18, 0.28), epsilon = 1e-15);
        assert_relative_eq!(finger.elbow_in_world(q), Vec2::new(0.1, 0.28), epsilon = 1e-15);
    }

    #[test]
    fn torque_law_of_the_appendix() {
        // L = 0.1 m, links at 0 and 90 degrees: bottom −fy L, top +fx L.
        let finger = Finger { base_m: Vec2::zeros(), link_m: 0.1, elbow: Elbow::Left };
        let q = JointAngles { bottom_rad: 0.0, top_rad: std::f64::consts::FRAC_PI_2 };
        let gravity = GravityTorque { bottom_nm: 0.05, top_nm: 0.03, top_correction: 2.0 };
        let t = finger.torques(q, Vec2::new(3.0, 4.0), &gravity);
        assert_relative_eq!(t.bottom_nm, 0.05 - 0.4, epsilon = 1e-12);
        assert_relative_eq!(t.top_nm, 0.3 / 2.0, epsilon = 1e-12);
    }

    #[test]
    fn out_of_reach_is_none() {
        let finger = Hand::default().fingers[0];
        assert!(finger.joint_angles(finger.base_m + Vec2::new(0.17, 0.0)).is_none());
        assert!(finger.joint_angles(finger.base_m).is_none());
    }

    #[test]
    fn elbows_point_outwards() {
        let hand = Hand::default();
        for (finger, outwards) in hand.fingers.iter().zip([-1.0, 1.0]) {
            let q = finger.joint_angles(hand.workspace.center_m).expect("centre is in reach");
            assert!((finger.elbow_in_world(q).x - finger.base_m.x) * outwards > 0.0);
        }
    }

    proptest! {
        #[test]
        fn inverse_undoes_forward(dx in -0.037..0.037f64, dy in -0.037..0.037f64) {
            let hand = Hand::default();
            let target = hand.workspace.clamp(hand.workspace.center_m + Vec2::new(dx, dy));
            for finger in &hand.fingers {
                let q = finger.joint_angles(target).expect("the workspace is in reach");
                prop_assert!((finger.tip_in_world(q) - target).norm() < 1e-12);
            }
        }

        #[test]
        fn jacobian_is_the_derivative(qb in -3.0..3.0f64, qt in -3.0..3.0f64) {
            let finger = Hand::default().fingers[1];
            let q = JointAngles { bottom_rad: qb, top_rad: qt };
            let h = 1e-6;
            let column = |dqb: f64, dqt: f64| {
                let plus = JointAngles { bottom_rad: qb + dqb, top_rad: qt + dqt };
                let minus = JointAngles { bottom_rad: qb - dqb, top_rad: qt - dqt };
                (finger.tip_in_world(plus) - finger.tip_in_world(minus)) / (2.0 * h)
            };
            let numeric = Matrix2::from_columns(&[column(h, 0.0), column(0.0, h)]);
            prop_assert!((numeric - finger.jacobian(q)).norm() < 1e-9);
        }
    }
}
