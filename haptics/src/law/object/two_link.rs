//! Two rigid links that turn in a vertical plane, the second hung on the first, both joints driven: the joint torques
//! of a motion.
//!
//! q₁ is the angle of the first link from hanging straight down, q₂ that of the second link against the first. The
//! joint torques depend on masses and lengths only through six numbers (base parameters: Khalil & Dombre 2002, §9.4),
//! linear in the Lagrangian
//!
//! `L = ½ A q̇₁² + ½ B (q̇₁+q̇₂)² + C cos q₂ q̇₁ (q̇₁+q̇₂) + ½ R q̇₂² + g (G₁ cos q₁ + G₂ cos(q₁+q₂))`,
//!
//! and the torque of joint j is `d/dt ∂L/∂q̇ⱼ − ∂L/∂qⱼ + bⱼ q̇ⱼ + cⱼ dⱼ`, with dⱼ the direction of its motion. Momenta and the rest are
//! kept apart: a fit filters first and differentiates then, and never needs an acceleration.

/// One number of the model.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TwoLinkParameter {
    /// Name, with its unit.
    pub name: &'static str,
    /// Description of the parameter.
    pub about: &'static str,
}

const fn parameter(name: &'static str, about: &'static str) -> TwoLinkParameter {
    TwoLinkParameter { name, about }
}

/// The parameters, in the order of all columns. m, r, I: mass, distance of the middle of mass from the joint, inertia about the joint.
pub const TWO_LINK: [TwoLinkParameter; 10] = [
    parameter("link1_inertia_kg_m2", "I₁ + m₂ l₁², with the first motor's rotor behind its gear"),
    parameter("link2_inertia_kg_m2", "I₂"),
    parameter("coupling_kg_m2", "m₂ l₁ r₂"),
    parameter("rotor2_inertia_kg_m2", "the second motor's rotor behind its gear: only the joint's own rate moves it"),
    parameter("link1_moment_kg_m", "m₁ r₁ + m₂ l₁: gravity at the first joint, over g"),
    parameter("link2_moment_kg_m", "m₂ r₂: gravity at the second joint, over g"),
    parameter("viscous1_Nm_s", "viscous friction of the first joint"),
    parameter("coulomb1_Nm", "Coulomb friction of the first joint"),
    parameter("viscous2_Nm_s", "viscous friction of the second joint"),
    parameter("coulomb2_Nm", "Coulomb friction of the second joint"),
];

/// One row a joint, one column a parameter.
pub type TwoLinkRows = [[f64; TWO_LINK.len()]; 2];

/// Both joints at one instant.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TwoLinkMotion {
    /// q₁ from hanging, q₂ against the first link, rad.
    pub angle_rad: [f64; 2],
    /// rad/s.
    pub rate_rad_s: [f64; 2],
    /// Direction of each joint's motion, −1 … 1.
    pub direction: [f64; 2],
}

impl TwoLinkMotion {
    /// ∂L/∂q̇ⱼ of every parameter, N m s per unit of it.
    pub fn momenta(&self) -> TwoLinkRows {
        let ([_, q2], [v1, v2]) = (self.angle_rad, self.rate_rad_s);
        let (both, cos) = (v1 + v2, q2.cos());
        [
            [v1, both, cos * (2.0 * v1 + v2), 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
            [0.0, both, cos * v1, v2, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        ]
    }

    /// −∂L/∂qⱼ and friction of every parameter, N m per unit of it, under `gravity_m_s2`.
    pub fn torques(&self, gravity_m_s2: f64) -> TwoLinkRows {
        let ([q1, q2], [v1, v2], [d1, d2]) = (self.angle_rad, self.rate_rad_s, self.direction);
        let (first, second) = (gravity_m_s2 * q1.sin(), gravity_m_s2 * (q1 + q2).sin());
        let turned = q2.sin() * v1 * (v1 + v2);
        [[0.0, 0.0, 0.0, 0.0, first, second, v1, d1, 0.0, 0.0], [0.0, 0.0, turned, 0.0, 0.0, second, 0.0, 0.0, v2, d2]]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const GRAVITY: f64 = 9.81;
    const MASS: [f64; 2] = [0.7, 0.4];
    const LENGTH: [f64; 2] = [0.25, 0.18];

    fn angles(t: f64) -> [f64; 2] {
        [0.9 * (1.7 * t).sin() + 0.3, 1.4 * (2.9 * t + 0.4).cos()]
    }

    fn motion(t: f64) -> TwoLinkMotion {
        let h = 1e-5;
        let (a, b) = (angles(t + h), angles(t - h));
        let rate = [0, 1].map(|j: usize| (a[j] - b[j]) / (2.0 * h));
        TwoLinkMotion { angle_rad: angles(t), rate_rad_s: rate, direction: rate.map(f64::signum) }
    }

    /// Torques on two point masses at the links' ends by Newton's law, from their places alone.
    fn newton(t: f64) -> [f64; 2] {
        let places = |[q1, q2]: [f64; 2]| {
            let elbow = [LENGTH[0] * q1.sin(), -LENGTH[0] * q1.cos()];
            [elbow, [elbow[0] + LENGTH[1] * (q1 + q2).sin(), elbow[1] - LENGTH[1] * (q1 + q2).cos()]]
        };
        let h = 1e-4;
        let (before, now, after) = (places(angles(t - h)), places(angles(t)), places(angles(t + h)));
        let force = |m: usize, k: usize| {
            let acceleration = (before[m][k] - 2.0 * now[m][k] + after[m][k]) / (h * h);
            MASS[m] * (acceleration + if k == 1 { GRAVITY } else { 0.0 })
        };
        // Moments about the joint that drives the parts beyond it.
        let moment =
            |m: usize, about: [f64; 2]| (now[m][0] - about[0]) * force(m, 1) - (now[m][1] - about[1]) * force(m, 0);
        [moment(0, [0.0; 2]) + moment(1, [0.0; 2]), moment(1, now[0])]
    }

    #[test]
    fn torques_of_two_point_masses_are_those_of_newton() {
        let ([m1, m2], [l1, l2]) = (MASS, LENGTH);
        let values = [
            m1 * l1 * l1 + m2 * l1 * l1,
            m2 * l2 * l2,
            m2 * l1 * l2,
            0.0,
            m1 * l1 + m2 * l1,
            m2 * l2,
            0.0,
            0.0,
            0.0,
            0.0,
        ];
        let sum = |row: &[f64; 10]| row.iter().zip(&values).map(|(c, v)| c * v).sum::<f64>();
        for t in [0.1, 0.7, 1.3, 2.9] {
            let h = 1e-4;
            let (after, before) = (motion(t + h).momenta(), motion(t - h).momenta());
            let rest = motion(t).torques(GRAVITY);
            for (joint, expected) in newton(t).into_iter().enumerate() {
                let found = (sum(&after[joint]) - sum(&before[joint])) / (2.0 * h) + sum(&rest[joint]);
                assert!((found - expected).abs() < 2e-5, "joint {joint} at {t} s: {found} against {expected}");
            }
        }
    }

    #[test]
    fn friction_and_the_rotor_act_on_their_own_joint_alone() {
        let motion = TwoLinkMotion { rate_rad_s: [2.0, -3.0], direction: [1.0, -1.0], ..TwoLinkMotion::default() };
        let torques = motion.torques(GRAVITY);
        assert_eq!(torques[0][6..], [2.0, 1.0, 0.0, 0.0]);
        assert_eq!(torques[1][6..], [0.0, 0.0, -3.0, -1.0]);
        assert_eq!([motion.momenta()[0][3], motion.momenta()[1][3]], [0.0, -3.0]);
    }
}
