//! `touchstone demo`: the whole chain on built-in recordings, without a display.

use super::{Output, diagnose, fit, report, screenshot};
use crate::built_in::{BuiltInRecording, RECORDINGS, write};
use crate::report::collect::Sheet;
use crate::report::source::Source;
use anyhow::Context;
use clap::Args;
use estimator::diagnose::{Diagnosis, Findings};
use estimator::estimate::Fit;
use estimator::pipeline::{Analysis, Options, analyse};
use haptics::recording::Recording;
use haptics::world::World;
use schemars::JsonSchema;
use serde::Serialize;
use std::fmt::Write;
use std::path::PathBuf;
use std::time::Instant;

/// Arguments of `demo`.
#[derive(Args)]
pub struct Demo {
    /// Folder for recordings, worlds, predictions, pictures and the report
    #[arg(long, default_value = "demo-out")]
    out: PathBuf,
}

/// What `demo --json` prints.
#[derive(JsonSchema, Serialize)]
pub(crate) struct Said {
    /// The folder with everything.
    out: PathBuf,
    /// How long it took, s.
    seconds: f64,
    /// What came out of each recording.
    recordings: Vec<Chain>,
    /// The pictures that could be drawn.
    pictures: Vec<PathBuf>,
    /// The page about both.
    report: PathBuf,
}

/// What came out of one recording.
#[derive(JsonSchema, Serialize)]
struct Chain {
    /// Its name.
    name: &'static str,
    /// The recording.
    log: PathBuf,
    /// The calibrated world.
    world: PathBuf,
    /// The forces that this predicts for the recording's motion.
    simulation: PathBuf,
    /// The world with what the diagnosis found.
    extended_world: PathBuf,
    /// What was identified.
    fit: Fit,
    /// What the model of the thesis leaves, and why.
    diagnosis: Diagnosis,
    /// Root mean square of measured − predicted by channel, N.
    residual_rms: Vec<(String, f64)>,
    /// How many values lie within two of their errors of those it was recorded with.
    within_two_errors: Hits,
}

/// A count out of all.
#[derive(JsonSchema, Serialize)]
struct Hits {
    /// How many.
    hits: usize,
    /// Of so many.
    of: usize,
}

const PICTURE: [u32; 2] = [1280, 720];
const WORKBENCH: [u32; 2] = [1600, 1000];

impl Demo {
    pub(super) fn run(&self) -> anyhow::Result<Output> {
        let started = Instant::now();
        std::fs::create_dir_all(&self.out)
            .with_context(|| format!("the folder could not be made: {}", self.out.display()))?;
        let mut text = String::new();
        let mut results = Vec::new();
        for built_in in &RECORDINGS {
            let result = self.chain(built_in, &mut text)?;
            results.push(result);
        }
        let pictures = self.pictures(&mut text);
        let report = self.report(&mut text)?;
        let seconds = started.elapsed().as_secs_f64();
        let _ = writeln!(text, "\nDone in {seconds:.1} s; everything is in {}", self.out.display());
        let said = Said { out: self.out.clone(), seconds, recordings: results, pictures, report };
        Ok(Output { text, json: serde_json::to_value(&said)? })
    }

    /// Log → segments → fit → world → simulation → diagnosis → extended world of one recording.
    fn chain(&self, built_in: &BuiltInRecording, text: &mut String) -> anyhow::Result<Chain> {
        progress(&format!("{}: segment, fit, calibrate, simulate, diagnose, extend", built_in.title));
        let log = self.file(&format!("{}.csv", built_in.name));
        write(&log, built_in.csv)?;
        write(&self.file(&format!("{}.meta.json", built_in.name)), built_in.meta)?;
        let recordings = estimator::log::load(&log, None)?;
        let analysis = analyse(&recordings, &Options::default())?;
        let world_file = self.file(&format!("{}.world.json", built_in.name));
        write(&world_file, &(analysis.world.to_json() + "\n"))?;
        let recording = recordings.first().context("the built-in log is empty")?;
        let simulation = estimator::simulate::simulate(&analysis.world, recording)?;
        let prediction = self.file(&format!("{}.simulated.csv", built_in.name));
        estimator::log::write_csv(&simulation.to_recording(recording), &prediction)?;

        let _ = writeln!(text, "\n{}", built_in.title);
        if let Some(segmentation) = analysis.segmentations.first().and_then(Option::as_ref) {
            let _ = writeln!(text, "  states: {}", segmentation.sequence());
        }
        text.push_str(&fit::describe(&analysis.fit));
        for (name, rms) in &simulation.residual_rms {
            let _ = writeln!(text, "  simulated {name}: measured − predicted {rms:.3} N RMS");
        }
        let within = compare(built_in, &analysis, text)?;
        let (diagnosis, extended) = self.diagnose(built_in, &recordings, text)?;
        Ok(Chain {
            name: built_in.name,
            log,
            world: world_file,
            simulation: prediction,
            extended_world: extended,
            fit: analysis.fit,
            diagnosis: diagnosis.diagnosis,
            residual_rms: simulation.residual_rms,
            within_two_errors: within,
        })
    }

    /// Diagnoses the thesis's model on the recording. Returns the diagnosis, and the file of the extended world.
    fn diagnose(
        &self,
        built_in: &BuiltInRecording,
        recordings: &[Recording],
        text: &mut String,
    ) -> anyhow::Result<(Findings, PathBuf)> {
        let options = estimator::diagnose::Options::default();
        let diagnosis = estimator::diagnose::diagnose(recordings, &options)?;
        let world = estimator::diagnose::extended_world(recordings, &options, &diagnosis)?;
        let file = self.file(&format!("{}.extended.json", built_in.name));
        write(&file, &(world.to_json() + "\n"))?;
        for line in diagnose::describe(&diagnosis).lines() {
            let _ = writeln!(text, "  {line}");
        }
        Ok((diagnosis, file))
    }

    /// Draws the pictures; without a Vulkan driver the demo continues and says so.
    fn pictures(&self, text: &mut String) -> Vec<PathBuf> {
        let mut made = Vec::new();
        let _ = writeln!(text, "\nPictures");
        for (name, dark) in [("stack", false), ("crank", true)] {
            progress(&format!("pictures of {name}"));
            let world = self.file(&format!("{name}.world.json"));
            let scene = screenshot::scene_picture(&world.to_string_lossy(), None, PICTURE, dark);
            self.keep(&format!("{name}-scene.png"), scene, &mut made, text);
            let panel = estimator::log::load(&self.file(&format!("{name}.csv")), None)
                .map_err(anyhow::Error::from)
                .and_then(|recordings: Vec<Recording>| screenshot::workbench(recordings, WORKBENCH, dark));
            self.keep(&format!("{name}-workbench.png"), panel, &mut made, text);
        }
        made
    }

    /// Writes one page about both recordings.
    fn report(&self, text: &mut String) -> anyhow::Result<PathBuf> {
        progress("report");
        let logs: Vec<PathBuf> = RECORDINGS.iter().map(|r| self.file(&format!("{}.csv", r.name))).collect();
        let read = |log: &PathBuf| estimator::log::load(log, None).map_err(|error| error.to_string());
        let sheets: Vec<Sheet> = logs.iter().map(|log| Sheet::new(Source::of(log, None), read(log))).collect();
        let out = self.file("report.html");
        report::write("Touchstone demo", &sheets, &out, &logs)?;
        let _ = writeln!(text, "\nReport\n  {}", out.display());
        Ok(out)
    }

    fn keep(&self, name: &str, picture: anyhow::Result<image::RgbaImage>, made: &mut Vec<PathBuf>, text: &mut String) {
        let path = self.file(name);
        match picture.and_then(|picture| screenshot::save(&picture, &path)) {
            Ok(()) => {
                let _ = writeln!(text, "  {}", path.display());
                made.push(path);
            }
            Err(error) => {
                let _ = writeln!(text, "  no {name}: {error:#}");
            }
        }
    }

    fn file(&self, name: &str) -> PathBuf {
        self.out.join(name)
    }
}

/// Number of estimates within two standard errors of the true values.
fn compare(built_in: &BuiltInRecording, analysis: &Analysis, text: &mut String) -> anyhow::Result<Hits> {
    let truth = World::from_json(built_in.truth)?;
    let (mut hits, mut all) = (0, 0);
    for (object, name, value) in true_values(&truth) {
        let Some(parameter) = analysis.fit.parameter(&object, &name) else { continue };
        if let (Some(found), Some(error)) = (parameter.value, parameter.std_error) {
            all += 1;
            hits += usize::from((found - value).abs() <= 2.0 * error);
        }
    }
    let _ = writeln!(text, "  against the world it was recorded in: {hits} of {all} values within two of their errors");
    Ok(Hits { hits, of: all })
}

fn progress(what: &str) {
    eprintln!("… {what}");
}

/// Names and true values of the parameters that a fit should estimate in a world.
fn true_values(world: &World) -> Vec<(String, String, f64)> {
    let mut values = Vec::new();
    for block in &world.blocks {
        for (name, value) in
            [("weight_N", block.mass_kg * world.gravity_m_s2), ("width_m", block.width_m), ("height_m", block.height_m)]
        {
            values.push((block.name.clone(), name.to_owned(), value));
        }
    }
    if let Some(crank) = &world.crank {
        let mut push = |name: &str, value: f64| values.push(("crank".to_owned(), name.to_owned(), value));
        push("radius_m", crank.radius_m);
        push("center_x_m", crank.center_m.x);
        for (id, name) in [
            ("weight", "weight_N"),
            ("load-friction", "friction_mu"),
            ("viscous-friction", "viscous_N_s_m"),
            ("coulomb-friction", "coulomb_N"),
        ] {
            if let Some(effect) = crank.effects.iter().find(|e| e.law().id() == id) {
                push(name, effect.values[0]);
            }
        }
    }
    values
}
