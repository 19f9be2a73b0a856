//! From the loaded recordings to a fit and its replay, in the background, and again whenever the user changes how.

use super::jobs::change;
use super::session::Session;
use crate::text::sentence::sentence;
use crate::ui::refits::{FIT, JUDGE, SEGMENT, SIMULATE, analyse_sharing, judge, replay_all};
use estimator::pipeline::Analysis;
use estimator::segment::{Segmentation, segment_by};
use std::sync::Arc;
use std::time::Instant;

impl Session {
    /// Segments and fits in the background.
    pub fn refit(&mut self, ctx: &egui::Context) {
        if self.document.recordings.is_empty() {
            return;
        }
        self.calibration.what_if.forget();
        self.jobs.cancel_after(FIT);
        self.calibration.stale = false;
        let (recordings, choice) = (self.document.recordings.clone(), self.calibration.choice.clone());
        let shared = self.calibration.refits.shared(&choice);
        self.calibration.refits.asked = Some(choice.clone());
        self.calibration.refits.begun = Instant::now();
        let job = self.jobs.start(ctx, FIT, "Fitting", move |_| {
            let analysis = analyse_sharing(&recordings, &shared, &choice)?;
            change(move |session: &mut Self, ctx| session.fitted(ctx, analysis))
        });
        job.if_given_up(|session: &mut Self, _| {
            if session.calibration.analysis.is_none() {
                session.calibration.fit_problem =
                    Some("The fit was cancelled; press Fit to start it again.".to_owned());
            }
            session.calibration.refits.gave_up();
            session.calibration.stale = true;
        });
    }

    /// Sees whether the fit on the screen still is what was chosen, and makes it follow where that is quick. Call once a frame.
    pub fn follow_choice(&mut self, ctx: &egui::Context) {
        let Some(asked) = &self.calibration.refits.asked else { return };
        self.calibration.stale = *asked != self.calibration.choice;
        let busy = self.jobs.is_running(FIT);
        // While rules are edited only the states follow: a fit with half a rule is of no use.
        if self.calibration.stale
            && self.calibration.refits.live
            && self.calibration.refits.quick()
            && !busy
            && self.calibration.rules.is_none()
        {
            self.refit(ctx);
        }
    }

    /// Tells the states of the shown recording anew, in the background; the fit stays as it was.
    pub fn resegment(&mut self, ctx: &egui::Context) {
        let Some(prepared) = self.document.prepared().cloned() else { return };
        let (index, choice) = (self.document.current, self.calibration.choice.clone());
        self.jobs.start(ctx, SEGMENT, "", move |_| {
            let recording = choice.given_to(index, &prepared.recording);
            let found = segment_by(choice.method, &recording, choice.task, choice.thresholds)
                .map_err(|error| sentence(&error.to_string()))?;
            change(move |session: &mut Self, _| session.segmented(index, found))
        });
    }

    /// The states of one recording were told anew.
    pub(super) fn segmented(&mut self, index: usize, found: Segmentation) {
        let Some(analysis) = self.calibration.analysis.as_mut() else { return };
        if let Some(place) = Arc::make_mut(analysis).segmentations.get_mut(index) {
            *place = Some(found);
        }
    }

    /// A fit has come.
    pub(super) fn fitted(&mut self, ctx: &egui::Context, analysis: Analysis) {
        self.calibration.refits.took = Some(self.calibration.refits.begun.elapsed());
        let analysis = Arc::new(analysis);
        self.calibration.analysis = Some(Arc::clone(&analysis));
        self.calibration.fit_problem = None;
        let (recordings, fitted) = (self.document.recordings.clone(), Arc::clone(&analysis));
        self.jobs.start(ctx, JUDGE, "", move |_| {
            let enough = judge(&fitted, &recordings);
            change(|session: &mut Self, _| session.calibration.enough = enough)
        });
        let recordings = self.document.recordings.clone();
        self.jobs.start(ctx, SIMULATE, "Replaying in the fitted world", move |_| {
            let replays = replay_all(&analysis.world, &recordings);
            change(|session: &mut Self, _| session.calibration.replays = replays)
        });
    }
}
