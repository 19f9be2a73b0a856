//! Replays of the open recordings without any cause: how often a diagnosis names one all the same.

use crate::text::sentence::sentence;
use crate::ui::background::jobs::{JobKind, Jobs};
use crate::ui::calibrate::state::Calibration;
use crate::ui::diagnose::state::{DIAGNOSE, Diagnosing, StartFrom, options, plain};
use crate::ui::document::fit_choice::FitChoice;
use crate::ui::document::prepared::Prepared;
use crate::ui::document::state::Document;
use crate::ui::session::{Session, change};
use estimator::diagnose::{self, Options, Progress, Twins};
use std::sync::Arc;

/// Diagnosing replays.
pub const REPLAY: JobKind = JobKind::new("twins").after(&DIAGNOSE);

/// Number of replays.
/// Choice: none named of 20 bounds the share of false alarms by 17 %; halved, by 31 %.
pub const REPLAYS: u32 = 20;

/// Counts false alarms in the background.
pub fn count(
    document: &Document,
    calibration: &Calibration,
    diagnosing: &Diagnosing,
    jobs: &mut Jobs<Session>,
    ctx: &egui::Context,
) {
    let Some(answer) = diagnosing.answer.clone() else { return };
    let (recordings, choice) = (document.recordings.clone(), calibration.choice.clone());
    jobs.start(ctx, REPLAY, "Diagnosing replays", move |ticket| {
        let ticket = ticket.clone();
        let progress = Progress::new(move |share| ticket.goes_on(share));
        let twins = count_now(&recordings, &choice, answer.from, progress);
        change(|session, _| session.diagnosing.twins = Some(twins))
    });
}

/// Diagnoses replays; the sentence of an error.
pub fn count_now(
    recordings: &[Arc<Prepared>],
    choice: &FitChoice,
    from: StartFrom,
    progress: Progress,
) -> Result<Twins, String> {
    let plain = plain(recordings, choice);
    let options = Options { twins: true, ..options(&plain, choice, from, Progress::default()) };
    let counted = diagnose::diagnose(&plain, &options).and_then(|mut found| {
        diagnose::twins(&plain, &Options { progress, ..options }, &mut found, REPLAYS)?;
        Ok(found.diagnosis.twins)
    });
    let counted = counted.map_err(|error| sentence(&error.to_string()))?;
    counted.map(|twins| *twins).ok_or_else(|| "These recordings have no replays.".to_owned())
}
