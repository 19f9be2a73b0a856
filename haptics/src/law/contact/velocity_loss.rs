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
        what: "An impact takes more or less speed than the model says.",
        shows: "In the speeds right after a contact and in how long an object bounces.",
        mimics: "Damping of the contact mimics it (it is the model's way to lose speed), the filter of the velocity \
                 hides it.",
        reveals: "Impacts at different speeds and angles, sampled fast, reveal it.",
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

    /// Damping number α of a contact with just this restitution, whatever its stiffness and the masses behind it. The
    /// force is k x (1 + α v/v₀), with the closing speed v and the speed v₀ at which the surfaces met (Hunt & Crossley
    /// 1975).
    ///
    /// m v dv = −k x (1 + α v/v₀) dx over the whole impact gives (1 + e) α = ln((1 + α)/(1 − e α)), with 1/e as the upper bound
    /// of α. Below e = 0.02 it is held at that of 0.02.
    pub fn impact_damping(&self) -> f64 {
        let e = self.e.clamp(0.02, 1.0);
        let nearly = 1.5 * (1.0 - e) / e;
        if e > 0.99 {
            return nearly;
        }
        if e < 0.25 {
            // Next to its bound: 1 − e α = (1 + α) exp(−(1 + e) α), from the bound itself.
            return (0..5).fold(1.0 / e, |a, _| (1.0 - (1.0 + a) * (-(1.0 + e) * a).exp()) / e);
        }
        // Newton's method from a value that is nearly right.
        (0..5).fold(nearly.min(0.985 / e), |a, _| {
            let miss = (1.0 + e) * a - ((1.0 + a) / (1.0 - e * a)).ln();
            a - miss / (1.0 + e - 1.0 / (1.0 + a) - e / (1.0 - e * a))
        })
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
        assert_eq!(VelocityLoss { e: 1.0, mu: 0.0 }.impact_damping(), 0.0);
        for e in [0.03, 0.2, 0.249, 0.251, 0.5, 0.8, 0.98] {
            // α (1 + e) = ln((1 + α)/(1 − e α)), by its exponential: no logarithm that the search itself takes.
            let a = VelocityLoss { e, mu: 0.0 }.impact_damping();
            assert!(((1.0 + a) * (-(1.0 + e) * a).exp() - (1.0 - e * a)).abs() < 1e-5, "e = {e}: {a}");
        }
        // 1.5 · 1.4328 = 2.1491 and ln(2.4328/0.2836) = 2.1491.
        assert!((loss.impact_damping() - 1.4328).abs() < 1e-4);
        assert!(VelocityLoss { e: 0.0, mu: 0.0 }.impact_damping().is_finite());
    }
}
