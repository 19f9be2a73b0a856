//! Doing an experiment in Train: beginning, watching, ending it.

use super::recorder::RECORD;
use super::session::{Session, change};
use crate::ui::experimenting;
use crate::ui::guided::Phase;
use std::path::PathBuf;

/// Begins the experiment that is ready, or begins it again.
pub fn begin_experiment(session: &mut Session) {
    let Some(guided) = &mut session.experiments.guided else { return };
    if let Err(problem) = guided.begin(&mut session.training.trainer) {
        guided.phase = Phase::Ready;
        session.messages.fail(problem);
    }
}

/// Leaves the experiment; a recording that is not over is removed.
pub fn leave_experiment(session: &mut Session) {
    let guided = session.experiments.guided.take();
    if guided.is_some_and(|g| matches!(g.phase, Phase::Going(_))) {
        session.training.trainer.discard_recording();
    }
}

/// Once a frame: ends the experiment when its time is over.
pub(crate) fn follow_experiment(session: &mut Session, ctx: &egui::Context) {
    let Some(guided) = &mut session.experiments.guided else { return };
    let Some(time_s) = guided.time_s(&session.training.trainer) else { return };
    if !session.training.trainer.is_recording() {
        // Another world was chosen, or the disk is full: what there is of it was saved and said.
        guided.phase = Phase::Ready;
        return;
    }
    if time_s < guided.table.duration_s() {
        return;
    }
    guided.phase = Phase::Ending;
    let Some(stopping) = session.training.trainer.stop_recording() else { return };
    session.jobs.start(ctx, RECORD, "", move |_| {
        let path = stopping.wait().map(|finished| finished.path);
        change(|session, _| followed(session, path))
    });
}

/// The recording of the experiment has its end.
pub(crate) fn followed(session: &mut Session, path: Result<PathBuf, String>) {
    let phase = match path {
        Ok(path) => Phase::Recorded(path),
        Err(problem) => {
            session.messages.fail(problem);
            Phase::Ready
        }
    };
    if let Some(guided) = &mut session.experiments.guided {
        guided.phase = phase;
    }
}

/// A hand on the mouse that follows the rings, for pictures and tests: the trainer's clock must be a manual one.
pub fn follow_rings(session: &mut Session, seconds: f64) {
    const FRAME_S: f64 = 1.0 / 60.0;
    let mut left_s = seconds;
    while left_s > 0.0 {
        let Some(guided) = &session.experiments.guided else { return };
        let Some((step, _, goal)) = guided.now(&session.training.trainer) else { return };
        let (holds, firmer_n) = (step.holds, goal.pinch_n - session.training.trainer.pinch.strength_n());
        let pinch = &mut session.training.trainer.pinch;
        pinch.move_to(goal.center_m);
        pinch.button = holds;
        if holds && firmer_n > 0.0 {
            pinch.strengthen(firmer_n);
        }
        session.training.trainer.advance(FRAME_S);
        left_s -= FRAME_S;
    }
}

/// Adds the recorded experiment to the diagnosis.
pub fn add_followed(session: &mut Session, ctx: &egui::Context) {
    let Some(guided) = session.experiments.guided.take() else { return };
    if let Phase::Recorded(path) = guided.phase {
        experimenting::add_experiment(session, ctx, &path);
    }
}
