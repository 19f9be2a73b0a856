//! Blind cases for the diagnosis of tasks other than cranks and mechanisms: carried and slid blocks, barrels, needles, switches, thrown bodies.
//!
//! As in the crate `blind` nothing here shares a formula with the estimator: the stepped world or an integrator of its own moves
//! things, instruments written down here look at them, and truth is opened by the scorer alone.

pub mod barrel;
pub mod blocks;
pub mod needle;
pub mod perform;
pub mod score;
pub mod sensor;
pub mod sheet;
pub mod slide;
pub mod structured;
pub mod switch;
pub mod throw;

use estimator::diagnose::Options;
use haptics::recording::Recording;

/// What may be looked at.
#[derive(Clone, Debug)]
pub struct Case {
    /// Recordings of one object.
    pub recordings: Vec<Recording>,
    /// The model to start from.
    pub options: Options,
}

/// What only a scorer opens.
#[derive(Clone, Debug, Default)]
pub struct Truth {
    /// What is hidden, in the words of the vocabulary; empty in a null case.
    pub hidden: Vec<&'static str>,
    /// What the model lacks in any case and may be named as well.
    pub besides: Vec<&'static str>,
    /// Causes that nobody can tell from the hidden one in this recording.
    pub equals: Vec<&'static str>,
    /// Parameter of the hidden cause, with its true value.
    pub value: Option<(&'static str, f64)>,
    /// Parameters that must come out right for the answer to be right: name, true value, and how far off one may be.
    pub near: Vec<(&'static str, f64, f64)>,
}
