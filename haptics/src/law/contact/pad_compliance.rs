//! Pad compliance: a series spring at the contact: the measured position is off by F/k (Hooke 1678; thesis, 2.3: 0.11 cm).
//! k > 0; k → ∞ is a rigid finger. The tip is deeper in the object than its surface by F/k, along the force.

use super::super::entry::{Entry, Kind, POSITIVE, ParameterSpec};

/// Pad compliance; equation and sign in the module's head.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PadCompliance {
    /// Stiffness, N/m.
    pub k: f64,
}

impl PadCompliance {
    /// Its page of the catalogue.
    pub const ENTRY: Entry = Entry {
        id: "pad-compliance",
        kind: Kind::Plant,
        title: "Give of the pads",
        equation: "x measured = x + F/k",
        what: "The fingertip or the finger behind it gives way, so that the measured position is not that of the \
               object.",
        shows: "As widths that are too small, radii that follow the pull and heights that follow the weight.",
        mimics: "A length scale mimics it at one grip force, a shifted centre under a steady load.",
        reveals: "Changing the grip and the pull while holding still reveals it.",
        parameters: &[ParameterSpec::nonlinear("k", "N/m", "N/m", POSITIVE)],
    };

    /// Displacement of the tip under a force, m; zero for a rigid finger (k = 0, unset).
    pub fn give_m(&self, force_n: f64) -> f64 {
        if self.k > 0.0 { force_n / self.k } else { 0.0 }
    }

    /// The stiffness of this spring behind another, N/m: compliances add.
    pub fn behind(&self, other_n_m: f64) -> f64 {
        if self.k > 0.0 && other_n_m > 0.0 { 1.0 / (1.0 / self.k + 1.0 / other_n_m) } else { self.k.max(other_n_m) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_effect() {
        // The thesis's 1.1 mm: 2.75 N on 2500 N/m. Two equal springs in series are half as stiff.
        let pad = PadCompliance { k: 2500.0 };
        assert!((pad.give_m(2.75) - 1.1e-3).abs() < 1e-15);
        assert!((pad.behind(2500.0) - 1250.0).abs() < 1e-9);
    }
}
