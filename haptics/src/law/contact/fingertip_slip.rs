//! Fingertip slip: the grasp point moves on the object by (dx, dy), evenly from t0 over `duration`. duration = 0 is a jump.
//! Positions of the object that were taken from the tips are off by it from then on.

use super::super::entry::{ANY, Entry, Kind, POSITIVE, ParameterSpec};
use crate::Vec2;
use serde::{Deserialize, Serialize};

/// Fingertip slip; equation and sign in the module's head.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct FingertipSlip {
    /// The whole way that the tips move on the object, m.
    pub way_m: Vec2,
    /// Start of the slip, s.
    pub t0_s: f64,
    /// Duration of the slip, s.
    pub duration_s: f64,
}

impl FingertipSlip {
    /// Its page of the catalogue.
    pub const ENTRY: Entry = Entry {
        id: "fingertip-slip",
        kind: Kind::Plant,
        title: "Slip in the fingers",
        equation: "grasp point + (dx, dy) ramp((t − t0)/duration)",
        what: "The object moves in the grasp.",
        shows: "As a shift of centre, height or angle at one time, mostly where the shear comes near friction times \
                grip.",
        mimics: "Drift of a joint sensor or give of the pads mimic it when it is slow.",
        reveals: "A second pass over the same path, or gripping harder, reveals it.",
        parameters: &[
            ParameterSpec::linear("dx", "m", "m", ANY),
            ParameterSpec::linear("dy", "m", "m", ANY),
            ParameterSpec::nonlinear("t0", "s", "s", ANY),
            ParameterSpec::nonlinear("duration", "s", "s", POSITIVE),
        ],
    };

    /// Displacement of the grasp point from its first place, m.
    pub fn displacement_m(&self, time_s: f64) -> Vec2 {
        let since = time_s - self.t0_s;
        let share =
            if self.duration_s > 0.0 { (since / self.duration_s).clamp(0.0, 1.0) } else { f64::from(since >= 0.0) };
        self.way_m * share
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_effect() {
        // A quarter of 2 mm after half a second of two.
        let slip = FingertipSlip { way_m: Vec2::new(0.0, -2e-3), t0_s: 3.0, duration_s: 2.0 };
        assert!((slip.displacement_m(3.5) - Vec2::new(0.0, -5e-4)).norm() < 1e-15);
        assert_eq!(slip.displacement_m(2.9), Vec2::zeros());
        assert_eq!(slip.displacement_m(9.0), slip.way_m);
    }
}
