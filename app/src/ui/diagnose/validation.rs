//! Checks of a diagnosis on held-out recordings.

use crate::text::file_name::name_of;
use crate::text::sentence::sentence;
use crate::ui::background::jobs::{JobKind, Jobs, no_change};
use crate::ui::calibrate::state::Calibration;
use crate::ui::diagnose::checked::{Checked, On};
use crate::ui::diagnose::state::{Answer, DIAGNOSE, Diagnosing, options, plain};
use crate::ui::document::fit_choice::FitChoice;
use crate::ui::document::prepared::Prepared;
use crate::ui::document::state::Document;
use crate::ui::session::{Session, change};
use estimator::diagnose::{self, Findings, Options, Progress};
use haptics::recording::Recording;
use std::sync::Arc;

/// Checking a diagnosis on other recordings.
pub const CHECK: JobKind = JobKind::new("check").after(&DIAGNOSE);

/// Checks the answer in the background.
pub fn check(
    document: &Document,
    calibration: &Calibration,
    diagnosing: &mut Diagnosing,
    jobs: &mut Jobs<Session>,
    ctx: &egui::Context,
    on: On,
) {
    let Some(answer) = diagnosing.answer.clone() else { return };
    diagnosing.check_field.clear();
    let (recordings, choice) = (document.recordings.clone(), calibration.choice.clone());
    jobs.start(ctx, CHECK, "Checking on other recordings", move |ticket| {
        match check_now(&recordings, &choice, &answer, &on, &|share| ticket.goes_on(share)) {
            Some(checked) => change(move |session, _| {
                if matches!(on, On::Files(_)) {
                    judge(&mut session.diagnosing, &answer, &checked);
                }
                take_checked(&mut session.diagnosing, checked);
            }),
            None => no_change(),
        }
    });
}

/// Other files judge the answer that was asked about, if it is still there. A recording that was left out judges
/// another diagnosis, that of the rest.
fn judge(diagnosing: &mut Diagnosing, asked: &Arc<Answer>, checked: &[Checked]) {
    let Some(answer) = diagnosing.answer.as_mut().filter(|answer| Arc::ptr_eq(answer, asked)) else { return };
    let figures = checked.iter().filter_map(|c| c.found.clone().ok()).collect();
    Arc::make_mut(answer).diagnosis.judge_by(figures);
}

/// A check has ended: what is newer takes the place of what was there of the same name.
pub(crate) fn take_checked(diagnosing: &mut Diagnosing, checked: Vec<Checked>) {
    let all = &mut diagnosing.checked;
    all.retain(|old| checked.iter().all(|new| new.name != old.name));
    all.extend(checked);
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

fn one(recording: &Recording, options: &Options, diagnosis: &Findings) -> Checked {
    let found = diagnose::validate(std::slice::from_ref(recording), options, diagnosis);
    let found = found.map_err(|error| sentence(&error.to_string())).and_then(|mut all| {
        if all.is_empty() { Err("Nothing could be compared.".to_owned()) } else { Ok(all.swap_remove(0)) }
    });
    let usual = crate::text::diagnosis_words::force_unit(diagnosis).to_owned();
    let unit = found.as_ref().ok().and_then(|v| v.unit.clone()).unwrap_or(usual);
    Checked { name: recording.name.clone(), found, unit }
}
