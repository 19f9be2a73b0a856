//! Work in the background: nothing here ever makes the window wait.

use super::diagnosing::Answer;
use super::mapping::Looked;
use super::mapping::preview::Seen;
use super::plots::{Levels, Recipe};
use super::prepare::Prepared;
use crate::video::Video;
use estimator::cancellation;
use estimator::diagnose::Worlds;
use estimator::log::preview::Preview;
use estimator::online::information::Enough;
use estimator::pipeline::Analysis;
use estimator::segment::Segmentation;
use estimator::simulate::Simulation;
use haptics::world::World;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::time::{Duration, Instant};

/// A job that takes longer than this is shown, with a way to cancel it.
const SHOWN_AFTER: Duration = Duration::from_millis(600);

/// What a job does; at most one of each runs at a time as far as the window is concerned.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum JobKind {
    /// Reading a log.
    Load,
    /// Segmenting and fitting.
    Fit,
    /// Telling states anew while rules are edited.
    Segment,
    /// Replaying the measured motion through the fitted world.
    Simulate,
    /// Judging whether there is enough data.
    Judge,
    /// Replaying with a value that is tried.
    WhatIf,
    /// Looking how the force depends on the parameters.
    Sensitivity,
    /// Waiting for a file dialog.
    Dialog,
    /// Writing a file.
    Save,
    /// Looking at a log whose columns are to be mapped.
    Look,
    /// Reading a log for the preview of a mapping.
    Preview,
    /// Waiting for the end of a recording.
    Record,
    /// Looking for recordings that a killed program left behind.
    Recover,
    /// Looking for what the model gets wrong.
    Diagnose,
    /// Making the worlds without and with what was found.
    Extend,
    /// Replaying the measured motion through the extended world.
    SimulateExtended,
    /// Rehearsing the experiment that a diagnosis asks for.
    Rehearse,
    /// Preparing that experiment for a person.
    Guide,
    /// Checking a diagnosis on other recordings.
    Check,
    /// Letting the expert of a lesson do it.
    Expert,
    /// Grading an attempt at a lesson.
    Grade,
    /// Computing curves for plots.
    Curves,
    /// Finding where a recording lies on another one.
    Align,
    /// Reading a video.
    Video,
    /// Decoding a picture of it.
    Picture,
    /// Finding where a video lies on its recording.
    AlignVideo,
}

/// Why a file is being chosen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    /// A log to calibrate from.
    OpenLog,
    /// A world to train in.
    OpenWorld,
    /// A project.
    OpenProject,
    /// Another recording of the same object.
    AddLog,
    /// A recording of the experiment that a diagnosis asks for.
    AddExperiment,
    /// A video of the shown recording.
    OpenVideo,
    /// Recordings to check a diagnosis on.
    Check,
    /// Where the project goes.
    SaveProject,
    /// Where the report goes.
    SaveReport,
    /// Where the recording goes.
    SaveLog,
    /// Where the calibrated world goes.
    SaveWorld,
    /// To write the calibrated world for another simulator.
    ExportWorld,
    /// Where the extended world goes.
    SaveExtended,
    /// Where a table of attempts goes.
    SaveHistory,
}

/// What a job brings back.
#[derive(Debug)]
pub enum Outcome {
    /// A log, ready to be shown.
    Loaded(PathBuf, Vec<Arc<Prepared>>),
    /// A project, and all its recordings.
    Project(Box<super::project::Project>, Vec<Arc<Prepared>>),
    /// A fit of what is loaded.
    Fitted(Box<Analysis>),
    /// The states of one recording, told anew.
    Segmented(usize, Box<Segmentation>),
    /// Predicted forces and the course of the world, one a recording that can be replayed.
    Simulated(Vec<Option<Replayed>>),
    /// The values that were tried, and the replay of every recording with them.
    Tried(std::collections::BTreeMap<String, f64>, Vec<Option<Replayed>>),
    /// How the force depends on the parameters.
    Sensitive(Arc<super::sensitivity::Sensitivity>),
    /// What is still missing for the parameters of the fit.
    Judged(Vec<Enough>),
    /// The answer of a file dialog; `None`: cancelled, or no dialog on this system.
    Chosen(Purpose, Option<PathBuf>),
    /// The answer of a file dialog for several files.
    ChosenMany(Purpose, Vec<PathBuf>),
    /// What a diagnosis is worth on other recordings.
    Checked(Vec<super::checking::Checked>),
    /// A world from a file.
    World(Box<World>),
    /// Where something was written.
    Saved(PathBuf),
    /// Recordings without their end.
    Unfinished(Vec<PathBuf>),
    /// A log that cannot be read as it stands, and why: its columns can be mapped.
    Unmapped(PathBuf, String),
    /// A log that was looked at, for the mapping dialog.
    Looked(Box<Looked>),
    /// What a mapping makes of its log.
    Previewed(Box<Result<Seen, String>>),
    /// A mapping was saved; the log can be opened with it.
    Mapped {
        /// The log.
        log: PathBuf,
        /// The sidecar that was written.
        sidecar: PathBuf,
    },
    /// What the model gets wrong, or why that cannot be told.
    Diagnosed(Result<Box<Answer>, String>),
    /// The worlds without and with what was found, or why there are none.
    Extended(Result<Box<Worlds>, String>),
    /// What an experiment would settle, or why that cannot be told.
    Rehearsed(Result<Box<crate::experiment::Rehearsal>, String>),
    /// An experiment for a person, or why it cannot be done.
    Guided(Result<Box<super::guided::Guided>, String>),
    /// The expert of a lesson has done it.
    Expert(Result<Box<super::lessons::Trace>, String>),
    /// A lesson in the calibrated world is ready.
    Practise(Result<Box<estimator::training::lesson::Lesson>, String>),
    /// An attempt at a lesson was graded.
    Graded(Result<Box<super::lessons::Debrief>, String>),
    /// The recording of an experiment that a person did, or why there is none.
    Followed(Result<PathBuf, String>),
    /// The recording of an experiment, to be diagnosed with the others.
    Performed(PathBuf),
    /// Forces in the extended world, one a recording that can be replayed.
    SimulatedExtended(Vec<Option<Replayed>>),
    /// Computed curves, and what they were computed from.
    Curves(Vec<(Recipe, Arc<Levels>)>),
    /// What to add to the times of a recording so that it lies on the shown one, s; or why that cannot be told.
    Aligned(usize, Result<f64, String>),
    /// A video that was read, or why it cannot be shown.
    Video(PathBuf, Result<Arc<Video>, String>),
    /// A picture of a video; none where the file is damaged.
    Picture {
        /// The video.
        file: PathBuf,
        /// Number of the picture.
        index: usize,
        /// What it shows.
        picture: Option<egui::ColorImage>,
    },
    /// When a video begins on its recording's clock, s; or why that cannot be told.
    VideoAligned(PathBuf, Result<f64, String>),
    /// The same, while somebody shifts it: by shown and moved recording; `None` where they are not alike.
    MostAlike((usize, usize), Option<f64>),
    /// Nothing: the user has cancelled it.
    Cancelled,
    /// One sentence.
    Failed(String),
}

/// A recording played through a world.
#[derive(Clone, Debug)]
pub struct Replayed {
    /// Predicted forces.
    pub simulation: Option<Arc<Simulation>>,
    /// Their curves in shown units, by channel name.
    pub curves: Vec<(String, Arc<Levels>)>,
    /// Where everything was when.
    pub film: Option<Arc<super::film::Film>>,
}

struct Report {
    kind: JobKind,
    generation: u64,
    outcome: Outcome,
}

/// What a job and the window have in common while it runs.
#[derive(Clone, Debug, Default)]
pub struct Ticket(Arc<Shared>);

#[derive(Debug, Default)]
struct Shared {
    /// Share done in ten-thousandths; 0: nothing is known.
    done: AtomicU32,
    cancelled: AtomicBool,
    preview: Preview,
}

impl Ticket {
    /// Tells how much is done, 0 … 1.
    pub fn tell(&self, share: f64) {
        self.0.done.store((1e4 * share.clamp(0.0, 1.0)) as u32, Ordering::Relaxed);
    }

    /// Set when nobody wants the answer any more.
    pub fn cancelled(&self) -> &AtomicBool {
        &self.0.cancelled
    }

    /// Where a reader shows what it has read.
    pub fn preview(&self) -> &Preview {
        &self.0.preview
    }

    fn share(&self) -> Option<f64> {
        let done = self.0.done.load(Ordering::Relaxed);
        (done > 0).then(|| f64::from(done) * 1e-4)
    }
}

struct Running {
    kind: JobKind,
    generation: u64,
    what: String,
    begun: Instant,
    ticket: Ticket,
}

/// A job that takes its time.
#[derive(Clone, Debug, PartialEq)]
pub struct Progress {
    /// Which.
    pub kind: JobKind,
    /// In words.
    pub what: String,
    /// How much is done, 0 … 1, where that is known.
    pub share: Option<f64>,
    /// Since when.
    pub elapsed: Duration,
}

/// Starts jobs and collects what they bring.
pub struct Jobs {
    sender: Sender<Report>,
    receiver: Receiver<Report>,
    running: Vec<Running>,
    generation: u64,
}

impl Default for Jobs {
    fn default() -> Self {
        let (sender, receiver) = channel();
        Self { sender, receiver, running: Vec::new(), generation: 0 }
    }
}

impl Jobs {
    /// Runs `work` on a thread of its own. A job of the same kind that still runs is forgotten: only the newest answer counts.
    pub fn start(&mut self, ctx: &egui::Context, kind: JobKind, work: impl FnOnce() -> Outcome + Send + 'static) {
        self.start_watched(ctx, kind, String::new(), move |_| work());
    }

    /// [`Jobs::start`] for work that may take long: `what` it does stands in the window, it tells how far it is, and it looks
    /// whether it is still wanted.
    pub fn start_watched(
        &mut self,
        ctx: &egui::Context,
        kind: JobKind,
        what: String,
        work: impl FnOnce(&Ticket) -> Outcome + Send + 'static,
    ) {
        self.cancel(kind);
        self.generation += 1;
        let (generation, ticket) = (self.generation, Ticket::default());
        self.running.push(Running { kind, generation, what, begun: Instant::now(), ticket: ticket.clone() });
        let (sender, ctx) = (self.sender.clone(), ctx.clone());
        let spawned = std::thread::Builder::new().name(format!("{kind:?}").to_lowercase()).spawn(move || {
            let outcome = catch_unwind(AssertUnwindSafe(|| done_if_wanted(kind, &ticket, work))).unwrap_or_else(|_| {
                Outcome::Failed("An internal fault stopped this step; the rest of the program goes on.".to_owned())
            });
            // A closed window needs no answer.
            let _ = sender.send(Report { kind, generation, outcome });
            ctx.request_repaint();
        });
        if let Err(error) = spawned {
            let outcome = Outcome::Failed(format!("The system gave no thread for this step ({error})."));
            let _ = self.sender.send(Report { kind, generation, outcome });
        }
    }

    /// Ends a job: it is told to stop, and its answer will be dropped.
    pub fn cancel(&mut self, kind: JobKind) {
        for running in self.running.iter().filter(|r| r.kind == kind) {
            running.ticket.cancelled().store(true, Ordering::Relaxed);
        }
        self.running.retain(|running| running.kind != kind);
    }

    /// True while such a job runs.
    pub fn is_running(&self, kind: JobKind) -> bool {
        self.running.iter().any(|running| running.kind == kind)
    }

    /// True while anything computes (a waiting dialog does not count).
    pub fn is_busy(&self) -> bool {
        self.running.iter().any(|running| running.kind != JobKind::Dialog)
    }

    /// The job that has been running longest, of those that say what they do, once it takes its time.
    pub fn progress(&self) -> Option<Progress> {
        let longest = self.running.iter().filter(|r| !r.what.is_empty()).min_by_key(|r| r.begun)?;
        let elapsed = longest.begun.elapsed();
        (elapsed > SHOWN_AFTER).then(|| Progress {
            kind: longest.kind,
            what: longest.what.clone(),
            share: longest.ticket.share(),
            elapsed,
        })
    }

    /// What a long read of a log has brought so far.
    pub fn preview(&self) -> Option<(&Preview, Progress)> {
        let progress = self.progress().filter(|p| p.kind == JobKind::Load)?;
        let reading = self.running.iter().find(|r| r.kind == JobKind::Load)?;
        let preview = reading.ticket.preview();
        (!preview.is_empty()).then_some((preview, progress))
    }

    /// What has come back since the last call; never waits.
    pub fn poll(&mut self) -> Vec<Outcome> {
        let mut outcomes = Vec::new();
        while let Ok(report) = self.receiver.try_recv() {
            let mine = |r: &Running| (r.kind, r.generation) == (report.kind, report.generation);
            if let Some(index) = self.running.iter().position(mine) {
                self.running.remove(index);
                outcomes.push(report.outcome);
            }
        }
        outcomes
    }
}

/// Does it, and ends early where the estimator looks whether it is still wanted. What writes a file is not ended by the next that does.
fn done_if_wanted(kind: JobKind, ticket: &Ticket, work: impl FnOnce(&Ticket) -> Outcome) -> Outcome {
    if matches!(kind, JobKind::Save | JobKind::Record) {
        return work(ticket);
    }
    let asked = ticket.clone();
    let wanted = move || !asked.cancelled().load(Ordering::Relaxed);
    cancellation::while_wanted(wanted, || work(ticket)).unwrap_or(Outcome::Cancelled)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wait(jobs: &mut Jobs) -> Vec<Outcome> {
        let begun = Instant::now();
        while begun.elapsed() < Duration::from_secs(10) {
            let outcomes = jobs.poll();
            if !outcomes.is_empty() {
                return outcomes;
            }
            std::thread::sleep(Duration::from_millis(1));
        }
        Vec::new()
    }

    #[test]
    fn a_panicking_job_ends_in_a_sentence() {
        let mut jobs = Jobs::default();
        jobs.start(&egui::Context::default(), JobKind::Fit, || panic!("a bug"));
        assert!(jobs.is_busy());
        assert!(matches!(wait(&mut jobs).as_slice(), [Outcome::Failed(_)]));
        assert!(!jobs.is_busy());
    }

    #[test]
    fn only_the_newest_answer_counts() {
        let mut jobs = Jobs::default();
        let ctx = egui::Context::default();
        for name in ["old", "new"] {
            jobs.start(&ctx, JobKind::Save, move || Outcome::Saved(PathBuf::from(name)));
        }
        // Whichever ends first: the old answer must never come out, so the only outcome is the new one.
        let outcomes = wait(&mut jobs);
        assert!(!jobs.is_busy());
        assert!(matches!(outcomes.as_slice(), [Outcome::Saved(path)] if path.ends_with("new")), "{outcomes:?}");
    }

    #[test]
    fn a_cancelled_job_is_told_and_its_answer_dropped() {
        let mut jobs = Jobs::default();
        let (told, heard) = channel();
        jobs.start_watched(&egui::Context::default(), JobKind::Load, "Reading".to_owned(), move |ticket| {
            ticket.tell(0.25);
            while !ticket.cancelled().load(Ordering::Relaxed) {
                std::thread::sleep(Duration::from_millis(1));
            }
            told.send(()).expect("the test listens");
            Outcome::Cancelled
        });
        let begun = Instant::now();
        while jobs.progress().is_none_or(|p| p.share.is_none()) && begun.elapsed() < Duration::from_secs(10) {
            std::thread::sleep(Duration::from_millis(5));
        }
        let progress = jobs.progress().expect("it takes its time");
        assert_eq!((progress.what.as_str(), progress.share), ("Reading", Some(0.25)));
        jobs.cancel(JobKind::Load);
        heard.recv_timeout(Duration::from_secs(10)).expect("it ends");
        assert!(!jobs.is_busy() && jobs.progress().is_none() && jobs.poll().is_empty());
    }

    #[test]
    fn a_cancelled_job_ends_in_the_loops_of_the_estimator_but_a_file_is_written() {
        for (kind, ends) in [(JobKind::Fit, true), (JobKind::Save, false)] {
            let mut jobs = Jobs::default();
            let ((go, may_go), (told, heard)) = (channel(), channel());
            jobs.start_watched(&egui::Context::default(), kind, "Working".to_owned(), move |_| {
                may_go.recv().expect("the test goes on");
                told.send(cancellation::check().is_err()).expect("the test listens");
                Outcome::Cancelled
            });
            jobs.cancel(kind);
            go.send(()).expect("the job waits");
            assert_eq!(heard.recv_timeout(Duration::from_secs(10)), Ok(ends), "{kind:?}");
        }
    }
}
