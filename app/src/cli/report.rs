//! `touchstone report`: all results for one or several logs on one page.

use super::stated::Stated;
use super::{LogArgs, Output, progress, sentence};
use crate::report::collect::Sheet;
use crate::report::page::whole::page;
use crate::report::provenance::Provenance;
use crate::report::source::Source;
use anyhow::Context;
use clap::Args;
use estimator::diagnose::Verdict;
use haptics::recording::Task;
use schemars::JsonSchema;
use serde::Serialize;
use std::fmt::Write;
use std::path::{Path, PathBuf};

/// Arguments of `report`.
#[derive(Args)]
pub struct Report {
    /// Log files: a section each
    #[arg(required = true)]
    logs: Vec<PathBuf>,
    #[command(flatten)]
    source: LogArgs,
    /// Heading of the page
    #[arg(long, default_value = "Measurement report")]
    title: String,
    /// Where to write the page
    #[arg(long, default_value = "report.html")]
    out: PathBuf,
    #[command(flatten)]
    stated: Stated,
}

/// What `report --json` prints.
#[derive(JsonSchema, Serialize)]
pub(crate) struct Said {
    /// The page.
    out: PathBuf,
    /// The logs that it is about.
    logs: Vec<OfLog>,
}

/// What came out of one log.
#[derive(JsonSchema, Serialize)]
struct OfLog {
    /// The file.
    log: String,
    /// Its SHA-256; null where it could not be read.
    sha256: Option<String>,
    /// What could not be done, in sentences.
    problems: Vec<String>,
    /// What it contains, where it could be read.
    #[serde(flatten)]
    content: Option<Content>,
}

/// What a log that could be read contains.
#[derive(JsonSchema, Serialize)]
struct Content {
    /// How many recordings it has.
    recordings: usize,
    /// What was done; null where that is not known.
    task: Option<Task>,
    /// Parameters that the fit looked for.
    parameters: usize,
    /// Those of them that it measured: found, and larger than their errors where their size is asked.
    identified: usize,
    /// The diagnosis in one word; null without one.
    verdict: Option<Verdict>,
    /// What looks wrong in the log, in sentences.
    warnings: Vec<String>,
}

impl Report {
    /// Writes the page. The second value is a sentence if a log could not be read.
    pub(super) fn run(&self) -> anyhow::Result<(Output, Option<String>)> {
        let sheets: Vec<Sheet> = self.logs.iter().map(|log| self.sheet(log)).collect();
        write(&self.title, &sheets, &self.out, &self.logs)?;
        let unread: Vec<&str> = sheets.iter().filter_map(|s| s.content.as_ref().err()).map(String::as_str).collect();
        let problem = match unread.as_slice() {
            [] => None,
            [one] => Some((*one).to_owned()),
            [first, rest @ ..] => Some(format!("{first} (and {} more logs could not be read)", rest.len())),
        };
        let said = Said { out: self.out.clone(), logs: sheets.iter().map(one).collect() };
        Ok((Output { text: describe(&sheets, &self.out), json: serde_json::to_value(&said)? }, problem))
    }

    fn sheet(&self, log: &Path) -> Sheet {
        let source = Source::of(log, self.source.meta.as_deref());
        let read = self.source.load(log).map(|mut recordings| {
            self.stated.put_into(&mut recordings);
            recordings
        });
        let name = source.name();
        progress::during(&format!("analysing {name}"), |_| Sheet::new(source, read.map_err(|e| sentence(&e))))
    }
}

/// Writes the page of `sheets`; never over one of its logs.
pub(super) fn write(title: &str, sheets: &[Sheet], out: &Path, logs: &[PathBuf]) -> anyhow::Result<()> {
    let place = |path: &Path| std::fs::canonicalize(path).ok();
    if let Some(log) = place(out).and_then(|out| logs.iter().find(|log| place(log).as_ref() == Some(&out))) {
        anyhow::bail!("the report would overwrite the log {}; choose another --out", log.display());
    }
    haptics::text_file::write(out, page(title, sheets, &Provenance::now()))
        .with_context(|| format!("the report could not be written: {}", out.display()))
}

fn describe(sheets: &[Sheet], out: &Path) -> String {
    let mut text = format!("{}\n", out.display());
    for sheet in sheets {
        let _ = match &sheet.content {
            Ok(content) => {
                let (found, all) = content.identified();
                let why = content.analysis.as_ref().err();
                let said = match why {
                    Some(why) => format!("no parameters, because the fit did not succeed: {why}"),
                    None if all == 0 => "no parameters were looked for".to_owned(),
                    None => format!("{found} of {all} parameters were measured"),
                };
                writeln!(text, "  {}: {said}", sheet.source.name())
            }
            Err(_) => writeln!(text, "  {}: could not be read", sheet.source.name()),
        };
    }
    text
}

fn one(sheet: &Sheet) -> OfLog {
    let sha256 = sheet.source.log.digest.as_ref().ok().map(|(_, hash)| hash.clone());
    let log = sheet.source.log.path.to_string_lossy().into_owned();
    let found = match &sheet.content {
        Ok(found) => found,
        Err(why) => return OfLog { log, sha256, problems: vec![why.clone()], content: None },
    };
    let (identified, parameters) = found.identified();
    let problems = [found.analysis.as_ref().err(), found.diagnosis.as_ref().err()].into_iter().flatten().cloned();
    let content = Content {
        recordings: found.recordings.len(),
        task: found.analysis.as_ref().ok().map(|a| a.task),
        parameters,
        identified,
        verdict: found.diagnosis.as_ref().ok().map(|d| d.verdict),
        warnings: found.warnings().into_iter().map(str::to_owned).collect(),
    };
    OfLog { log, sha256, problems: problems.collect(), content: Some(content) }
}
