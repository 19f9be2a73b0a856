//! Limits that several identifications share.

/// Number of its standard errors from which a value differs from zero, or from another value.
pub(super) const SIGNIFICANT: f64 = 3.0;
/// Number of its standard errors from which a value differs from zero beyond doubt, such as the strongest of several
/// candidates.
pub(super) const CLEARLY_SIGNIFICANT: f64 = 4.0;
/// Number of its standard errors, or multiple of its noise, from which an event is certain that is sought at many places.
pub(super) const CERTAIN: f64 = 5.0;
/// Multiple of its noise from which a force is that of a contact.
pub(super) const CONTACT_NOISES: f64 = 8.0;
/// Least number of rows of a fit to a held object; thinning leaves so many.
pub(super) const LEAST_FIT_ROWS: usize = 12;
/// Least number of samples of a straight line through place over force.
pub(super) const LEAST_LINE_ROWS: usize = 8;
/// Least number of rows of a recorded segment with a curve or a motion.
pub const LEAST_SEGMENT_ROWS: usize = 24;
/// Least number of samples that a parabola can be judged by, or a mean.
/// Derived: the three numbers of the parabola and two samples more.
pub(super) const LEAST_OF_PARABOLA: usize = 5;
/// Least peak of a push or a hold, as a share of the strongest force.
pub(super) const PUSH_SHARE: f64 = 0.15;
/// Largest number of rows of a fit; longer records are thinned.
pub(super) const MOST_FIT_ROWS: usize = 4000;
/// Shortest rest that is free motion, s: a force that passes through zero rests, too.
pub const LEAST_FREE_S: f64 = 0.25;
/// Time at either end of free motion that may touch already, s.
pub const FREE_ENDS_S: f64 = 0.05;
/// Least force of a finger that touches a switch, as a share of its strongest force.
pub const TOUCH_SHARE: f64 = 0.03;
/// Way of a switch after a turn within which the force goes over from one curve to the other, m.
pub const SETTLED_M: f64 = 0.8e-3;
/// Share of each recording's end that the quality figures hold out.
pub(super) const HELD_OUT: f64 = 0.3;
/// Number of steps of the coarse search for the place of a bend in a curve.
pub(super) const SEARCH_STEPS: usize = 60;
/// Number of steps of the golden section after the coarse search.
/// Derived: 0.618⁴⁰ = 4e-9 of the bracket remains.
pub(super) const GOLDEN_STEPS: usize = 40;
