//! The page of a cause for `docs/causes/`, made from the catalogue. `cargo run -p haptics --example causes` writes all
//! of them; `haptics/tests/causes.rs` fails if the written ones differ.

use super::entry::{Enters, Entry, Kind, ParameterSpec};
use std::fmt::Write as _;

/// First line of every page, so that the copy is not edited by hand.
const MADE: &str =
    "<!-- Made by `cargo run -p haptics --example causes` from the laws in haptics/src/law. Change it there. -->";

/// The page of one cause in Markdown. `head` is the docstring of the law's file, as written after `//!`; empty where it has none.
pub fn page(entry: &Entry, head: &str) -> String {
    let mut text = format!("{MADE}\n\n# {}\n\n", entry.title);
    let _ = writeln!(text, "`{}` · {}\n\n    {}\n", entry.id, kind(entry.kind), entry.equation);
    let sections = [
        ("What it is", entry.what),
        ("How it shows", entry.shows),
        ("What mimics it", entry.mimics),
        ("Which motion reveals it", entry.reveals),
    ];
    for (title, words) in sections {
        let _ = writeln!(text, "## {title}\n\n{words}\n");
    }
    text += &parameters(entry.parameters);
    if !head.is_empty() {
        let _ = writeln!(text, "\n## The law\n\n{head}");
    }
    text + "\n[All causes](README.md)\n"
}

fn kind(kind: Kind) -> &'static str {
    match kind {
        Kind::Plant => "*plant*: part of what is felt; the extended world has it",
        Kind::Instrument => {
            "*instrument*: a fault of the measurement; it corrects the recording and leaves the world alone"
        }
    }
}

fn parameters(specs: &[ParameterSpec]) -> String {
    let mut text = String::from(
        "## Parameters\n\n| name | unit along a path | unit of an angle | range | in a fit |\n|---|---|---|---|---|\n",
    );
    for spec in specs {
        let _ = writeln!(
            text,
            "| `{}` | {} | {} | {} | {} |",
            spec.name,
            spec.unit,
            spec.unit_angular,
            range(spec.bounds),
            enters(spec.enters)
        );
    }
    text
}

fn range((low, high): (f64, f64)) -> String {
    match (low.is_finite(), high.is_finite()) {
        (true, true) => format!("{low} … {high}"),
        (true, false) => format!("≥ {low}"),
        (false, true) => format!("≤ {high}"),
        (false, false) => "any".to_owned(),
    }
}

fn enters(enters: Enters) -> &'static str {
    match enters {
        Enters::Linear => "linear",
        Enters::Nonlinear => "searched for",
        Enters::Fixed => "known beforehand",
    }
}

/// The page of a term without a name (`other:<expression>`).
pub fn nameless() -> String {
    format!(
        "{MADE}\n\n# Something that no law explains\n\n`other:<expression>` · unnamed\n\n{}\n\n[All causes](README.md)\n",
        "## What it is\n\nAn effect on one measured quantity that no law of this list describes: a force that follows another recorded channel \
         (a temperature, a voltage), friction that grows with the length of a needle in its hole, puncture forces that differ. The \
         expression names that quantity. It is a description, not a law: no world is extended by it. Unknown smooth forces over \
         position, speed, load or time have no entry of this kind; the field `model_error` states them.\n\n\
         ## How it shows\n\nAs a gain on held-out data.\n\n\
         ## What mimics it\n\nA cause of the list in a form far from the law's, several causes at once that cancel in part, or \
         noise whose size changes during the recording.\n\n\
         ## Which motion reveals it\n\nOne that changes what the expression names and holds everything else still. When the \
         mechanism is understood, it becomes a law: one file in haptics/src/law."
    )
}

/// The list of all pages.
pub fn index<'a>(entries: impl Iterator<Item = &'a Entry>) -> String {
    let (plant, instrument): (Vec<&Entry>, Vec<&Entry>) = entries.partition(|entry| entry.kind == Kind::Plant);
    let mut text = format!(
        "{MADE}\n\n# Causes\n\nWhat a simulation can be getting wrong, and what `touchstone diagnose` can name. How it decides: \
         [Diagnosis](../diagnosis.md).\n"
    );
    let parts = [
        ("In the world (plant)", "These change the world that the trainee feels.", plant),
        ("In the measurement (instrument)", "These correct the recording and leave the world alone.", instrument),
    ];
    for (title, words, entries) in parts {
        let _ = writeln!(
            text,
            "\n## {title}\n\n{words}\n\n| cause | id | term | which motion reveals it |\n|---|---|---|---|"
        );
        for e in entries {
            // A bar would end the cell, also within back-quotes.
            let equation = e.equation.replace('|', "\\|");
            let _ = writeln!(text, "| [{}]({}.md) | `{}` | `{equation}` | {} |", e.title, e.id, e.id, e.reveals);
        }
    }
    text + "\n## Without a name\n\n[Something that no law explains](other.md) (`other:<expression>`): it is there, and what it goes with \
            is reported.\n"
}
