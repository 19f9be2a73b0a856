//! Lessons in Train: watching an expert, practising, the test, and its result. No drawing here.

use crate::text::sentence::sentence;
use crate::ui::background::jobs::Jobs;
use crate::ui::calibrate::state::Calibration;
use crate::ui::session::{Session, change};
use crate::ui::shell::message_list::Messages;
use crate::ui::shell::workspace::Workspace;
use crate::ui::train::lessons::kept;
use crate::ui::train::lessons::state::{Debrief, EXPERT, GRADE, Lessons, Open, Phase, grade_file};
use crate::ui::train::lessons::trace;
use crate::ui::train::lessons::trace::Trace;
use crate::ui::train::state::Training;
use crate::ui::train::trainer::live::{Operator, Sensors};
use estimator::training::lesson::{Lesson, attempt, expert, practise};
use haptics::recording::Meta;
use std::sync::Arc;

/// Opens a lesson and loads its world into the trainer; the expert performs it unseen, in the background.
pub fn open_lesson(
    training: &mut Training,
    messages: &mut Messages,
    jobs: &mut Jobs<Session>,
    ctx: &egui::Context,
    lesson: &Arc<Lesson>,
) {
    if open_lesson_only(training, messages, lesson) {
        let lesson = Arc::clone(lesson);
        jobs.start(ctx, EXPERT, "", move |_| {
            let trace = trace::of_expert(&lesson);
            change(|session, _| expert_did_it(&mut session.training.lessons, &mut session.messages, trace))
        });
    }
}

/// The same by its title, in Train.
pub fn open_lesson_titled(
    workspace: &mut Workspace,
    training: &mut Training,
    messages: &mut Messages,
    jobs: &mut Jobs<Session>,
    ctx: &egui::Context,
    title: &str,
) {
    if let Some(lesson) = training.lessons.all.iter().find(|lesson| lesson.title == title).cloned() {
        *workspace = Workspace::Train;
        close_lesson(training, messages);
        open_lesson(training, messages, jobs, ctx, &lesson);
    }
}

/// The same synchronously, for screenshots.
pub fn open_lesson_now(training: &mut Training, messages: &mut Messages, lesson: &Arc<Lesson>) {
    if open_lesson_only(training, messages, lesson) {
        expert_did_it(&mut training.lessons, messages, trace::of_expert(lesson));
    }
}

/// Makes a lesson of the calibrated world, with an expert reference of its own, in the background.
pub fn practise_on_this(calibration: &Calibration, jobs: &mut Jobs<Session>, ctx: &egui::Context) {
    let Some(world) = calibration.analysis.as_ref().map(|analysis| analysis.world.clone()) else { return };
    jobs.start(ctx, EXPERT, "Watching an expert in this world", move |_| {
        let measured = practise::on(world).and_then(|mut lesson| {
            lesson.expert = Some(expert::measure(&lesson)?);
            Ok(lesson)
        });
        let lesson = measured.map_err(|error| sentence(&error.to_string()));
        change(|session, ctx| {
            lesson_made(
                &mut session.workspace,
                &mut session.training,
                &mut session.messages,
                &mut session.jobs,
                ctx,
                lesson,
            );
        })
    });
}

/// Receives the finished lesson of the calibrated world.
pub(crate) fn lesson_made(
    workspace: &mut Workspace,
    training: &mut Training,
    messages: &mut Messages,
    jobs: &mut Jobs<Session>,
    ctx: &egui::Context,
    lesson: Result<Lesson, String>,
) {
    match lesson {
        Ok(lesson) => {
            *workspace = Workspace::Train;
            open_lesson(training, messages, jobs, ctx, &Arc::new(lesson));
        }
        Err(problem) => messages.fail(problem),
    }
}

fn open_lesson_only(training: &mut Training, messages: &mut Messages, lesson: &Arc<Lesson>) -> bool {
    close_lesson(training, messages);
    let opened = Open::new(lesson, 0).and_then(|mut open| {
        open.begin(&mut training.trainer, Operator::You)?;
        Ok(open)
    });
    match opened {
        Ok(open) => {
            training.lessons.open = Some(Box::new(open));
            training.lessons.shown = true;
            true
        }
        Err(problem) => {
            messages.fail(problem);
            false
        }
    }
}

/// Closes the lesson; an unfinished attempt is removed.
pub fn close_lesson(training: &mut Training, messages: &mut Messages) {
    let Some(open) = training.lessons.open.take() else { return };
    if matches!(open.phase, Phase::Testing | Phase::Asking) {
        training.trainer.discard_recording();
    }
    training.trainer.script.acts = None;
    // A demonstrating expert stops, and the trainee regains control.
    if training.trainer.operator == Operator::Scripted
        && let Err(problem) = training.trainer.hand_to(Operator::You)
    {
        messages.fail(problem);
    }
}

/// Starts the expert's demonstration.
pub fn watch_lesson(training: &mut Training, messages: &mut Messages) {
    begin_phase(training, messages, Phase::Watching, Operator::Scripted);
}

/// Starts practice.
pub fn practise_lesson(training: &mut Training, messages: &mut Messages) {
    begin_phase(training, messages, Phase::Practising, Operator::You);
}

/// Starts the attempt that counts.
pub fn test_lesson(training: &mut Training, messages: &mut Messages) {
    begin_phase(training, messages, Phase::Testing, Operator::You);
    let Some(open) = training.lessons.open.as_ref().filter(|open| open.phase == Phase::Testing) else {
        return;
    };
    let mut stated = Meta::default();
    stated.other.insert(attempt::SIDECAR_KEY.to_owned(), open.attempted(&training.trainer, None).to_json());
    (training.trainer.stated, training.trainer.sensors) = (stated, Sensors::Ideal);
    let begun = training.trainer.start_recording();
    (training.trainer.stated, training.trainer.sensors) = (Meta::default(), Sensors::Usual);
    if let Err(problem) = begun {
        back_to_brief(training, messages);
        messages.fail(problem);
    }
}

fn begin_phase(training: &mut Training, messages: &mut Messages, phase: Phase, operator: Operator) {
    let Some(open) = &mut training.lessons.open else { return };
    match open.begin(&mut training.trainer, operator) {
        Ok(()) => open.phase = phase,
        Err(problem) => {
            open.phase = Phase::Brief;
            messages.fail(problem);
        }
    }
}

/// Returns to the description of the lesson; an unfinished attempt is removed.
pub fn back_to_brief(training: &mut Training, messages: &mut Messages) {
    begin_phase(training, messages, Phase::Brief, Operator::You);
}

/// Updates the progress of the attempt. False if it ended because another world was chosen.
pub(crate) fn see_lesson(training: &mut Training) -> bool {
    let (Some(open), Some((snapshot, world))) = (&mut training.lessons.open, training.trainer.scene()) else {
        return false;
    };
    let is_on = matches!(open.phase, Phase::Watching | Phase::Practising | Phase::Testing | Phase::Asking);
    if is_on && **world != open.world {
        // The part recorded until then is not an attempt.
        training.lessons.open = None;
        training.trainer.script.acts = None;
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
pub(crate) fn follow_lesson(training: &mut Training, jobs: &mut Jobs<Session>, ctx: &egui::Context) {
    if !see_lesson(training) {
        return;
    }
    let Some(open) = training.lessons.open.as_mut().filter(|open| open.phase == Phase::Testing) else {
        return;
    };
    if !training.trainer.is_recording() {
        // The disk is full, or the servo has stopped: this was reported.
        open.phase = Phase::Brief;
        return;
    }
    let over = open.progress.running_s() > open.lesson.at_most_s || open.progress.broken().is_some();
    if open.progress.is_completed() && open.lesson.question.is_some() {
        open.phase = Phase::Asking;
    } else if over || open.progress.is_completed() {
        end_lesson(training, jobs, ctx, None);
    }
}

/// Ends the attempt because the trainee gives up or has answered; it is graded from its file.
pub fn end_lesson(training: &mut Training, jobs: &mut Jobs<Session>, ctx: &egui::Context, answer: Option<usize>) {
    let Some(open) = &mut training.lessons.open else { return };
    if answer.is_some() {
        training.trainer.state_at_end(attempt::SIDECAR_KEY, open.attempted(&training.trainer, answer).to_json());
    }
    open.phase = Phase::Grading;
    let Some(stopping) = training.trainer.stop_recording() else { return };
    let lesson = Arc::clone(&open.lesson);
    jobs.start(ctx, GRADE, "", move |_| {
        let debrief = grade_file(&lesson, stopping);
        change(|session, _| graded(&mut session.training, &mut session.messages, debrief))
    });
}

/// Ends the attempt and grades it synchronously, for screenshots.
pub fn end_lesson_now(training: &mut Training, messages: &mut Messages, answer: Option<usize>) {
    let Some(open) = &mut training.lessons.open else { return };
    if answer.is_some() {
        training.trainer.state_at_end(attempt::SIDECAR_KEY, open.attempted(&training.trainer, answer).to_json());
    }
    let lesson = Arc::clone(&open.lesson);
    let Some(stopping) = training.trainer.stop_recording() else { return };
    graded(training, messages, grade_file(&lesson, stopping));
}

/// Receives the result of the grading.
pub(crate) fn graded(training: &mut Training, messages: &mut Messages, debrief: Result<Debrief, String>) {
    if let Ok(debrief) = &debrief {
        kept::keep_graded(training, debrief);
    }
    let Some(open) = &mut training.lessons.open else { return };
    match debrief {
        Ok(debrief) => open.phase = Phase::Debrief(Box::new(debrief)),
        Err(problem) => {
            open.phase = Phase::Brief;
            messages.fail(problem);
        }
    }
}

/// Receives the trace of the expert's unseen performance.
pub(crate) fn expert_did_it(lessons: &mut Lessons, messages: &mut Messages, trace: Result<Trace, String>) {
    let Some(open) = &mut lessons.open else { return };
    match trace {
        Ok(trace) => open.expert = Some(Arc::new(trace)),
        Err(problem) => messages.fail(problem),
    }
}
