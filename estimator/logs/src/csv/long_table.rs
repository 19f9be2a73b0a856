//! Long tables: one number in a row, with its time and the name of its signal (databases, plots, melted data frames). They are
//! written as tables with a column for each signal.

use super::cells::{Notation, number};
use super::sniff::{delimiter_of, names};
use super::{calendar, decimal::Decimal};
use crate::plan::is_like_a_clock;
use std::collections::HashMap;
use std::fmt::Write as _;

/// Sentence about a table that was long.
pub const NOTE: &str = "the numbers of several signals stand below each other: each signal is read as a column";
/// Names of the column with the numbers.
const VALUES: [&str; 3] = ["value", "wert", "reading"];
/// Names of the column with the signals' names.
const SIGNALS: [&str; 12] = [
    "variable",
    "channel",
    "signal",
    "topic",
    "field",
    "series",
    "sensor",
    "metric",
    "quantity",
    "parameter",
    "tag",
    "key",
];
/// More signals than these are no columns. Choice: a plot or a data logger has tens.
const MOST_SIGNALS: usize = 200;

/// Places of a long table's columns.
#[derive(Clone, Copy, Debug)]
pub struct Columns {
    time: usize,
    signal: usize,
    value: usize,
    width: usize,
    delimiter: u8,
}

/// Columns of a long table, as the names in its first line show them; none for other texts.
pub fn columns(start: &[u8]) -> Option<Columns> {
    let header = rows(start).next()?;
    let delimiter = delimiter_of(header);
    let names: Vec<String> = names(header, delimiter).iter().map(|name| name.to_lowercase()).collect();
    let place = |known: &[&str]| names.iter().position(|name| known.contains(&name.trim_matches('_')));
    let time = names.iter().position(|name| is_like_a_clock(name))?;
    Some(Columns { time, signal: place(&SIGNALS)?, value: place(&VALUES)?, width: names.len(), delimiter })
}

/// Lines that are no comments.
fn rows(text: &[u8]) -> impl Iterator<Item = &[u8]> {
    text.split(|b| *b == b'\n').filter(|line| !line.trim_ascii().is_empty() && !line.starts_with(b"#"))
}

/// One row of the wide table.
#[derive(Debug)]
struct Moment {
    time_s: f64,
    /// The time as the file has it.
    time: String,
    /// Numbers by signal; empty where there is none.
    values: Vec<String>,
}

/// The table with tabs, in the order of its times; none if a time has two numbers of one signal
/// or a row does not fit.
pub fn wide(text: &[u8], columns: Columns) -> Option<Vec<u8>> {
    let (mut signals, mut places) = (Vec::new(), HashMap::new());
    let mut moments: Vec<Moment> = Vec::new();
    let mut cells = rows(text).map(|line| columns.of(line));
    let header = cells.next()??[0].clone();
    for row in cells {
        let [time, signal, value] = row?;
        let at = *places.entry(time.clone()).or_insert(moments.len());
        if at == moments.len() {
            moments.push(Moment { time_s: seconds(&time)?, time, values: Vec::new() });
        }
        let column = signals.iter().position(|known| *known == signal).unwrap_or(signals.len());
        if column == signals.len() {
            signals.push(signal);
        }
        let values = &mut moments[at].values;
        values.resize(values.len().max(column + 1), String::new());
        if column >= MOST_SIGNALS || !std::mem::replace(&mut values[column], value).is_empty() {
            return None;
        }
    }
    moments.sort_by(|a, b| a.time_s.total_cmp(&b.time_s));
    let mut wide = format!("{header}\t{}\n", signals.join("\t"));
    for Moment { time, mut values, .. } in moments {
        values.resize(signals.len(), String::new());
        let _ = writeln!(wide, "{time}\t{}", values.join("\t"));
    }
    (signals.len() > 1).then(|| wide.into_bytes())
}

impl Columns {
    /// Time, signal and number of a row; none for a row of another width.
    fn of(self, line: &[u8]) -> Option<[String; 3]> {
        let cells = names(line.trim_ascii_end(), self.delimiter);
        (cells.len() == self.width).then(|| [self.time, self.signal, self.value].map(|column| cells[column].clone()))
    }
}

/// A time for the order of rows, s.
fn seconds(time: &str) -> Option<f64> {
    let notation = Notation { decimal: Decimal::Either, ..Notation::default() };
    number(time.as_bytes(), notation).or_else(|| calendar::parse(time).map(|ns| 1e-9 * ns as f64))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn signals_stand_beside_each_other_in_the_order_of_their_times() {
        let text = b"time_s,variable,value\n0.0,a,1\n0.1,a,2\n0.1,b,4\n0.0,b,3\n0.2,b,5\n";
        let columns = columns(text).expect("a long table");
        let wide = wide(text, columns).expect("a table");
        assert_eq!(String::from_utf8_lossy(&wide), "time_s\ta\tb\n0.0\t1\t3\n0.1\t2\t4\n0.2\t\t5\n");
    }

    #[test]
    fn two_numbers_of_one_signal_at_one_time_are_no_table() {
        let text = b"time,signal,value\n0,a,1\n0,b,2\n0,a,3\n";
        assert!(wide(text, columns(text).expect("such names")).is_none());
        assert!(columns(b"time,force,value\n0,1,2\n").is_none());
    }
}
