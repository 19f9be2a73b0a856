//! Lessons in Train: watching an expert, practising, the test, and its result. No drawing here.

use crate::text::sentence::sentence;
use crate::ui::lessons::kept;
use crate::ui::lessons::state::{Debrief, EXPERT, GRADE, Open, Phase, grade_file};
use crate::ui::lessons::trace;
use crate::ui::lessons::trace::Trace;
use crate::ui::session::{Session, change};
use crate::ui::trainer::live::{Operator, Sensors};
use crate::ui::workspace::Workspace;
use estimator::training::lesson::{Lesson, attempt, expert, practise};
use haptics::recording::Meta;
use std::sync::Arc;

/// Opens a lesson and loads its world into the trainer; the expert performs it unseen, in the background.
pub fn open_lesson(session: &mut Session, ctx: &egui::Context, lesson: &Arc<Lesson>) {
    if open_lesson_only(session, lesson) {
        let lesson = Arc::clone(lesson);
        session.jobs.start(ctx, EXPERT, "", move |_| {
            let trace = trace::of_expert(&lesson);
            change(|session, _| expert_did_it(session, trace))
        });
    }
}

/// The same by its title, in Train.
pub fn open_lesson_titled(session: &mut Session, ctx: &egui::Context, title: &str) {
    if let Some(lesson) = session.training.lessons.all.iter().find(|lesson| lesson.title == title).cloned() {
        session.workspace = Workspace::Train;
        close_lesson(session);
        open_lesson(session, ctx, &lesson);
    }
}

/// The same synchronously, for screenshots.
pub fn open_lesson_now(session: &mut Session, lesson: &Arc<Lesson>) {
    if open_lesson_only(session, lesson) {
        expert_did_it(session, trace::of_expert(lesson));
    }
}

/// Makes a lesson of the calibrated world, with an expert reference of its own, in the background.
pub fn practise_on_this(session: &mut Session, ctx: &egui::Context) {
    let Some(world) = session.calibration.analysis.as_ref().map(|analysis| analysis.world.clone()) else { return };
    session.jobs.start(ctx, EXPERT, "Watching an expert in this world", move |_| {
        let measured = practise::on(world).and_then(|mut lesson| {
            lesson.expert = Some(expert::measure(&lesson)?);
            Ok(lesson)
        });
        let lesson = measured.map_err(|error| sentence(&error.to_string()));
        change(|session, ctx| lesson_made(session, ctx, lesson))
    });
}

/// Receives the finished lesson of the calibrated world.
pub(crate) fn lesson_made(session: &mut Session, ctx: &egui::Context, lesson: Result<Lesson, String>) {
    match lesson {
        Ok(lesson) => {
            session.workspace = Workspace::Train;
            open_lesson(session, ctx, &Arc::new(lesson));
        }
        Err(problem) => session.messages.fail(problem),
    }
}

fn open_lesson_only(session: &mut Session, lesson: &Arc<Lesson>) -> bool {
    close_lesson(session);
    let opened = Open::new(lesson, 0).and_then(|mut open| {
        open.begin(&mut session.training.trainer, Operator::You)?;
        Ok(open)
    });
    match opened {
        Ok(open) => {
            session.training.lessons.open = Some(Box::new(open));
            session.training.lessons.shown = true;
            true
        }
        Err(problem) => {
            session.messages.fail(problem);
            false
        }
    }
}

/// Closes the lesson; an unfinished attempt is removed.
pub fn close_lesson(session: &mut Session) {
    let Some(open) = session.training.lessons.open.take() else { return };
    if matches!(open.phase, Phase::Testing | Phase::Asking) {
        session.training.trainer.discard_recording();
    }
    session.training.trainer.script.acts = None;
    // A demonstrating expert stops, and the trainee regains control.
    if session.training.trainer.operator == Operator::Scripted
        && let Err(problem) = session.training.trainer.hand_to(Operator::You)
    {
        session.messages.fail(problem);
    }
}

/// Starts the expert's demonstration.
pub fn watch_lesson(session: &mut Session) {
    begin_phase(session, Phase::Watching, Operator::Scripted);
}

/// Starts practice.
pub fn practise_lesson(session: &mut Session) {
    begin_phase(session, Phase::Practising, Operator::You);
}

/// Starts the attempt that counts.
pub fn test_lesson(session: &mut Session) {
    begin_phase(session, Phase::Testing, Operator::You);
    let Some(open) = session.training.lessons.open.as_ref().filter(|open| open.phase == Phase::Testing) else {
        return;
    };
    let mut stated = Meta::default();
    stated.other.insert(attempt::SIDECAR_KEY.to_owned(), open.attempted(&session.training.trainer, None).to_json());
    (session.training.trainer.stated, session.training.trainer.sensors) = (stated, Sensors::Ideal);
    let begun = session.training.trainer.start_recording();
    (session.training.trainer.stated, session.training.trainer.sensors) = (Meta::default(), Sensors::Usual);
    if let Err(problem) = begun {
        back_to_brief(session);
        session.messages.fail(problem);
    }
}

fn begin_phase(session: &mut Session, phase: Phase, operator: Operator) {
    let Some(open) = &mut session.training.lessons.open else { return };
    match open.begin(&mut session.training.trainer, operator) {
        Ok(()) => open.phase = phase,
        Err(problem) => {
            open.phase = Phase::Brief;
            session.messages.fail(problem);
        }
    }
}

/// Returns to the description of the lesson; an unfinished attempt is removed.
pub fn back_to_brief(session: &mut Session) {
    begin_phase(session, Phase::Brief, Operator::You);
}

/// Updates the progress of the attempt. False if it ended because another world was chosen.
pub(crate) fn see_lesson(session: &mut Session) -> bool {
    let (Some(open), Some((snapshot, world))) = (&mut session.training.lessons.open, session.training.trainer.scene())
    else {
        return false;
    };
    let is_on = matches!(open.phase, Phase::Watching | Phase::Practising | Phase::Testing | Phase::Asking);
    if is_on && **world != open.world {
        // The part recorded until then is not an attempt.
        session.training.lessons.open = None;
        session.training.trainer.script.acts = None;
        return false;
    }
    if matches!(open.phase, Phase::Practising | Phase::Testing) {
        open.progress.see(snapshot.state.time_s, &snapshot.state);
    }
    if let (Phase::Practising, Some(way)) = (&open.phase, &open.expert) {
        let state = &snapshot.state;
        let touches = state.tip_force_n.iter().any(|force| force.norm() > trace::TOUCH_N);
        open.ghost.see(way, state.time_s, state.input.tip_in_world, touches);
    }
    true
}

/// Runs once per frame: follows the attempt and ends it when its goals are reached, a rule is broken or its time is
/// over.
pub(crate) fn follow_lesson(session: &mut Session, ctx: &egui::Context) {
    if !see_lesson(session) {
        return;
    }
    let Some(open) = session.training.lessons.open.as_mut().filter(|open| open.phase == Phase::Testing) else {
        return;
    };
    if !session.training.trainer.is_recording() {
        // The disk is full, or the servo has stopped: this was reported.
        open.phase = Phase::Brief;
        return;
    }
    let over = open.progress.running_s() > open.lesson.at_most_s || open.progress.broken().is_some();
    if open.progress.is_completed() && open.lesson.question.is_some() {
        open.phase = Phase::Asking;
    } else if over || open.progress.is_completed() {
        end_lesson(session, ctx, None);
    }
}

/// Ends the attempt because the trainee gives up or has answered; it is graded from its file.
pub fn end_lesson(session: &mut Session, ctx: &egui::Context, answer: Option<usize>) {
    let Some(open) = &mut session.training.lessons.open else { return };
    if answer.is_some() {
        session
            .training
            .trainer
            .state_at_end(attempt::SIDECAR_KEY, open.attempted(&session.training.trainer, answer).to_json());
    }
    open.phase = Phase::Grading;
    let Some(stopping) = session.training.trainer.stop_recording() else { return };
    let lesson = Arc::clone(&open.lesson);
    session.jobs.start(ctx, GRADE, "", move |_| {
        let debrief = grade_file(&lesson, stopping);
        change(|session, _| graded(session, debrief))
    });
}

/// Ends the attempt and grades it synchronously, for screenshots.
pub fn end_lesson_now(session: &mut Session, answer: Option<usize>) {
    let Some(open) = &mut session.training.lessons.open else { return };
    if answer.is_some() {
        session
            .training
            .trainer
            .state_at_end(attempt::SIDECAR_KEY, open.attempted(&session.training.trainer, answer).to_json());
    }
    let lesson = Arc::clone(&open.lesson);
    let Some(stopping) = session.training.trainer.stop_recording() else { return };
    graded(session, grade_file(&lesson, stopping));
}

/// Receives the result of the grading.
pub(crate) fn graded(session: &mut Session, debrief: Result<Debrief, String>) {
    if let Ok(debrief) = &debrief {
        kept::keep_graded(session, debrief);
    }
    let Some(open) = &mut session.training.lessons.open else { return };
    match debrief {
        Ok(debrief) => open.phase = Phase::Debrief(Box::new(debrief)),
        Err(problem) => {
            open.phase = Phase::Brief;
            session.messages.fail(problem);
        }
    }
}

/// Receives the trace of the expert's unseen performance.
pub(crate) fn expert_did_it(session: &mut Session, trace: Result<Trace, String>) {
    let Some(open) = &mut session.training.lessons.open else { return };
    match trace {
        Ok(trace) => open.expert = Some(Arc::new(trace)),
        Err(problem) => session.messages.fail(problem),
    }
}
