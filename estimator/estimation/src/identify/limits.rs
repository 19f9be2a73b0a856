//! Limits that several identifications share.

/// Number of its standard errors from which a value differs from zero, or from another value.
/// Choice: halved, 1 of 49 answers change; doubled, 2 of 49 answers change.
pub(super) const SIGNIFICANT: f64 = 3.0;
/// Number of its standard errors from which a value differs from zero beyond doubt, such as the strongest of several
/// candidates.
/// Choice: halved, 2 of 40 answers change; doubled, 3 of 40 answers change.
pub(super) const CLEARLY_SIGNIFICANT: f64 = 4.0;
/// Number of its standard errors, or multiple of its noise, from which an event is certain that is sought at many places.
/// Choice: halved, 0 of 27 answers change; doubled, 1 of 27 answers change.
pub(super) const CERTAIN: f64 = 5.0;
/// Multiple of its noise from which a force is that of a contact.
/// Choice: halved or doubled, none of 15 answers changes.
pub(super) const CONTACT_NOISES: f64 = 8.0;
/// Least number of rows of a fit to a held object; thinning leaves so many.
/// Choice: no case of the ablation reads it.
pub(super) const LEAST_FIT_ROWS: usize = 12;
/// Least number of samples of a straight line through place over force.
/// Choice: halved or doubled, none of 21 answers changes.
pub(super) const LEAST_LINE_ROWS: usize = 8;
/// Least number of rows of a recorded segment with a curve or a motion.
/// Choice: halved or doubled, none of 26 answers changes.
pub const LEAST_SEGMENT_ROWS: usize = 24;
/// Least number of samples that a parabola can be judged by, or a mean.
/// Derived: the three numbers of the parabola and two samples more.
pub(super) const LEAST_OF_PARABOLA: usize = 5;
/// Least peak of a push or a hold, as a share of the strongest force.
/// Choice: halved or doubled, none of 15 answers changes.
pub(super) const PUSH_SHARE: f64 = 0.15;
/// Largest number of rows of a fit; longer records are thinned.
/// Choice: halved or doubled, none of 15 answers changes.
pub(super) const MOST_FIT_ROWS: usize = 4000;
/// Shortest rest that is free motion, s: a force that passes through zero rests, too.
/// Choice: halved, 14 of 46 answers change; doubled, 9 of 46 answers change (2 to right).
pub const LEAST_FREE_S: f64 = 0.25;
/// Time at either end of free motion that may touch already, s.
/// Choice: no case of the ablation reads it.
pub const FREE_ENDS_S: f64 = 0.05;
/// Least force of a finger that touches a switch, as a share of its strongest force.
/// Choice: halved, 16 of 21 answers change; doubled, 19 of 21 answers change.
pub const TOUCH_SHARE: f64 = 0.03;
/// Way of a switch after a turn within which the force goes over from one curve to the other, as a share of the longest
/// push.
/// Choice: halved, 9 of 21 answers change; doubled, 17 of 19 answers change (2 to wrong).
pub const SETTLED: f64 = 0.1;
/// Share of each recording's end that the quality figures hold out.
/// Choice: halved or doubled, none of 48 answers changes.
pub(super) const HELD_OUT: f64 = 0.3;
/// Number of steps of the coarse search for the place of a bend in a curve.
/// Choice: halved, 1 of 36 answers change; doubled, 0 of 36 answers change.
pub(super) const SEARCH_STEPS: usize = 60;
/// Number of steps of the golden section after the coarse search.
/// Derived: 0.618⁴⁰ = 4e-9 of the bracket remains.
pub(super) const GOLDEN_STEPS: usize = 40;
/// Largest relative difference of two forces by rounding.
/// Choice: halved or doubled, none of 5 answers changes.
pub(super) const ROUNDING: f64 = 1e-9;
