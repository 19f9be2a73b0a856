//! Limits that several identifications share.

/// Number of its standard errors from which a value differs from zero, or from another value.
pub(super) const SIGNIFICANT: f64 = 3.0;
/// Number of its standard errors from which a value differs from zero beyond doubt, such as the strongest of several
/// candidates.
pub(super) const CLEARLY_SIGNIFICANT: f64 = 4.0;
/// Multiple of its noise from which a force is that of a contact.
pub(super) const CONTACT_NOISES: f64 = 8.0;
/// Least number of rows of a fit to a held object; thinning leaves so many.
pub(super) const LEAST_FIT_ROWS: usize = 12;
/// Least number of samples of a straight line through place over force.
pub(super) const LEAST_LINE_ROWS: usize = 8;
/// Largest number of rows of a fit; longer records are thinned.
pub(super) const MOST_FIT_ROWS: usize = 4000;
/// Shortest rest that is free motion, s: a force that passes through zero rests, too.
pub(super) const LEAST_FREE_S: f64 = 0.25;
/// Share of each recording's end that the quality figures hold out.
pub(super) const HELD_OUT: f64 = 0.3;
/// Number of steps of the coarse search for the place of a bend in a curve.
pub(super) const SEARCH_STEPS: usize = 60;
/// Number of steps of the golden section after the coarse search.
/// Derived: 0.618⁴⁰ = 4e-9 of the bracket remains.
pub(super) const GOLDEN_STEPS: usize = 40;
