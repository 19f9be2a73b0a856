//! Replaying with tried values, in the background or at once.

use crate::ui::background::jobs::Jobs;
use crate::ui::calibrate::refits::replay_forces;
use crate::ui::calibrate::replayed::Replayed;
use crate::ui::calibrate::state::Calibration;
use crate::ui::calibrate::what_if::{WHAT_IF, world};
use crate::ui::document::state::Document;
use crate::ui::session::{Session, change};

/// Tries a value, or with `None` no longer.
pub fn try_value(calibration: &mut Calibration, name: &str, value: Option<f64>) {
    match value {
        Some(value) => drop(calibration.what_if.values.insert(name.to_owned(), value)),
        None => drop(calibration.what_if.values.remove(name)),
    }
    if !calibration.what_if.is_on() {
        calibration.what_if.forget();
    }
}

/// Replays with the newest tried values when the last replay has come; call once a frame.
pub fn follow_what_if(document: &Document, calibration: &Calibration, jobs: &mut Jobs<Session>, ctx: &egui::Context) {
    if !calibration.what_if.is_behind() || jobs.is_running(WHAT_IF) {
        return;
    }
    let Some(analysis) = calibration.analysis.clone() else { return };
    let (recordings, choice, values) =
        (document.recordings.clone(), calibration.choice.clone(), calibration.what_if.values.clone());
    jobs.start(ctx, WHAT_IF, "", move |_| {
        let world = world(&analysis, &choice.given_to_all(&recordings), &values);
        let replays = replay_forces(&world, &recordings);
        change(|session, _| session.calibration.what_if.take(values, replays))
    });
}

/// Replays with the tried values now, for a picture.
pub(crate) fn try_now(document: &Document, calibration: &mut Calibration) {
    let Some(analysis) = &calibration.analysis else { return };
    let values = calibration.what_if.values.clone();
    let world = world(analysis, &calibration.choice.given_to_all(&document.recordings), &values);
    let replays = replay_forces(&world, &document.recordings);
    calibration.what_if.take(values, replays);
}

/// The replay that plots show: of the tried values while something is tried.
pub fn shown_curves<'a>(document: &Document, calibration: &'a Calibration) -> Option<&'a Replayed> {
    let tried = calibration.what_if.replays.get(document.current).filter(|_| calibration.what_if.is_on());
    tried.and_then(Option::as_ref).or_else(|| calibration.replay(document.current))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ui::calibrate::what_if::residual_rms;
    use crate::ui::tests::{CRANK, STACK, session};

    fn tried(document: &Document, calibration: &Calibration, name: &str, factor: f64) -> f64 {
        let analysis = calibration.analysis.as_ref().expect("fitted");
        let (object, plain) = name.split_once('.').expect("object.name");
        let value = analysis.fit.value(object, plain).expect("identified");
        let recordings = calibration.choice.given_to_all(&document.recordings);
        let world = world(analysis, &recordings, &[(name.to_owned(), factor * value)].into());
        residual_rms(&replay_forces(&world, &document.recordings)).expect("predicts")
    }

    #[test]
    fn a_wrong_weight_leaves_more_of_the_force_and_the_fitted_one_as_much_as_before() {
        for (recording, name) in [(STACK.clone(), "block-1.weight_N"), (CRANK.clone(), "crank.weight_N")] {
            let session = session(recording);
            let before = residual_rms(&session.calibration.replays).expect("predicts");
            let same = tried(&session.document, &session.calibration, name, 1.0);
            assert!((same - before).abs() < 1e-9 + 1e-6 * before, "{name}: {same} and {before}");
            let heavy = tried(&session.document, &session.calibration, name, 1.6);
            assert!(heavy > 1.1 * before, "{name}: {heavy} against {before}");
        }
    }
}
