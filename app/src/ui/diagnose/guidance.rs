//! Doing an experiment in Train: beginning, watching, ending it.

use crate::ui::background::jobs::Jobs;
use crate::ui::diagnose::experiment;
use crate::ui::diagnose::experiment_state::Experiments;
use crate::ui::diagnose::guided_experiment::Phase;
use crate::ui::session::{Session, change};
use crate::ui::shell::message_list::Messages;
use crate::ui::train::recorder::RECORD;
use crate::ui::train::trainer::live::Trainer;
use std::path::PathBuf;

/// Begins the experiment that is ready, or begins it again.
pub fn begin_experiment(experiments: &mut Experiments, trainer: &mut Trainer, messages: &mut Messages) {
    let Some(guided) = &mut experiments.guided else { return };
    if let Err(problem) = guided.begin(trainer) {
        guided.phase = Phase::Ready;
        messages.fail(problem);
    }
}

/// Leaves the experiment; a recording that is not over is removed.
pub fn leave_experiment(experiments: &mut Experiments, trainer: &mut Trainer) {
    let guided = experiments.guided.take();
    if guided.is_some_and(|g| matches!(g.phase, Phase::Going(_))) {
        trainer.discard_recording();
    }
}

/// Once a frame: ends the experiment when its time is over.
pub(crate) fn follow_experiment(
    experiments: &mut Experiments,
    trainer: &mut Trainer,
    jobs: &mut Jobs<Session>,
    ctx: &egui::Context,
) {
    let Some(guided) = &mut experiments.guided else { return };
    let Some(time_s) = guided.time_s(trainer) else { return };
    if !trainer.is_recording() {
        // Another world was chosen, or the disk is full: what there is of it was saved and said.
        guided.phase = Phase::Ready;
        return;
    }
    if time_s < guided.table.duration_s() {
        return;
    }
    guided.phase = Phase::Ending;
    let Some(stopping) = trainer.stop_recording() else { return };
    jobs.start(ctx, RECORD, "", move |_| {
        let path = stopping.wait().map(|finished| finished.path);
        change(|session, _| followed(&mut session.experiments, &mut session.messages, path))
    });
}

/// The recording of the experiment has its end.
pub(crate) fn followed(experiments: &mut Experiments, messages: &mut Messages, path: Result<PathBuf, String>) {
    let phase = match path {
        Ok(path) => Phase::Recorded(path),
        Err(problem) => {
            messages.fail(problem);
            Phase::Ready
        }
    };
    if let Some(guided) = &mut experiments.guided {
        guided.phase = phase;
    }
}

/// A hand on the mouse that follows the rings, for pictures and tests: the trainer's clock must be a manual one.
pub fn follow_rings(experiments: &Experiments, trainer: &mut Trainer, seconds: f64) {
    const FRAME_S: f64 = 1.0 / 60.0;
    let mut left_s = seconds;
    while left_s > 0.0 {
        let Some(guided) = &experiments.guided else { return };
        let Some((step, _, goal)) = guided.now(trainer) else { return };
        let (holds, firmer_n) = (step.holds, goal.pinch_n - trainer.pinch.strength_n());
        let pinch = &mut trainer.pinch;
        pinch.move_to(goal.center_m);
        pinch.button = holds;
        if holds && firmer_n > 0.0 {
            pinch.strengthen(firmer_n);
        }
        trainer.advance(FRAME_S);
        left_s -= FRAME_S;
    }
}

/// Adds the recorded experiment to the diagnosis.
pub fn add_followed(session: &mut Session, ctx: &egui::Context) {
    let Some(guided) = session.experiments.guided.take() else { return };
    if let Phase::Recorded(path) = guided.phase {
        experiment::add_experiment(session, ctx, &path);
    }
}
