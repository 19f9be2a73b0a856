//! Work in the background: nothing here ever makes the window wait.

use super::plots::Levels;
use super::prepare::Prepared;
use estimator::pipeline::Analysis;
use estimator::simulate::Simulation;
use haptics::world::World;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};

/// What a job does; at most one of each runs at a time as far as the window is concerned.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum JobKind {
    /// Reading a log.
    Load,
    /// Segmenting and fitting.
    Fit,
    /// Replaying the measured motion through the fitted world.
    Simulate,
    /// Waiting for a file dialog.
    Dialog,
    /// Writing a file.
    Save,
}

/// Why a file is being chosen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    /// A log to calibrate from.
    OpenLog,
    /// A world to train in.
    OpenWorld,
    /// Where the recording goes.
    SaveLog,
    /// Where the calibrated world goes.
    SaveWorld,
}

/// What a job brings back.
#[derive(Debug)]
pub enum Outcome {
    /// A log, ready to be shown.
    Loaded(PathBuf, Vec<Arc<Prepared>>),
    /// A fit of what is loaded.
    Fitted(Box<Analysis>),
    /// Predicted forces and the course of the world, one a recording that can be replayed.
    Simulated(Vec<Option<Replayed>>),
    /// The answer of a file dialog; `None`: cancelled, or no dialog on this system.
    Chosen(Purpose, Option<PathBuf>),
    /// A world from a file.
    World(Box<World>),
    /// Where something was written.
    Saved(PathBuf),
    /// One sentence.
    Failed(String),
}

/// A recording played through a world.
#[derive(Clone, Debug)]
pub struct Replayed {
    /// Predicted forces.
    pub simulation: Option<Arc<Simulation>>,
    /// Their curves in shown units, by channel name.
    pub curves: Vec<(String, Levels)>,
    /// Where everything was when.
    pub film: Option<Arc<super::film::Film>>,
}

struct Report {
    kind: JobKind,
    generation: u64,
    outcome: Outcome,
}

/// Starts jobs and collects what they bring.
pub struct Jobs {
    sender: Sender<Report>,
    receiver: Receiver<Report>,
    running: Vec<(JobKind, u64)>,
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
        self.generation += 1;
        let generation = self.generation;
        self.running.retain(|(running, _)| *running != kind);
        self.running.push((kind, generation));
        let (sender, ctx) = (self.sender.clone(), ctx.clone());
        let spawned = std::thread::Builder::new().name(format!("{kind:?}").to_lowercase()).spawn(move || {
            let outcome = catch_unwind(AssertUnwindSafe(work)).unwrap_or_else(|_| {
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

    /// Forgets a job: its answer will be dropped.
    pub fn forget(&mut self, kind: JobKind) {
        self.running.retain(|(running, _)| *running != kind);
    }

    /// True while such a job runs.
    pub fn is_running(&self, kind: JobKind) -> bool {
        self.running.iter().any(|(running, _)| *running == kind)
    }

    /// True while anything computes (a waiting dialog does not count).
    pub fn is_busy(&self) -> bool {
        self.running.iter().any(|(kind, _)| *kind != JobKind::Dialog)
    }

    /// What has come back since the last call; never waits.
    pub fn poll(&mut self) -> Vec<Outcome> {
        let mut outcomes = Vec::new();
        while let Ok(report) = self.receiver.try_recv() {
            let key = (report.kind, report.generation);
            if let Some(index) = self.running.iter().position(|running| *running == key) {
                self.running.remove(index);
                outcomes.push(report.outcome);
            }
        }
        outcomes
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::{Duration, Instant};

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
}
