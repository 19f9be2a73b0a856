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
        if self.recordings.is_empty() {
            return;
        }
        self.what_if.forget();
        self.jobs.cancel_after(FIT);
        self.stale = false;
        let (recordings, choice) = (self.recordings.clone(), self.choice.clone());
        let shared = self.refits.shared(&choice);
        self.refits.asked = Some(choice.clone());
        self.refits.begun = Instant::now();
        let job = self.jobs.start(ctx, FIT, "Fitting", move |_| {
            let analysis = analyse_sharing(&recordings, &shared, &choice)?;
            change(move |session: &mut Self, ctx| session.fitted(ctx, analysis))
        });
        job.if_given_up(|session: &mut Self, _| {
            if session.analysis.is_none() {
                session.fit_problem = Some("The fit was cancelled; press Fit to start it again.".to_owned());
            }
            session.refits.gave_up();
            session.stale = true;
        });
    }

    /// Sees whether the fit on the screen still is what was chosen, and makes it follow where that is quick. Call once a frame.
    pub fn follow_choice(&mut self, ctx: &egui::Context) {
        let Some(asked) = &self.refits.asked else { return };
        self.stale = *asked != self.choice;
        let busy = self.jobs.is_running(FIT);
        // While rules are edited only the states follow: a fit with half a rule is of no use.
        if self.stale && self.refits.live && self.refits.quick() && !busy && self.rules.is_none() {
            self.refit(ctx);
        }
    }

    /// Tells the states of the shown recording anew, in the background; the fit stays as it was.
    pub fn resegment(&mut self, ctx: &egui::Context) {
        let Some(prepared) = self.prepared().cloned() else { return };
        let (index, choice) = (self.current, self.choice.clone());
        self.jobs.start(ctx, SEGMENT, "", move |_| {
            let recording = choice.given_to(index, &prepared.recording);
            let found = segment_by(choice.method, &recording, choice.task, choice.thresholds)
                .map_err(|error| sentence(&error.to_string()))?;
            change(move |session: &mut Self, _| session.segmented(index, found))
        });
    }

    /// The states of one recording were told anew.
    pub(super) fn segmented(&mut self, index: usize, found: Segmentation) {
        let Some(analysis) = self.analysis.as_mut() else { return };
        if let Some(place) = Arc::make_mut(analysis).segmentations.get_mut(index) {
            *place = Some(found);
        }
    }

    /// A fit has come.
    pub(super) fn fitted(&mut self, ctx: &egui::Context, analysis: Analysis) {
        self.refits.took = Some(self.refits.begun.elapsed());
        let analysis = Arc::new(analysis);
        self.analysis = Some(Arc::clone(&analysis));
        self.fit_problem = None;
        let (recordings, fitted) = (self.recordings.clone(), Arc::clone(&analysis));
        self.jobs.start(ctx, JUDGE, "", move |_| {
            let enough = judge(&fitted, &recordings);
            change(|session: &mut Self, _| session.enough = enough)
        });
        let recordings = self.recordings.clone();
        self.jobs.start(ctx, SIMULATE, "Replaying in the fitted world", move |_| {
            let replays = replay_all(&analysis.world, &recordings);
            change(|session: &mut Self, _| session.replays = replays)
        });
    }
}
