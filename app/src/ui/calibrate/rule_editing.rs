//! Editing the rules of a task: trying and saving the draft.

use crate::text::sentence::sentence;
use crate::ui::background::jobs::Jobs;
use crate::ui::calibrate::fitting;
use crate::ui::calibrate::refits::SEGMENT;
use crate::ui::calibrate::rules::Rules;
use crate::ui::calibrate::state::Calibration;
use crate::ui::document::files::{SAVE, saved};
use crate::ui::document::state::Document;
use crate::ui::session::Session;
use crate::ui::shell::message_list::Messages;
use estimator::segment::library;
use std::sync::Arc;

/// Opens the rules of the task that is chosen; says why not where it has none.
pub fn open(document: &Document, calibration: &Calibration, messages: &mut Messages) -> Option<Box<Rules>> {
    let found = document.prepared().cloned().and_then(|prepared| calibration.choice.definition(&prepared));
    match found {
        Some(Ok(task)) => Some(Box::new(Rules::of(task))),
        Some(Err(problem)) => {
            messages.fail(problem);
            None
        }
        None => {
            messages.fail("The task of this recording is not known; choose one first.");
            None
        }
    }
}

/// Looks at what was changed, and tells the states anew with it. Call once a frame.
pub fn follow(ctx: &egui::Context, document: &Document, calibration: &mut Calibration, jobs: &mut Jobs<Session>) {
    let running = jobs.is_running(SEGMENT);
    let Some(rules) = calibration.rules.as_mut().filter(|rules| rules.untried) else { return };
    rules.fault = rules.draft.fault().map(|fault| sentence(&fault));
    if rules.fault.is_some() {
        rules.untried = false;
        return;
    }
    if running {
        // One after the other: the newest draft waits for its turn.
        return;
    }
    rules.untried = false;
    let same = rules.draft == rules.before;
    let draft = rules.draft.clone();
    if !same || calibration.choice.own.is_some() {
        calibration.choice.task = Some(draft.like);
        calibration.choice.own = Some(Arc::new(draft));
    }
    fitting::resegment(document, calibration, jobs, ctx);
}

/// Writes the draft under its new name, in the background.
pub fn save(
    ctx: &egui::Context,
    document: &Document,
    calibration: &mut Calibration,
    messages: &mut Messages,
    jobs: &mut Jobs<Session>,
) {
    let Some(rules) = calibration.rules.as_mut() else { return };
    let mut task = rules.draft.clone();
    rules.name.trim().clone_into(&mut task.name);
    if task.title == rules.before.title && task.name != rules.before.name {
        task.title = task.name.replace(['-', '_'], " ");
    }
    let Some(folder) = library::folder() else {
        messages.fail("This system names no folder for a user's data; save the task by hand (docs/tasks.md).");
        return;
    };
    match library::save(folder, &task) {
        Ok(path) => {
            (rules.before, rules.draft) = (task.clone(), task.clone());
            calibration.choice.task = Some(task.like);
            calibration.choice.own = Some(Arc::new(task));
            fitting::resegment(document, calibration, jobs, ctx);
            jobs.start(ctx, SAVE, "", move |_| saved(path));
        }
        Err(error) => messages.fail(sentence(&error.to_string())),
    }
}
