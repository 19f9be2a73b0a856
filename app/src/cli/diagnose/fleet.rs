//! Many logs of many objects: each is diagnosed separately, and its result is written at once as one line of JSON.
//!
//! An unreadable file, or one on which the program fails, has a line with a sentence; the others continue. Existing
//! lines in a file are kept as long as the log, its sidecar and the options are unchanged.

use crate::report::source::{Hashed, Source};
use anyhow::Context;
use estimator::diagnose::Diagnosis;
use haptics::recording::JoinedFile;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::collections::HashMap;
use std::fs::File;
use std::io::{BufRead as _, BufReader, Read as _, Seek as _, SeekFrom, Write};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

/// What tells that a log need not be diagnosed again.
#[derive(Clone, Debug, PartialEq, Eq, Hash, JsonSchema, Serialize, Deserialize)]
pub struct Key {
    /// The log, as it was given.
    pub file: String,
    /// SHA-256 of its bytes; absent where they could not be read.
    pub sha256: Option<String>,
    /// SHA-256 of its sidecar's bytes; absent where it has none.
    pub sidecar_sha256: Option<String>,
    /// Version and options of the run.
    pub asked: String,
}

/// One line.
#[derive(Debug, JsonSchema, Serialize)]
pub struct Line {
    /// What it is of.
    #[serde(flatten)]
    pub key: Key,
    /// What `diagnose --json` says of this log alone.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Option<Diagnosis>")]
    pub result: Option<Value>,
    /// Why there is none, in one sentence.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub error: Option<String>,
}

/// Summary of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tally {
    /// Logs with a result.
    pub done: usize,
    /// Logs with an error sentence instead.
    pub failed: usize,
    /// Logs with an existing line.
    pub kept: usize,
    /// Logs among them whose line is an error.
    pub failed_before: usize,
}

/// Existing lines, with true if the line is an error.
pub type Standing = HashMap<Key, bool>;

/// Existing line, parsed.
#[derive(Deserialize)]
struct Read {
    #[serde(flatten)]
    key: Key,
    error: Option<String>,
}

impl Key {
    /// Key of a log in its current state.
    pub fn of(log: &Path, meta: Option<&Path>, asked: &str) -> Self {
        let source = Source::of(log, meta);
        let digits = |digest: &Result<(u64, String), String>| digest.as_ref().ok().map(|(_, digits)| digits.clone());
        Self {
            file: log.display().to_string(),
            sha256: digits(&source.log.digest),
            sidecar_sha256: source.sidecar.as_ref().and_then(|sidecar| digits(&sidecar.digest)),
            asked: asked.to_owned() + &joined(log, source.stated.as_deref()),
        }
    }
}

/// The files that a sidecar joins to its log, by their SHA-256; empty without any.
fn joined(log: &Path, sidecar: Option<&str>) -> String {
    let meta = sidecar.and_then(|text| estimator::log::parse_sidecar(text, log).ok()).unwrap_or_default();
    let folder = log.parent().unwrap_or(Path::new(""));
    let digest = |file: &JoinedFile| Hashed::of(&folder.join(&file.file)).digest;
    let shown: Vec<String> = meta.join.iter().map(|file| format!(" --join {:?}", digest(file))).collect();
    shown.concat()
}

/// Existing lines of a file; those truncated by a kill count as missing.
pub fn standing(path: &Path) -> anyhow::Result<Standing> {
    let file = match File::open(path) {
        Ok(file) => file,
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(Standing::new()),
        Err(error) => {
            return Err(error).with_context(|| format!("the results so far cannot be read: {}", path.display()));
        }
    };
    let mut keys = Standing::new();
    for line in BufReader::new(file).split(b'\n') {
        let line = line.with_context(|| format!("the results so far cannot be read: {}", path.display()))?;
        // A file that was unreadable then may be readable now.
        let read = serde_json::from_slice::<Read>(&line).ok().filter(|read| read.key.sha256.is_some());
        keys.extend(read.map(|read| (read.key, read.error.is_some())));
    }
    Ok(keys)
}

/// Opens a file of lines for appending; a truncated line is terminated first.
pub fn append_to(path: &Path) -> anyhow::Result<File> {
    let say = || format!("the results cannot be written; check the folder and its permissions: {}", path.display());
    let mut file = File::options().create(true).read(true).append(true).open(path).with_context(say)?;
    if file.seek(SeekFrom::End(0)).with_context(say)? > 0 {
        let mut last = [0];
        file.seek(SeekFrom::End(-1)).and_then(|_| file.read_exact(&mut last)).with_context(say)?;
        if last != *b"\n" {
            file.write_all(b"\n").with_context(say)?;
        }
    }
    Ok(file)
}

/// Input of a fleet run.
pub struct Run<'a> {
    /// The logs.
    pub logs: &'a [PathBuf],
    /// Number of parallel jobs, at least one.
    pub jobs: usize,
    /// Existing lines.
    pub standing: &'a Standing,
    /// Key of a log in its current state.
    pub key: &'a (dyn Fn(&Path) -> Key + Sync),
    /// Diagnoses one log.
    pub work: &'a (dyn Fn(&Path) -> anyhow::Result<Value> + Sync),
    /// Receives the number of completed logs.
    pub told: &'a (dyn Fn(usize) + Sync),
}

impl Run<'_> {
    /// Processes every log, writes its line, and holds no more of them in memory than there are jobs.
    pub fn through(&self, out: &mut (impl Write + Send)) -> anyhow::Result<Tally> {
        let shared = Mutex::new((out, Tally::default(), None));
        let next = AtomicUsize::new(0);
        let take_turns = || {
            while let Some(log) = self.logs.get(next.fetch_add(1, Ordering::Relaxed)) {
                let key = (self.key)(log);
                let stands = self.standing.get(&key).copied();
                let line = stands.is_none().then(|| self.line(log, key));
                let mut shared = shared.lock().unwrap_or_else(PoisonError::into_inner);
                let (out, tally, broken) = &mut *shared;
                let Some(line) = line else {
                    tally.kept += 1;
                    tally.failed_before += usize::from(stands == Some(true));
                    (self.told)(tally.done + tally.failed + tally.kept);
                    continue;
                };
                *(if line.error.is_none() { &mut tally.done } else { &mut tally.failed }) += 1;
                (self.told)(tally.done + tally.failed + tally.kept);
                if let Err(error) = write(*out, &line) {
                    broken.get_or_insert(error);
                    next.store(self.logs.len(), Ordering::Relaxed);
                }
            }
        };
        std::thread::scope(|scope| {
            for index in 1..self.jobs.min(self.logs.len()) {
                // Without a thread the others have more to do.
                let named = std::thread::Builder::new().name(format!("diagnose-{index}"));
                let _ = named.spawn_scoped(scope, take_turns);
            }
            take_turns();
        });
        let (_, tally, broken) = shared.into_inner().unwrap_or_else(PoisonError::into_inner);
        match broken {
            Some(error) => Err(anyhow::Error::new(error).context("the results cannot be written; the run has ended")),
            None => Ok(tally),
        }
    }

    /// Line of a log.
    fn line(&self, log: &Path, key: Key) -> Line {
        // A panic drops everything that the work was building, so no partial result is visible.
        let made = catch_unwind(AssertUnwindSafe(|| (self.work)(log)));
        let (result, error) = match made {
            Ok(Ok(result)) => (Some(result), None),
            Ok(Err(error)) => (None, Some(super::super::sentence(&error))),
            Err(panic) => (None, Some(fault(panic.as_ref()))),
        };
        Line { key, result, error }
    }
}

/// Sentence about a panic.
fn fault(panic: &(dyn std::any::Any + Send)) -> String {
    let said = panic.downcast_ref::<&str>().map(|text| (*text).to_owned());
    let said = said.or_else(|| panic.downcast_ref::<String>().cloned()).unwrap_or_default().replace('\n', " ");
    format!("a fault of the program itself ended the work on this log ({said}); please report it with the log")
}

/// Writes one line with one call, so that lines of several processes do not mix.
fn write(out: &mut impl Write, line: &Line) -> std::io::Result<()> {
    let mut text = serde_json::to_vec(line)?;
    text.push(b'\n');
    out.write_all(&text)?;
    out.flush()
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    struct Folder(tempfile::TempDir);

    impl Folder {
        fn of(files: &[(&str, &str)]) -> Self {
            let folder = Self(tempfile::tempdir().expect("a folder"));
            for (name, text) in files {
                std::fs::write(folder.path(name), text).expect("written");
            }
            folder
        }

        fn path(&self, name: &str) -> PathBuf {
            self.0.path().join(name)
        }

        /// Runs over the files. Returns the lines in the order of the files.
        fn run(&self, names: &[&str], jobs: usize, standing: &Standing) -> (Tally, Vec<Value>) {
            let logs: Vec<PathBuf> = names.iter().map(|name| self.path(name)).collect();
            let mut out = Vec::new();
            let run = Run { logs: &logs, jobs, standing, key: &key, work: &work, told: &|_| {} };
            let tally = run.through(&mut out).expect("memory can be written");
            let mut lines: Vec<Value> = out
                .split(|byte| *byte == b'\n')
                .filter(|line| !line.is_empty())
                .map(|line| serde_json::from_slice(line).expect("JSON"))
                .collect();
            lines.sort_by_key(|line| line["file"].as_str().expect("a name").to_owned());
            (tally, lines)
        }
    }

    fn key(log: &Path) -> Key {
        Key::of(log, None, "a test")
    }

    fn work(log: &Path) -> anyhow::Result<Value> {
        let text = std::fs::read_to_string(log).context("it cannot be read")?;
        assert!(text != "panic", "the file says\nso");
        anyhow::ensure!(text != "bad", "it is bad");
        Ok(json!({ "length": text.len() }))
    }

    #[test]
    fn bad_files_and_panics_are_lines_and_the_others_go_on() {
        let folder = Folder::of(&[("a", "one"), ("b", "panic"), ("c", "bad"), ("e", "three")]);
        for jobs in [1, 3, 64] {
            let (tally, lines) = folder.run(&["a", "b", "c", "d", "e"], jobs, &Standing::new());
            assert_eq!(tally, Tally { done: 2, failed: 3, ..Tally::default() });
            assert_eq!((&lines[0]["result"]["length"], &lines[4]["result"]["length"]), (&json!(3), &json!(5)));
            assert!(lines[1]["error"].as_str().is_some_and(|e| e.contains("fault") && e.contains("the file says so")));
            assert_eq!(lines[2]["error"], "it is bad");
            assert!(
                lines[3]["error"].as_str().is_some_and(|e| e.contains("cannot be read"))
                    && lines[3]["sha256"].is_null()
            );
            assert!(lines.iter().all(|line| line.get("result").is_some() != line.get("error").is_some()));
        }
    }

    #[test]
    fn what_stands_is_kept_until_the_file_changes() {
        let folder = Folder::of(&[("a", "one"), ("b", "bad"), ("a.meta.json", "{}")]);
        let out = folder.path("out.jsonl");
        let names = ["a", "b", "none"];
        let (_, lines) = folder.run(&names, 2, &Standing::new());
        let text: Vec<String> = lines.iter().map(Value::to_string).collect();
        // The last line was cut off by a kill.
        std::fs::write(&out, format!("{}\n{}\n{}", text[0], text[1], &text[0][..20])).expect("written");
        let kept = standing(&out).expect("readable");
        assert_eq!(folder.run(&names, 2, &kept).0, Tally { done: 0, failed: 1, kept: 2, failed_before: 1 });
        // Another sidecar, another log.
        std::fs::write(folder.path("a.meta.json"), "{ }").expect("written");
        assert_eq!(folder.run(&names, 2, &kept).0, Tally { done: 1, failed: 1, kept: 1, failed_before: 1 });
        append_to(&out).and_then(|mut file| Ok(writeln!(file, "{}", text[1])?)).expect("appended");
        let whole = std::fs::read_to_string(&out).expect("readable");
        assert_eq!(whole.lines().count(), 4, "the cut line stands alone: {whole}");
        assert!(standing(&folder.path("nowhere")).expect("nothing stands").is_empty());
    }

    #[test]
    fn a_full_disk_ends_the_run_in_a_sentence() {
        struct Full;
        impl Write for Full {
            fn write(&mut self, _: &[u8]) -> std::io::Result<usize> {
                Err(std::io::Error::other("no space left"))
            }
            fn flush(&mut self) -> std::io::Result<()> {
                Ok(())
            }
        }
        let folder = Folder::of(&[("a", "one")]);
        let logs = vec![folder.path("a"); 50];
        let asked = AtomicUsize::new(0);
        let counted = |log: &Path| {
            asked.fetch_add(1, Ordering::Relaxed);
            work(log)
        };
        let run = Run { logs: &logs, jobs: 2, standing: &Standing::new(), key: &key, work: &counted, told: &|_| {} };
        let error = run.through(&mut Full).expect_err("nothing can be written");
        assert!(format!("{error:#}").contains("cannot be written") && asked.load(Ordering::Relaxed) < 5);
    }
}
