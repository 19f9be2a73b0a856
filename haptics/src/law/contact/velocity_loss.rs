//! Velocity loss of an impact: v' = −e v along the normal (Newton 1687), and along the surface at most mu (1 + e)|v| is lost
//! (Routh 1877). 0 ≤ e ≤ 1, mu ≥ 0; e = 1, mu = 0 loses nothing. Velocities are those of the body that hits; closing is
//! negative.

use super::super::entry::{Entry, Kind, ParameterSpec};
use serde::{Deserialize, Serialize};

/// Velocity loss; equation and sign in the module's head.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct VelocityLoss {
    /// Restitution.
    pub e: f64,
    /// Friction during the impact.
    pub mu: f64,
}

impl VelocityLoss {
    /// Its page of the catalogue.
    pub const ENTRY: Entry = Entry {
        id: "velocity-loss",
        kind: Kind::Plant,
        title: "Loss at an impact",
        equation: "v' = −e v, loss along the surface ≤ mu (1 + e) abs(v)",
        about: "An impact takes more or less speed than the model says. It shows in the speeds right after a contact and in how \
            long an object bounces. Damping of the contact mimics it (it is the model's way to lose speed), the filter of the \
            velocity hides it. Impacts at different speeds and angles, sampled fast, reveal it.",
        parameters: &[
            ParameterSpec::linear("e", "1", "1", (0.0, 1.0)),
            ParameterSpec::nonlinear("mu", "1", "1", (0.0, 10.0)),
        ],
    };

    /// Velocity after the impact, normal and along the surface, m/s. An opening contact is left alone.
    pub fn after(&self, normal_m_s: f64, along_m_s: f64) -> (f64, f64) {
        if normal_m_s >= 0.0 {
            return (normal_m_s, along_m_s);
        }
        let most = self.mu * (1.0 + self.e) * normal_m_s.abs();
        (-self.e * normal_m_s, along_m_s - along_m_s.signum() * most.min(along_m_s.abs()))
    }

    /// Damping of a spring-damper contact that never pulls and loses as much, N s/m, for stiffness k and mass m: with damping
    /// ratio ζ it leaves e = exp(−2 ζ acos ζ/√(1 − ζ²)) of the speed (Schwager & Pöschel 2007), inverted by Newton's method.
    /// Below e = exp(−2) the contact is overdamped, e ≈ 1/(2 ζ + 0.72)² (within 0.01), and ζ is held at 5.
    pub fn damping_n_s_m(&self, stiffness_n_m: f64, mass_kg: f64) -> f64 {
        let e = self.e.clamp(0.0, 1.0);
        let ratio = if e > (-2.0_f64).exp() { underdamped(-e.ln()) } else { (0.5 / e.sqrt() - 0.36).min(5.0) };
        2.0 * ratio * (stiffness_n_m * mass_kg).max(0.0).sqrt()
    }
}

/// The damping ratio ζ < 1 whose loss 2 ζ acos ζ/√(1 − ζ²) is `loss`, which is below 2.
fn underdamped(loss: f64) -> f64 {
    // The loss rises with ζ and bends down: from below, Newton's steps never overshoot far.
    let mut ratio = loss / std::f64::consts::PI;
    for _ in 0..6 {
        let rest = 1.0 - ratio * ratio;
        let angle = ratio.acos();
        let miss = 2.0 * ratio * angle / rest.sqrt() - loss;
        let slope = 2.0 * (angle / rest.powf(1.5) - ratio / rest);
        ratio = (ratio - miss / slope).clamp(0.0, 0.999);
    }
    ratio
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_effect() {
        // 2 m/s down with e = 0.5: 1 m/s up; mu (1 + e) v = 0.3 m/s of 1 m/s are lost along the surface.
        let loss = VelocityLoss { e: 0.5, mu: 0.1 };
        let (normal, along) = loss.after(-2.0, 1.0);
        assert!((normal - 1.0).abs() < 1e-15 && (along - 0.7).abs() < 1e-15);
        assert_eq!(loss.after(-2.0, 0.2).1, 0.0, "it sticks, it does not turn round");
        assert_eq!(VelocityLoss { e: 1.0, mu: 0.0 }.damping_n_s_m(8000.0, 0.05), 0.0);
        // ζ = 0.5: acos = π/3, so e = exp(−(π/3)/(√3/2)) = 0.2984; 2 ζ √(k m) = 20 N s/m.
        let half = (-std::f64::consts::FRAC_PI_3 / 0.75_f64.sqrt()).exp();
        assert!((VelocityLoss { e: half, mu: 0.0 }.damping_n_s_m(8000.0, 0.05) - 20.0).abs() < 1e-3);
        assert!(VelocityLoss { e: 0.0, mu: 0.0 }.damping_n_s_m(8000.0, 0.05).is_finite());
    }
}
