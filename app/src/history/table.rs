//! Attempts as a table for other programs: one line each, one column per measure.

use crate::history::attempt::Attempt;
use serde_json::Value;
use std::collections::BTreeSet;

/// Columns of every attempt.
const COLUMNS: [&str; 13] = [
    "trainee",
    "lesson",
    "delay_ms",
    "predicted",
    "began_utc",
    "duration_s",
    "completed",
    "score",
    "meets_criterion",
    "proficient",
    "measures_version",
    "grade_version",
    "recording",
];

/// Table with a header line. Measures that only some attempts have are empty in the others. An error is a sentence.
pub fn csv(attempts: &[Attempt]) -> Result<String, String> {
    let measures: Vec<Vec<(String, String)>> = attempts.iter().map(|attempt| leaves(&attempt.measures)).collect();
    let names: BTreeSet<&str> = measures.iter().flatten().map(|(name, _)| name.as_str()).collect();
    let mut writer = csv::Writer::from_writer(Vec::new());
    let written = (|| {
        writer.write_record(COLUMNS.iter().chain(&names))?;
        for (attempt, measures) in attempts.iter().zip(&measures) {
            let value = |name: &&str| measures.iter().find(|(own, _)| own == *name).map_or("", |(_, value)| value);
            let of_all = own(attempt);
            writer.write_record(of_all.iter().map(String::as_str).chain(names.iter().map(value)))?;
        }
        writer.flush()?;
        Ok::<(), csv::Error>(())
    })();
    let failed = |error: &dyn std::fmt::Display| format!("The table cannot be made: {error}.");
    written.map_err(|error| failed(&error))?;
    let bytes = writer.into_inner().map_err(|error| failed(&error))?;
    String::from_utf8(bytes).map_err(|error| failed(&error))
}

/// Values of [`COLUMNS`].
fn own(attempt: &Attempt) -> [String; 13] {
    let Attempt { trainee, lesson, conditions, began, duration_s, completed, score, .. } = attempt;
    [
        trainee.clone(),
        lesson.clone(),
        conditions.delay_ms.to_string(),
        conditions.predicted.to_string(),
        began.to_string(),
        duration_s.to_string(),
        completed.to_string(),
        score.map(|score| score.to_string()).unwrap_or_default(),
        attempt.meets_criterion.to_string(),
        attempt.proficient.to_string(),
        attempt.measures_version.to_string(),
        attempt.grade_version.to_string(),
        attempt.recording.as_ref().map(|path| path.display().to_string()).unwrap_or_default(),
    ]
}

/// All values in nested objects, by their names joined with dots; lists as they are written.
fn leaves(value: &Value) -> Vec<(String, String)> {
    fn walk(prefix: &str, value: &Value, found: &mut Vec<(String, String)>) {
        match value {
            Value::Object(parts) => {
                for (name, part) in parts {
                    let name = if prefix.is_empty() { name.clone() } else { format!("{prefix}.{name}") };
                    walk(&name, part, found);
                }
            }
            Value::Null => {}
            Value::String(text) => found.push((prefix.to_owned(), text.clone())),
            other => found.push((prefix.to_owned(), other.to_string())),
        }
    }
    let mut found = Vec::new();
    walk("", value, &mut found);
    found
}
