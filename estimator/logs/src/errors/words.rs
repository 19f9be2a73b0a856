//! Parts of the sentences of errors: places, and entries of a sidecar.

use haptics::recording::Suggested;
use haptics::text_file::one_line as plain;
use std::collections::BTreeMap;

/// Fault of a unit: it is not known, or not stated.
pub(super) fn unit_fault(unit: &str) -> String {
    if unit.is_empty() { "states no unit".to_owned() } else { format!("has the unknown unit `{}`", plain(unit)) }
}

/// Choice among two columns, as an entry of the sidecar.
pub(super) fn chosen(column: &str, choice: Option<&str>) -> String {
    let entry = |choice: &str| format!(", like {{\"{}\": \"{}\"}}", plain(column), plain(choice));
    choice.map_or(String::new(), entry)
}

/// Entries of `columns`, at the end of a sentence.
pub(super) fn mapped_instead(columns: &BTreeMap<String, String>) -> String {
    let entry = |(name, header): (&String, &String)| format!("\"{}\": \"{}\"", plain(name), plain(header));
    let entries: Vec<String> = columns.iter().map(entry).collect();
    if entries.is_empty() {
        return String::new();
    }
    format!("; for a motion along one line, state \"columns\": {{{}}} in the sidecar", entries.join(", "))
}

/// `row 3 (line 4)`, or without the line where the format has none.
pub(super) fn place(row: usize, line: u64) -> String {
    if line == 0 { format!("row {row}") } else { format!("row {row} (line {line})") }
}

/// Advice about a container without columns of numbers.
pub(super) fn columns_advice(format: &str) -> &'static str {
    match format {
        "MATLAB" => "save vectors of equal length, one of them the time, with save('log.mat', ..., '-v7')",
        _ => "export the log with JSON, protobuf or ROS 2 messages, or as CSV",
    }
}

/// Advice about a cell, with the entry of a sidecar that leaves out its column or such rows.
pub(super) fn cell_advice(advice: &str, mend: Option<&Suggested>) -> String {
    let Some((key, value)) = mend.and_then(|entries| entries.iter().next()) else { return advice.to_owned() };
    let entries = value.as_object().map(|columns| {
        let entries: Vec<String> = columns.keys().map(|name| format!("\"{name}\": null")).collect();
        format!("{{{}}}", entries.join(", "))
    });
    let out = if value.is_array() { "such rows" } else { "the column" };
    let value = entries.unwrap_or_else(|| value.to_string());
    format!("{advice}, or leave {out} out: \"{key}\": {} in the sidecar", plain(&value))
}

/// Advice about a row of another length.
pub(super) fn unequal_advice(found: usize, expected: usize) -> &'static str {
    if found > expected {
        "two lines may have run together: correct or remove them"
    } else {
        "the line may be cut off: complete or remove it"
    }
}

/// Entry of a sidecar for a column whose name and stated unit disagree. `factor`: SI value of the stated unit over that of the
/// name's.
pub(super) fn stated_factor(column: &str, (named, stated): (&str, &str), factor: Option<f64>) -> String {
    let column = plain(column);
    match factor {
        Some(factor) => format!("\"scale\": {{\"{column}\": {factor}}} for `{}`, or 1 for {named}", plain(stated)),
        None => format!("\"scale\": {{\"{column}\": SI value of 1}}"),
    }
}
