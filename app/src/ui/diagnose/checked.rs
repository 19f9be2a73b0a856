//! The value of a diagnosis on other recordings: figures and verdicts.

use estimator::diagnose::Validation;
use std::path::PathBuf;

/// Recordings that the answer is checked on.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum On {
    /// Other files of the same object.
    Files(Vec<PathBuf>),
    /// An open recording: the question is put to all others alone.
    LeftOut(usize),
}

/// One recording, and what came of it.
#[derive(Clone, Debug)]
pub struct Checked {
    /// Its name.
    pub name: String,
    /// The figures, or why there are none, in a sentence.
    pub found: Result<Validation, String>,
    /// Unit of the figures.
    pub unit: String,
}

/// Verdict of the figures on an extension, in one word.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Holds {
    /// It explains this recording, too.
    Yes,
    /// It cannot be told.
    Unclear,
    /// It makes this recording worse.
    No,
}

/// Less than this of the power gone is nothing that holds.
pub(crate) const LEAST_SHARE: f64 = 0.05;

/// The verdict on one recording: the whole interval decides.
pub fn holds(validation: &Validation) -> Holds {
    match validation.interval {
        [low, _] if low > LEAST_SHARE => Holds::Yes,
        [_, high] if high < 0.0 => Holds::No,
        _ => Holds::Unclear,
    }
}
