//! Advice for the next attempt, in one sentence: drawn from its faults, else from the worst measure.

use super::graded::{Figure, Grade};
use crate::definitions::Definition;

/// A measure that is worse than the experts' mean by less than this many units needs no advice.
const FINE: f64 = 1.0;

/// The sentence for an attempt.
pub fn of(grade: &Grade) -> String {
    if let Some(rule) = grade.rules.iter().find(|rule| !rule.reached) {
        return format!("Next time, first of all: {}.", lower(&rule.says));
    }
    if let Some(goal) = grade.goals.iter().find(|goal| !goal.reached) {
        return format!("Not reached yet: {}.", lower(&goal.says));
    }
    if grade.answered_rightly == Some(false) {
        return "The answer was wrong: lift it again to feel its weight, and squeeze it gently to feel its wall."
            .to_owned();
    }
    let worst = grade.figures.iter().max_by(|a, b| (a.weight * a.worse_by).total_cmp(&(b.weight * b.worse_by)));
    match worst.filter(|figure| figure.worse_by > FINE) {
        Some(figure) => about(figure),
        None if grade.meets_criterion => {
            "As an expert does it: do it once more like this, to show that it stays.".to_owned()
        }
        None => "Nearly there: everything a little better, nothing stands out.".to_owned(),
    }
}

fn about(figure: &Figure) -> String {
    let Some(definition) = Definition::of(&figure.measure) else { return String::new() };
    let what = |value: f64| shown(value, definition.unit);
    let name = lower(definition.name);
    format!("{} ({name}: {}, experts {}).", definition.advice, what(figure.value), what(figure.expert_mean))
}

/// A value as people read it.
pub fn shown(value: f64, unit: &str) -> String {
    match unit {
        "m" => format!("{:.1} mm", 1e3 * value),
        "rad" => format!("{:.1}°", value.to_degrees()),
        "kg" => format!("{:.1} g", 1e3 * value),
        "J" => format!("{:.1} mJ", 1e3 * value),
        "s" => format!("{value:.1} s"),
        "N" => format!("{value:.2} N"),
        "" if value.fract() == 0.0 => format!("{value:.0}"),
        "" => format!("{value:.2}"),
        other => format!("{value:.2} {other}"),
    }
}

fn lower(text: &str) -> String {
    let mut letters = text.trim_end_matches('.').chars();
    letters.next().map_or_else(String::new, |first| first.to_lowercase().chain(letters).collect())
}
