//! Rows and runs to keep: `select` of the sidecar.

use super::Planner;
use crate::errors::LogError;
use serde_json::Value;

/// Names of columns that count runs, in lower case and without an ending such as `_id`.
const RUNS: [&str; 18] = [
    "run",
    "runs",
    "trials",
    "toss",
    "lauf",
    "versuch",
    "wiederholung",
    "trial",
    "episode",
    "test",
    "demo",
    "demonstration",
    "take",
    "repetition",
    "rep",
    "attempt",
    "experiment",
    "segment",
];
/// Endings of such names that say nothing else.
const ENDINGS: [&str; 8] = ["_id", "_no", "_nr", "_num", "_number", "_index", "_idx", "_"];

/// True for the name of a column that counts runs: `run`, `Trial No.`, `episode_index`.
pub fn counts_runs(header: &str) -> bool {
    let name = header.rsplit('.').find(|part| !part.is_empty()).unwrap_or(header);
    let name = name.trim_end_matches('#').trim().to_lowercase().replace([' ', '-'], "_");
    RUNS.iter().any(|run| name.strip_prefix(run).is_some_and(|rest| rest.is_empty() || ENDINGS.contains(&rest)))
}

/// One condition of `select`: a column has one of some values.
#[derive(Clone, Debug)]
pub struct Wanted {
    /// Column of the file.
    pub column: usize,
    /// The values, as text.
    pub texts: Vec<String>,
    numbers: Vec<f64>,
}

impl Wanted {
    /// Condition of one value, or of a list of them.
    pub fn new(column: usize, value: &Value) -> Self {
        let text = |value: &Value| value.as_str().map_or_else(|| value.to_string(), |s| s.trim().to_owned());
        let texts: Vec<String> = match value {
            Value::Array(values) => values.iter().map(text).collect(),
            one => vec![text(one)],
        };
        let numbers = texts.iter().filter_map(|text| text.parse().ok()).collect();
        Self { column, texts, numbers }
    }

    /// True when the cell is one of the values, as text or as a number (`1` = `1.0`).
    pub fn matches(&self, cell: &[u8]) -> bool {
        if self.texts.iter().any(|text| cell == text.as_bytes()) {
            return true;
        }
        let number = || std::str::from_utf8(cell).ok()?.parse::<f64>().ok();
        !self.numbers.is_empty() && number().is_some_and(|number| self.numbers.contains(&number))
    }

    /// The values, for a sentence.
    pub fn shown(&self) -> String {
        self.texts.join(" or ")
    }
}

impl Planner<'_> {
    pub(super) fn take_select(&mut self) -> Result<(), LogError> {
        for (name, value) in &self.meta.select {
            let source = self.meta.columns.get(name).unwrap_or(name);
            match self.position(source) {
                Some(column) => self.plan.select.push(Wanted::new(column, value)),
                // Runs have names without a column of their own.
                None if name == "trial" => self.plan.runs = Some(Wanted::new(0, value)),
                None => return Err(self.missing(source, "\"select\" in the sidecar names it".to_owned())),
            }
        }
        Ok(())
    }

    /// Takes the column that counts runs, if no column is called `trial` or mapped to it.
    pub(super) fn guess_runs(&mut self) {
        let is_free =
            |&c: &usize| !self.plan.targets.iter().any(|t| t.column == c && crate::units::is_program_name(&t.name));
        let mut found = (0..self.headers.len()).filter(|&c| counts_runs(&self.headers[c]));
        let refused = self.meta.columns.get("trial").is_some_and(String::is_empty);
        if self.plan.trial.is_some() || refused {
            return;
        }
        if let Some(column) = found.find(|c| is_free(c)) {
            self.plan.trial = Some(column);
            self.plan.is_trial_guessed = true;
            self.plan.uses[column] = super::Use::Ignore;
            self.plan.targets.retain(|t| t.column != column);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_that_count_runs_are_told_by_their_names() {
        for name in ["run", "Run", "Trial No", "episode_index", "test", "Demo#", "/log.run", "segment", "rep_nr"] {
            assert!(counts_runs(name), "{name}");
        }
        for name in ["runtime", "testing_N", "run_s", "pose", "sample", "trial_torque", "q_m", ""] {
            assert!(!counts_runs(name), "{name}");
        }
    }

    #[test]
    fn a_list_selects_each_of_its_values() {
        let wanted = Wanted::new(0, &serde_json::json!([1, "neg_2"]));
        assert!(wanted.matches(b"1.0") && wanted.matches(b"neg_2") && !wanted.matches(b"2"));
        assert_eq!(wanted.shown(), "1 or neg_2");
    }
}
