//! From the loaded recordings to a fit and its replay, in the background, and again whenever the user changes how.

use crate::text::sentence::sentence;
use crate::ui::background::jobs::Jobs;
use crate::ui::calibrate::refits::{FIT, JUDGE, SEGMENT, SIMULATE, analyse_sharing, judge, replay_all};
use crate::ui::calibrate::state::Calibration;
use crate::ui::document::state::Document;
use crate::ui::session::{Session, change};
use estimator::pipeline::Analysis;
use estimator::segment::{Segmentation, segment_by};
use std::sync::Arc;
use std::time::Instant;

/// Segments and fits in the background.
pub fn refit(document: &Document, calibration: &mut Calibration, jobs: &mut Jobs<Session>, ctx: &egui::Context) {
    if document.recordings.is_empty() {
        return;
    }
    calibration.what_if.forget();
    jobs.cancel_after(FIT);
    calibration.stale = false;
    let (recordings, choice) = (document.recordings.clone(), calibration.choice.clone());
    let shared = calibration.refits.shared(&choice);
    calibration.refits.asked = Some(choice.clone());
    calibration.refits.begun = Instant::now();
    let job = jobs.start(ctx, FIT, "Fitting", move |_| {
        let analysis = analyse_sharing(&recordings, &shared, &choice)?;
        change(move |session, ctx| {
            fitted(&session.document, &mut session.calibration, &mut session.jobs, ctx, analysis);
        })
    });
    job.if_given_up(|session, _| {
        if session.calibration.analysis.is_none() {
            session.calibration.fit_problem = Some("The fit was cancelled; press Fit to start it again.".to_owned());
        }
        session.calibration.refits.gave_up();
        session.calibration.stale = true;
    });
}

/// Sees whether the fit on the screen still is what was chosen, and makes it follow where that is quick. Call once a frame.
pub fn follow_choice(
    document: &Document,
    calibration: &mut Calibration,
    jobs: &mut Jobs<Session>,
    ctx: &egui::Context,
) {
    let Some(asked) = &calibration.refits.asked else { return };
    calibration.stale = *asked != calibration.choice;
    let busy = jobs.is_running(FIT);
    // While rules are edited only the states follow: a fit with half a rule is of no use.
    if calibration.stale
        && calibration.refits.live
        && calibration.refits.quick()
        && !busy
        && calibration.rules.is_none()
    {
        refit(document, calibration, jobs, ctx);
    }
}

/// Tells the states of the shown recording anew, in the background; the fit stays as it was.
pub fn resegment(document: &Document, calibration: &Calibration, jobs: &mut Jobs<Session>, ctx: &egui::Context) {
    let Some(prepared) = document.prepared().cloned() else { return };
    let (index, choice) = (document.current, calibration.choice.clone());
    jobs.start(ctx, SEGMENT, "", move |_| {
        let recording = choice.given_to(index, &prepared.recording);
        let found = segment_by(choice.method, &recording, choice.task, choice.thresholds)
            .map_err(|error| sentence(&error.to_string()))?;
        change(move |session, _| segmented(&mut session.calibration, index, found))
    });
}

/// The states of one recording were told anew.
pub(crate) fn segmented(calibration: &mut Calibration, index: usize, found: Segmentation) {
    let Some(analysis) = calibration.analysis.as_mut() else { return };
    if let Some(place) = Arc::make_mut(analysis).segmentations.get_mut(index) {
        *place = Some(found);
    }
}

/// A fit has come.
pub(crate) fn fitted(
    document: &Document,
    calibration: &mut Calibration,
    jobs: &mut Jobs<Session>,
    ctx: &egui::Context,
    analysis: Analysis,
) {
    calibration.refits.took = Some(calibration.refits.begun.elapsed());
    let analysis = Arc::new(analysis);
    calibration.analysis = Some(Arc::clone(&analysis));
    calibration.fit_problem = None;
    let (recordings, fitted) = (document.recordings.clone(), Arc::clone(&analysis));
    jobs.start(ctx, JUDGE, "", move |_| {
        let enough = judge(&fitted, &recordings);
        change(|session, _| session.calibration.enough = enough)
    });
    let recordings = document.recordings.clone();
    jobs.start(ctx, SIMULATE, "Replaying in the fitted world", move |_| {
        let replays = replay_all(&analysis.world, &recordings);
        change(|session, _| session.calibration.replays = replays)
    });
}
