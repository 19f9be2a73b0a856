//! `touchstone report`: everything about one or several logs on one page.

use super::stated::Stated;
use super::{LogArgs, Output, progress, sentence};
use crate::report::source::Source;
use crate::report::{Provenance, Sheet, page};
use anyhow::Context;
use clap::Args;
use serde_json::{Value, json};
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

impl Report {
    /// The second value is a sentence when a log could not be read: the page is written all the same.
    pub(super) fn run(&self) -> anyhow::Result<(Output, Option<String>)> {
        let sheets: Vec<Sheet> = self.logs.iter().map(|log| self.sheet(log)).collect();
        write(&self.title, &sheets, &self.out, &self.logs)?;
        let unread: Vec<&str> = sheets.iter().filter_map(|s| s.content.as_ref().err()).map(String::as_str).collect();
        let problem = match unread.as_slice() {
            [] => None,
            [one] => Some((*one).to_owned()),
            [first, rest @ ..] => Some(format!("{first} (and {} more logs could not be read)", rest.len())),
        };
        Ok((Output { text: describe(&sheets, &self.out), json: to_json(&sheets, &self.out) }, problem))
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

/// Writes the page of `sheets`; never over one of the logs it is about.
pub(super) fn write(title: &str, sheets: &[Sheet], out: &Path, logs: &[PathBuf]) -> anyhow::Result<()> {
    let place = |path: &Path| std::fs::canonicalize(path).ok();
    if let Some(log) = place(out).and_then(|out| logs.iter().find(|log| place(log).as_ref() == Some(&out))) {
        anyhow::bail!("the report would overwrite the log {}; choose another --out", log.display());
    }
    std::fs::write(out, page(title, sheets, &Provenance::now()))
        .with_context(|| format!("the report could not be written: {}", out.display()))
}

fn describe(sheets: &[Sheet], out: &Path) -> String {
    let mut text = format!("{}\n", out.display());
    for sheet in sheets {
        let _ = match &sheet.content {
            Ok(content) => {
                let (found, all) = content.identified();
                writeln!(text, "  {}: {found} of {all} parameters", sheet.source.name())
            }
            Err(_) => writeln!(text, "  {}: could not be read", sheet.source.name()),
        };
    }
    text
}

fn to_json(sheets: &[Sheet], out: &Path) -> Value {
    let logs: Vec<Value> = sheets.iter().map(one).collect();
    json!({ "out": out, "logs": logs })
}

fn one(sheet: &Sheet) -> Value {
    let sha256 = sheet.source.log.digest.as_ref().ok().map(|(_, hash)| hash);
    let log = sheet.source.log.path.to_string_lossy();
    let content = match &sheet.content {
        Ok(content) => content,
        Err(why) => return json!({ "log": log, "sha256": sha256, "problems": [why] }),
    };
    let (identified, parameters) = content.identified();
    let problems: Vec<&String> =
        [content.analysis.as_ref().err(), content.diagnosis.as_ref().err()].into_iter().flatten().collect();
    json!({
        "log": log,
        "sha256": sha256,
        "recordings": content.recordings.len(),
        "task": content.analysis.as_ref().ok().map(|a| a.task),
        "parameters": parameters,
        "identified": identified,
        "verdict": content.diagnosis.as_ref().ok().map(|d| d.verdict),
        "warnings": content.warnings(),
        "problems": problems,
    })
}
