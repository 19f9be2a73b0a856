//! `touchstone simulate`: the measured motion through a world.

use super::{LogArgs, Output};
use clap::Args;
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
        let said = Said {
            out: self.out.clone(),
            samples: simulation.time_s.len(),
            columns: simulation.predicted.iter().map(|column| column.name.clone()).collect(),
            residual_rms,
        };
        Ok(Output { text, json: serde_json::to_value(&said)? })
    }
}
