//! Lessons in Train: watching an expert, practising, the test, and its result. No drawing here.

use crate::recorder::Stopping;
use crate::text::sentence::sentence;
use crate::ui::jobs::{JobKind, change};
use crate::ui::lessons::ghost::Ghost;
use crate::ui::lessons::trace;
use crate::ui::lessons::trace::Trace;
use crate::ui::lessons::trace::trace_of;
use crate::ui::session::Session;
use crate::ui::trainer::choice::WorldChoice;
use crate::ui::trainer::live::{Operator, Sensors, Trainer};
use crate::ui::workspace::Workspace;
use estimator::training::lesson::{Attempted, Grade, Lesson, Progress, attempt, expert, grade, practise};
use haptics::recording::Meta;
use haptics::world::World;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Letting the expert of a lesson do it.
const EXPERT: JobKind = JobKind::new("expert");
/// Grading an attempt at a lesson.
const GRADE: JobKind = JobKind::new("grade");

/// How far a trainee is with a lesson.
#[derive(Clone, Debug, PartialEq)]
pub enum Phase {
    /// Reading what it is about.
    Brief,
    /// The expert shows it.
    Watching,
    /// Trying it; nothing is recorded.
    Practising,
    /// The attempt that counts; it is recorded.
    Testing,
    /// The goals are reached; a question is open.
    Asking,
    /// The recording gets its end and is graded.
    Grading,
    /// What came of it.
    Debrief(Box<Debrief>),
}

/// What came of an attempt.
#[derive(Clone, Debug, PartialEq)]
pub struct Debrief {
    /// What it is worth.
    pub grade: Grade,
    /// Its recording.
    pub path: PathBuf,
    /// What the hand did.
    pub trace: Trace,
}

/// A lesson that is open.
pub struct Open {
    /// Which.
    pub lesson: Arc<Lesson>,
    /// Which of its worlds stands there.
    pub variant: usize,
    /// How far the trainee is.
    pub phase: Phase,
    /// How far the attempt is.
    pub progress: Progress,
    /// How the expert did it.
    pub expert: Option<Arc<Trace>>,
    /// Where the ghost is that goes along while practising.
    pub ghost: Ghost,
    world: World,
    attempts: usize,
}

/// What the window knows of lessons.
#[derive(Default)]
pub struct Lessons {
    /// Those on offer; read when they are first asked for.
    pub all: Vec<Arc<Lesson>>,
    /// What is wrong with lessons of the user's.
    pub problems: Vec<String>,
    /// Where the user's lessons are; absent: nowhere.
    pub folder: Option<PathBuf>,
    /// The side of Train shows lessons.
    pub shown: bool,
    /// The one that is open.
    pub open: Option<Box<Open>>,
    /// A ghost of the expert's fingers goes along while practising.
    pub ghost_off: bool,
    loaded: bool,
}

impl Lessons {
    /// Reads the lessons, once.
    pub fn load(&mut self) {
        if std::mem::replace(&mut self.loaded, true) {
            return;
        }
        let folder = self.folder.clone().or_else(crate::lessons::own_folder);
        let (all, problems) = crate::lessons::all(folder.as_deref());
        self.problems = problems;
        self.all = all.into_iter().map(Arc::new).collect();
    }
}

impl Lessons {
    /// What may be answered now; nothing while no question is open.
    pub fn answers(&self) -> Vec<String> {
        let open = self.open.as_deref().filter(|open| open.phase == Phase::Asking);
        open.and_then(|open| open.lesson.question.as_ref()).map(|q| q.answers.clone()).unwrap_or_default()
    }
}

impl Open {
    fn new(lesson: &Arc<Lesson>, variant: usize) -> Result<Self, String> {
        let world = lesson.world(variant).map_err(|error| sentence(&error.to_string()))?;
        let progress = Progress::live(lesson, &world);
        Ok(Self {
            lesson: Arc::clone(lesson),
            variant,
            phase: Phase::Brief,
            progress,
            expert: None,
            ghost: Ghost::default(),
            world,
            attempts: 0,
        })
    }

    /// Begins anew, with a world that is drawn again where the lesson has several.
    fn begin(&mut self, trainer: &mut Trainer, operator: Operator) -> Result<(), String> {
        let count = self.lesson.variant_count();
        if count > 1 {
            // Another one each time, in no order that could be learned; where nobody looks at the clock, in order.
            let drawn =
                std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH).map_or(0, |d| d.subsec_nanos());
            self.attempts += 1;
            self.variant = match trainer.clock {
                crate::ui::trainer::live::Clock::RealTime => drawn as usize % count,
                crate::ui::trainer::live::Clock::Manual => self.attempts % count,
            };
            self.world = self.lesson.world(self.variant).map_err(|error| sentence(&error.to_string()))?;
        }
        trainer.discard_recording();
        trainer.script.acts = (operator == Operator::Scripted).then(|| self.lesson.acts().into());
        trainer.file = Some(self.world.clone());
        (trainer.operator, trainer.choice) = (operator, WorldChoice::File);
        trainer.restart()?;
        self.progress = Progress::live(&self.lesson, &self.world);
        self.ghost = Ghost::default();
        Ok(())
    }

    /// Which step the expert shows now.
    pub fn step(&self, trainer: &Trainer) -> Option<usize> {
        let now_s = trainer.scene()?.0.state.time_s;
        trainer.acts_begin_s.iter().rposition(|begin_s| *begin_s <= now_s)
    }

    fn attempted(&self, trainer: &Trainer, answer: Option<usize>) -> Attempted {
        let line = trainer.delay();
        Attempted {
            answer,
            delay_ms: 1e3 * line.round_trip_s,
            predicted: line.predicted && !line.is_none(),
            definition: Some(Box::new((*self.lesson).clone())),
            ..Attempted::at(&self.lesson, self.variant)
        }
    }
}

impl Session {
    /// Opens a lesson and puts its world into the trainer; the expert does it unseen, in the background.
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
        if let Some(lesson) = self.lessons.all.iter().find(|lesson| lesson.title == title).cloned() {
            self.workspace = Workspace::Train;
            self.close_lesson();
            self.open_lesson(ctx, &lesson);
        }
    }

    /// The same at once, for pictures.
    pub fn open_lesson_now(&mut self, lesson: &Arc<Lesson>) {
        if self.open_lesson_only(lesson) {
            self.expert_did_it(trace::of_expert(lesson));
        }
    }

    /// Makes a lesson of the calibrated world, with experts of its own; in the background.
    pub fn practise_on_this(&mut self, ctx: &egui::Context) {
        let Some(world) = self.analysis.as_ref().map(|analysis| analysis.world.clone()) else { return };
        self.jobs.start(ctx, EXPERT, "Watching an expert in this world", move |_| {
            let measured = practise::on(world).and_then(|mut lesson| {
                lesson.expert = Some(expert::measure(&lesson)?);
                Ok(lesson)
            });
            let lesson = measured.map_err(|error| sentence(&error.to_string()));
            change(|session: &mut Self, ctx| session.lesson_made(ctx, lesson))
        });
    }

    /// The lesson in the calibrated world is ready.
    pub(crate) fn lesson_made(&mut self, ctx: &egui::Context, lesson: Result<Lesson, String>) {
        match lesson {
            Ok(lesson) => {
                self.workspace = Workspace::Train;
                self.open_lesson(ctx, &Arc::new(lesson));
            }
            Err(problem) => self.fail(problem),
        }
    }

    fn open_lesson_only(&mut self, lesson: &Arc<Lesson>) -> bool {
        self.close_lesson();
        let opened = Open::new(lesson, 0).and_then(|mut open| {
            open.begin(&mut self.trainer, Operator::You)?;
            Ok(open)
        });
        match opened {
            Ok(open) => {
                self.lessons.open = Some(Box::new(open));
                self.lessons.shown = true;
                true
            }
            Err(problem) => {
                self.fail(problem);
                false
            }
        }
    }

    /// Leaves the lesson; an attempt that is not over is removed.
    pub fn close_lesson(&mut self) {
        let Some(open) = self.lessons.open.take() else { return };
        if matches!(open.phase, Phase::Testing | Phase::Asking) {
            self.trainer.discard_recording();
        }
        self.trainer.script.acts = None;
        // An expert who shows something stops, and the trainee has the hand again.
        if self.trainer.operator == Operator::Scripted
            && let Err(problem) = self.trainer.hand_to(Operator::You)
        {
            self.fail(problem);
        }
    }

    /// Lets the expert show the lesson.
    pub fn watch_lesson(&mut self) {
        self.begin_phase(Phase::Watching, Operator::Scripted);
    }

    /// Lets the trainee try it.
    pub fn practise_lesson(&mut self) {
        self.begin_phase(Phase::Practising, Operator::You);
    }

    /// Begins the attempt that counts.
    pub fn test_lesson(&mut self) {
        self.begin_phase(Phase::Testing, Operator::You);
        let Some(open) = self.lessons.open.as_ref().filter(|open| open.phase == Phase::Testing) else { return };
        let mut stated = Meta::default();
        stated.other.insert(attempt::SIDECAR_KEY.to_owned(), open.attempted(&self.trainer, None).to_json());
        (self.trainer.stated, self.trainer.sensors) = (stated, Sensors::Ideal);
        let begun = self.trainer.start_recording();
        (self.trainer.stated, self.trainer.sensors) = (Meta::default(), Sensors::Usual);
        if let Err(problem) = begun {
            self.back_to_brief();
            self.fail(problem);
        }
    }

    fn begin_phase(&mut self, phase: Phase, operator: Operator) {
        let Some(open) = &mut self.lessons.open else { return };
        match open.begin(&mut self.trainer, operator) {
            Ok(()) => open.phase = phase,
            Err(problem) => {
                open.phase = Phase::Brief;
                self.fail(problem);
            }
        }
    }

    /// Back to what the lesson is about; an attempt that is not over is removed.
    pub fn back_to_brief(&mut self) {
        self.begin_phase(Phase::Brief, Operator::You);
    }

    /// Looks how far the attempt is. False when it is over because another world was chosen.
    pub(crate) fn see_lesson(&mut self) -> bool {
        let (Some(open), Some((snapshot, world))) = (&mut self.lessons.open, self.trainer.scene()) else {
            return false;
        };
        let is_on = matches!(open.phase, Phase::Watching | Phase::Practising | Phase::Testing | Phase::Asking);
        if is_on && **world != open.world {
            // What was recorded of it until then is no attempt.
            self.lessons.open = None;
            self.trainer.script.acts = None;
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

    /// Once a frame: watches the attempt and ends it when its goals are reached, a rule was broken or its time is over.
    pub(crate) fn follow_lesson(&mut self, ctx: &egui::Context) {
        if !self.see_lesson() {
            return;
        }
        let Some(open) = self.lessons.open.as_mut().filter(|open| open.phase == Phase::Testing) else { return };
        if !self.trainer.is_recording() {
            // The disk is full, or the servo has stopped: it was said.
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

    /// The trainee gives up, or has answered: the attempt is graded from its file.
    pub fn end_lesson(&mut self, ctx: &egui::Context, answer: Option<usize>) {
        let Some(open) = &mut self.lessons.open else { return };
        if answer.is_some() {
            self.trainer.state_at_end(attempt::SIDECAR_KEY, open.attempted(&self.trainer, answer).to_json());
        }
        open.phase = Phase::Grading;
        let Some(stopping) = self.trainer.stop_recording() else { return };
        let lesson = Arc::clone(&open.lesson);
        self.jobs.start(ctx, GRADE, "", move |_| {
            let debrief = grade_file(&lesson, stopping);
            change(|session: &mut Self, _| session.graded(debrief))
        });
    }

    /// Ends the attempt and grades it at once, for pictures.
    pub fn end_lesson_now(&mut self, answer: Option<usize>) {
        let Some(open) = &mut self.lessons.open else { return };
        if answer.is_some() {
            self.trainer.state_at_end(attempt::SIDECAR_KEY, open.attempted(&self.trainer, answer).to_json());
        }
        let lesson = Arc::clone(&open.lesson);
        let Some(stopping) = self.trainer.stop_recording() else { return };
        self.graded(grade_file(&lesson, stopping));
    }

    /// The attempt was graded.
    pub(crate) fn graded(&mut self, debrief: Result<Debrief, String>) {
        if let Ok(debrief) = &debrief {
            self.keep_graded(debrief);
        }
        let Some(open) = &mut self.lessons.open else { return };
        match debrief {
            Ok(debrief) => open.phase = Phase::Debrief(Box::new(debrief)),
            Err(problem) => {
                open.phase = Phase::Brief;
                self.fail(problem);
            }
        }
    }

    /// The expert has done the lesson, unseen.
    pub(crate) fn expert_did_it(&mut self, trace: Result<Trace, String>) {
        let Some(open) = &mut self.lessons.open else { return };
        match trace {
            Ok(trace) => open.expert = Some(Arc::new(trace)),
            Err(problem) => self.fail(problem),
        }
    }
}

/// Waits for the end of the recording and grades what is in it.
fn grade_file(lesson: &Lesson, stopping: Stopping) -> Result<Debrief, String> {
    let path = stopping.wait()?.path;
    let (grade, trace) = graded_from(&path, Some(lesson))?;
    Ok(Debrief { grade, path, trace })
}

/// Grades the attempt in a recording: by the lesson given, else by the one that travels in it.
///
/// # Errors
/// One sentence: it is no attempt, or it cannot be read.
pub fn graded_from(path: &Path, lesson: Option<&Lesson>) -> Result<(Grade, Trace), String> {
    let told = |error: &dyn std::fmt::Display| sentence(&error.to_string());
    let recording = estimator::log::load(path, None).map_err(|e| told(&e))?.into_iter().next();
    let recording = recording.ok_or("The attempt was not recorded.")?;
    let attempted =
        Attempted::of(&recording).map_err(|e| told(&e))?.ok_or("This recording is no attempt at a lesson.")?;
    let own = attempted.definition.clone();
    let lesson = lesson.or(own.as_deref()).ok_or("The lesson of this attempt is not known here.")?;
    let bytes = estimator::log::attached(path, "world.json").map_err(|e| told(&e))?;
    let text = bytes.and_then(|bytes| String::from_utf8(bytes).ok()).ok_or("The recording has lost its world.")?;
    let world = World::from_json(&text).map_err(|e| told(&e))?;
    let grade = grade(lesson, &attempted, &world, &recording).map_err(|e| told(&e))?;
    Ok((grade, trace_of(&recording)))
}
