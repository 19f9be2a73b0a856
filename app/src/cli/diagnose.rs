//! `touchstone diagnose`: what the simulation gets wrong, why, and what the extension gains.

pub(crate) mod fleet;

use super::{LogArgs, Output};
use crate::tasks::Chosen;
use crate::text::diagnosis_words::{said_in_words, state_in_words};
use anyhow::Context;
use clap::Args;
use estimator::diagnose::{
    Baseline, Cause, CauseParameter, Diagnosis, ModelError, Options, Progress, Residual, RolloutOf, Twins, Validation,
    Verdict, diagnose, extended_world, twins, validate,
};
use estimator::words::amount;
use haptics::world::World;
use std::fmt::Write as _;
use std::io::Write;
use std::path::{Path, PathBuf};

/// Arguments of `diagnose`.
#[derive(Args)]
pub struct Diagnose {
    /// Log files of one object; with `--json-lines`, of one object each
    #[arg(required = true)]
    logs: Vec<PathBuf>,
    #[command(flatten)]
    source: LogArgs,
    /// Start from this world instead of the task's plain model
    #[arg(long)]
    world: Option<PathBuf>,
    /// Start a mechanism from `mass`, `mass+viscous`, `mass+viscous+coulomb`, or a world file
    #[arg(long)]
    baseline: Option<String>,
    /// Measure the gain on these logs of the same object, too; nothing is fitted to them
    #[arg(long, num_args = 1..)]
    validate: Vec<PathBuf>,
    /// Replay the logs without any cause so many times and count how often a diagnosis names one all the same
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1000))]
    twin: Option<u32>,
    /// Write the world with what was found in it here
    #[arg(long)]
    out: Option<PathBuf>,
    /// Diagnose every log by itself and print a line of JSON for each as soon as it is done, also for those that fail
    #[arg(long, conflicts_with_all = ["out", "validate", "twin"])]
    json_lines: bool,
    /// How many logs at the same time [default: one for each processor]
    #[arg(long, requires = "json_lines", value_parser = clap::value_parser!(u16).range(1..=1024))]
    jobs: Option<u16>,
    /// Append the lines to this file instead, and leave out logs that stand in it already, unchanged
    #[arg(long, requires = "json_lines", value_name = "LINES")]
    resume: Option<PathBuf>,
}

impl Diagnose {
    pub(super) fn run(&self) -> anyhow::Result<Output> {
        let mut recordings = Vec::new();
        for log in &self.logs {
            recordings.extend(self.source.load(log)?);
        }
        let options = self.options()?;
        let mut diagnosis = super::progress::during("diagnosing", |share| {
            let share = share.clone();
            let progress = Progress::new(move |done| {
                share.tell(done);
                true
            });
            diagnose(&recordings, &Options { progress, ..options.clone() })
        })?;
        for log in &self.validate {
            let more = validate(&self.source.load(log)?, &options, &diagnosis)?;
            diagnosis.judge_by(more);
        }
        if let Some(runs) = self.twin {
            super::progress::during(&format!("diagnosing {runs} replays"), |share| {
                let share = share.clone();
                let progress = Progress::new(move |done| {
                    share.tell(done);
                    true
                });
                twins(&recordings, &Options { progress, ..options.clone() }, &mut diagnosis, runs)
            })?;
        }
        let mut text = describe(&diagnosis);
        if let Some(path) = &self.out {
            let world = extended_world(&recordings, &options, &diagnosis)?;
            haptics::text_file::write(path, world.to_json() + "\n")
                .with_context(|| format!("the world could not be written: {}", path.display()))?;
            let _ = writeln!(text, "world: {}", path.display());
        }
        Ok(Output { text, json: serde_json::to_value(&diagnosis.diagnosis)? })
    }
}

impl Diagnose {
    /// Options of the diagnosis.
    fn options(&self) -> anyhow::Result<Options> {
        let named_file = self.baseline.as_ref().map(PathBuf::from).filter(|b| b.extension().is_some());
        let world = match self.world.as_ref().or(named_file.as_ref()) {
            Some(path) => {
                let text = haptics::text_file::read(path)
                    .with_context(|| format!("the world could not be read: {}", path.display()))?;
                Some(World::from_json(&text).with_context(|| format!("no world: {}", path.display()))?)
            }
            None => None,
        };
        let baseline = self.baseline.clone().filter(|_| world.is_none());
        // Tasks with a model of their own ignore it: an invalid name is an error all the same.
        if let Some(name) = &baseline {
            estimator::diagnose::named(name)?;
        }
        Ok(Options { baseline, world, twins: self.twin.is_some(), ..Options::default() })
    }

    /// True if every log has a line of its own.
    pub(super) fn is_fleet(&self) -> bool {
        self.json_lines
    }

    /// Diagnoses every log separately. Returns a sentence if some of them failed.
    pub(super) fn run_fleet(&self) -> anyhow::Result<Option<String>> {
        let options = self.options()?;
        if let Some(task) = &self.source.task {
            Chosen::find(task)?;
        }
        let standing = self.resume.as_deref().map(fleet::standing).transpose()?.unwrap_or_default();
        let mut out: Box<dyn Write + Send> = match &self.resume {
            Some(path) => Box::new(fleet::append_to(path)?),
            None => Box::new(std::io::stdout()),
        };
        let asked = self.asked(&options);
        let usual = std::thread::available_parallelism().map_or(1, usize::from);
        let tally = super::progress::during(&format!("diagnosing {} logs", self.logs.len()), |share| {
            let run = fleet::Run {
                logs: &self.logs,
                jobs: self.jobs.map_or(usual, usize::from),
                standing: &standing,
                key: &|log| fleet::Key::of(log, self.source.meta.as_deref(), &asked),
                work: &|log| self.one(log, &options),
                told: &|dealt_with| share.tell(dealt_with as f64 / self.logs.len() as f64),
            };
            run.through(&mut out)
        })?;
        let fleet::Tally { done, failed, kept, failed_before } = tally;
        // Standard output is for the lines alone.
        let then = if failed_before > 0 { format!(" ({failed_before} of them failed then)") } else { String::new() };
        eprintln!("{done} diagnosed, {kept} stood there already{then}, {failed} failed");
        // A resumed run has not repaired the earlier failures.
        let failed = failed + failed_before;
        Ok((failed > 0)
            .then(|| format!("{failed} of {} logs could not be diagnosed; their lines say why", self.logs.len())))
    }

    fn one(&self, log: &Path, options: &Options) -> anyhow::Result<serde_json::Value> {
        let recordings = self.source.load_quietly(log)?;
        Ok(serde_json::to_value(diagnose(&recordings, options)?.diagnosis)?)
    }

    /// Version, revision of the sources if the build knows it, and options: a change of these may change the answer.
    fn asked(&self, options: &Options) -> String {
        let mut asked = format!("touchstone {}", env!("CARGO_PKG_VERSION"));
        if let Some(revision) = crate::report::provenance::revision() {
            let _ = write!(asked, " ({revision})");
        }
        let mut add = |name: &str, value: Option<String>| {
            if let Some(value) = value {
                let _ = write!(asked, " --{name} {value}");
            }
        };
        add("task", self.source.task.clone());
        add("part", self.source.part.shown());
        add("baseline", options.baseline.clone());
        add("world", options.world.as_ref().map(|world| crate::report::source::sha256(world.to_json().as_bytes())));
        asked
    }
}

/// Text of a diagnosis.
pub(super) fn describe(diagnosis: &Diagnosis) -> String {
    let mut text = String::new();
    // The word of the JSON comes first.
    let word = match diagnosis.verdict {
        Verdict::Causes => "causes: each is named below",
        Verdict::None => "none: nothing beyond the noise",
        Verdict::Ambiguous => "ambiguous: this recording cannot tell",
        Verdict::Unexplained => "unexplained: something that no known cause explains",
    };
    let _ = writeln!(text, "verdict: {word}");
    let _ = writeln!(text, "  {}", model_line(diagnosis));
    for left in &diagnosis.residuals {
        let _ = writeln!(text, "    {}", residual_line(left));
    }
    for cause in &diagnosis.causes {
        let _ = writeln!(text, "  {}", cause_line(cause));
    }
    if let Some((error, unit)) = diagnosis.model_error.as_ref().zip(diagnosis.baseline.unit.as_ref()) {
        let _ = writeln!(text, "  {}", model_error_line(error, unit));
    }
    for other in &diagnosis.alternatives {
        let _ = writeln!(
            text,
            "  or {} instead of {} ({:.0} %): {}",
            other.id,
            other.instead_of,
            100.0 * other.posterior,
            other.why
        );
    }
    for settled in &diagnosis.settled {
        let _ =
            writeln!(text, "  settled by {}: {}, not {}; {}", settled.by, settled.kept, settled.excluded, settled.why);
    }
    if !diagnosis.not_excited.is_empty() {
        let ids: Vec<&str> = diagnosis.not_excited.iter().map(|n| n.id.as_str()).collect();
        let _ = writeln!(text, "  could not have been seen here: {}", ids.join(", "));
    }
    if let Some(next) = &diagnosis.next_experiment {
        let _ = writeln!(
            text,
            "  next: {} (separates {}, power {:.0} %)",
            next.motion,
            next.separates.join(", "),
            100.0 * next.expected_power
        );
    }
    for (k, other) in diagnosis.validation.iter().enumerate() {
        // An object with one coordinate is compared in the unit of the first recordings.
        let unit = other.unit.as_deref().or(diagnosis.baseline.unit.as_deref());
        let _ = writeln!(text, "  validation {}{}", k + 1, validation_line(other, unit));
    }
    if let Some(twins) = &diagnosis.twins {
        let _ = writeln!(text, "  {}", twins_line(twins, &diagnosis.baseline));
    }
    for warning in &diagnosis.warnings {
        let _ = writeln!(text, "  ! {warning}");
    }
    text
}

/// False alarms in replays without any cause.
fn twins_line(twins: &Twins, baseline: &Baseline) -> String {
    let [low, high] = twins.interval.map(|share| 100.0 * share);
    let which: Vec<String> = twins.by_cause.iter().map(|named| format!("{} {}", named.id, named.runs)).collect();
    let which = if which.is_empty() { String::new() } else { format!(" ({})", which.join(", ")) };
    let same = baseline.unit.as_ref().filter(|_| twins.heldout_rms_n > 0.0);
    let residual = same.map_or_else(String::new, |unit| {
        let [replays, measured] = [twins.heldout_rms_n, baseline.heldout_rms_n].map(|rms| amount(rms, unit));
        format!("; the model's residual is {replays} in them, {measured} as measured")
    });
    format!(
        "twins: {} of {} replays without any cause name one{which}, 95 % interval {low:.0} to {high:.0} %{residual}",
        twins.named, twins.runs
    )
}

/// Gain on another recording, after its number.
fn validation_line(other: &Validation, unit: Option<&str>) -> String {
    let of = other.of.as_ref().map_or(String::new(), |of| format!(" of the {of}"));
    let said = |value: f64| unit.map_or_else(|| format!("{value:.4}"), |unit| amount(value, unit));
    let [low, high] = other.interval.map(|share| 100.0 * share);
    let left_out = if other.left_out.is_empty() {
        String::new()
    } else {
        format!("; {} belongs to the first recordings alone, or cannot be shown here", other.left_out.join(", "))
    };
    format!(
        "{of}: {} unexplained before, {} after; {:.0} % of its power goes [{low:.0}, {high:.0}]{left_out}",
        said(other.rms_before),
        said(other.rms_after),
        100.0 * other.share
    )
}

/// Residual of a channel in a state.
fn residual_line(left: &Residual) -> String {
    let [before, after] = [left.rms_before, left.rms_after].map(|rms| amount(rms, &left.unit));
    let noise = left.noise_floor.map_or_else(String::new, |noise| format!(", noise {}", amount(noise, &left.unit)));
    let state = state_in_words(left.state);
    format!("{}, {state}: {before} left, {after} with what was found{noise} ({} rows)", left.channel, left.rows)
}

/// Compared model, and its residual.
fn model_line(diagnosis: &Diagnosis) -> String {
    let Baseline { model, heldout_rms_n, of, unit, .. } = &diagnosis.baseline;
    let Some(unit) = unit else { return format!("model {model}: there was nothing to compare it with") };
    let of = of.as_ref().map_or_else(String::new, |of| format!(" of the {of}"));
    let [left, floor, end] =
        [*heldout_rms_n, diagnosis.noise_floor_n, diagnosis.end.heldout_rms_n].map(|rms| amount(rms, unit));
    format!("model {model}: {left}{of} unexplained on held-out data, noise floor {floor}, with what was found {end}")
}

fn parameter(p: &CauseParameter) -> String {
    said_in_words(p).unwrap_or_else(|| {
        let unit = if p.unit == "1" { "" } else { &p.unit };
        format!("{} {} {unit}", p.name, super::table::with_error(p.value, p.std_error)).trim_end().to_owned()
    })
}

/// Structured error that no known cause describes.
fn model_error_line(error: &ModelError, unit: &str) -> String {
    let over: Vec<String> = error.over.iter().map(|o| format!("{} {}", o.variable, amount(o.rms_n, unit))).collect();
    format!(
        "model error: {} RMS, {:.0} % of the power that the model leaves above the noise; by {}",
        amount(error.rms_n, unit),
        100.0 * error.share,
        over.join(", ")
    )
}

fn cause_line(cause: &Cause) -> String {
    let parameters: Vec<String> = cause.parameters.iter().map(parameter).collect();
    let not_run = cause.gain.no_rollout.as_ref().map_or_else(String::new, |why| format!("; not run forward: {why}"));
    let forward = cause.gain.rollout.as_ref().map_or(not_run, |r| {
        let what = if r.of == RolloutOf::Position { "position" } else { "force" };
        format!(
            "; run forward over {} windows of {} s the {what} is off by {} RMS instead of {}",
            r.windows,
            r.window_s,
            amount(r.rms_after, &r.unit),
            amount(r.rms_before, &r.unit)
        )
    });
    // A gap in the clock has no parameters.
    let parameters = if parameters.is_empty() { String::new() } else { format!("{}; ", parameters.join(", ")) };
    format!("{} ({:.0} %): {parameters}{}{forward}", cause.id, 100.0 * cause.posterior, cause.evidence)
}
