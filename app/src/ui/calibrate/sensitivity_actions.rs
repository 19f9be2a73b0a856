//! Computing the sensitivity, in the background or at once.

use crate::ui::background::jobs::Jobs;
use crate::ui::background::jobs::no_change;
use crate::ui::calibrate::refits::FIT;
use crate::ui::calibrate::sensitivity::{SENSITIVITY, sensitivity};
use crate::ui::calibrate::state::Calibration;
use crate::ui::document::state::Document;
use crate::ui::session::{Session, change};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// Computes it now, for a picture.
pub(crate) fn look_at_sensitivity(document: &Document, calibration: &mut Calibration) {
    let Some(analysis) = &calibration.analysis else { return };
    let given = calibration.choice.given_to_all(&document.recordings);
    let found = sensitivity(analysis, &document.recordings, &given, |_| {}, &AtomicBool::new(false));
    calibration.sensitivity = found.map(Arc::new);
}

/// Computes it in the background, unless it is there.
pub fn want_sensitivity(document: &Document, calibration: &Calibration, jobs: &mut Jobs<Session>, ctx: &egui::Context) {
    let Some(analysis) = calibration.analysis.clone() else { return };
    let there = calibration.sensitivity.as_ref().is_some_and(|s| s.is_of(&analysis));
    // A fit that is about to change needs none.
    if there || calibration.stale || jobs.is_running(SENSITIVITY) || jobs.is_running(FIT) {
        return;
    }
    let (recordings, choice) = (document.recordings.clone(), calibration.choice.clone());
    let title = "Looking how the force depends on the parameters";
    jobs.start(ctx, SENSITIVITY, title, move |ticket| {
        let given = choice.given_to_all(&recordings);
        match sensitivity(&analysis, &recordings, &given, |share| ticket.tell(share), ticket.cancelled()) {
            Some(found) => change(|session, _| session.calibration.sensitivity = Some(Arc::new(found))),
            None => no_change(),
        }
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ui::calibrate::sensitivity::Sensitivity;
    use crate::ui::tests::{CRANK, STACK, session};
    use haptics::recording::Recording;

    fn found(recording: Recording) -> Sensitivity {
        let session = session(recording);
        let analysis = session.calibration.analysis.clone().expect("fitted");
        let given = session.calibration.choice.given_to_all(&session.document.recordings);
        sensitivity(&analysis, &session.document.recordings, &given, |_| {}, &AtomicBool::new(false))
            .expect("not cancelled")
    }

    #[test]
    fn the_force_depends_on_the_weight_as_the_weight_says() {
        let found = found(STACK.clone());
        let weight = found.effects.iter().find(|e| e.name == "block-1.weight_N").expect("weighed");
        // A tenth of 0.35 N, shared by two fingers, for about a fifth of the time.
        assert!(weight.force_rms > 0.001 && weight.force_rms < 0.035, "{weight:?}");
        assert!(weight.by_its_error.is_some_and(|e| e < 0.3 * weight.force_rms));
        assert!(found.effects.is_sorted_by(|a, b| a.force_rms >= b.force_rms));
    }

    #[test]
    fn correlations_are_symmetric_and_one_with_themselves() {
        let found = found(CRANK.clone());
        assert!(!found.groups.is_empty());
        for group in &found.groups {
            for (i, row) in group.values.iter().enumerate() {
                assert!((row[i] - 1.0).abs() < 1e-9);
                assert!(
                    row.iter().enumerate().all(|(j, r)| r.abs() <= 1.0 + 1e-9 && (r - group.values[j][i]).abs() < 1e-9)
                );
            }
        }
    }
}
