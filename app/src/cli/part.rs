//! Runs and windows of time on the command line.

use clap::Args;
use estimator::log::Part;
use haptics::recording::TimeWindow;
use serde_json::Value;
use std::collections::BTreeMap;

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
        Ok(Part { select, windows: self.windows()? })
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

    /// Text of the part, for the key of an answer that is kept; none for all of the log.
    pub fn shown(&self) -> Option<String> {
        let Self { select, from_s, to_s } = self;
        let is_all = select.is_empty() && from_s.is_empty() && to_s.is_empty();
        (!is_all).then(|| format!("{select:?} {from_s:?} {to_s:?}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn windows_are_paired_and_refused_in_words() {
        let windows = |from: &[f64], to: &[f64]| {
            PartArgs { select: Vec::new(), from_s: from.to_vec(), to_s: to.to_vec() }
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
    fn values_of_one_column_add_up() {
        let select = vec![pair("run=1").expect("a pair"), pair("run = b").expect("a pair")];
        let part = PartArgs { select, ..PartArgs::default() }.stated().expect("a part");
        assert_eq!(part.select["run"], serde_json::json!(["1", "b"]));
        assert!(pair("run").is_err() && pair("=2").is_err());
    }
}
