//! Text files of LabVIEW (`.lvm`), as a table with a header and a row of units.
//!
//! National Instruments, *Specification for the LabVIEW Measurement File*: a head for the file, one for each segment, and
//! rows. Both heads end with `***End_of_Header***`.

use super::calendar;
use crate::errors::LogError;
use std::borrow::Cow;
use std::collections::HashMap;
use std::path::Path;

const END: &str = "***End_of_Header***";

/// True for the start of such a file.
pub fn is_measurement(start: &[u8]) -> bool {
    start.trim_ascii_start().starts_with(b"LabVIEW Measurement")
}

/// A measurement as a table with tabs, a header, and a row of units.
#[derive(Debug)]
pub struct Measurement {
    pub text: Vec<u8>,
    /// Channels with a clock of their own: column of the channel, and of its clock.
    pub clocks: Vec<(usize, usize)>,
}

/// The first segment as a table.
pub fn table(text: &[u8], path: &Path) -> Result<Measurement, LogError> {
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
    let has_clock = fact("X_Columns") != "No";
    let decimal = if fact("Decimal_Separator") == "," { "," } else { "." };
    let of_first =
        |name: &str| segment.get(name)?.iter().find_map(|cell| cell.replace(decimal, ".").parse::<f64>().ok());
    let (start, step) = (of_first("X0").unwrap_or(0.0), of_first("Delta_X"));
    if !has_clock && step.is_none() {
        return Err(refuse("has no clock: Delta_X is missing in its head"));
    }
    let rows = lines.take_while(|line| !line.trim().is_empty() && !line.contains(END));
    let mut rows: Vec<Vec<Cow<'_, str>>> =
        rows.map(|line| line.split(delimiter).map(|cell| Cow::Borrowed(cell.trim())).collect()).collect();
    // Absolute times count from 1904 in every channel, relative ones from the channel's own start.
    let began = (fact("Time_Pref") != "Absolute").then_some(&segment);
    let columns = Columns::of(&names, began, &rows);
    for (row, cells) in rows.iter_mut().enumerate() {
        if let (false, true, Some(step), Some(time)) = (has_clock, is_clock(names[0]), step, cells.first_mut()) {
            *time = format!("{}", start + step * row as f64).replace('.', decimal).into();
        }
        columns.shift(cells, decimal);
    }
    Ok(columns.written(&names, &segment, &rows))
}

/// The entries of a head up to its end: name and cells.
fn facts<'a>(lines: &mut impl Iterator<Item = &'a str>, delimiters: &[char]) -> HashMap<String, Vec<String>> {
    let head = lines.take_while(|line| !line.starts_with(END));
    head.filter_map(|line| {
        let (name, rest) = line.split_once(delimiters)?;
        // A comma behind a tab is the decimal mark that the head states.
        let delimiter = line[name.len()..].chars().next()?;
        let cells = rest.split(delimiter).map(|cell| cell.trim().to_owned());
        Some((name.trim().to_owned(), cells.collect()))
    })
    .collect()
}

/// Columns of the table. The file's head has a cell for every channel, above the channel, and empty ones above clocks.
struct Columns {
    /// Columns of the file that are written.
    kept: Vec<usize>,
    /// Clocks that differ from the first one: their column, its channel, and the seconds by which they start later.
    own: Vec<(usize, usize, f64)>,
}

fn is_clock(name: &str) -> bool {
    name == "X_Value"
}

impl Columns {
    /// A further clock that holds the same times as the first one is left out. `began`: the head with the starts of the
    /// channels, if their times count from there.
    fn of(names: &[&str], began: Option<&HashMap<String, Vec<String>>>, rows: &[Vec<Cow<'_, str>>]) -> Self {
        let end = names.iter().position(|name| *name == "Comment").unwrap_or(names.len());
        let clocks: Vec<usize> = (0..end).filter(|&k| is_clock(names[k])).collect();
        let first = clocks.first().copied().unwrap_or(0);
        let start_ns = |channel: usize| {
            // The cells above the clocks are empty, and so is that of the fact's name.
            let cell = |name: &str| began?.get(name)?.get(channel - 1).filter(|cell| !cell.is_empty());
            calendar::parse(&format!("{} {}", cell("Date")?, cell("Time")?))
        };
        let later_s = |channel: usize| match (start_ns(first + 1), start_ns(channel)) {
            (Some(first), Some(own)) => 1e-9 * (own - first) as f64,
            _ => 0.0,
        };
        let differs = |k: usize| rows.iter().any(|row| row.get(k) != row.get(first));
        let of_clock = |&k: &usize| {
            let later_s = later_s(k + 1);
            (k + 1 < end && (later_s != 0.0 || differs(k))).then_some((k, k + 1, later_s))
        };
        let own: Vec<(usize, usize, f64)> = clocks.iter().skip(1).filter_map(of_clock).collect();
        let is_kept = |k: &usize| !is_clock(names[*k]) || *k == first || own.iter().any(|(clock, ..)| clock == k);
        Self { kept: (0..end).filter(is_kept).collect(), own }
    }

    /// Puts the times of clocks that start later on those of the first one.
    fn shift(&self, cells: &mut [Cow<'_, str>], decimal: &str) {
        for &(clock, _, later_s) in self.own.iter().filter(|(.., later_s)| *later_s != 0.0) {
            let Some(cell) = cells.get_mut(clock) else { continue };
            if let Ok(time) = cell.replace(decimal, ".").parse::<f64>() {
                *cell = format!("{}", time + later_s).replace('.', decimal).into();
            }
        }
    }

    fn written(
        &self,
        names: &[&str],
        segment: &HashMap<String, Vec<String>>,
        rows: &[Vec<Cow<'_, str>>],
    ) -> Measurement {
        let channel = |k: usize| self.own.iter().find(|(clock, ..)| *clock == k).map(|(_, channel, _)| names[*channel]);
        let name = |&k: &usize| channel(k).map_or_else(|| names[k].to_owned(), |channel| format!("time_{channel}"));
        let mut stated = segment.get("Y_Unit_Label").into_iter().flatten().filter(|unit| !unit.is_empty());
        let unit = |&k: &usize| {
            if is_clock(names[k]) {
                "(s)".to_owned()
            } else {
                // Without a label, the name may have the unit.
                stated.next().map_or_else(String::new, |unit| format!("({unit})"))
            }
        };
        let mut lines = vec![self.kept.iter().map(name).collect::<Vec<_>>(), self.kept.iter().map(unit).collect()];
        let cells = |row: &Vec<Cow<'_, str>>| {
            self.kept.iter().map(|&k| row.get(k).cloned().unwrap_or_default().into_owned()).collect()
        };
        lines.extend(rows.iter().map(cells));
        let text = lines.iter().map(|line| line.join("\t") + "\n").collect::<String>().into_bytes();
        let place = |column: usize| self.kept.iter().position(|k| *k == column);
        // A clock belongs to all channels up to the next one.
        let clocks = self.own.iter().flat_map(|&(clock, first, _)| {
            let channels = (first..names.len()).take_while(|&k| !is_clock(names[k]));
            channels.filter_map(move |channel| Some((place(channel)?, place(clock)?)))
        });
        Measurement { text, clocks: clocks.collect() }
    }
}
