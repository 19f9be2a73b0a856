//! From the loaded recordings to a fit and its replay, in the background, and again whenever the user changes how.

use super::session::{Session, change};
use crate::text::sentence::sentence;
use crate::ui::refits::{FIT, JUDGE, SEGMENT, SIMULATE, analyse_sharing, judge, replay_all};
use estimator::pipeline::Analysis;
use estimator::segment::{Segmentation, segment_by};
use std::sync::Arc;
use std::time::Instant;

/// Segments and fits in the background.
pub fn refit(session: &mut Session, ctx: &egui::Context) {
    if session.document.recordings.is_empty() {
        return;
    }
    session.calibration.what_if.forget();
    session.jobs.cancel_after(FIT);
    session.calibration.stale = false;
    let (recordings, choice) = (session.document.recordings.clone(), session.calibration.choice.clone());
    let shared = session.calibration.refits.shared(&choice);
    session.calibration.refits.asked = Some(choice.clone());
    session.calibration.refits.begun = Instant::now();
    let job = session.jobs.start(ctx, FIT, "Fitting", move |_| {
        let analysis = analyse_sharing(&recordings, &shared, &choice)?;
        change(move |session, ctx| fitted(session, ctx, analysis))
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
pub fn follow_choice(session: &mut Session, ctx: &egui::Context) {
    let Some(asked) = &session.calibration.refits.asked else { return };
    session.calibration.stale = *asked != session.calibration.choice;
    let busy = session.jobs.is_running(FIT);
    // While rules are edited only the states follow: a fit with half a rule is of no use.
    if session.calibration.stale
        && session.calibration.refits.live
        && session.calibration.refits.quick()
        && !busy
        && session.calibration.rules.is_none()
    {
        refit(session, ctx);
    }
}

/// Tells the states of the shown recording anew, in the background; the fit stays as it was.
pub fn resegment(session: &mut Session, ctx: &egui::Context) {
    let Some(prepared) = session.document.prepared().cloned() else { return };
    let (index, choice) = (session.document.current, session.calibration.choice.clone());
    session.jobs.start(ctx, SEGMENT, "", move |_| {
        let recording = choice.given_to(index, &prepared.recording);
        let found = segment_by(choice.method, &recording, choice.task, choice.thresholds)
            .map_err(|error| sentence(&error.to_string()))?;
        change(move |session, _| segmented(session, index, found))
    });
}

/// The states of one recording were told anew.
pub(crate) fn segmented(session: &mut Session, index: usize, found: Segmentation) {
    let Some(analysis) = session.calibration.analysis.as_mut() else { return };
    if let Some(place) = Arc::make_mut(analysis).segmentations.get_mut(index) {
        *place = Some(found);
    }
}

/// A fit has come.
pub(crate) fn fitted(session: &mut Session, ctx: &egui::Context, analysis: Analysis) {
    session.calibration.refits.took = Some(session.calibration.refits.begun.elapsed());
    let analysis = Arc::new(analysis);
    session.calibration.analysis = Some(Arc::clone(&analysis));
    session.calibration.fit_problem = None;
    let (recordings, fitted) = (session.document.recordings.clone(), Arc::clone(&analysis));
    session.jobs.start(ctx, JUDGE, "", move |_| {
        let enough = judge(&fitted, &recordings);
        change(|session, _| session.calibration.enough = enough)
    });
    let recordings = session.document.recordings.clone();
    session.jobs.start(ctx, SIMULATE, "Replaying in the fitted world", move |_| {
        let replays = replay_all(&analysis.world, &recordings);
        change(|session, _| session.calibration.replays = replays)
    });
}
