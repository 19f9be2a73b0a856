//! Recordings to draw: those that travel with the program, and performances of the scripted operator.

use crate::cli::built_in;
use crate::ui::trainer::{Clock, Operator, Trainer, WorldChoice};
use crate::worlds;
use anyhow::{Context as _, anyhow};
use haptics::recording::Recording;
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// Longest performance, s of simulated time: a script that does not end is cut off.
const LONGEST_S: f64 = 120.0;

/// What a picture is drawn from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Sample {
    /// The built-in recording of two blocks.
    Stack,
    /// The built-in recording of a crank.
    Crank,
    /// The scripted operator with the needle.
    Needle,
    /// A table whose columns have no meaning yet.
    Foreign,
    /// A built-in world, performed live.
    World(&'static str),
}

/// Recordings that were made already.
#[derive(Default)]
pub struct Samples {
    known: BTreeMap<Sample, Vec<Recording>>,
    folder: Option<TempDir>,
}

impl Samples {
    /// The recordings of a sample; those of foreign tables and live worlds are none.
    pub fn recordings(&mut self, sample: Sample) -> anyhow::Result<Vec<Recording>> {
        if let Some(known) = self.known.get(&sample) {
            return Ok(known.clone());
        }
        let made = match sample {
            Sample::Stack => built_in("stack", self.folder()?)?,
            Sample::Crank => built_in("crank", self.folder()?)?,
            Sample::Needle => performed("needle", self.folder()?)?,
            Sample::Foreign | Sample::World(_) => Vec::new(),
        };
        self.known.insert(sample, made.clone());
        Ok(made)
    }

    /// A file with columns that say little: a cart that is pushed to and fro, in another program's words.
    pub fn foreign(&mut self) -> anyhow::Result<PathBuf> {
        let path = self.folder()?.join("bench-7.csv");
        let mut text = String::from("Time [ms],Position (mm),Load cell / N,Temp\n");
        for i in 0..2_000_u32 {
            let t = 0.004 * f64::from(i);
            let place = 100.0 * (1.3 * t).sin() + 40.0 * (3.1 * t).sin();
            let force = 0.6 * (1.3 * t).cos() - 0.9 * (3.1 * t).sin();
            let _ = writeln!(text, "{},{place:.3},{force:.4},{:.1}", 4 * i, 21.0 + 0.1 * t);
        }
        std::fs::write(&path, text)?;
        Ok(path)
    }

    fn folder(&mut self) -> anyhow::Result<&Path> {
        if self.folder.is_none() {
            self.folder = Some(tempfile::tempdir().context("there is no room for temporary files")?);
        }
        self.folder.as_ref().map(TempDir::path).context("there is no room for temporary files")
    }
}

/// The scripted operator's recording in a built-in world.
fn performed(world: &str, folder: &Path) -> anyhow::Result<Vec<Recording>> {
    let mut trainer = Trainer::default();
    (trainer.clock, trainer.operator) = (Clock::Manual, Operator::Scripted);
    (trainer.file, trainer.choice) = (Some(worlds::find(Path::new(world))?), WorldChoice::File);
    trainer.recordings_folder = Some(folder.to_path_buf());
    trainer.ensure_running().map_err(|problem| anyhow!(problem))?;
    trainer.start_recording().map_err(|problem| anyhow!(problem))?;
    let mut left_s = LONGEST_S;
    while !trainer.performance_over() && left_s > 0.0 {
        trainer.advance(1.0);
        left_s -= 1.0;
    }
    let stopping = trainer.stop_recording().context("the performance was not recorded")?;
    let finished = stopping.wait().map_err(|problem| anyhow!(problem))?;
    Ok(estimator::log::load(&finished.path, None)?)
}
