//! The value of a diagnosis on other recordings: figures and verdicts.

use crate::text::file_name::name_of;
use crate::text::sentence::sentence;
use crate::ui::background::jobs::JobKind;
use crate::ui::diagnose::state::{Answer, DIAGNOSE, options, plain};
use crate::ui::document::fit_choice::FitChoice;
use crate::ui::document::prepared::Prepared;
use estimator::diagnose::{self, Findings, Options, Progress, Validation};
use haptics::recording::Recording;
use std::path::PathBuf;
use std::sync::Arc;

/// Checking a diagnosis on other recordings.
pub const CHECK: JobKind = JobKind::new("check").after(&DIAGNOSE);

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

/// Measures what was found on other recordings; nothing when `goes_on` said no.
pub fn check_now(
    recordings: &[Arc<Prepared>],
    choice: &FitChoice,
    answer: &Answer,
    on: &On,
    goes_on: &(dyn Fn(f64) -> bool + Sync),
) -> Option<Vec<Checked>> {
    let plain = plain(recordings, choice);
    match on {
        On::Files(paths) => {
            let mut all = Vec::new();
            for (k, path) in paths.iter().enumerate() {
                if !goes_on(k as f64 / paths.len() as f64) {
                    return None;
                }
                let options = options(&plain, choice, answer.from, Progress::default());
                match estimator::log::load(path, None) {
                    Ok(read) => all.extend(read.iter().map(|r| one(r, &options, &answer.diagnosis))),
                    Err(error) => all.push(Checked {
                        name: name_of(path),
                        found: Err(sentence(&error.to_string())),
                        unit: String::new(),
                    }),
                }
            }
            Some(all)
        }
        On::LeftOut(index) => {
            let left_out = plain.get(*index)?;
            let others: Vec<Recording> =
                plain.iter().enumerate().filter(|(k, _)| k != index).map(|(_, r)| r.clone()).collect();
            let options = options(&plain, choice, answer.from, Progress::default());
            if !goes_on(0.05) {
                return None;
            }
            let found = match diagnose::diagnose(&others, &options) {
                Ok(diagnosis) => one(left_out, &options, &diagnosis),
                Err(error) => Checked {
                    name: left_out.name.clone(),
                    found: Err(format!("Without this recording: {}", sentence(&error.to_string()))),
                    unit: String::new(),
                },
            };
            goes_on(1.0).then_some(vec![found])
        }
    }
}

pub(crate) fn one(recording: &Recording, options: &Options, diagnosis: &Findings) -> Checked {
    let found = diagnose::validate(std::slice::from_ref(recording), options, diagnosis);
    let found = found.map_err(|error| sentence(&error.to_string())).and_then(|mut all| {
        if all.is_empty() { Err("Nothing could be compared.".to_owned()) } else { Ok(all.swap_remove(0)) }
    });
    let usual = crate::text::diagnosis_words::force_unit(diagnosis).to_owned();
    let unit = found.as_ref().ok().and_then(|v| v.unit.clone()).unwrap_or(usual);
    Checked { name: recording.name.clone(), found, unit }
}
