//! `touchstone bench ablation`: each numeric constant of the diagnosis and of the identification halved and doubled, and
//! the answers that change.

mod annotate;
mod schemata;

use super::super::{Output, progress};
use anyhow::{Context, anyhow, bail};
use clap::Args;
use schemars::JsonSchema;
use schemata::{Constant, Sources};
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::thread;

/// Arguments of `bench ablation`.
#[derive(Args)]
pub struct AblationBench {
    /// Checkout of the sources [default: the one that this program was built from]
    #[arg(long)]
    source: Option<PathBuf>,
    /// Seeds of the cases
    #[arg(long, value_delimiter = ',', default_value = "1,2,3")]
    seeds: Vec<u64>,
    /// Only so many cases of each seed, spread over all tasks
    #[arg(long)]
    cases: Option<u64>,
    /// A factor of a constant is tried no more after so many changed answers of one process
    #[arg(long, default_value_t = 3)]
    enough: u64,
    /// Factors of each constant
    #[arg(long, value_delimiter = ',', default_value = "0.5,2")]
    factors: Vec<f64>,
    /// Only constants with these names
    #[arg(long, value_delimiter = ',')]
    only: Vec<String>,
    /// File for the table, as Markdown
    #[arg(long)]
    write: Option<PathBuf>,
    /// Counts of an earlier run, its answer with --json, instead of asking the cases
    #[arg(long)]
    from: Option<PathBuf>,
    /// Write the counts into the comment of each constant that names no source and no derivation
    #[arg(long)]
    annotate: bool,
}

/// Answers that changed when a constant was multiplied by one factor.
#[derive(Clone, Copy, Debug, Default, Deserialize, JsonSchema, Serialize)]
struct Counts {
    /// Cases that were asked.
    asked: usize,
    /// Cases with any other digit.
    digits: usize,
    /// Cases with an estimate that moved by more than half its standard error, and the same words.
    moved: usize,
    /// Cases with another verdict, cause, alternative, or identified parameter, still as right or wrong as before.
    words: usize,
    /// Right answers that became wrong.
    worse: usize,
    /// Wrong answers that became right.
    better: usize,
}

/// A constant with its counts, one for each factor.
#[derive(Deserialize, JsonSchema, Serialize)]
struct Row {
    name: String,
    file: String,
    line: usize,
    value: String,
    counts: Vec<Counts>,
}

/// Answer of `bench ablation --json`.
#[derive(Deserialize, JsonSchema, Serialize)]
pub(crate) struct Said {
    /// Seeds of the cases.
    seeds: Vec<u64>,
    /// Number of cases.
    cases: usize,
    /// Cases whose answer is right with all constants as they are.
    right: usize,
    /// Factors of each constant.
    factors: Vec<f64>,
    /// Names that must stay constants: lengths of arrays, patterns.
    fixed: usize,
    /// Each constant.
    constants: Vec<Row>,
}

impl AblationBench {
    pub(super) fn run(&self) -> anyhow::Result<Output> {
        let source = self.source.clone().unwrap_or_else(|| Path::new(env!("CARGO_MANIFEST_DIR")).join(".."));
        let source =
            source.canonicalize().with_context(|| format!("{}: no sources; give --source", source.display()))?;
        let said = match &self.from {
            Some(path) => {
                let text = std::fs::read_to_string(path).with_context(|| path.display().to_string())?;
                let earlier = serde_json::from_str(&text);
                earlier.with_context(|| format!("{}: no answer of `bench ablation --json`", path.display()))?
            }
            None => self.asked(&source)?,
        };
        let text = markdown(&said);
        if let Some(path) = &self.write {
            std::fs::write(path, &text).with_context(|| path.display().to_string())?;
        }
        if self.annotate {
            let written = annotate::annotate(&source, &said.constants, &said.factors)?;
            eprintln!("{written} comments of constants were written");
        }
        Ok(Output { text, json: serde_json::to_value(&said)? })
    }

    /// Builds the sources with constants that vary, and asks the cases.
    fn asked(&self, source: &Path) -> anyhow::Result<Said> {
        let copy = source.join("target/ablation/sources");
        let (constants, fixed) =
            progress::during("building the sources with constants that vary", |_| build(source, &copy))?;
        let varied = self.varied(&constants)?;
        let cases = progress::during("asking the cases", |_| self.ask(&copy, &varied))?;
        Ok(self.said(&cases, &varied, &constants, fixed))
    }

    /// Indices of the constants that are asked for; an unknown name is an error.
    fn varied(&self, constants: &[Constant]) -> anyhow::Result<Vec<usize>> {
        if let Some(unknown) = self.only.iter().find(|name| constants.iter().all(|c| c.name != **name)) {
            bail!("no constant that can vary is called `{unknown}`: see the list that the bench prints without --only");
        }
        let is_asked = |c: &Constant| self.only.is_empty() || self.only.contains(&c.name);
        Ok(constants.iter().enumerate().filter(|(_, c)| is_asked(c)).map(|(k, _)| k).collect())
    }

    /// Asks all cases of all seeds in as many processes as there are cores.
    fn ask(&self, copy: &Path, varied: &[usize]) -> anyhow::Result<Vec<Value>> {
        let parts = thread::available_parallelism().map_or(1, usize::from);
        let one = |seed: u64, part: usize| -> anyhow::Result<Vec<Value>> {
            let task = json!({
                "seed": seed,
                "part": part,
                "parts": parts,
                "cases": self.cases,
                "enough": self.enough,
                "factors": self.factors,
                "varied": varied,
            });
            let mut child = Command::new(copy.join("../target/debug/ablate"));
            child.arg(task.to_string()).env("RAYON_NUM_THREADS", "1").stdout(Stdio::piped());
            let mut child = child.spawn().context("the program that asks the cases does not start")?;
            let lines = BufReader::new(child.stdout.take().context("a process without output")?).lines();
            let cases = lines.map(|line| Ok(serde_json::from_str(&line?)?)).collect::<anyhow::Result<Vec<Value>>>()?;
            if !child.wait()?.success() {
                bail!("the process that asks the cases of seed {seed} ended early");
            }
            Ok(cases)
        };
        let mut all = Vec::new();
        for &seed in &self.seeds {
            let answers = thread::scope(|scope| {
                let one = &one;
                let threads: Vec<_> = (0..parts).map(|part| scope.spawn(move || one(seed, part))).collect();
                threads.into_iter().map(thread::ScopedJoinHandle::join).collect::<Vec<_>>()
            });
            for answer in answers {
                all.extend(answer.map_err(|_| anyhow!("a thread that reads the cases of seed {seed} panicked"))??);
            }
        }
        Ok(all)
    }

    /// Counts the changes of every constant that was varied.
    fn said(&self, cases: &[Value], varied: &[usize], constants: &[Constant], fixed: usize) -> Said {
        let mut counts: BTreeMap<usize, Vec<Counts>> = BTreeMap::new();
        for variant in cases.iter().filter_map(|case| case["variants"].as_array()).flatten() {
            let (Some(index), Some(factor)) = (variant[0].as_u64(), variant[1].as_f64()) else { continue };
            let Some(which) = self.factors.iter().position(|f| *f == factor) else { continue };
            let of = counts.entry(index as usize).or_insert_with(|| vec![Counts::default(); self.factors.len()]);
            let of = &mut of[which];
            of.asked += 1;
            match variant[2].as_str().unwrap_or_default() {
                "digits" => of.digits += 1,
                "moved" => of.moved += 1,
                "words" => of.words += 1,
                "worse" => of.worse += 1,
                "better" => of.better += 1,
                _ => {}
            }
        }
        let mut row = |k: usize, c: &Constant| Row {
            name: c.name.clone(),
            file: c.file.display().to_string(),
            line: c.line,
            value: c.value.clone(),
            counts: counts.remove(&k).unwrap_or_else(|| vec![Counts::default(); self.factors.len()]),
        };
        Said {
            seeds: self.seeds.clone(),
            cases: cases.len(),
            right: cases.iter().filter(|case| case["right"] == json!(true)).count(),
            factors: self.factors.clone(),
            fixed,
            constants: varied.iter().map(|&k| row(k, &constants[k])).collect(),
        }
    }
}

/// Copies and rewrites the sources, and builds the program that asks the cases. Returns the constants that vary, and the
/// number of names that do not.
fn build(source: &Path, copy: &Path) -> anyhow::Result<(Vec<Constant>, usize)> {
    schemata::copy(source, copy)?;
    let mut sources = Sources::read(source)?;
    loop {
        let constants = sources.write(copy)?;
        let built = Command::new("cargo")
            .args(["build", "-p", "tests", "--bin", "ablate", "--features", "ablation", "--message-format=json"])
            .env("CARGO_TARGET_DIR", copy.join("../target"))
            .env("RUSTFLAGS", "-Awarnings")
            .current_dir(copy)
            .stderr(Stdio::null())
            .output()
            .context("cargo builds the copy")?;
        if built.status.success() {
            return Ok((constants, sources.fixed()));
        }
        let messages = String::from_utf8_lossy(&built.stdout);
        if !sources.keep_fixed(copy, &messages) {
            let rendered = messages.lines().filter_map(|l| serde_json::from_str::<Value>(l).ok());
            let errors = rendered.filter(|m| m["message"]["level"] == "error");
            let first: Vec<String> =
                errors.filter_map(|m| m["message"]["rendered"].as_str().map(str::to_owned)).take(3).collect();
            bail!("the sources with constants that vary do not build:\n{}", first.join("\n"));
        }
    }
}

/// The table.
fn markdown(said: &Said) -> String {
    let seeds: Vec<String> = said.seeds.iter().map(u64::to_string).collect();
    let mut text = format!(
        "# Ablation of constants\n\n`touchstone bench ablation --seeds {}`: {} cases, {} of them right. \
         Changed answers of those asked, by factor. \
         An axis of a grid has so many times the values; a factor is tried no more after some changes.\n\n| constant | value |",
        seeds.join(","),
        said.cases,
        said.right
    );
    for factor in &said.factors {
        let _ = write!(text, " × {factor}: asked | digits | moved | words | worse | better |");
    }
    let _ = write!(text, "\n|---|---|{}\n", "--:|--:|--:|--:|--:|--:|".repeat(said.factors.len()));
    for row in &said.constants {
        let file = row.file.split("src/").nth(1).unwrap_or(&row.file).trim_end_matches(".rs");
        let value = row.value.replace('|', "\\|").replace('\n', " ");
        let _ = write!(text, "| `{file}` {} | {value} |", row.name);
        for c in &row.counts {
            let cells = [c.asked, c.digits, c.moved, c.words, c.worse, c.better];
            for n in cells {
                let _ = write!(text, " {} |", if n == 0 { "–".to_owned() } else { n.to_string() });
            }
        }
        text.push('\n');
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bench(only: &[&str]) -> AblationBench {
        AblationBench {
            source: None,
            seeds: vec![1],
            cases: None,
            enough: 3,
            factors: vec![0.5, 2.0],
            only: only.iter().map(|name| (*name).to_owned()).collect(),
            write: None,
            from: None,
            annotate: false,
        }
    }

    fn constants() -> Vec<Constant> {
        let one = |name: &str| Constant {
            name: name.to_owned(),
            file: PathBuf::from("estimator/src/diagnose/a.rs"),
            line: 1,
            value: "0.5".to_owned(),
        };
        vec![one("NEAR"), one("FAR")]
    }

    #[test]
    fn changes_are_counted_by_constant_and_factor() {
        let cases = [
            json!({"case": "a", "right": true, "variants": [[0, 0.5, "worse"], [0, 2.0, "none"], [1, 2.0, "moved"]]}),
            json!({"case": "b", "right": false, "variants": [[0, 0.5, "better"], [0, 2.0, "digits"]]}),
        ];
        let said = bench(&[]).said(&cases, &[0, 1], &constants(), 3);
        assert_eq!((said.cases, said.right, said.fixed), (2, 1, 3));
        let near = &said.constants[0].counts;
        assert_eq!((near[0].asked, near[0].worse, near[0].better), (2, 1, 1));
        assert_eq!((near[1].asked, near[1].digits, said.constants[1].counts[1].moved), (2, 1, 1));
        let table = markdown(&said);
        assert!(table.contains("| `diagnose/a` NEAR | 0.5 | 2 | – | – | – | 1 | 1 | 2 | 1 |"), "{table}");
    }

    #[test]
    fn an_unknown_name_is_an_error() {
        assert_eq!(bench(&[]).varied(&constants()).expect("all"), [0, 1]);
        assert_eq!(bench(&["FAR"]).varied(&constants()).expect("one"), [1]);
        let error = bench(&["NEAR", "HALF"]).varied(&constants()).expect_err("no constant").to_string();
        assert!(error.contains("`HALF`"), "{error}");
    }
}
