//! Following what happens between frames: the answers of jobs, and the features that watch something.

use crate::ui::calibrate::fitting;
use crate::ui::calibrate::state::Calibration;
use crate::ui::calibrate::what_if_actions;
use crate::ui::diagnose::experiment_state::Experiments;
use crate::ui::diagnose::guidance;
use crate::ui::document::opening;
use crate::ui::document::project_files;
use crate::ui::document::state::Document;
use crate::ui::document::undo_actions;
use crate::ui::session::Session;
use crate::ui::shell::message_list::Messages;
use crate::ui::train::lessons::practising;
use crate::ui::train::trainees;

/// Takes in what the jobs bring; call once a frame.
pub fn poll(session: &mut Session, ctx: &egui::Context) {
    for answer in session.jobs.poll() {
        match answer {
            Ok(change) => change(session, ctx),
            Err(problem) => job_failed(
                &session.document,
                &mut session.calibration,
                &mut session.experiments,
                &mut session.messages,
                problem,
            ),
        }
    }
    crate::ui::train::recorder::follow(ctx, &mut session.training.trainer, &mut session.jobs);
    guidance::follow_experiment(&mut session.experiments, &mut session.training.trainer, &mut session.jobs, ctx);
    trainees::follow_history(&mut session.training.learning, &mut session.messages);
    practising::follow_lesson(&mut session.training, &mut session.jobs, ctx);
    let (now_s, held) = ctx.input(|i| (i.time, i.pointer.any_down()));
    undo_actions::note_changes(&mut session.document, &session.calibration, &session.plots, now_s, held);
    fitting::follow_choice(&session.document, &mut session.calibration, &mut session.jobs, ctx);
    what_if_actions::follow_what_if(&session.document, &session.calibration, &mut session.jobs, ctx);
}

/// A job has failed.
fn job_failed(
    document: &Document,
    calibration: &mut Calibration,
    experiments: &mut Experiments,
    messages: &mut Messages,
    problem: String,
) {
    experiments.asks_again = false;
    if !document.recordings.is_empty() && calibration.analysis.is_none() {
        calibration.fit_problem = Some(problem.clone());
    }
    messages.fail(problem);
}

/// Reads the same log again.
pub fn reload(session: &mut Session, ctx: &egui::Context) {
    match session.document.path.clone() {
        Some(_) if session.document.sources.len() > 1 => {
            project_files::restore(
                &mut session.messages,
                &mut session.jobs,
                ctx,
                project_files::project_of(session.workspace, &session.document, &session.calibration, &session.plots),
            );
        }
        Some(path) => opening::open(&mut session.document, &mut session.jobs, ctx, &path),
        None => session.messages.fail("There is no file to reload: open a log first."),
    }
}
