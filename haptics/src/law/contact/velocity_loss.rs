//! Velocity loss of an impact: v' = −e v along the normal (Newton 1687), and along the surface at most mu (1 + e)|v| is lost
//! (Routh 1877). 0 ≤ e ≤ 1, mu ≥ 0; e = 1, mu = 0 loses nothing. Velocities are those of the body that hits; closing is
//! negative.

use super::super::entry::{Entry, Kind, ParameterSpec};

/// Velocity loss; equation and sign in the module's head.
#[derive(Clone, Copy, Debug, PartialEq)]
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

    /// Damping of a spring-damper contact that loses as much, N s/m: one half wave of an oscillator of stiffness k and mass m
    /// leaves e = exp(−π ζ/√(1 − ζ²)) of the speed. e = 0 is critical damping.
    pub fn damping_n_s_m(&self, stiffness_n_m: f64, mass_kg: f64) -> f64 {
        let log = self.e.clamp(0.0, 1.0).ln();
        let ratio = if log.is_finite() { -log / log.hypot(std::f64::consts::PI) } else { 1.0 };
        2.0 * ratio * (stiffness_n_m * mass_kg).max(0.0).sqrt()
    }
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
        assert!((VelocityLoss { e: 0.0, mu: 0.0 }.damping_n_s_m(8000.0, 0.05) - 40.0).abs() < 1e-12, "2 √(k m)");
    }
}
