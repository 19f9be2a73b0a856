//! Runs and windows of time on the command line.

use crate::report::source::Hashed;
use clap::Args;
use estimator::log::Part;
use haptics::recording::{JoinedFile, TimeWindow};
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::PathBuf;

/// The part of a log that is used; it takes the place of the sidecar's statements.
#[derive(Args, Clone, Debug, Default)]
pub struct PartArgs {
    /// Use only rows with this value of a column, e.g. `run=2` or `trial=2`; more of them for one column add up
    #[arg(long, value_name = "COLUMN=VALUE", value_parser = pair)]
    select: Vec<(String, String)>,
    /// Use the log from this time on, in its own times; with several `--from-s` and `--to-s`, each pair is a recording
    #[arg(long, visible_alias = "from", value_name = "SECONDS", allow_negative_numbers = true)]
    from_s: Vec<f64>,
    /// Use the log up to this time
    #[arg(long, visible_alias = "to", value_name = "SECONDS", allow_negative_numbers = true)]
    to_s: Vec<f64>,
    /// Put the channels of another file of the same run onto the log's clock; several files with several flags
    #[arg(long, value_name = "FILE")]
    join: Vec<PathBuf>,
    /// Add so many seconds to the times of the joined file, one for each `--join`; found from a channel of both when absent
    #[arg(long, value_name = "SECONDS", allow_negative_numbers = true, requires = "join")]
    offset_s: Vec<f64>,
}

fn pair(text: &str) -> Result<(String, String), String> {
    let pair = text.split_once('=').map(|(name, value)| (name.trim().to_owned(), value.trim().to_owned()));
    pair.filter(|(name, value)| !name.is_empty() && !value.is_empty())
        .ok_or_else(|| format!("`{text}` is no column with a value; write it like run=2"))
}

impl PartArgs {
    /// The part, as the loader takes it.
    pub fn stated(&self) -> anyhow::Result<Part> {
        let mut values: BTreeMap<String, Vec<Value>> = BTreeMap::new();
        for (name, value) in &self.select {
            values.entry(name.clone()).or_default().push(value.as_str().into());
        }
        let select = values.into_iter().map(|(name, values)| (name, Value::Array(values))).collect();
        Ok(Part { select, windows: self.windows()?, join: self.joined()? })
    }

    fn windows(&self) -> anyhow::Result<Vec<TimeWindow>> {
        let (starts, ends) = (&self.from_s, &self.to_s);
        let count = starts.len().max(ends.len());
        let is_paired = starts.len() == ends.len() || count == 1;
        anyhow::ensure!(is_paired, "several windows of time need as many --from-s as --to-s");
        let window = |k: usize| TimeWindow { from_s: starts.get(k).copied(), to_s: ends.get(k).copied() };
        let windows: Vec<TimeWindow> = (0..count).map(window).collect();
        let empty = windows
            .iter()
            .find_map(|w| w.from_s.zip(w.to_s).filter(|(from, to)| from.is_nan() || to.is_nan() || from >= to));
        anyhow::ensure!(
            empty.is_none(),
            "--from-s must be smaller than --to-s; they are {:?}",
            empty.unwrap_or_default()
        );
        Ok(windows)
    }

    /// Files that are joined; their paths are from the working folder, not from the log's.
    fn joined(&self) -> anyhow::Result<Vec<JoinedFile>> {
        let (files, offsets) = (&self.join, &self.offset_s);
        let is_paired = offsets.is_empty() || offsets.len() == files.len();
        anyhow::ensure!(is_paired, "several joined files need as many --offset-s as --join, or none");
        let file = |(k, path): (usize, &PathBuf)| {
            let file = std::path::absolute(path)?;
            Ok(JoinedFile { file, offset_s: offsets.get(k).copied(), by: None })
        };
        files.iter().enumerate().map(file).collect()
    }

    /// Text of the part, for the key of an answer that is kept; none for all of the log.
    pub fn shown(&self) -> Option<String> {
        let Self { select, from_s, to_s, join, offset_s } = self;
        let is_whole = select.is_empty() && from_s.is_empty() && to_s.is_empty();
        let part = (!is_whole).then(|| format!("{select:?} {from_s:?} {to_s:?}"));
        // The contents of joined files belong to the answer.
        let digests: Vec<_> = join.iter().map(|file| Hashed::of(file).digest).collect();
        let joined = (!join.is_empty()).then(|| format!("{digests:?} {offset_s:?}"));
        let shown: Vec<String> = part.into_iter().chain(joined).collect();
        (!shown.is_empty()).then(|| shown.join(" "))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn windows_are_paired_and_refused_in_words() {
        let windows = |from: &[f64], to: &[f64]| {
            PartArgs { from_s: from.to_vec(), to_s: to.to_vec(), ..PartArgs::default() }
                .windows()
                .map_err(|e| e.to_string())
        };
        let pair = |from, to| TimeWindow { from_s: Some(from), to_s: Some(to) };
        assert_eq!(windows(&[1.0, 5.0], &[2.0, 6.0]), Ok(vec![pair(1.0, 2.0), pair(5.0, 6.0)]));
        assert_eq!(windows(&[], &[2.0]), Ok(vec![TimeWindow { from_s: None, to_s: Some(2.0) }]));
        assert_eq!(windows(&[], &[]), Ok(Vec::new()));
        assert!(windows(&[1.0, 5.0], &[2.0]).is_err_and(|e| e.contains("as many")));
        assert!(windows(&[3.0], &[2.0]).is_err_and(|e| e.contains("smaller")));
    }

    #[test]
    fn joined_files_have_an_offset_each_or_none() {
        let part = |offsets: &[f64]| {
            let join = vec![PathBuf::from("a.csv"), PathBuf::from("b.csv")];
            PartArgs { join, offset_s: offsets.to_vec(), ..PartArgs::default() }.stated()
        };
        let join = part(&[0.5, -1.0]).expect("a part").join;
        assert!(join[1].offset_s == Some(-1.0) && join[1].file.is_absolute() && join[1].file.ends_with("b.csv"));
        assert!(part(&[]).expect("a part").join.iter().all(|file| file.offset_s.is_none()));
        assert!(part(&[0.5]).is_err_and(|e| e.to_string().contains("as many")));
    }

    #[test]
    fn values_of_one_column_add_up() {
        let select = vec![pair("run=1").expect("a pair"), pair("run = b").expect("a pair")];
        let part = PartArgs { select, ..PartArgs::default() }.stated().expect("a part");
        assert_eq!(part.select["run"], serde_json::json!(["1", "b"]));
        assert!(pair("run").is_err() && pair("=2").is_err());
    }
}
