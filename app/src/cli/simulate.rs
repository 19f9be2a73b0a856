//! `touchstone simulate`: simulation of the measured motion in a world.

use super::{LogArgs, Output};
use clap::Args;
use estimator::simulate::PredictedPart;
use schemars::JsonSchema;
use serde::Serialize;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::PathBuf;

/// Arguments of `simulate`.
#[derive(Args)]
pub struct Simulate {
    /// World file, or a built-in world: stack, crank, needle, barrel, switch, guide, table
    world: PathBuf,
    /// Log file with the motion
    log: PathBuf,
    #[command(flatten)]
    source: LogArgs,
    /// Where to write the predicted forces
    #[arg(long)]
    out: PathBuf,
}

/// What `simulate --json` prints.
#[derive(JsonSchema, Serialize)]
pub(crate) struct Said {
    /// The file with the predicted forces.
    out: PathBuf,
    /// Its samples.
    samples: usize,
    /// Names of the predicted channels.
    columns: Vec<String>,
    /// Root mean square of measured minus predicted for each channel that was measured, in its unit.
    residual_rms: BTreeMap<String, f64>,
    /// The part of the forces that the world's laws predict, and how well, where that is not all of them.
    #[serde(skip_serializing_if = "Option::is_none")]
    predicted_part: Option<PredictedPart>,
    /// What no law predicts and is as measured, or that no measured force enters: sentences.
    inputs: Vec<String>,
    /// What each channel reads while nothing is touched, N: it is predicted there, where it is not zero.
    #[serde(rename = "bias_N")]
    bias_n: BTreeMap<String, f64>,
}

impl Simulate {
    pub(super) fn run(&self) -> anyhow::Result<Output> {
        let world = crate::worlds::find(&self.world)?;
        let recordings = self.source.load(&self.log)?;
        let [recording] = recordings.as_slice() else {
            anyhow::bail!(
                "the log holds {} recordings; choose one with \"select\" in its sidecar: {}",
                recordings.len(),
                self.log.display()
            );
        };
        let simulation = super::progress::during("simulating", |_| estimator::simulate::simulate(&world, recording))?;
        estimator::log::write_csv(&simulation.to_recording(recording), &self.out)?;
        let mut text =
            format!("{}: {} samples of {} predicted\n", self.out.display(), simulation.time_s.len(), recording.name);
        let mut residual_rms = BTreeMap::new();
        for (name, value) in &simulation.residual_rms {
            let _ = writeln!(text, "  {name:<10} measured − predicted: {value:.4} RMS");
            residual_rms.insert(name.clone(), *value);
        }
        if let Some(part) = &simulation.part {
            let rms = part.rms_n.map_or_else(String::new, |rms| format!(", measured − predicted: {rms:.4} N RMS"));
            let _ = writeln!(text, "  predicted: {} at {} samples{rms}", part.what, part.samples);
            if let Some(open) = &part.left_open {
                let rms =
                    open.rms_n.map_or_else(String::new, |rms| format!("; measured − predicted there: {rms:.4} RMS"));
                let _ = writeln!(text, "  left open: {}, at {} samples{rms}", open.what, open.samples);
            }
        }
        for (name, level) in &simulation.bias_n {
            let _ = writeln!(text, "  {name} reads {level:.3} N while nothing is touched");
        }
        for input in &simulation.inputs {
            let _ = writeln!(text, "  {input}");
        }
        let said = Said {
            out: self.out.clone(),
            samples: simulation.time_s.len(),
            columns: simulation.predicted.iter().map(|column| column.name.clone()).collect(),
            residual_rms,
            predicted_part: simulation.part,
            inputs: simulation.inputs,
            bias_n: simulation.bias_n.into_iter().collect(),
        };
        Ok(Output { text, json: serde_json::to_value(&said)? })
    }
}
