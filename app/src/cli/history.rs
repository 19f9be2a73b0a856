//! `touchstone history`: the trainees' attempts with their lessons, times and scores.

use super::Output;
use crate::history::attempt;
use crate::history::attempt::{Attempt, Conditions};
use crate::history::store::{Query, Store};
use crate::history::table;
use anyhow::{Context as _, anyhow};
use clap::Args;
use estimator::training::progress::{LearningCurve, Session, Try, proficient_at, sessions};
use schemars::JsonSchema;
use serde::Serialize;
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

/// What `history --json` prints.
#[derive(JsonSchema, Serialize)]
pub(crate) struct Said {
    /// Everybody whom the history knows.
    trainees: Vec<String>,
    /// The attempts that were asked for, in their order.
    attempts: Vec<Attempt>,
    /// How these went on.
    progress: Vec<Progress>,
}

/// What `history --import FILE --json` prints.
#[derive(JsonSchema, Serialize)]
pub(crate) struct Imported {
    /// Attempts that were taken in.
    new: usize,
    /// Attempts that were known already.
    known: usize,
}

/// How one trainee went on at one lesson under the same conditions.
#[derive(JsonSchema, Serialize)]
struct Progress {
    /// Who.
    trainee: String,
    /// Id of the lesson.
    lesson: String,
    /// Under what.
    conditions: Conditions,
    /// How many, with and without a score.
    attempts: usize,
    /// After how many scored attempts the trainee was proficient; null: not yet.
    proficient_after: Option<usize>,
    /// Sittings, from the scores of their attempts.
    sessions: Vec<Sitting>,
    /// The power law of practice through the scores; null with too few.
    curve: Option<Practice>,
}

/// One sitting.
#[derive(JsonSchema, Serialize)]
struct Sitting {
    /// Scored attempts.
    attempts: usize,
    /// Mean score.
    mean: f64,
    /// Half of its 95 % interval; null with one attempt.
    half_width: Option<f64>,
}

impl From<&Session> for Sitting {
    fn from(s: &Session) -> Self {
        Self { attempts: s.end - s.first, mean: s.mean, half_width: s.half_width }
    }
}

/// The power law of practice.
#[derive(JsonSchema, Serialize)]
struct Practice {
    /// What the score goes to after endless practice.
    level: f64,
    /// What the first attempt was off that; negative where scores rise.
    gain: f64,
    /// How fast.
    exponent: f64,
    /// Its 95 % interval.
    exponent_interval: [f64; 2],
    /// Standard deviation of single attempts about the curve.
    scatter: f64,
    /// Whether the scores changed at all, by an F test at 5 %.
    is_seen: bool,
    /// The curve at the last attempt.
    now: f64,
    /// Its 95 % interval.
    now_interval: [f64; 2],
}

impl Practice {
    fn of(scores: &[f64]) -> Option<Self> {
        let c = LearningCurve::fit(scores)?;
        let now = c.at(scores.len() as f64);
        Some(Self {
            level: c.level,
            gain: c.gain,
            exponent: c.exponent,
            exponent_interval: c.exponent_interval,
            scatter: c.scatter,
            is_seen: c.is_seen,
            now: now.value,
            now_interval: now.interval,
        })
    }
}

impl History {
    pub(super) fn run(&self) -> anyhow::Result<Output> {
        let path = self.database.clone().or_else(attempt::of_user);
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
            crate::write_whole::write_whole(to, &text).map_err(|problem| anyhow!(problem))?;
        }
        let groups = groups(&attempts);
        let text = in_words(&trainees, &groups, self.csv.as_deref());
        let progress = groups.iter().filter_map(|group| progress(group)).collect();
        Ok(Output { text, json: serde_json::to_value(Said { trainees, attempts, progress })? })
    }
}

/// Attempts of one trainee at one lesson under the same conditions, in order.
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

/// Attempts with a score, as points of the learning curve.
fn tries(group: &[&Attempt]) -> Vec<Try> {
    group.iter().filter_map(|attempt| attempt.as_try()).collect()
}

fn progress(group: &[&Attempt]) -> Option<Progress> {
    let (first, tries) = (group.first()?, tries(group));
    let scores: Vec<f64> = tries.iter().map(|t| t.value).collect();
    Some(Progress {
        trainee: first.trainee.clone(),
        lesson: first.lesson.clone(),
        conditions: first.conditions,
        attempts: group.len(),
        proficient_after: proficient_at(&tries).map(|index| index + 1),
        sessions: sessions(&tries).iter().map(Sitting::from).collect(),
        curve: Practice::of(&scores),
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

/// Imports attempts, one per line, and reports each once it is on the disk.
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
        // Progress, and a confirmation for a waiting caller: not on standard output, which is for the answer.
        let mut said = std::io::stderr().lock();
        let _ = writeln!(said, "kept {}", new + known).and_then(|()| said.flush());
    }
    let text = format!("{new} attempts taken in, {known} known already\n");
    Ok(Output { text, json: serde_json::to_value(Imported { new, known })? })
}
