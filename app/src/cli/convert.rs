//! `touchstone convert`: a log in another format.

use super::{LogArgs, Output};
use anyhow::Context;
use clap::Args;
use estimator::identify::payload::compensate::{compensated, removed};
use estimator::log::{Attachment, Encoding, Part, write_encoded};
use haptics::recording::{Recording, Warning};
use haptics::world::World;
use schemars::JsonSchema;
use serde::Serialize;
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

/// Value of `--compensate` without poses: the log itself.
const ITSELF: &str = "IN";

/// Arguments of `convert`.
#[derive(Args)]
pub struct Convert {
    /// Log file: CSV, MCAP, Parquet or MATLAB, told by its content
    #[arg(value_name = "IN")]
    log: PathBuf,
    /// Where to write it; the ending names the format: .csv (with a sidecar beside it), .mcap or .parquet (which carry it)
    #[arg(value_name = "OUT")]
    out: PathBuf,
    /// Calibrated world to carry along in an MCAP file
    #[arg(long)]
    world: Option<PathBuf>,
    /// Remove the weight of a sensor's load and the bias of the sensor from the wrench: as the log itself shows them, or poses
    /// of the same sensor
    #[arg(long, value_name = "POSES", num_args = 0..=1, require_equals = true, default_missing_value = ITSELF)]
    compensate: Option<PathBuf>,
    /// Write the messages of an MCAP file in JSON instead of protobuf
    #[arg(long)]
    json_messages: bool,
    #[command(flatten)]
    source: LogArgs,
}

/// What `convert --json` prints.
#[derive(JsonSchema, Serialize)]
pub(crate) struct Said {
    /// The file that was written.
    out: PathBuf,
    /// Recordings in it.
    recordings: usize,
    /// Samples of all of them.
    samples: usize,
    /// What looks wrong in the samples.
    pub(crate) warnings: Vec<Warning>,
    /// Weight and bias that `--compensate` removed, named `object.name` as in a fit.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    compensated: BTreeMap<String, f64>,
}

impl Convert {
    pub(super) fn run(&self) -> anyhow::Result<Output> {
        self.spare_the_input()?;
        let recordings = self.compensated(self.source.load(&self.log)?)?;
        let attachments = self.attachments()?;
        anyhow::ensure!(
            !self.json_messages || self.is_mcap(),
            "only an MCAP file has messages in JSON; name the output .mcap: {}",
            self.out.display()
        );
        let encoding = if self.json_messages { Encoding::Json } else { Encoding::Protobuf };
        super::progress::during("writing", |_| write_encoded(&recordings, &self.out, &attachments, encoding))?;
        let samples: usize = recordings.iter().map(Recording::len).sum();
        let warnings: Vec<&Warning> = recordings.iter().flat_map(|r| &r.warnings).collect();
        let mut text = format!("{}: {} recording(s), {samples} samples", self.out.display(), recordings.len());
        for warning in &warnings {
            let _ = write!(text, "\n  ! {}", warning.text); // writing into a string cannot fail
        }
        let compensated = recordings.first().filter(|_| self.compensate.is_some());
        let compensated = compensated.map(|r| r.meta.compensated.clone()).unwrap_or_default();
        if !compensated.is_empty() {
            let parts: Vec<String> = compensated.iter().map(|(name, value)| format!("{name} {value:.5}")).collect();
            let _ = write!(text, "\n  removed: {}", parts.join(", "));
        }
        let warnings = warnings.into_iter().cloned().collect();
        let said = Said { out: self.out.clone(), recordings: recordings.len(), samples, warnings, compensated };
        Ok(Output { text, json: serde_json::to_value(&said)? })
    }

    /// The recordings without the load and the bias of their sensor, if that is asked for.
    fn compensated(&self, recordings: Vec<Recording>) -> anyhow::Result<Vec<Recording>> {
        let Some(poses) = &self.compensate else { return Ok(recordings) };
        let mut elsewhere = None;
        if poses != Path::new(ITSELF) {
            let recordings = super::read(poses, None, &Part::default())?;
            let [one] = recordings.as_slice() else {
                anyhow::bail!("{} holds {} recordings; choose one with \"select\"", poses.display(), recordings.len())
            };
            elsewhere = Some(removed(one)?.without_drift());
        }
        let one = |recording: &Recording| match &elsewhere {
            Some(removed) => Ok(compensated(recording, removed)?),
            None => Ok(compensated(recording, &removed(recording)?)?),
        };
        recordings.iter().map(one).collect()
    }

    /// Error if the output would overwrite the input or its sidecar.
    fn spare_the_input(&self) -> anyhow::Result<()> {
        let same = |a: &Path, b: &Path| match (a.canonicalize(), b.canonicalize()) {
            (Ok(a), Ok(b)) => a == b,
            _ => false,
        };
        anyhow::ensure!(
            !same(&self.log, &self.out),
            "the output is the input; choose another name: {}",
            self.out.display()
        );
        let ours = estimator::log::sidecar_path(&self.out);
        let theirs = self.source.meta.clone().unwrap_or_else(|| estimator::log::sidecar_path(&self.log));
        let csv = self.out.extension().is_some_and(|e| e.eq_ignore_ascii_case("csv"));
        anyhow::ensure!(
            !csv || !same(&ours, &theirs),
            "the sidecar of the output would replace that of the input ({}); choose another name: {}",
            theirs.display(),
            self.out.display()
        );
        Ok(())
    }

    fn is_mcap(&self) -> bool {
        self.out.extension().is_some_and(|e| e.eq_ignore_ascii_case("mcap"))
    }

    fn attachments(&self) -> anyhow::Result<Vec<Attachment>> {
        let Some(path) = &self.world else { return Ok(Vec::new()) };
        anyhow::ensure!(
            self.is_mcap(),
            "only an MCAP file can carry a world; name the output .mcap: {}",
            self.out.display()
        );
        World::load(path).with_context(|| path.display().to_string())?;
        let data = std::fs::read(path).with_context(|| path.display().to_string())?;
        let name = "world.json".to_owned();
        Ok(vec![Attachment { name, media_type: "application/json".to_owned(), data }])
    }
}
