//! The section of one log.

use super::{diagnosis, recording, replay, results, unknown};
use crate::diagnosis_words::headline_of;
use crate::report::Sheet;
use crate::report::collect::Content;
use crate::ui::format;
use crate::ui::session::sentence;
use estimator::diagnose::{Diagnosis, Verdict};
use haptics::recording::Task;
use maud::{Markup, html};

/// What a diagnosis starts from when nothing else is stated.
const PLAIN: &str = "The plain model of the task";

/// Everything about a log, under its name.
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
        Err(_) => "A recording whose fit did not succeed",
    };
    match content.recordings.len() {
        1 => what.to_owned(),
        n => format!("{what}; {n} recordings"),
    }
}

/// What a reader in a hurry needs.
fn summary(content: &Content) -> Markup {
    let (found, all) = content.identified();
    html! {
        div class="card summary" {
            ul {
                @if all > 0 {
                    li class=(if found == all { "good" } else { "" }) {
                        @if found == all { "All " (all) " parameters were measured." }
                        @else { (found) " of " (all) " parameters were measured; what is missing for the others stands below." }
                    }
                }
                @if let Some(text) = agreement(content) { li class="good" { (text) } }
                @if let Ok(diagnosis) = &content.diagnosis {
                    li { (headline_of(PLAIN, diagnosis)) }
                }
                @if let Some(diagnosis) = &content.of_world {
                    li class=(if diagnosis.verdict == Verdict::None { "good" } else { "" }) { (of_world(diagnosis)) }
                }
                @if let Err(why) = &content.analysis { li class="warning" { "The fit did not succeed: " (sentence(why)) } }
                @match content.warnings().len() {
                    0 => li class="good" { "Nothing in the data looks wrong." },
                    1 => li class="warning" { "One warning about the quality of the data." },
                    n => li class="warning" { (n) " warnings about the quality of the data." },
                }
            }
        }
    }
}

/// What the calibrated world leaves, in one sentence.
pub fn of_world(diagnosis: &Diagnosis) -> String {
    match diagnosis.verdict {
        Verdict::None => "The world that was calibrated leaves nothing beyond the noise.".to_owned(),
        Verdict::Unexplained => {
            "The world that was calibrated leaves something that no known cause explains.".to_owned()
        }
        _ => headline_of("The world that was calibrated still", diagnosis),
    }
}

/// How well force that the fit did not see is met.
fn agreement(content: &Content) -> Option<String> {
    let quality = content.analysis.as_ref().ok()?.fit.quality.as_ref()?;
    let (share, off) = (100.0 * quality.heldout_share, 100.0 * quality.heldout_relative);
    off.is_finite().then(|| {
        format!(
            "The fitted model meets the force on the {} % of the recording that it was not fitted to within {} %.",
            format::number(share, 0),
            format::significant(off, 2)
        )
    })
}
