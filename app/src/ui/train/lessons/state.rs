//! Lessons, and the progress of a trainee at one of them.

use crate::recorder::Stopping;
use crate::text::sentence::sentence;
use crate::ui::background::jobs::JobKind;
use crate::ui::train::lessons::ghost::Ghost;
use crate::ui::train::lessons::trace::Trace;
use crate::ui::train::lessons::trace::trace_of;
use crate::ui::train::trainer::live::{Operator, Trainer};
use crate::ui::train::trainer::world_choice::WorldChoice;
use estimator::training::lesson::{Attempted, Grade, Lesson, Progress, grade};
use haptics::world::World;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Letting the expert of a lesson do it.
pub(crate) const EXPERT: JobKind = JobKind::new("expert");

/// Grading an attempt at a lesson.
pub(crate) const GRADE: JobKind = JobKind::new("grade");

/// Stage of a trainee in a lesson.
#[derive(Clone, Debug, PartialEq)]
pub enum Phase {
    /// The trainee reads the description.
    Brief,
    /// The expert demonstrates.
    Watching,
    /// The trainee practises; nothing is recorded.
    Practising,
    /// The attempt that counts; it is recorded.
    Testing,
    /// The goals are reached; a question is open.
    Asking,
    /// The recording is finished and graded.
    Grading,
    /// The result is shown.
    Debrief(Box<Debrief>),
}

/// Result of an attempt.
#[derive(Clone, Debug, PartialEq)]
pub struct Debrief {
    /// Grade of the attempt.
    pub grade: Grade,
    /// Path of the recording.
    pub path: PathBuf,
    /// Trace of the hand.
    pub trace: Trace,
}

/// A lesson that is open.
pub struct Open {
    /// The lesson itself.
    pub lesson: Arc<Lesson>,
    /// Index of the current world among the lesson's variants.
    pub variant: usize,
    /// Stage of the trainee.
    pub phase: Phase,
    /// Progress of the attempt.
    pub progress: Progress,
    /// Trace of the expert.
    pub expert: Option<Arc<Trace>>,
    /// Ghost that accompanies the trainee during practice.
    pub ghost: Ghost,
    pub(crate) world: World,
    attempts: usize,
}

/// State of the lessons in the window.
#[derive(Default)]
pub struct Lessons {
    /// Available lessons; read on first use.
    pub all: Vec<Arc<Lesson>>,
    /// Problems in the user's lessons.
    pub problems: Vec<String>,
    /// Folder of the user's lessons; `None` if there is none.
    pub folder: Option<PathBuf>,
    /// True if the side of Train shows lessons.
    pub shown: bool,
    /// Open lesson.
    pub open: Option<Box<Open>>,
    /// True if the ghost of the expert's fingers is switched off during practice.
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
    /// Possible answers; empty while no question is open.
    pub fn answers(&self) -> Vec<String> {
        let open = self.open.as_deref().filter(|open| open.phase == Phase::Asking);
        open.and_then(|open| open.lesson.question.as_ref()).map(|q| q.answers.clone()).unwrap_or_default()
    }
}

impl Open {
    pub(crate) fn new(lesson: &Arc<Lesson>, variant: usize) -> Result<Self, String> {
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

    /// Starts over, with a newly drawn world if the lesson has several.
    pub(crate) fn begin(&mut self, trainer: &mut Trainer, operator: Operator) -> Result<(), String> {
        let count = self.lesson.variant_count();
        if count > 1 {
            // Another variant each time, in an unpredictable order; with a manual clock, in sequence.
            let drawn =
                std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH).map_or(0, |d| d.subsec_nanos());
            self.attempts += 1;
            self.variant = match trainer.clock {
                crate::ui::train::trainer::live::Clock::RealTime => drawn as usize % count,
                crate::ui::train::trainer::live::Clock::Manual => self.attempts % count,
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

    /// Step that the expert currently shows.
    pub fn step(&self, trainer: &Trainer) -> Option<usize> {
        let now_s = trainer.scene()?.0.state.time_s;
        trainer.acts_begin_s.iter().rposition(|begin_s| *begin_s <= now_s)
    }

    pub(crate) fn attempted(&self, trainer: &Trainer, answer: Option<usize>) -> Attempted {
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

/// Waits for the end of the recording and grades it.
pub(crate) fn grade_file(lesson: &Lesson, stopping: Stopping) -> Result<Debrief, String> {
    let path = stopping.wait()?.path;
    let (grade, trace) = graded_from(&path, Some(lesson))?;
    Ok(Debrief { grade, path, trace })
}

/// Grades the attempt in a recording: by the given lesson, or by the one embedded in the recording.
///
/// # Errors
/// One sentence: it is not an attempt, or it cannot be read.
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
