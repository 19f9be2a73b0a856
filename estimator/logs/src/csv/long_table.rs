//! Long tables: one number in a row, with its time and the name of its signal (databases, plots, melted data frames). They are
//! written as tables with a column for each signal.

use super::cells::{Notation, number};
use super::sniff::{delimiter_of, names};
use super::{calendar, decimal::Decimal};
use crate::plan::is_like_a_clock;
use haptics::recording::Meta;
use std::borrow::Cow;
use std::collections::{HashMap, HashSet};
use std::fmt::Write as _;

/// Sentence about a table that was long.
pub const NOTE: &str = "the numbers of several signals stand below each other: each signal is read as a column";
/// Names of the column with the numbers.
const VALUES: [&str; 5] = ["value", "wert", "reading", "data", "val"];
/// Names of the column with the signals' names.
const SIGNALS: [&str; 14] = [
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
    "name",
    "kanal",
];
/// Names of the column with the signals' units.
const UNITS: [&str; 4] = ["unit", "units", "uom", "einheit"];
/// More signals than these are no columns. Choice: a plot or a data logger has tens.
const MOST_SIGNALS: usize = 200;

/// Fewer rows show no times that repeat. Choice: two signals at two times.
const LEAST_ROWS: usize = 4;

/// Places of a long table's columns.
#[derive(Clone, Debug)]
pub struct Columns {
    time: usize,
    signal: usize,
    value: usize,
    unit: Option<usize>,
    /// Columns that may tell signals of one name apart.
    others: Vec<usize>,
    names: Vec<String>,
    delimiter: u8,
}

/// Columns of a long table, as the names in its first line show them; none for other texts, and if the sidecar names columns of the
/// table as it stands.
pub fn columns(start: &[u8], meta: Option<&Meta>) -> Option<Columns> {
    let header = rows(start).next()?;
    let delimiter = delimiter_of(header);
    let names = names(header.trim_ascii_end(), delimiter);
    let lower: Vec<String> = names.iter().map(|name| name.to_lowercase()).collect();
    let place = |known: &[&str]| lower.iter().position(|name| known.contains(&name.trim_matches('_')));
    let is_clock = |column: usize| is_like_a_clock(&lower[column]);
    let time = (0..names.len()).find(|column| is_clock(*column))?;
    let by_name = place(&SIGNALS).zip(place(&VALUES));
    let ((signal, value), unit) = (by_name.or_else(|| by_cells(start, &names, time, delimiter))?, place(&UNITS));
    let is_other = |column: &usize| ![signal, value].contains(column) && Some(*column) != unit && !is_clock(*column);
    let is_named = |meta: &Meta| {
        let mut named = meta.columns.values().chain(meta.select.keys());
        named.any(|name| names.iter().enumerate().any(|(column, known)| known == name && !is_clock(column)))
    };
    let others = (0..names.len()).filter(is_other).collect();
    (!meta.is_some_and(is_named)).then(|| Columns {
        time,
        signal,
        value,
        unit,
        others,
        names: names.clone(),
        delimiter,
    })
}

/// Columns of the signals and of the numbers in a table of three columns whose times repeat: the one holds texts, the other numbers.
fn by_cells(start: &[u8], names: &[String], time: usize, delimiter: u8) -> Option<(usize, usize)> {
    if names.len() != 3 {
        return None;
    }
    let rows: Vec<Row<'_>> = rows(start).skip(1).map(|line| cells(line, delimiter)).collect();
    // The last row may be cut.
    let rows = rows.split_last()?.1;
    if rows.len() < LEAST_ROWS || rows.iter().any(|row| row.len() != 3) {
        return None;
    }
    let times: HashSet<&str> = rows.iter().map(|row| row[time].as_ref()).collect();
    let (texts, numbers) = (
        |column: usize| rows.iter().all(|row| seconds(&row[column]).is_none()),
        |column: usize| rows.iter().all(|row| is_number(&row[column])),
    );
    let beside: Vec<usize> = (0..3).filter(|column| *column != time).collect();
    let pairs = [(beside[0], beside[1]), (beside[1], beside[0])];
    let is_pair = |(signal, value): &(usize, usize)| texts(*signal) && numbers(*value);
    pairs.into_iter().find(is_pair).filter(|_| 2 * times.len() <= rows.len() + 1)
}

/// Cells of a row; those without quotes are not copied.
type Row<'a> = Vec<Cow<'a, str>>;

fn cells(line: &[u8], delimiter: u8) -> Row<'_> {
    let line = line.trim_ascii_end();
    if line.contains(&b'"') {
        return names(line, delimiter).into_iter().map(Cow::Owned).collect();
    }
    line.split(|b| *b == delimiter).map(|cell| String::from_utf8_lossy(cell.trim_ascii())).collect()
}

/// Lines that are no comments.
fn rows(text: &[u8]) -> impl Iterator<Item = &[u8]> {
    text.split(|b| *b == b'\n').filter(|line| !line.trim_ascii().is_empty() && !line.starts_with(b"#"))
}

/// The table with tabs, in the order of its times. None if it is none: a time has two numbers of one signal, a row does not fit,
/// signals have numbers for names, or another column holds measurements.
pub fn wide(text: &[u8], columns: &Columns) -> Option<Vec<u8>> {
    let of = |line| Some(cells(line, columns.delimiter)).filter(|cells| cells.len() == columns.names.len());
    let rows: Vec<Row<'_>> = rows(text).skip(1).map(of).collect::<Option<_>>()?;
    if rows.iter().all(|row| is_number(&row[columns.signal])) {
        return None;
    }
    let tags = tags(&rows, columns)?;
    let (mut signals, mut units): (Vec<String>, Vec<&str>) = (Vec::new(), Vec::new());
    let mut places = HashMap::new();
    let mut moments: Vec<(f64, &str, Vec<&str>)> = Vec::new();
    for row in &rows {
        let (time, value) = (row[columns.time].as_ref(), row[columns.value].as_ref());
        if is_missing(value) {
            continue;
        }
        let at = *places.entry(time).or_insert(moments.len());
        if at == moments.len() {
            moments.push((seconds(time)?, time, Vec::new()));
        }
        let name: Vec<&str> = tags.iter().chain([&columns.signal]).map(|tag| row[*tag].as_ref()).collect();
        let (name, unit) = (name.join("."), columns.unit.map_or("", |unit| row[unit].as_ref()));
        let column = signals.iter().position(|known| *known == name).unwrap_or(signals.len());
        if column == signals.len() {
            signals.push(name);
            units.push(unit);
        }
        let values = &mut moments[at].2;
        values.resize(values.len().max(column + 1), "");
        let before = std::mem::replace(&mut values[column], value);
        if column >= MOST_SIGNALS || units[column] != unit || !before.is_empty() && before != value {
            return None;
        }
    }
    moments.sort_by(|a, b| a.0.total_cmp(&b.0));
    let header = signals.iter().zip(&units).map(|(name, unit)| match *unit {
        "" => name.clone(),
        unit => format!("{name} [{unit}]"),
    });
    let mut wide = format!("{}\t{}\n", columns.names[columns.time], header.collect::<Vec<_>>().join("\t"));
    for (_, time, mut values) in moments {
        values.resize(signals.len(), "");
        let _ = writeln!(wide, "{time}\t{}", values.join("\t"));
    }
    (signals.len() > 1).then(|| wide.into_bytes())
}

/// Columns of texts that tell signals of one name apart. None if another column holds measurements: numbers that change, with
/// decimals. Whole numbers count rows, or grade them.
fn tags(rows: &[Row<'_>], columns: &Columns) -> Option<Vec<usize>> {
    let mut tags = Vec::new();
    for &column in &columns.others {
        let pairs: HashSet<(&str, &str)> =
            rows.iter().map(|row| (row[columns.signal].as_ref(), row[column].as_ref())).collect();
        let signals: HashSet<&str> = pairs.iter().map(|(signal, _)| *signal).collect();
        if pairs.len() == signals.len() {
            continue;
        }
        if !rows.iter().all(|row| is_number(&row[column]) || row[column].is_empty()) {
            tags.push(column);
        } else if rows.iter().any(|row| row[column].contains(['.', ',', 'e', 'E'])) {
            return None;
        }
    }
    Some(tags)
}

/// True for a cell that says that there is no number.
fn is_missing(cell: &str) -> bool {
    cell.is_empty() || ["nan", "null", "na", "none"].iter().any(|word| cell.eq_ignore_ascii_case(word))
}

fn is_number(cell: &str) -> bool {
    value(cell).is_some()
}

fn value(cell: &str) -> Option<f64> {
    number(cell.as_bytes(), Notation { decimal: Decimal::Either, ..Notation::default() })
}

/// A time for the order of rows, s.
fn seconds(time: &str) -> Option<f64> {
    value(time).or_else(|| calendar::parse(time).map(|ns| 1e-9 * ns as f64))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table(text: &str) -> Option<String> {
        let columns = columns(text.as_bytes(), None).expect("such names");
        wide(text.as_bytes(), &columns).map(|wide| String::from_utf8_lossy(&wide).into_owned())
    }

    #[test]
    fn signals_stand_beside_each_other_in_the_order_of_their_times() {
        let wide = table("time_s,variable,value\n0.0,a,1\n0.1,a,2\n0.1,b,4\n0.0,b,3\n0.2,b,5\n0.2,a,nan\n");
        assert_eq!(wide.expect("a table"), "time_s\ta\tb\n0.0\t1\t3\n0.1\t2\t4\n0.2\t\t5\n");
    }

    #[test]
    fn tags_and_units_belong_to_the_name() {
        let wide = table("time,device,signal,unit,value,id\n0,l,f,N,1,1\n0,r,f,N,2,2\n1,l,f,N,3,3\n");
        assert_eq!(wide.expect("a table"), "time\tl.f [N]\tr.f [N]\n0\t1\t2\n1\t3\t\n");
    }

    #[test]
    fn three_columns_need_no_known_names() {
        let wide = table("stamp_time,what,q\n0,a,1\n0,b,2\n1,a,3\n1,b,4\n2,a,5\n2,b,6\n");
        assert_eq!(wide.expect("a table"), "stamp_time\ta\tb\n0\t1\t2\n1\t3\t4\n2\t5\t6\n");
        // Every time once: the texts are states.
        assert!(columns(b"time,state,force\n0,free,1\n1,free,2\n2,held,3\n3,held,4\n", None).is_none());
    }

    #[test]
    fn other_tables_are_left_as_they_are() {
        for text in [
            "time,signal,value\n0,a,1\n0,b,2\n0,a,3\n",
            "time,channel,position,value\n0,A,1.5,1\n1,B,1.6,2\n2,A,1.7,3\n",
            "time,signal,value\n0,0.1,1\n1,0.2,2\n",
            "time,signal,unit,value\n0,a,m,1\n1,a,mm,1000\n1,b,N,1\n",
        ] {
            assert!(table(text).is_none(), "{text}");
        }
        assert!(columns(b"time,force,value\n0,1,2\n", None).is_none());
        let meta = Meta { columns: [("f_N".to_owned(), "value".to_owned())].into(), ..Meta::default() };
        assert!(columns(b"time,signal,value\n0,a,1\n", Some(&meta)).is_none());
    }
}
