//! Limits that several rooms of the diagnosis share.

/// Deviation from which a difference is significant, in standard errors or in standard deviations of the noise.
/// Choice: halved, 1 of 81 answers change; doubled, 2 of 81 answers change (2 to wrong).
pub(crate) const SIGNIFICANT: f64 = 3.0;
/// Deviation that is certain, in standard errors or in standard deviations of the noise: touch, a fault, a wrong sign.
/// Choice: halved, 0 of 24 answers change; doubled, 4 of 24 answers change.
pub(crate) const CERTAIN: f64 = 6.0;
/// Evidence within which two explanations are ambiguous, 2 ln(likelihood).
/// Choice: halved or doubled, none of 90 answers changes.
pub(crate) const AMBIGUOUS: f64 = 10.0;
/// Evidence beyond doubt where rows are not independent, 2 ln(likelihood).
/// Derived: six times the evidence that is very strong (10, Kass & Raftery 1995), because neighbouring rows repeat each
/// other.
pub(crate) const SURE: f64 = 60.0;
/// Least number of rows of a fit.
/// Choice: not varied, because a sentence prints it. They are three rows for each of a dozen parameters.
pub(crate) const LEAST_ROWS_OF_A_FIT: usize = 40;
/// Least number of samples of one phase of a contact.
/// Choice: halved, 1 of 67 answers change; doubled, 1 of 67 answers change.
pub(crate) const LEAST_PHASE_SAMPLES: usize = 20;
/// Least number of independent pieces for a mean with its scatter.
/// Choice: halved or doubled, none of 47 answers changes.
pub(crate) const LEAST_PIECES: usize = 8;
/// Least number of rows of a short run.
/// Derived: a mean and a slope take two rows, and a third one tests them.
pub(crate) const FEWEST: usize = 3;
/// Time step, in row periods, from which rows are missing.
/// Choice: halved, 13 of 36 answers change; doubled, 1 of 36 answers change (1 to right).
pub(crate) const GAP_IN_PERIODS: f64 = 1.6;
/// Most rounds of refinement of searched values, of the sensor's faults, and of a choice beside structured errors.
/// Choice: halved, 2 of 48 answers change (1 to right); doubled, 0 of 48 answers change.
pub(crate) const REFINEMENTS: usize = 2;
/// Most rounds of a loop that ends by itself when nothing changes.
/// Choice: halved, 4 of 90 answers change; doubled, 3 of 90 answers change.
pub(crate) const MOST_ROUNDS: usize = 8;
/// Number of equal parts of a recording, or of a rest.
/// Choice: halved, 4 of 21 answers change; doubled, 3 of 21 answers change.
pub(crate) const PARTS: usize = 10;
/// Majority: least share of a whole that represents it.
/// Derived: one half.
pub(crate) const HALF: f64 = 0.5;
/// Assumed relative error of a quantity that a person stated without one.
/// Choice: halved or doubled, none of 15 answers changes.
pub(crate) const ASSUMED_ERROR: f64 = 0.02;

/// Period of the rows of a fast motion, s: no motion of a hand is faster than half of its rate.
/// Choice: halved, 20 of 64 answers change (1 to wrong, 1 to right); doubled, 27 of 64 answers change (3 to right).
pub(crate) const FAST_ROW_S: f64 = 0.01;
/// Shortest row of a mechanism or a transmission, s.
/// Choice: halved or doubled, none of 5 answers changes.
pub(crate) const SHORTEST_S: f64 = 0.02;
/// Longest row, s: every motion of a hand lasts longer.
/// Choice: halved, 4 of 5 answers change (2 to right); doubled, 3 of 5 answers change (1 to right).
pub(crate) const LONGEST_BLOCK_S: f64 = 0.06;
/// Row period from which rows are slow, s.
/// Derived: the middle between the rows of a fast motion (0.01 s) and the shortest of a mechanism (0.02 s).
pub(crate) const SLOW_ROW_S: f64 = 0.015;
/// Reach of the filter of the derived velocities beside an event, s.
/// Derived: half of its window (0.015 s) with a fifth of it as margin.
pub(crate) const FILTER_REACH_S: f64 = 0.018;
/// Time in which a contact or a rest settles, s: beside a change of contact it belongs to neither side, and a rest is
/// followed in windows of it.
/// Choice: halved, 2 of 36 answers change; doubled, 4 of 36 answers change (as a window of rests: none of 43).
pub(crate) const SETTLING_S: f64 = 0.1;
/// Pause, s: between joined recordings, over a change of place, and least duration of empty fingers.
/// Choice: halved or doubled, none of 15 answers changes.
pub(crate) const PAUSE_S: f64 = 1.0;
/// Speed of a resting hand, in sizes of the object per second: a block that a finger pushes faster slides.
/// Choice: no case of the ablation reads it.
pub(crate) const HAND_REST_HZ: f64 = 0.25;
