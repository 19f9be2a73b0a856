//! `touchstone segment`: the states over time.

use super::{LogArgs, Output};
use clap::{Args, ValueEnum};
use estimator::segment::agreement::Score;
use estimator::segment::{Segmentation, Thresholds, segment_by};
use haptics::recording::Recording;
use serde_json::{Value, json};
use std::fmt::Write;
use std::path::PathBuf;

/// Arguments of `segment`.
#[derive(Args)]
pub struct Segment {
    /// Log file
    log: PathBuf,
    #[command(flatten)]
    source: LogArgs,
    /// How states are told apart
    #[arg(long, default_value = "threshold")]
    method: Method,
    /// Force threshold, N; chosen from the noise when not given (with --velocity-threshold)
    #[arg(long, requires = "velocity_threshold")]
    force_threshold: Option<f64>,
    /// Velocity threshold, m/s
    #[arg(long, requires = "force_threshold")]
    velocity_threshold: Option<f64>,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Method {
    /// Qualitative reasoning: thresholds and rules
    Threshold,
    /// A hidden Markov model that starts from the rules and learns from the recording
    Hmm,
}

impl From<Method> for estimator::segment::Method {
    fn from(method: Method) -> Self {
        match method {
            Method::Threshold => Self::Threshold,
            Method::Hmm => Self::Hmm,
        }
    }
}

impl Segment {
    pub(super) fn run(&self) -> anyhow::Result<Output> {
        let recordings = self.source.load(&self.log)?;
        let given = self.force_threshold.zip(self.velocity_threshold);
        let given = given.map(|(force_n, velocity_m_s)| Thresholds { velocity_m_s, force_n });
        let mut text = String::new();
        let mut all = Vec::new();
        for recording in &recordings {
            let mut result =
                super::progress::during("segmenting", |_| segment_by(self.method.into(), recording, None, given))?;
            result.warnings.extend(recording.warnings.iter().map(|w| w.text.clone()));
            describe(&mut text, recording, &result);
            all.push(serde_json::to_value(&result)?);
        }
        let json: Value = if all.len() == 1 { all.remove(0) } else { json!({ "recordings": all }) };
        Ok(Output { text, json })
    }
}

/// Writes the agreement with the labels.
fn agreement(text: &mut String, score: &Score) {
    let _ = writeln!(
        text,
        "  against the labels: {:.1} % of {} samples; boundaries F1 {:.3} (within {:.3} s, {} labelled)",
        100.0 * score.accuracy,
        score.samples,
        score.boundary_f1,
        score.tolerance_s,
        score.boundaries
    );
    let states: Vec<String> = score.states.iter().map(|(state, s)| format!("{state} {:.3}", s.f1)).collect();
    let _ = writeln!(text, "    F1 by samples: {}", states.join(", "));
    if !score.as_one.is_empty() {
        let _ = writeln!(text, "    {} count as one: the labels do not tell them apart", score.as_one.join(" and "));
    }
    if !score.unknown_labels.is_empty() {
        let _ = writeln!(text, "    labels that name no state were left out: {}", score.unknown_labels.join(", "));
    }
}

fn describe(text: &mut String, recording: &Recording, result: &Segmentation) {
    let by_strokes = result.thresholds == Thresholds { velocity_m_s: 0.0, force_n: 0.0 };
    let (how, last_column) = match &result.posterior {
        None if by_strokes => ("its strokes", "share of samples that agree"),
        None => ("thresholds and rules", "share of samples that agree"),
        Some(_) => ("a hidden Markov model", "mean probability"),
    };
    let _ = writeln!(text, "{}: {} by {how}", recording.name, result.task);
    if !by_strokes {
        let _ = writeln!(
            text,
            "  thresholds: {:.4} N, {:.2} mm/s",
            result.thresholds.force_n,
            result.thresholds.velocity_m_s * 1e3
        );
    }
    let _ = writeln!(text, "  start … end, s; state; subtask; {last_column}");
    for state in &result.states {
        let _ = writeln!(
            text,
            "  {:>9.3} … {:<9.3} {:<18} {:<20} {:.2}",
            state.t0,
            state.t1,
            state.state.name(),
            state.subtask.as_deref().unwrap_or("–"),
            state.probability
        );
    }
    let _ = writeln!(text, "  sequence: {}", result.sequence());
    for (state, shown) in &result.shows {
        let _ = writeln!(text, "  {state} shows {}", shown.join(", "));
    }
    if let Some(score) = &result.score {
        agreement(text, score);
    }
    for warning in &result.warnings {
        let _ = writeln!(text, "  ! {warning}");
    }
}
