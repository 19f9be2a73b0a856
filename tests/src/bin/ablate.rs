//! Cases of `touchstone bench ablation`: asks each with every constant that it reads multiplied by given factors.
//!
//! Runs in a copy of the sources whose constants can be varied. Prints one JSON line a case. Truth is opened by the
//! scorers of the batteries alone.

use blind::{Counts, Set, battery};
use estimator::ablation::{reset, vary};
use estimator::diagnose::{Findings, Options, diagnose};
use estimator::estimate::Fit;
use estimator::pipeline::{self, analyse};
use haptics::recording::Recording;
use serde::Deserialize;
use serde_json::{Value, json};
use std::collections::{HashMap, HashSet};
use std::hash::{DefaultHasher, Hash, Hasher};
use std::panic::{AssertUnwindSafe, catch_unwind, set_hook};
use tests::tasks::{barrel, blocks, needle, score, slide, switch, throw};

/// An estimate has moved by this many of its standard errors.
const MOVED_ERRORS: f64 = 0.5;

/// Prints the score of an answer: right or not.
type Judge = Box<dyn Fn(Result<Findings, String>) -> bool>;

/// Part of the work of the bench, its one argument.
#[derive(Deserialize)]
struct Task {
    seed: u64,
    /// Every `parts`-th case is asked, from this one on.
    part: usize,
    parts: usize,
    /// Largest number of cases; none: all.
    cases: Option<usize>,
    /// A factor of a constant is tried no more after so many changed answers.
    enough: u64,
    factors: Vec<f64>,
    /// Indices of the constants that are varied.
    varied: Vec<usize>,
}

/// A case, its scorer closed over its truth.
struct Case {
    name: String,
    recordings: Vec<Recording>,
    options: Options,
    is_right: Judge,
}

/// An answer, reduced to the parts that are compared.
struct Outcome {
    digits: u64,
    estimates: HashMap<String, (f64, f64)>,
    words: String,
    is_right: bool,
}

/// Change of an answer, from none to a right answer that becomes wrong or the other way round.
#[derive(Clone, Copy, PartialEq)]
enum Change {
    None,
    Digits,
    Moved,
    Words,
    Worse,
    Better,
}

impl Change {
    fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Digits => "digits",
            Self::Moved => "moved",
            Self::Words => "words",
            Self::Worse => "worse",
            Self::Better => "better",
        }
    }

    fn between(was: &Outcome, is: &Outcome) -> Self {
        let moved = |(name, (value, error)): (&String, &(f64, f64))| {
            is.estimates.get(name).is_none_or(|(other, _)| (other - value).abs() > MOVED_ERRORS * error)
        };
        match (was.is_right, is.is_right) {
            (true, false) => Self::Worse,
            (false, true) => Self::Better,
            _ if was.words != is.words => Self::Words,
            _ if was.estimates.iter().any(moved) => Self::Moved,
            _ if was.digits != is.digits => Self::Digits,
            _ => Self::None,
        }
    }
}

fn main() {
    let task = std::env::args().nth(1).unwrap_or_default();
    let task: Task = serde_json::from_str(&task).unwrap_or_else(|e| panic!("the argument is no task: {e}"));
    let varied: HashSet<usize> = task.varied.into_iter().collect();
    // A constant far from its value may break an invariant: that is an answer, too, and needs no text.
    set_hook(Box::new(|_| {}));
    let mut changed: HashMap<(usize, usize), u64> = HashMap::new();
    let cases = cases(task.seed).into_iter().take(task.cases.unwrap_or(usize::MAX));
    for make in cases.skip(task.part).step_by(task.parts) {
        let case = make();
        drop(reset());
        let diagnosis = diagnosed(&case);
        let read_by_diagnosis: HashSet<usize> = reset().into_iter().collect();
        let fit = fitted(&case);
        let read_by_fit: HashSet<usize> = reset().into_iter().collect();
        let was = Outcome::of(&case, &diagnosis, &fit);
        let mut read: Vec<usize> = read_by_diagnosis.union(&read_by_fit).copied().collect();
        read.sort_unstable();
        let mut variants = Vec::new();
        for &index in read.iter().filter(|index| varied.contains(*index)) {
            for (which, &factor) in task.factors.iter().enumerate() {
                let changes = changed.entry((index, which)).or_default();
                if *changes >= task.enough {
                    continue;
                }
                vary(index, factor);
                // A stage that does not read the constant answers as before.
                let again = read_by_diagnosis.contains(&index).then(|| diagnosed(&case));
                let refit = read_by_fit.contains(&index).then(|| fitted(&case));
                let is = Outcome::of(&case, again.as_ref().unwrap_or(&diagnosis), refit.as_ref().unwrap_or(&fit));
                let change = Change::between(&was, &is);
                drop(reset());
                if matches!(change, Change::Words | Change::Worse | Change::Better) {
                    *changes += 1;
                }
                variants.push(json!([index, factor, change.name()]));
            }
        }
        println!("{}", json!({"case": case.name, "right": was.is_right, "variants": variants}));
    }
}

/// Diagnoses a case; a panic is an answer, too.
fn diagnosed(case: &Case) -> Result<Findings, String> {
    let ask = || diagnose(&case.recordings, &case.options).map_err(|e| e.to_string());
    catch_unwind(AssertUnwindSafe(ask)).unwrap_or_else(|_| Err("panic".to_owned()))
}

/// Fits a case; a panic is an answer, too.
fn fitted(case: &Case) -> Result<Fit, String> {
    let options = pipeline::Options { task: case.options.task, ..pipeline::Options::default() };
    let ask = || analyse(&case.recordings, &options).map(|a| a.fit).map_err(|e| e.to_string());
    catch_unwind(AssertUnwindSafe(ask)).unwrap_or_else(|_| Err("panic".to_owned()))
}

impl Outcome {
    fn of(case: &Case, answer: &Result<Findings, String>, fit: &Result<Fit, String>) -> Self {
        let mut estimates = HashMap::new();
        let mut words = Vec::new();
        let mut digits = DefaultHasher::new();
        match answer {
            Ok(findings) => {
                let said = serde_json::to_value(&findings.diagnosis).unwrap_or(Value::Null);
                said.to_string().hash(&mut digits);
                words.push(format!("{:?}", findings.verdict));
                words.extend(findings.causes.iter().map(|c| c.id.clone()));
                words.push("or".to_owned());
                words.extend(findings.alternatives.iter().map(|a| a.id.clone()));
                for cause in &findings.causes {
                    for p in &cause.parameters {
                        estimates.insert(format!("{} {}", cause.id, p.name), (p.value, p.std_error));
                    }
                }
            }
            Err(sentence) => words.push(sentence.clone()),
        }
        match fit {
            Ok(fit) => {
                serde_json::to_string(fit).unwrap_or_default().hash(&mut digits);
                for p in &fit.parameters {
                    words.push(format!("{}{}", p.name, if p.identified { "" } else { "?" }));
                    if let (true, Some(value), Some(error)) = (p.identified, p.value, p.std_error) {
                        estimates.insert(p.name.clone(), (value, error));
                    }
                }
            }
            Err(sentence) => words.push(sentence.clone()),
        }
        let is_right = (case.is_right)(answer.clone());
        Self { digits: digits.finish(), estimates, words: words.join(" "), is_right }
    }
}

/// The fast blind battery, and every kind of every other task once, in an order that mixes them.
fn cases(seed: u64) -> Vec<Box<dyn Fn() -> Case>> {
    let mut all: Vec<Box<dyn Fn() -> Case>> = Vec::new();
    for job in battery(Counts::FAST, seed) {
        all.push(Box::new(move || {
            let (case, truth) = job.make();
            let (options, recordings) = (blind::score::options(&case), case.recordings.clone());
            let name = format!("{} {}", job.set.name(), job.seed);
            let job = job.clone();
            let is_right = move |answer| {
                let row = blind::score::Row::new(&job, &case, &truth, answer, 0.0);
                let (named, hidden) = (row.named(), row.ids());
                let known = |id: &&str| hidden.contains(id) || row.equals.contains(id);
                let found = |id: &&str| named.contains(id) || row.equals.iter().any(|e| named.contains(e));
                row.answer.is_ok()
                    && named.iter().all(known)
                    && (matches!(row.set, Set::Null | Set::Nameless) || hidden.iter().all(found))
            };
            Case { name, recordings, options, is_right: Box::new(is_right) }
        }));
    }
    macro_rules! add {
        ($task:ident) => {
            for (name, kind) in $task::Kind::ALL {
                all.push(Box::new(move || {
                    let (case, truth) = $task::make(kind, seed);
                    let is_right = move |answer| {
                        let row = score::Row { kind: name, seed, truth: truth.clone(), answer };
                        row.right() && row.spurious() == 0
                    };
                    let name = format!("{} {name} {seed}", stringify!($task));
                    Case { name, recordings: case.recordings, options: case.options, is_right: Box::new(is_right) }
                }));
            }
        };
    }
    add!(blocks);
    add!(slide);
    add!(barrel);
    add!(needle);
    add!(switch);
    add!(throw);
    // A part of the cases holds some of every task.
    let count = all.len();
    let stride = (1..count).rev().find(|s| gcd(*s, count) == 1 && *s < count / 2).unwrap_or(1);
    let mut order: Vec<Option<Box<dyn Fn() -> Case>>> = all.into_iter().map(Some).collect();
    (0..count).filter_map(|k| order[k * stride % count].take()).collect()
}

fn gcd(a: usize, b: usize) -> usize {
    if b == 0 { a } else { gcd(b, a % b) }
}
