//! Parameters and effects that are not identifiable, and the motion that would reveal them.

use crate::report::collect::{Content, is_lost};
use crate::text::diagnosis_words::{listed, title};
use crate::text::format;
use crate::text::sentence::sentence;
use estimator::diagnose::NotExcited;
use estimator::estimate::{ConstraintKind, Parameter};
use maud::{Markup, html};

/// The section.
pub fn unknown(content: &Content) -> Markup {
    let all = content.analysis.as_ref().map_or(&[][..], |a| &a.fit.parameters);
    let hidden: Vec<&Parameter> = all.iter().filter(|p| !p.identified).collect();
    let lost = || all.iter().filter(|p| p.identified && is_lost(p));
    let constraints = content.analysis.as_ref().map_or(&[][..], |a| &a.fit.constraints);
    let open = constraints.iter().filter(|c| c.kind == ConstraintKind::Undecided);
    let not_excited = content.diagnosis.as_ref().map_or(&[][..], |d| &d.not_excited);
    html! {
        section class="card" {
            h3 { "What could not be known" }
            @if !hidden.is_empty() {
                h4 { "Parameters that this motion does not show" }
                ul { @for parameter in hidden {
                    li {
                        b { (format::object(&parameter.object)) ", " (format::parameter(&parameter.name, None).label.to_lowercase()) } ": "
                        (sentence(&parameter.how))
                        @if let Some(words) = missing(content, parameter) { " What would show it: " (words) "." }
                    }
                } }
            }
            @if lost().next().is_some() {
                h4 { "Parameters that are lost in their own errors" }
                ul { @for parameter in lost() {
                    li {
                        b { (format::object(&parameter.object)) ", " (format::parameter(&parameter.name, None).label.to_lowercase()) } ": "
                        "nothing, or twice as much, is as likely."
                        @if let Some(words) = missing(content, parameter) { " What would show it: " (words) "." }
                    }
                } }
            }
            @for constraint in open { p { b { "A constraint stays open: " } (sentence(&constraint.evidence)) } }
            @if !not_excited.is_empty() {
                h4 { "Effects that could be there and would not have been seen" }
                ul { @for (why, ids) in by_reason(not_excited) {
                    @let names: Vec<String> = ids.iter().map(|id| title(id)).collect();
                    li { b { (format::capitalised(&listed(&names))) } ": " (sentence(why)) }
                } }
            }
            @if let Err(why) = &content.analysis { p { "No parameters and no constraints, because the fit did not succeed: " (sentence(why)) } }
            @if let Err(why) = &content.diagnosis { p { "Whether the model misses anything: " (sentence(why)) } }
            @if content.analysis.is_ok() && content.diagnosis.is_ok() && all.iter().all(|p| p.identified && !is_lost(p)) && not_excited.is_empty() {
                p { "Everything that was looked for could be seen." }
            }
        }
    }
}

/// Motion that would make a parameter identifiable.
fn missing(content: &Content, parameter: &Parameter) -> Option<String> {
    let enough = content.enough.iter().find(|e| e.object == parameter.object && e.name == parameter.name)?;
    let words = &enough.missing.as_ref()?.words;
    // If the reason already names the motion, it is not repeated.
    (!parameter.how.contains(words.as_str())).then(|| words.trim_end_matches('.').to_owned())
}

/// Effects grouped by the reason that hides them.
fn by_reason(all: &[NotExcited]) -> Vec<(&str, Vec<&str>)> {
    let mut found: Vec<(&str, Vec<&str>)> = Vec::new();
    for hidden in all {
        match found.iter_mut().find(|(why, _)| *why == hidden.why) {
            Some((_, ids)) => ids.push(&hidden.id),
            None => found.push((&hidden.why, vec![&hidden.id])),
        }
    }
    found
}
