//! `touchstone fit`: parameters with their standard errors, constraints, and a calibrated world.

use super::stated::Stated;
use super::table::{parameter_line, with_error};
use super::{LogArgs, Output, enough};
use anyhow::Context;
use clap::Args;
use estimator::estimate::{Constraint, Fit as Fitted};
use estimator::online::enough_for;
use estimator::online::information::{Enough, Wanted};
use estimator::pipeline::{Options, analyse};
use schemars::JsonSchema;
use serde::Serialize;
use std::fmt::Write;
use std::path::PathBuf;

/// Arguments of `fit`.
#[derive(Args)]
pub struct Fit {
    /// Log files of one object
    #[arg(required = true)]
    logs: Vec<PathBuf>,
    #[command(flatten)]
    source: LogArgs,
    /// Wanted accuracy of a parameter, e.g. `weight_N=1%`; may be given several times
    #[arg(long = "wanted", value_name = "NAME=SHARE")]
    wanted: Vec<String>,
    /// Write the calibrated world here
    #[arg(long)]
    out: Option<PathBuf>,
    #[command(flatten)]
    stated: Stated,
}

/// What `fit --json` prints.
#[derive(JsonSchema, Serialize)]
pub(crate) struct Said<'a> {
    /// What was found.
    #[serde(flatten)]
    fit: &'a Fitted,
    /// Whether each parameter is known as well as was wanted, and what to do where it is not.
    enough: Vec<Enough>,
}

impl Fit {
    pub(super) fn run(&self) -> anyhow::Result<Output> {
        let mut wanted = Wanted::default();
        for text in &self.wanted {
            wanted.state(text).map_err(anyhow::Error::msg)?;
        }
        let mut recordings = Vec::new();
        for log in &self.logs {
            recordings.extend(self.source.load(log)?);
        }
        self.stated.put_into(&mut recordings);
        let mut analysis = super::progress::during("fitting", |_| analyse(&recordings, &Options::default()))?;
        for recording in &recordings {
            for warning in &recording.warnings {
                if !analysis.fit.warnings.contains(&warning.text) {
                    analysis.fit.warnings.push(warning.text.clone());
                }
            }
        }
        if let Some(path) = &self.out {
            haptics::text_file::write(path, analysis.world.to_json() + "\n")
                .with_context(|| format!("the world could not be written: {}", path.display()))?;
        }
        let mut text = describe(&analysis.fit);
        if let Some(path) = &self.out {
            let _ = writeln!(text, "world: {}", path.display());
        }
        let missing = enough_for(&recordings, analysis.task, &analysis.fit, &wanted);
        text.push_str(&enough::table(&missing));
        let json = serde_json::to_value(Said { fit: &analysis.fit, enough: missing })?;
        Ok(Output { text, json })
    }
}

/// Fit as text in columns.
pub(super) fn describe(fit: &Fitted) -> String {
    let mut text = format!("task: {}\n", fit.task);
    for parameter in &fit.parameters {
        let _ = writeln!(text, "{}", parameter_line(parameter));
    }
    for constraint in &fit.constraints {
        let _ = writeln!(text, "  {}", constraint_line(constraint));
    }
    if let Some(quality) = &fit.quality {
        let _ = writeln!(
            text,
            "  force residual {:.4} {unit}; on the {:.0} % held out {:.4} {unit} ({:.1} % of the force)",
            quality.rms,
            quality.heldout_share * 100.0,
            quality.heldout_rms,
            quality.heldout_relative * 100.0,
            unit = quality.unit
        );
    }
    for warning in &fit.warnings {
        let _ = writeln!(text, "  ! {warning}");
    }
    text
}

fn constraint_line(constraint: &Constraint) -> String {
    let kind = format!("{:?}", constraint.kind).to_lowercase();
    let radius = constraint.radius_m.map_or(String::new(), |radius| {
        let error = constraint.std_error.get("radius_m").copied().unwrap_or(0.0);
        format!(", radius {} mm", with_error(radius * 1e3, error * 1e3))
    });
    let interval = constraint.radius_interval_m.map_or(String::new(), |(low, high)| {
        let high = high.map_or("∞ (it could be straight)".to_owned(), |h| format!("{:.3} mm", h * 1e3));
        format!(", 95 % within {:.3} … {high}", low * 1e3)
    });
    let named: Vec<&str> =
        [&constraint.recording, &constraint.object].into_iter().filter_map(|n| n.as_deref()).collect();
    let name = if named.is_empty() { String::new() } else { format!("{}: ", named.join(", ")) };
    let words: Vec<String> =
        crate::text::constraint_words::constraint_words(constraint).into_iter().map(|w| format!("; {w}")).collect();
    format!("{name}{kind}{radius}{interval}: {}{}", constraint.evidence, words.concat())
}
