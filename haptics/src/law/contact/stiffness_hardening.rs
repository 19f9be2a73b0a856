//! Hardening of a contact: k1 x + kh x^1.5 + k3 x³ instead of k1 x, for a depth x ≥ 0: a sphere on a flat gives x^1.5 (Hertz 1881),
//! a thin foam that fills up a cubic. k1, kh, k3 ≥ 0; kh = k3 = 0 is the linear pad. The force pushes apart.

use super::super::entry::{Entry, Kind, POSITIVE, ParameterSpec};

/// Hardening; equation and sign in the module's head.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StiffnessHardening {
    /// Linear part, N/m.
    pub k1: f64,
    /// Cubic part, N/m³.
    pub k3: f64,
    /// Hertz's part, N/m^1.5.
    pub hertz: f64,
}

impl StiffnessHardening {
    /// Its page of the catalogue.
    pub const ENTRY: Entry = Entry {
        id: "stiffness-hardening",
        kind: Kind::Plant,
        title: "Hardening contact",
        equation: "k1 x + k3 x³ (or Hertz x^1.5)",
        what: "A contact that gets stiffer the deeper it is pressed.",
        shows: "As a force over compression that bends upwards, so that the stiffness found depends on the grip.",
        mimics: "A linear give mimics it over a small range of forces, creep of the foam when it is pressed once.",
        reveals: "Pressing slowly from light to hard and back reveals it.",
        parameters: &[
            ParameterSpec::linear("k1", "N/m", "N/m", POSITIVE),
            ParameterSpec::linear("k3", "N/m³", "N/m³", POSITIVE),
            ParameterSpec::linear("hertz", "N/m^1.5", "N/m^1.5", POSITIVE),
        ],
    };

    /// Elastic force at a depth, N.
    #[inline]
    pub fn force_n(&self, depth_m: f64) -> f64 {
        let mut slope = self.k1;
        // Most contacts are linear: spare them the root.
        if self.k3 != 0.0 || self.hertz != 0.0 {
            let depth = depth_m.max(0.0);
            slope += self.k3 * depth * depth + self.hertz * depth.sqrt();
        }
        slope * depth_m
    }

    /// Slope of the force at a depth, N/m.
    pub fn stiffness_n_m(&self, depth_m: f64) -> f64 {
        let depth = depth_m.max(0.0);
        self.k1 + 3.0 * self.k3 * depth * depth + 1.5 * self.hertz * depth.sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_effect() {
        // 1 mm: 2500 N/m give 2.5 N, 5e8 N/m³ add 0.5 N; 1e5 N/m^1.5 at 0.4 mm give 0.8 N (0.0004^1.5 = 8e-6).
        assert!((StiffnessHardening { k1: 2500.0, k3: 5e8, hertz: 0.0 }.force_n(1e-3) - 3.0).abs() < 1e-12);
        let hertz = StiffnessHardening { hertz: 1e5, ..StiffnessHardening::default() };
        assert!((hertz.force_n(4e-4) - 0.8).abs() < 1e-12);
        assert!((hertz.stiffness_n_m(4e-4) - 3000.0).abs() < 1e-9, "1.5 F/x");
    }
}
