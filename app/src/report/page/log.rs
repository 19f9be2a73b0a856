//! The section of one log.

use super::{diagnosis, recording, replay, results, unknown};
use crate::report::collect::{Content, Sheet};
use crate::text::diagnosis_words::{headline_of, small};
use crate::text::format;
use crate::text::sentence::sentence;
use estimator::diagnose::{Findings, Verdict};
use estimator::estimate::{Constraint, ConstraintKind};
use haptics::recording::Task;
use maud::{Markup, html};

/// Maximum number of a fit's warnings in the summary; all of them are listed below.
const MOST_DOUBTS: usize = 3;
/// Name of the base model of a diagnosis by default.
const PLAIN: &str = "The plain model of the task";

/// All results of a log, under its name.
pub fn section(number: usize, sheet: &Sheet) -> Markup {
    html! {
        section class="log" id=(format!("log-{number}")) {
            header {
                h2 { (sheet.source.name()) }
                @if let Ok(content) = &sheet.content { p class="muted" { (kind(content)) } }
            }
            @match &sheet.content {
                Err(why) => p class="failed broken" { "This log could not be read: " (why.trim_end_matches('.')) "." },
                Ok(content) => {
                    (summary(content))
                    (recording::facts(content))
                    (recording::course(content))
                    (results::parameters(content))
                    (results::constraints(content))
                    (replay::against_virtual(content))
                    (diagnosis::diagnosis(content))
                    (unknown::unknown(content))
                }
            }
        }
    }
}

fn kind(content: &Content) -> String {
    let object = content.analysis.as_ref().ok().and_then(|a| a.fit.parameters.first()).map(|p| p.object.as_str());
    let what = match content.analysis.as_ref().map(|a| a.task) {
        Ok(Task::Mechanism) if object == Some("chain") => "A chain of two links",
        Ok(Task::Mechanism) if object == Some("body") => "A body that is thrown",
        Ok(Task::BlockStack) => "Blocks that are lifted and stacked",
        Ok(Task::Crank) => "A crank, turned by its handle",
        Ok(Task::Needle) => "A needle through a sheet",
        Ok(Task::Mechanism) => "A mechanism that moves along one coordinate",
        Ok(Task::Barrel) => "A barrel",
        Ok(Task::Switch) => "A switch",
        Ok(Task::Payload) => "The load of a force/torque sensor",
        Err(_) => "A recording whose fit did not succeed",
    };
    match content.recordings.len() {
        1 => what.to_owned(),
        n => format!("{what}; {n} recordings"),
    }
}

/// Summary for a reader in a hurry.
fn summary(content: &Content) -> Markup {
    let (found, all) = content.identified();
    html! {
        div class="card summary" {
            ul {
                @if all == 0 && content.analysis.is_ok() { li class="warning" { "No parameters were looked for in this recording." } }
                @if all > 0 {
                    li class=(if found == all { "good" } else { "" }) {
                        @if found == all { "All " (all) " parameters were measured." }
                        @else { (found) " of " (all) " parameters were measured; what is missing for the others stands below." }
                    }
                }
                @if let Some((text, is_good)) = agreement(content) { li class=(if is_good { "good" } else { "warning" }) { (text) } }
                @if let Some(text) = held_by(content) { li { (text) } }
                @if let Ok(diagnosis) = &content.diagnosis {
                    li { (headline_of(PLAIN, diagnosis)) }
                }
                @if let Some(diagnosis) = &content.of_world {
                    li class=(if diagnosis.verdict == Verdict::None { "good" } else { "" }) {
                        (of_world(diagnosis))
                        @if let Some(words) = replay::beside_the_diagnosis(content, diagnosis) { " " (words) }
                    }
                }
                @if let Err(why) = &content.analysis { li class="warning" { "The fit did not succeed: " (sentence(why)) } }
                @for warning in doubts(content).iter().take(MOST_DOUBTS) { li class="warning" { "The fit warns: " (sentence(warning)) } }
                @match content.warnings().len() {
                    0 if !doubts(content).is_empty() => {}
                    0 => li class="good" { "Nothing in the data looks wrong." },
                    1 => li class="warning" { "One warning about the quality of the data." },
                    n => li class="warning" { (n) " warnings about the quality of the data." },
                }
            }
        }
    }
}

/// Residual of the calibrated world, in one sentence.
pub fn of_world(diagnosis: &Findings) -> String {
    match diagnosis.verdict {
        Verdict::None => "The world that was calibrated leaves nothing beyond the noise.".to_owned(),
        Verdict::Unexplained => {
            "The world that was calibrated leaves something that no known cause explains.".to_owned()
        }
        _ => headline_of("The world that was calibrated still", diagnosis),
    }
}

/// Warnings of the fit itself.
fn doubts(content: &Content) -> &[String] {
    content.analysis.as_ref().map_or(&[], |analysis| &analysis.fit.warnings)
}

/// Constraint of the moved object, in one sentence; `None` where it was not tested, or is inconclusive.
fn held_by(content: &Content) -> Option<String> {
    let told = |c: &&Constraint| !matches!(c.kind, ConstraintKind::Free | ConstraintKind::Undecided);
    let all = &content.analysis.as_ref().ok()?.fit.constraints;
    let held: Vec<&Constraint> = all.iter().filter(told).collect();
    let first = held.first()?;
    let kinds = held.iter().all(|c| c.kind == first.kind).then(|| small(results::title(first.kind)))?;
    Some(match (all.len(), first.radius_m) {
        (1, Some(radius_m)) => {
            let error = first.std_error.get("radius_m").map(|e| 1e3 * e);
            let (radius, error) = format::with_error(1e3 * radius_m, error);
            let error = error.map_or_else(String::new, |e| format!(" ± {e}"));
            format!("What was moved is held by {kinds}, {radius}{error} mm away.")
        }
        (1, None) => format!("What was moved is held by {kinds}."),
        (n, _) => format!("In {} of {n} recordings what was moved is held by {kinds}.", held.len()),
    })
}

/// Maximum relative residual of an adequate model, %.
const MEETS: f64 = 10.0;

/// Agreement with held-out force as text, and true if it is adequate.
fn agreement(content: &Content) -> Option<(String, bool)> {
    let quality = content.analysis.as_ref().ok()?.fit.quality.as_ref()?;
    let (share, off) = (100.0 * quality.heldout_share, 100.0 * quality.heldout_relative);
    off.is_finite().then(|| {
        let text = format!(
            "The fitted model meets the force on the {} % of the recording that it was not fitted to within {} %.",
            format::number(share, 0),
            format::significant(off, 2)
        );
        (text, off < MEETS)
    })
}
