//! Assumptions about geometry and pads in reading the samples of a switch.

/// Largest sine of a knob's angle from the top of its arc.
/// Choice: halved, 2 of 21 answers change; doubled, 0 of 21 answers change.
const FARTHEST_SINE: f64 = 0.95;

/// Give of a pad, and the arc on which the knob moves.
#[derive(Clone, Copy, Debug, Default)]
pub struct Assumptions {
    /// Give of the pad between a tip and the knob, m/N.
    pub give_m_n: f64,
    /// One over the lever's length, 1/m.
    pub bend_1_m: f64,
}

impl Assumptions {
    /// Way along the knob's arc at a way across its top, m.
    pub fn arc_m(&self, across_m: f64) -> f64 {
        let sine = (self.bend_1_m * across_m).clamp(-FARTHEST_SINE, FARTHEST_SINE);
        if self.bend_1_m > 0.0 { sine.asin() / self.bend_1_m } else { across_m }
    }

    /// The way across that belongs to one along the arc, m.
    pub fn across_m(&self, arc_m: f64) -> f64 {
        if self.bend_1_m > 0.0 { (self.bend_1_m * arc_m).sin() / self.bend_1_m } else { arc_m }
    }
}
