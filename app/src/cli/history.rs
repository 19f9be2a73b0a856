//! `touchstone history`: who practised what, when, and how well.

use super::Output;
use crate::history::{self, Attempt, Query, Store, table};
use anyhow::{Context as _, anyhow};
use clap::Args;
use estimator::training::progress::{LearningCurve, Session, Try, proficient_at, sessions};
use serde_json::{Value, json};
use std::fmt::Write as _;
use std::io::{BufRead as _, BufReader, Read, Write as _};
use std::path::PathBuf;

/// Arguments of `history`.
#[derive(Args)]
pub struct History {
    /// Only of this trainee
    #[arg(long)]
    trainee: Option<String>,
    /// Only at this lesson
    #[arg(long)]
    lesson: Option<String>,
    /// Write the attempts as a table, every measure a column
    #[arg(long)]
    csv: Option<PathBuf>,
    /// Take in attempts of another history: JSON, one attempt a line as `--json` has them, from a file or from `-`, the standard input.
    /// Each is on the disk when its line comes out; those that are known already are left as they are
    #[arg(long, value_name = "FILE")]
    import: Option<PathBuf>,
    /// Another database than the user's
    #[arg(long, value_name = "FILE")]
    database: Option<PathBuf>,
}

impl History {
    pub(super) fn run(&self) -> anyhow::Result<Output> {
        let path = self.database.clone().or_else(history::of_user);
        let path =
            path.context("the system names no folder for data; set HOME or XDG_DATA_HOME, or name a --database")?;
        let mut store = Store::open(&path).map_err(|problem| anyhow!(problem))?;
        if let Some(from) = &self.import {
            return import(&mut store, from);
        }
        let query = Query { trainee: self.trainee.clone(), lesson: self.lesson.clone() };
        let (attempts, problem) = store.attempts_and_problems(&query).map_err(|problem| anyhow!(problem))?;
        if let Some(problem) = problem {
            eprintln!("{problem}");
        }
        let trainees = store.trainees().map_err(|problem| anyhow!(problem))?;
        if let Some(to) = &self.csv {
            let text = table::csv(&attempts).map_err(|problem| anyhow!(problem))?;
            crate::ui::project::write_whole(to, &text).map_err(|problem| anyhow!(problem))?;
        }
        let groups = groups(&attempts);
        let text = in_words(&trainees, &groups, self.csv.as_deref());
        let progress: Vec<Value> = groups.iter().map(|group| progress(group)).collect();
        let json = json!({ "trainees": trainees, "attempts": attempts, "progress": progress });
        Ok(Output { text, json })
    }
}

/// Attempts of one trainee at one lesson under the same conditions, in their order.
fn groups(attempts: &[Attempt]) -> Vec<Vec<&Attempt>> {
    let mut found: Vec<Vec<&Attempt>> = Vec::new();
    for attempt in attempts {
        let same = |group: &&mut Vec<&Attempt>| group.first().is_some_and(|first| first.is_like(attempt));
        match found.iter_mut().find(same) {
            Some(group) => group.push(attempt),
            None => found.push(vec![attempt]),
        }
    }
    found
}

/// Those with a score, as learning is followed.
fn tries(group: &[&Attempt]) -> Vec<Try> {
    group.iter().filter_map(|attempt| attempt.as_try()).collect()
}

fn progress(group: &[&Attempt]) -> Value {
    let tries = tries(group);
    let values: Vec<f64> = tries.iter().map(|t| t.value).collect();
    let session = |s: &Session| json!({ "attempts": s.end - s.first, "mean": s.mean, "half_width": s.half_width });
    let curve = LearningCurve::fit(&values).map(|c| {
        json!({ "level": c.level, "gain": c.gain, "exponent": c.exponent, "exponent_interval": c.exponent_interval,
            "scatter": c.scatter, "is_seen": c.is_seen, "now": c.at(values.len() as f64).value,
            "now_interval": c.at(values.len() as f64).interval })
    });
    let first = group.first();
    json!({
        "trainee": first.map(|a| &a.trainee),
        "lesson": first.map(|a| &a.lesson),
        "conditions": first.map(|a| a.conditions),
        "attempts": group.len(),
        "proficient_after": proficient_at(&tries).map(|index| index + 1),
        "sessions": sessions(&tries).iter().map(session).collect::<Vec<_>>(),
        "curve": curve,
    })
}

fn in_words(trainees: &[String], groups: &[Vec<&Attempt>], csv: Option<&std::path::Path>) -> String {
    let mut text = String::new();
    if groups.is_empty() {
        let known = if trainees.is_empty() { "nobody".to_owned() } else { trainees.join(", ") };
        let _ = writeln!(text, "No attempts; known trainees: {known}.");
    }
    for group in groups {
        let Some(first) = group.first() else { continue };
        let tries = tries(group);
        let done = group.iter().filter(|a| a.completed).count();
        let _ = writeln!(text, "{}, {}{}", first.trainee, first.lesson, first.conditions.in_words());
        let _ = writeln!(text, "  {} attempts, {done} completed", group.len());
        for (k, s) in sessions(&tries).iter().enumerate() {
            let half = s.half_width.map_or(String::new(), |half| format!(" ± {half:.1}"));
            let _ = writeln!(text, "  session {}: {:.1}{half} in {} attempts", k + 1, s.mean, s.end - s.first);
        }
        let values: Vec<f64> = tries.iter().map(|t| t.value).collect();
        if let Some(curve) = LearningCurve::fit(&values).filter(|curve| curve.is_seen) {
            let now = curve.at(values.len() as f64);
            let _ = writeln!(
                text,
                "  power law of practice: now {:.1} [{:.1}, {:.1}], goes to {:.1}, exponent {:.2} [{:.2}, {:.2}]",
                now.value,
                now.interval[0],
                now.interval[1],
                curve.level,
                curve.exponent,
                curve.exponent_interval[0],
                curve.exponent_interval[1]
            );
        }
        if let Some(index) = proficient_at(&tries) {
            let _ = writeln!(text, "  proficient after attempt {}", index + 1);
        }
    }
    if let Some(to) = csv {
        let _ = writeln!(text, "table: {}", to.display());
    }
    text
}

/// Takes in attempts, one a line, and says so of each once it is on the disk.
fn import(store: &mut Store, from: &std::path::Path) -> anyhow::Result<Output> {
    let source: Box<dyn Read> = if from == std::path::Path::new("-") {
        Box::new(std::io::stdin())
    } else {
        Box::new(std::fs::File::open(from).with_context(|| format!("cannot read {}", from.display()))?)
    };
    let (mut new, mut known) = (0_usize, 0_usize);
    for (number, line) in BufReader::new(source).lines().enumerate() {
        let line = line.with_context(|| format!("cannot read {}", from.display()))?;
        if line.trim().is_empty() {
            continue;
        }
        let place = || format!("line {} of {} is no attempt", number + 1, from.display());
        let attempt: Attempt = serde_json::from_str(&line).with_context(place)?;
        let added = store.add(&attempt).map_err(|problem| anyhow!(problem))?;
        if added {
            new += 1;
        } else {
            known += 1;
        }
        // Progress, and a word for who waits to hear that it is safe: not on standard output, which is the answer's.
        let mut said = std::io::stderr().lock();
        let _ = writeln!(said, "kept {}", new + known).and_then(|()| said.flush());
    }
    let text = format!("{new} attempts taken in, {known} known already\n");
    Ok(Output { text, json: json!({ "new": new, "known": known }) })
}
