//! Asks the questions about real measurements and writes `docs/evidence/real-data.md`.
//!
//! `cargo run --release -p tests --bin real` needs the measurements beside the checkout (`../shared/data`).

use rayon::prelude::*;
use std::fmt::Write as _;
use std::process::ExitCode;
use tests::real::{Outcome, QUESTIONS, ask};

fn main() -> ExitCode {
    let answers: Vec<_> = QUESTIONS.par_iter().filter_map(|question| Some((question, ask(question)?))).collect();
    if answers.is_empty() {
        eprintln!("no measurements are beside the checkout (../shared/data)");
        return ExitCode::FAILURE;
    }
    let count = |outcome: Outcome| answers.iter().filter(|(_, judged)| judged.outcome == outcome).count();
    let mut text = format!(
        "# Real measurements\n\n`cargo run --release -p tests --bin real`: {} questions, {} right, {} honest, {} wrong with confidence, {} refused. The measurements are not part of this repository.\n\n| log | question | base model | answer | |\n|---|---|---|---|---|\n",
        answers.len(),
        count(Outcome::Right),
        count(Outcome::Honest),
        count(Outcome::Wrong),
        count(Outcome::Refused)
    );
    for (question, judged) in &answers {
        let said: String = judged.said.chars().take(120).collect();
        let base = question.baseline.unwrap_or("");
        let _ = writeln!(
            text,
            "| `{}` | {} | {base} | {} | {} |",
            question.log,
            question.asked,
            said.replace('|', "/"),
            judged.outcome.word()
        );
    }
    print!("{text}");
    let path = tests::workspace().join("docs/evidence/real-data.md");
    if let Err(error) = std::fs::write(&path, text) {
        eprintln!("{}: {error}", path.display());
        return ExitCode::FAILURE;
    }
    ExitCode::SUCCESS
}
