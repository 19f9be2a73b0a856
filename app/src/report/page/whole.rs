//! The page itself: an overview, a section for each log, what made it.

use super::{log, recording};
use crate::report::collect::Sheet;
use crate::report::provenance::Provenance;
use crate::report::source::Hashed;
use crate::report::style;
use crate::text::diagnosis_words::headline;
use crate::text::format;
use crate::text::sentence::sentence;
use maud::{DOCTYPE, Markup, PreEscaped, html};

/// Content security policy: no fetching and no scripts, whatever a file name contains.
const POLICY: &str = "default-src 'none'; style-src 'unsafe-inline'";

/// The whole page.
pub fn page(title: &str, sheets: &[Sheet], provenance: &Provenance) -> String {
    let whole = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta http-equiv="Content-Security-Policy" content=(POLICY);
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta name="generator" content=(format!("Touchstone {}", provenance.version));
                title { (title) }
                style { (PreEscaped(style::css())) }
            }
            body {
                main {
                    h1 { (title) }
                    p class="lead" { "Touchstone " (provenance.version) ", " (provenance.date) }
                    @if sheets.len() > 1 { (overview(sheets)) }
                    @for (k, sheet) in sheets.iter().enumerate() { (log::section(k + 1, sheet)) }
                    (repeat(sheets, provenance))
                }
            }
        }
    };
    printable(&whole.into_string())
}

/// Text without control characters, which are invalid in HTML; names and sidecars may contain them.
fn printable(text: &str) -> String {
    let hidden = |c: char| c.is_control() && c != '\n' && c != '\t';
    let turns = |c: char| matches!(c, '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}' | '\u{fdd0}'..='\u{fdef}');
    text.chars().map(|c| if hidden(c) || turns(c) { '\u{fffd}' } else { c }).collect()
}

/// Table with one line per log.
fn overview(sheets: &[Sheet]) -> Markup {
    html! {
        section class="card" id="overview" {
            h3 { "Overview" }
            table {
                thead { tr {
                    th { "Log" } th { "Task" } th class="number" { "Length" } th class="number" { "Parameters" }
                    th class="number" { "Warnings" } th { "Diagnosis" }
                } }
                tbody {
                    @for (k, sheet) in sheets.iter().enumerate() { (line(k + 1, sheet)) }
                }
            }
        }
    }
}

fn line(number: usize, sheet: &Sheet) -> Markup {
    let link = html! { a href=(format!("#log-{number}")) { (sheet.source.name()) } };
    let Ok(content) = &sheet.content else {
        return html! { tr { td { (link) } td colspan="5" class="muted" { "could not be read" } } };
    };
    let (found, all) = content.identified();
    html! {
        tr {
            td class="log-name" { (link) }
            td class="task" { (content.analysis.as_ref().map_or("–", |a| a.task.name())) }
            td class="number" { (recording::length(content)) }
            td class="number" { @if all > 0 { (found) " of " (all) } @else { "–" } }
            td class="number" { (content.warnings().len()) }
            td { @match &content.diagnosis {
                Ok(diagnosis) => (headline(diagnosis)),
                Err(_) => span class="muted" { "not diagnosed" },
            } }
        }
    }
}

/// Versions, files and hashes.
fn repeat(sheets: &[Sheet], provenance: &Provenance) -> Markup {
    html! {
        section class="log" id="provenance" {
            header { h2 { "How to repeat this" } }
            div class="card" {
                dl {
                    div { dt { "Program" } dd { "touchstone " (provenance.version) } }
                    div { dt { "Revision of its sources" } dd class="mono" { (provenance.revision.unwrap_or("not recorded by this build (a development build, or one without git)")) } }
                    div { dt { "Built for" } dd { (provenance.platform) } }
                    div { dt { "Date" } dd { (provenance.date) } }
                }
                h4 { "Command" }
                pre { (provenance.command) }
                p class="muted small" { "Nothing in these results is left to chance: where stretches are drawn at random (bootstrap), they are the same in every run." }
                h4 { "Files" }
                table {
                    thead { tr { th { "File" } th class="number" { "Bytes" } th { "SHA-256" } } }
                    tbody {
                        @for sheet in sheets {
                            (file(&sheet.source.log))
                            @if let Some(sidecar) = &sheet.source.sidecar { (file(sidecar)) }
                            @for joined in &sheet.source.joined { (file(joined)) }
                        }
                    }
                }
                @for sheet in sheets {
                    @if let Some(stated) = &sheet.source.stated {
                        h4 { "What the sidecar of " (sheet.source.name()) " states" }
                        pre { (brief(stated)) }
                    }
                }
            }
            footer { p { "All values are in SI units or units made of them. An error behind ± is one standard error; systematic parts are in it." } }
        }
    }
}

/// JSON without whitespace between tokens; other text unchanged.
fn brief(text: &str) -> String {
    let value: Option<serde_json::Value> = serde_json::from_str(text).ok();
    value.map_or_else(|| text.trim().to_owned(), |v| v.to_string().replace(",\"", ", \""))
}

fn file(file: &Hashed) -> Markup {
    html! {
        tr {
            td { (file.path.display().to_string()) }
            @match &file.digest {
                Ok((length, hash)) => {
                    td class="number" { (format::grouped(usize::try_from(*length).unwrap_or(usize::MAX))) }
                    td class="mono" { (hash) }
                }
                Err(why) => td colspan="2" class="muted" { (sentence(why)) },
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_cannot_be_printed_is_replaced() {
        assert_eq!(printable("a\u{0}b\u{1b}[31m\u{202e}c\n"), "a\u{fffd}b\u{fffd}[31m\u{fffd}c\n");
    }
}
