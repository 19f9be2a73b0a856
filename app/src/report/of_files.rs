//! A report of files.

use crate::report::collect::Sheet;
use crate::report::page::whole::page;
use crate::report::provenance::Provenance;
use crate::report::source;
use crate::text::sentence::sentence;
use haptics::recording::Recording;
use std::path::{Path, PathBuf};

/// Writes a page about log files, each with its sidecar if that is elsewhere. `given` receives every recording, counted
/// over all files, and returns it with the user's statements for the analysis. An error is a sentence.
pub fn of_files(
    files: &[(PathBuf, Option<PathBuf>)],
    out: &Path,
    given: impl Fn(usize, Recording) -> Recording,
) -> Result<(), String> {
    let mut count = 0;
    let sheets: Vec<Sheet> = files
        .iter()
        .map(|(log, meta)| {
            let read = estimator::log::load(log, meta.as_deref()).map(|recordings| {
                let from = count;
                count += recordings.len();
                recordings.into_iter().enumerate().map(|(k, r)| given(from + k, r)).collect()
            });
            let source = source::Source::of(log, meta.as_deref());
            Sheet::new(source, read.map_err(|e| sentence(&e.to_string())))
        })
        .collect();
    if files
        .iter()
        .any(|(log, _)| std::fs::canonicalize(log).ok().is_some_and(|l| std::fs::canonicalize(out).ok() == Some(l)))
    {
        return Err(format!("The report would overwrite the log; choose another name: {}", out.display()));
    }
    haptics::text_file::write(out, page("Measurement report", &sheets, &Provenance::now()))
        .map_err(|e| format!("The report cannot be written ({e}): {}", out.display()))
}
