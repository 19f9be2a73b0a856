//! `touchstone info`: the content of a log.

use super::{LogArgs, Output};
use clap::Args;
use estimator::segment::definition::Definition;
use haptics::recording::{Recording, Task, Warning};
use schemars::JsonSchema;
use serde::Serialize;
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::PathBuf;

/// Arguments of `info`.
#[derive(Args)]
pub struct Info {
    /// Log file
    log: PathBuf,
    #[command(flatten)]
    source: LogArgs,
    /// Write the shortest sidecar with which the log is read without doubts; values that only you know are null in it
    #[arg(long)]
    suggest: bool,
}

impl Info {
    pub(super) fn run(&self) -> anyhow::Result<Output> {
        if self.suggest {
            return super::suggest::run(&self.log, self.source.meta.as_deref());
        }
        let recordings = self.source.load(&self.log)?;
        let text = recordings.iter().map(describe).collect::<Vec<_>>().join("\n");
        let format = estimator::log::format(&self.log)?.name();
        let mut all: Vec<Value> =
            recordings.iter().map(|recording| to_json(recording, format)).collect::<serde_json::Result<_>>()?;
        let json = if all.len() == 1 {
            all.remove(0)
        } else {
            let warnings: Vec<&Warning> = recordings.iter().flat_map(|r| &r.warnings).collect();
            json!({ "recordings": all, "warnings": warnings })
        };
        Ok(Output { text, json })
    }
}

fn range(values: &[f64]) -> (f64, f64) {
    values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(*v), high.max(*v)))
}

fn describe(recording: &Recording) -> String {
    let mut text = String::new();
    let _ = writeln!(text, "{}", recording.name);
    let clock = match (recording.rate_hz(), recording.duration_s()) {
        (Some(rate), Some(duration)) => format!("{duration:.3} s at {rate:.1} Hz"),
        _ => "no clock".to_owned(),
    };
    let _ = writeln!(text, "  {} samples, {clock}", recording.len());
    if let Some(task) = recording.meta.task {
        let _ = match definition(recording, task) {
            Some(own) if own.name != task.name() => {
                writeln!(text, "  task: {} ({}), like {}", own.name, own.title, task.name())
            }
            _ => writeln!(text, "  task: {}", task.name()),
        };
        for (state, shown) in definition(recording, task).map(|task| task.shown_by_states()).unwrap_or_default() {
            let _ = writeln!(text, "    {state} shows {}", shown.join(", "));
        }
    }
    for channel in &recording.channels {
        let (low, high) = range(&channel.values);
        let (name, unit) = (&channel.name, &channel.unit);
        // Six decimals of a nanonewton are zeros.
        let _ = if (1e-12..1e-3).contains(&high.abs().max(low.abs())) {
            writeln!(text, "  {name:<22} {low:>12.5e} … {high:<12.5e} {unit}")
        } else {
            writeln!(text, "  {name:<22} {low:>12.6} … {high:<12.6} {unit}")
        };
    }
    for warning in &recording.warnings {
        let _ = writeln!(text, "  ! {}", warning.text);
    }
    text
}

/// Definition of the task with its states, if it is usable; its user reports an error in it.
fn definition(recording: &Recording, task: Task) -> Option<Definition> {
    Definition::of(recording, task).ok()
}

/// What `info --json` prints of one recording; of a file of several, `recordings` and `warnings` of all.
#[derive(JsonSchema, Serialize)]
pub(crate) struct Said {
    /// The file, and the trial where there are several.
    name: String,
    /// Format of the file: `csv`, `mat`, `mcap` or `parquet`.
    format: &'static str,
    /// Value of the `trial` column, where there are several.
    trial: Option<String>,
    /// What was done, as far as it is known.
    task: Option<Task>,
    /// Name of the task's definition.
    task_definition: Option<String>,
    /// Parameters that each state of the task shows.
    shows: Option<BTreeMap<String, Vec<String>>>,
    /// Number of samples.
    samples: usize,
    /// Samples a second; absent without a clock.
    rate_hz: Option<f64>,
    /// Length, s; absent without a clock.
    duration_s: Option<f64>,
    /// The channels.
    columns: Vec<Column>,
    /// Whether there is a column of states.
    labelled: bool,
    /// What looks wrong in the samples.
    pub(crate) warnings: Vec<Warning>,
}

/// One channel.
#[derive(JsonSchema, Serialize)]
pub(crate) struct Column {
    /// Its name.
    name: String,
    /// Its unit after reading: SI.
    unit: String,
    /// Its least value; absent where it has none.
    min: Option<f64>,
    /// Its largest value; absent where it has none.
    max: Option<f64>,
}

fn to_json(recording: &Recording, format: &'static str) -> serde_json::Result<Value> {
    let task = recording.meta.task.and_then(|task| definition(recording, task));
    let columns = recording.channels.iter().map(|channel| {
        let (low, high) = range(&channel.values);
        let [min, max] = [low, high].map(|value| Some(value).filter(|value| value.is_finite()));
        Column { name: channel.name.clone(), unit: channel.unit.clone(), min, max }
    });
    serde_json::to_value(Said {
        name: recording.name.clone(),
        format,
        trial: recording.trial.clone(),
        task: recording.meta.task,
        task_definition: task.as_ref().map(|task| task.name.clone()),
        shows: task.as_ref().map(Definition::shown_by_states),
        samples: recording.len(),
        rate_hz: recording.rate_hz(),
        duration_s: recording.duration_s(),
        columns: columns.collect(),
        labelled: recording.labels.is_some(),
        warnings: recording.warnings.clone(),
    })
}
