//! Text files of LabVIEW (`.lvm`), as a table with a header and a row of units.
//!
//! National Instruments, *Specification for the LabVIEW Measurement File*: a head for the file, one for each segment, and
//! rows. Both heads end with `***End_of_Header***`.

use crate::errors::LogError;
use std::collections::HashMap;
use std::path::Path;

const END: &str = "***End_of_Header***";

/// True for the start of such a file.
pub fn is_measurement(start: &[u8]) -> bool {
    start.trim_ascii_start().starts_with(b"LabVIEW Measurement")
}

/// The first segment as a table with tabs.
pub fn table(text: &[u8], path: &Path) -> Result<Vec<u8>, LogError> {
    let text = String::from_utf8_lossy(text);
    let refuse =
        |why: &str| LogError::NotATable { why: format!("a LabVIEW measurement {why}"), path: path.to_path_buf() };
    let mut lines = text.lines().map(|line| line.trim_end_matches('\r'));
    let head = facts(&mut lines, &['\t', ',']);
    let fact = |name: &str| head.get(name).and_then(|cells| cells.first()).map_or("", String::as_str);
    let delimiter = if fact("Separator").eq_ignore_ascii_case("comma") { ',' } else { '\t' };
    let segment = facts(&mut lines, &[delimiter]);
    let header = lines.find(|line| !line.trim().is_empty()).ok_or_else(|| refuse("without a table"))?;
    let names: Vec<&str> = header.split(delimiter).map(str::trim).collect();
    let comment = names.iter().position(|name| *name == "Comment").unwrap_or(names.len());
    let is_clock = |name: &str| name == "X_Value";
    // Every channel may have a clock of its own: all begin and go on alike, so the first one stands for all.
    let first_clock = names.iter().position(|name| is_clock(name));
    let kept: Vec<usize> = (0..comment).filter(|&k| !is_clock(names[k]) || Some(k) == first_clock).collect();
    let has_clock = fact("X_Columns") != "No";
    let decimal = fact("Decimal_Separator");
    let number = |text: &str| text.replace(if decimal == "," { ',' } else { '.' }, ".").parse::<f64>().ok();
    let of_first = |name: &str| segment.get(name)?.iter().find_map(|cell| number(cell));
    let (start, step) = (of_first("X0").unwrap_or(0.0), of_first("Delta_X"));
    if !has_clock && step.is_none() {
        return Err(refuse("has no clock: Delta_X is missing in its head"));
    }
    let units = segment.get("Y_Unit_Label").cloned().unwrap_or_default();
    let out = Out { names: &names, kept: &kept, units, is_clock: &|k| is_clock(names[k]) };
    let mut made = out.head();
    for (row, line) in lines.take_while(|line| !line.trim().is_empty() && !line.contains(END)).enumerate() {
        let cells: Vec<&str> = line.split(delimiter).map(str::trim).collect();
        let time = if has_clock { None } else { step.map(|step| start + step * row as f64) };
        made += &out
            .row(&cells, time.map(|t| format!("{t}").replace('.', if decimal == "," { "," } else { "." })).as_deref());
    }
    Ok(made.into_bytes())
}

/// The entries of a head up to its end: name and cells.
fn facts<'a>(lines: &mut impl Iterator<Item = &'a str>, delimiters: &[char]) -> HashMap<String, Vec<String>> {
    let head = lines.take_while(|line| !line.starts_with(END));
    head.filter_map(|line| {
        let (name, rest) = line.split_once(delimiters)?;
        let cells = rest.split('\t').map(|cell| cell.trim().to_owned());
        Some((name.trim().to_owned(), cells.collect()))
    })
    .collect()
}

/// The table to be written.
struct Out<'a> {
    names: &'a [&'a str],
    kept: &'a [usize],
    units: Vec<String>,
    is_clock: &'a dyn Fn(usize) -> bool,
}

impl Out<'_> {
    /// Names, and units below them.
    fn head(&self) -> String {
        let names: Vec<&str> = self.kept.iter().map(|&k| self.names[k]).collect();
        // The cells of the head stand above the channels, with empty ones above further clocks.
        let mut stated = self.units.iter().filter(|unit| !unit.is_empty());
        let units: Vec<String> = self
            .kept
            .iter()
            .map(|&k| {
                if (self.is_clock)(k) {
                    "(s)".to_owned()
                } else {
                    format!("({})", stated.next().map_or("", String::as_str))
                }
            })
            .collect();
        format!("{}\n{}\n", names.join("\t"), units.join("\t"))
    }

    fn row(&self, cells: &[&str], time: Option<&str>) -> String {
        let cell = |&k: &usize| match &time {
            Some(time) if (self.is_clock)(k) => (*time).to_owned(),
            _ => cells.get(k).copied().unwrap_or_default().to_owned(),
        };
        self.kept.iter().map(cell).collect::<Vec<_>>().join("\t") + "\n"
    }
}
