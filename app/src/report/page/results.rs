//! Parameters with their standard errors, and constraints.

use crate::report::chart::path;
use crate::report::collect::{Content, Drawn, MOST_DRAWN, is_lost};
use crate::report::page::parts::{fact, failed};
use crate::text::constraint_words::constraint_words;
use crate::text::format;
use crate::text::sentence::sentence;
use estimator::estimate::{Constraint, ConstraintKind, Parameter};
use maud::{Markup, html};

/// Maximum number of constraints with a card of their own.
const MOST_CARDS: usize = 2 * MOST_DRAWN;

/// The table of parameters.
pub fn parameters(content: &Content) -> Markup {
    let analysis = match &content.analysis {
        Ok(analysis) => analysis,
        Err(why) => {
            return html! { section class="card" { h3 { "Parameters" } (failed("The fit did not succeed", why)) } };
        }
    };
    let mut objects: Vec<&str> = Vec::new();
    for parameter in &analysis.fit.parameters {
        if !objects.contains(&parameter.object.as_str()) {
            objects.push(&parameter.object);
        }
    }
    let sentences: Vec<&String> =
        analysis.fit.warnings.iter().filter(|w| !content.warnings().contains(&w.as_str())).collect();
    html! {
        section class="card" {
            h3 { "Parameters" }
            table class="parameters" {
                thead { tr { th { "Parameter" } th class="number" { "Value ± error" } th { "Unit" } th { "How it was found" } } }
                tbody {
                    @for object in &objects {
                        tr class="object" { td colspan="4" { (format::object(object)) } }
                        @for parameter in analysis.fit.parameters.iter().filter(|p| p.object == **object) { (row(parameter)) }
                    }
                }
            }
            @if let Some(quality) = &analysis.fit.quality {
                @let unit = quality.unit.replace("Nm", "N·m");
                p class="muted small" {
                    "Force that the model leaves: " (format::significant(quality.rms, 3)) " " (unit) " RMS where it was fitted, "
                    (format::significant(quality.heldout_rms, 3)) " " (unit) " on the last " (format::number(100.0 * quality.heldout_share, 0))
                    " % of the recording by a fit that did not see them."
                }
            }
            @if !sentences.is_empty() {
                ul class="small" { @for warning in &sentences { li class="warning" { (sentence(warning)) } } }
            }
        }
    }
}

fn row(parameter: &Parameter) -> Markup {
    let quantity = format::parameter(&parameter.name, parameter.value);
    html! {
        tr class=[(!parameter.identified || is_lost(parameter)).then_some("hidden")] data-parameter=(parameter.full_name())
            data-value=[parameter.value] data-error=[parameter.std_error] {
            td class="name" { (quantity.label) }
            @match parameter.value {
                Some(value) => {
                    @let error = parameter.std_error.map(|e| e * quantity.factor);
                    @let (value, error) = format::with_error(value * quantity.factor, error);
                    td class="number" { b { (value) } @if let Some(error) = error { " ± " (error) } }
                    td class="unit" { (quantity.unit) }
                }
                None => td class="number" colspan="2" { "not identified" },
            }
            td class="how" {
                @if is_lost(parameter) { b { "Not measured: the error is larger than the value." } " " }
                (sentence(&parameter.how))
            }
        }
    }
}

/// Constraints, each with its evidence, over the path.
pub fn constraints(content: &Content) -> Markup {
    let Ok(analysis) = &content.analysis else { return html! {} };
    let all = &analysis.fit.constraints;
    if all.is_empty() {
        return html! {};
    }
    let cards = html! {
        @for constraint in all.iter().take(MOST_CARDS) { (one(constraint)) }
        @if all.len() > MOST_CARDS { (kinds(all)) }
    };
    let pictures: Vec<Markup> =
        content.drawn.iter().filter_map(|d| path::path(&d.prepared, &held(content, d, all))).collect();
    html! {
        section class="card" {
            h3 { "Constraints" }
            @if pictures.is_empty() { (cards) } @else {
                div class="beside" { div { (cards) } div { @for picture in &pictures { (picture) } } }
            }
        }
    }
}

/// The constraints of one recording.
fn held<'a>(content: &Content, drawn: &Drawn, all: &'a [Constraint]) -> Vec<&'a Constraint> {
    let name = &drawn.prepared.recording.name;
    let here = |c: &&Constraint| c.recording.as_ref().is_none_or(|r| name.ends_with(r.as_str()));
    all.iter().filter(|c| content.recordings.len() == 1 || here(c)).collect()
}

/// Number of constraints of each kind, where there are too many to print.
fn kinds(all: &[Constraint]) -> Markup {
    let mut counts: Vec<(&'static str, usize)> = Vec::new();
    for constraint in all {
        let name = title(constraint.kind);
        match counts.iter_mut().find(|(n, _)| *n == name) {
            Some((_, count)) => *count += 1,
            None => counts.push((name, 1)),
        }
    }
    let words: Vec<String> = counts.iter().map(|(name, count)| format!("{name} in {count}")).collect();
    html! { p class="muted" { "Of all " (all.len()) " recordings: " (words.join(", ")) "." } }
}

/// The name of a constraint in a heading.
pub fn title(kind: ConstraintKind) -> &'static str {
    match kind {
        ConstraintKind::Revolute => "A hinge: turning about a fixed axis",
        ConstraintKind::Prismatic => "A slide: moving along a fixed line",
        ConstraintKind::Free => "No constraint",
        ConstraintKind::Membrane => "A membrane",
        ConstraintKind::Unilateral => "A surface or a cable that holds one way",
        ConstraintKind::Spline => "A guide: a path that is neither line nor circle",
        ConstraintKind::Screw => "A screw: turning and sliding together",
        ConstraintKind::Undecided => "Undecided",
    }
}

/// Coordinates in mm, with their common standard error.
fn place(center_m: &[f64], error_m: Option<f64>) -> String {
    let error = error_m.map(|e| 1e3 * e);
    let numbers: Vec<String> = center_m.iter().map(|c| format::with_error(1e3 * c, error).0).collect();
    let error = center_m.first().and_then(|c| format::with_error(1e3 * c, error).1);
    let error = error.map_or_else(String::new, |e| format!(" ± {e}"));
    format!("({}){error} mm", numbers.join(", "))
}

fn one(constraint: &Constraint) -> Markup {
    let named: Vec<&str> =
        [&constraint.recording, &constraint.object].into_iter().filter_map(|n| n.as_deref()).collect();
    let error = |name: &str| constraint.std_error.get(name).copied();
    let millimetres = |value: f64, error: Option<f64>| {
        let (value, error) = format::with_error(1e3 * value, error.map(|e| 1e3 * e));
        error.map_or(format!("{value} mm"), |e| format!("{value} ± {e} mm"))
    };
    html! {
        div class="cause" {
            h4 { span { (title(constraint.kind)) } @if !named.is_empty() { span class="muted small" { (named.join(", ")) } } }
            dl {
                @if let Some(radius) = constraint.radius_m { (fact("Radius", &millimetres(radius, error("radius_m")))) }
                @if let Some((low, high)) = constraint.radius_interval_m.filter(|i| i.1.is_none() || constraint.radius_m.is_none()) {
                    @let high = high.map_or("∞ (it could be straight)".to_owned(), |h| millimetres(h, None));
                    (fact("Radius, 95 % within", &format!("{} … {high}", format::significant(1e3 * low, 4))))
                }
                @if let Some(center) = &constraint.center_m { (fact("Centre", &place(center, error("center_m")))) }
                @if let Some(direction) = &constraint.direction {
                    @let numbers: Vec<String> = direction.iter().map(|c| format::number(*c, 3)).collect();
                    (fact("Direction", &format!("({})", numbers.join(", "))))
                }
                @if let Some(angle) = constraint.coverage_rad { (fact("Angle that was turned", &format!("{}°", format::number(angle.to_degrees(), 0)))) }
                @if let Some(way) = constraint.coverage_m { (fact("Way that was covered", &millimetres(way, None))) }
                @if let Some(off) = constraint.residual_m { (fact("Path lies off it by", &format!("{} mm RMS", format::significant(1e3 * off, 2)))) }
                @if let Some(rigid) = constraint.rigid { (fact("Its own stiffness, without the pads", if rigid { "rigid, as far as this hand can tell" } else { "gives way" })) }
            }
            p { (sentence(&constraint.evidence)) }
            @for words in constraint_words(constraint) { p class="muted small" { (sentence(&words)) } }
        }
    }
}
