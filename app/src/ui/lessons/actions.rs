//! Lessons in Train: watching an expert, practising, the test, and its result. No drawing here.

use crate::text::sentence::sentence;
use crate::ui::jobs::change;
use crate::ui::lessons::state::{Debrief, EXPERT, GRADE, Open, Phase, grade_file};
use crate::ui::lessons::trace;
use crate::ui::lessons::trace::Trace;
use crate::ui::session::Session;
use crate::ui::trainer::live::{Operator, Sensors};
use crate::ui::workspace::Workspace;
use estimator::training::lesson::{Lesson, attempt, expert, practise};
use haptics::recording::Meta;
use std::sync::Arc;

impl Session {
    /// Opens a lesson and loads its world into the trainer; the expert performs it unseen, in the background.
    pub fn open_lesson(&mut self, ctx: &egui::Context, lesson: &Arc<Lesson>) {
        if self.open_lesson_only(lesson) {
            let lesson = Arc::clone(lesson);
            self.jobs.start(ctx, EXPERT, "", move |_| {
                let trace = trace::of_expert(&lesson);
                change(|session: &mut Self, _| session.expert_did_it(trace))
            });
        }
    }

    /// The same by its title, in Train.
    pub fn open_lesson_titled(&mut self, ctx: &egui::Context, title: &str) {
        if let Some(lesson) = self.training.lessons.all.iter().find(|lesson| lesson.title == title).cloned() {
            self.workspace = Workspace::Train;
            self.close_lesson();
            self.open_lesson(ctx, &lesson);
        }
    }

    /// The same synchronously, for screenshots.
    pub fn open_lesson_now(&mut self, lesson: &Arc<Lesson>) {
        if self.open_lesson_only(lesson) {
            self.expert_did_it(trace::of_expert(lesson));
        }
    }

    /// Makes a lesson of the calibrated world, with an expert reference of its own, in the background.
    pub fn practise_on_this(&mut self, ctx: &egui::Context) {
        let Some(world) = self.calibration.analysis.as_ref().map(|analysis| analysis.world.clone()) else { return };
        self.jobs.start(ctx, EXPERT, "Watching an expert in this world", move |_| {
            let measured = practise::on(world).and_then(|mut lesson| {
                lesson.expert = Some(expert::measure(&lesson)?);
                Ok(lesson)
            });
            let lesson = measured.map_err(|error| sentence(&error.to_string()));
            change(|session: &mut Self, ctx| session.lesson_made(ctx, lesson))
        });
    }

    /// Receives the finished lesson of the calibrated world.
    pub(crate) fn lesson_made(&mut self, ctx: &egui::Context, lesson: Result<Lesson, String>) {
        match lesson {
            Ok(lesson) => {
                self.workspace = Workspace::Train;
                self.open_lesson(ctx, &Arc::new(lesson));
            }
            Err(problem) => self.messages.fail(problem),
        }
    }

    fn open_lesson_only(&mut self, lesson: &Arc<Lesson>) -> bool {
        self.close_lesson();
        let opened = Open::new(lesson, 0).and_then(|mut open| {
            open.begin(&mut self.training.trainer, Operator::You)?;
            Ok(open)
        });
        match opened {
            Ok(open) => {
                self.training.lessons.open = Some(Box::new(open));
                self.training.lessons.shown = true;
                true
            }
            Err(problem) => {
                self.messages.fail(problem);
                false
            }
        }
    }

    /// Closes the lesson; an unfinished attempt is removed.
    pub fn close_lesson(&mut self) {
        let Some(open) = self.training.lessons.open.take() else { return };
        if matches!(open.phase, Phase::Testing | Phase::Asking) {
            self.training.trainer.discard_recording();
        }
        self.training.trainer.script.acts = None;
        // A demonstrating expert stops, and the trainee regains control.
        if self.training.trainer.operator == Operator::Scripted
            && let Err(problem) = self.training.trainer.hand_to(Operator::You)
        {
            self.messages.fail(problem);
        }
    }

    /// Starts the expert's demonstration.
    pub fn watch_lesson(&mut self) {
        self.begin_phase(Phase::Watching, Operator::Scripted);
    }

    /// Starts practice.
    pub fn practise_lesson(&mut self) {
        self.begin_phase(Phase::Practising, Operator::You);
    }

    /// Starts the attempt that counts.
    pub fn test_lesson(&mut self) {
        self.begin_phase(Phase::Testing, Operator::You);
        let Some(open) = self.training.lessons.open.as_ref().filter(|open| open.phase == Phase::Testing) else {
            return;
        };
        let mut stated = Meta::default();
        stated.other.insert(attempt::SIDECAR_KEY.to_owned(), open.attempted(&self.training.trainer, None).to_json());
        (self.training.trainer.stated, self.training.trainer.sensors) = (stated, Sensors::Ideal);
        let begun = self.training.trainer.start_recording();
        (self.training.trainer.stated, self.training.trainer.sensors) = (Meta::default(), Sensors::Usual);
        if let Err(problem) = begun {
            self.back_to_brief();
            self.messages.fail(problem);
        }
    }

    fn begin_phase(&mut self, phase: Phase, operator: Operator) {
        let Some(open) = &mut self.training.lessons.open else { return };
        match open.begin(&mut self.training.trainer, operator) {
            Ok(()) => open.phase = phase,
            Err(problem) => {
                open.phase = Phase::Brief;
                self.messages.fail(problem);
            }
        }
    }

    /// Returns to the description of the lesson; an unfinished attempt is removed.
    pub fn back_to_brief(&mut self) {
        self.begin_phase(Phase::Brief, Operator::You);
    }

    /// Updates the progress of the attempt. False if it ended because another world was chosen.
    pub(crate) fn see_lesson(&mut self) -> bool {
        let (Some(open), Some((snapshot, world))) = (&mut self.training.lessons.open, self.training.trainer.scene())
        else {
            return false;
        };
        let is_on = matches!(open.phase, Phase::Watching | Phase::Practising | Phase::Testing | Phase::Asking);
        if is_on && **world != open.world {
            // The part recorded until then is not an attempt.
            self.training.lessons.open = None;
            self.training.trainer.script.acts = None;
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
    pub(crate) fn follow_lesson(&mut self, ctx: &egui::Context) {
        if !self.see_lesson() {
            return;
        }
        let Some(open) = self.training.lessons.open.as_mut().filter(|open| open.phase == Phase::Testing) else {
            return;
        };
        if !self.training.trainer.is_recording() {
            // The disk is full, or the servo has stopped: this was reported.
            open.phase = Phase::Brief;
            return;
        }
        let over = open.progress.running_s() > open.lesson.at_most_s || open.progress.broken().is_some();
        if open.progress.is_completed() && open.lesson.question.is_some() {
            open.phase = Phase::Asking;
        } else if over || open.progress.is_completed() {
            self.end_lesson(ctx, None);
        }
    }

    /// Ends the attempt because the trainee gives up or has answered; it is graded from its file.
    pub fn end_lesson(&mut self, ctx: &egui::Context, answer: Option<usize>) {
        let Some(open) = &mut self.training.lessons.open else { return };
        if answer.is_some() {
            self.training
                .trainer
                .state_at_end(attempt::SIDECAR_KEY, open.attempted(&self.training.trainer, answer).to_json());
        }
        open.phase = Phase::Grading;
        let Some(stopping) = self.training.trainer.stop_recording() else { return };
        let lesson = Arc::clone(&open.lesson);
        self.jobs.start(ctx, GRADE, "", move |_| {
            let debrief = grade_file(&lesson, stopping);
            change(|session: &mut Self, _| session.graded(debrief))
        });
    }

    /// Ends the attempt and grades it synchronously, for screenshots.
    pub fn end_lesson_now(&mut self, answer: Option<usize>) {
        let Some(open) = &mut self.training.lessons.open else { return };
        if answer.is_some() {
            self.training
                .trainer
                .state_at_end(attempt::SIDECAR_KEY, open.attempted(&self.training.trainer, answer).to_json());
        }
        let lesson = Arc::clone(&open.lesson);
        let Some(stopping) = self.training.trainer.stop_recording() else { return };
        self.graded(grade_file(&lesson, stopping));
    }

    /// Receives the result of the grading.
    pub(crate) fn graded(&mut self, debrief: Result<Debrief, String>) {
        if let Ok(debrief) = &debrief {
            self.keep_graded(debrief);
        }
        let Some(open) = &mut self.training.lessons.open else { return };
        match debrief {
            Ok(debrief) => open.phase = Phase::Debrief(Box::new(debrief)),
            Err(problem) => {
                open.phase = Phase::Brief;
                self.messages.fail(problem);
            }
        }
    }

    /// Receives the trace of the expert's unseen performance.
    pub(crate) fn expert_did_it(&mut self, trace: Result<Trace, String>) {
        let Some(open) = &mut self.training.lessons.open else { return };
        match trace {
            Ok(trace) => open.expert = Some(Arc::new(trace)),
            Err(problem) => self.messages.fail(problem),
        }
    }
}
