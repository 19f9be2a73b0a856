//! Line or circle: a probability, and the thresholds from which it is an answer.
//!
//! The thresholds are set so that an answer is right in at least 19 of 20 mechanisms like those of the prior, on tuning
//! seeds. For parts cut out of a motion, which the prior does not cover, they are stricter. The figures are in
//! `docs/constraints.md`.

use super::super::noise::PathNoise;
use super::shape::{HINGE_M, Shape};

/// Least posterior probability for a straight path of a whole motion.
const STRAIGHT_WHOLE: f64 = 0.65;
/// The same for a motion whose rest at the ends is seen in a few samples only.
const STRAIGHT_FEW: f64 = 0.78;
/// The same for a part of a motion.
const STRAIGHT_PIECE: f64 = 0.93;
/// Largest bend of a straight path over its length with 95 % certainty, rad: a whole motion, a part.
const STRAIGHT_WHOLE_RAD: f64 = 1.0;
const STRAIGHT_PIECE_RAD: f64 = 0.5;
/// Probability of a line below which a path is round whatever its bend. It is also round if the interval leaves no
/// doubt.
const ROUND_PROBABILITY: f64 = 0.02;
/// The same for a slight bend: a circle that bends more would be plain to see, and is hidden not by noise but by
/// another shape.
const ROUND_SLIGHT: f64 = 0.3;
const SLIGHT_BEND_RAD: f64 = 0.6;
/// Certain bend from which a path is round whatever the prior, rad.
const ROUND_RAD: f64 = 0.15;
/// Least turn of a recorded hinge, rad (5°): hinges are recorded while they move.
const HINGE_TURN_RAD: f64 = 0.087;

impl Shape {
    fn bend(&self, curvature: f64) -> f64 {
        curvature * self.frame.extent_m
    }

    /// A circle and no line.
    pub(super) fn is_round(&self) -> bool {
        let low = self.decision_low;
        let within_reach = 1.0 / self.arc.curvature < HINGE_M.1 * 1.25;
        let certain =
            self.bend(low) > ROUND_RAD && 1.0 / low < HINGE_M.1 * 1.25 && self.rms_m < 0.5 * self.frame.line_rms_m;
        let line = self.straight_probability;
        let likely = line < ROUND_PROBABILITY
            || (line < ROUND_SLIGHT && self.bend(self.arc.curvature) < SLIGHT_BEND_RAD && !self.systematic());
        certain || (likely && within_reach)
    }

    /// A line and no circle within reach.
    pub(super) fn is_straight(&self) -> bool {
        let (least, most_rad) = match (self.whole, self.few) {
            (true, false) => (STRAIGHT_WHOLE, STRAIGHT_WHOLE_RAD),
            (true, true) => (STRAIGHT_FEW, STRAIGHT_WHOLE_RAD),
            (false, _) => (STRAIGHT_PIECE, STRAIGHT_PIECE_RAD),
        };
        self.straight_probability > least && self.bend(self.interval.1) < most_rad
    }
}

/// Probability of curvature 0 against curvatures of hinges within reach, bending either way, even odds before.
pub(super) fn straight_probability(noise: &PathNoise, curvature: f64, size: f64, extent_m: f64) -> f64 {
    let likelihood = |k: f64| noise.density((curvature - k) * size);
    let steps = 200;
    // No circle is shorter across than the path that lies on it.
    let nearest = HINGE_M.0.max(0.5 * extent_m);
    let ratio = (HINGE_M.1.min(extent_m / HINGE_TURN_RAD) / nearest).max(1.0);
    let round: f64 = (0..steps)
        .map(|i| 1.0 / (nearest * ratio.powf((f64::from(i) + 0.5) / f64::from(steps))))
        .map(|k| 0.5 * (likelihood(k) + likelihood(-k)))
        .sum::<f64>()
        / f64::from(steps);
    let line = likelihood(0.0);
    if line + round > 0.0 { line / (line + round) } else { 0.5 }
}
