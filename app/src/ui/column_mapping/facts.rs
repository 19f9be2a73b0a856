//! Inspection of a file before its columns have a meaning: names, first values, ranges.
//!
//! Text tables are inspected as text, so that columns of words can be trials, labels and selections. Other files go
//! through the reader under neutral names.

use estimator::log::units::{self, Dimension};
use estimator::log::written_units::in_header;
use estimator::log::{self, LogError, TextTable};
use haptics::recording::Meta;
use std::collections::BTreeSet;
use std::path::Path;

/// Number of bytes of a text table that are inspected.
const LOOK_BYTES: u64 = 32 << 20;
/// Share of numbers among the cells of a column of numbers, as in the reader of tables.
const NUMERIC: f64 = 0.9;
/// Number of first values that are shown.
const SHOWN_CELLS: usize = 3;
/// Minimum number of increasing rows between two restarts of a clock that starts again for every trial.
const ROWS_A_START: usize = 20;
/// Maximum number of distinct values that are kept.
const MOST_DISTINCT: usize = 60;

/// Facts about a column from inspection.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ColumnFacts {
    /// Its name in the file.
    pub header: String,
    /// Name by which a sidecar calls it.
    pub source: String,
    /// Text of its unit outside the name; empty for none.
    pub stated_unit: String,
    /// First values, as written in the file.
    pub first: Vec<String>,
    /// True if the cells are numbers, but for a few.
    pub numeric: bool,
    /// Smallest and largest number.
    pub range: Option<(f64, f64)>,
    /// True if the numbers increase from row to row, apart from a few restarts.
    pub increasing: bool,
    /// Number of rows whose number is smaller than the one before.
    pub falls: usize,
    /// True if every number is whole.
    pub whole: bool,
    /// Median step from row to row.
    pub step: Option<f64>,
    /// Number of rows whose value differs from the previous row.
    pub changes: usize,
    /// Distinct values in the order of the file; `None` if there are more than a list can hold.
    pub distinct: Option<Vec<String>>,
}

impl ColumnFacts {
    /// The name with the unit that stands outside it.
    pub fn with_unit(&self) -> String {
        let unit = self.stated_unit.trim_matches(['(', ')', '[', ']']);
        if unit.is_empty() { self.header.clone() } else { format!("{} [{unit}]", self.header) }
    }

    /// Text of the column's unit, for a quantity of this dimension.
    pub fn unit_text(&self, dimension: Dimension) -> &str {
        if self.stated_unit.is_empty() { in_header(&self.header, &[dimension]).1 } else { &self.stated_unit }
    }
}

/// Facts about an inspected file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FileFacts {
    /// Its columns.
    pub columns: Vec<ColumnFacts>,
    /// Number of inspected rows.
    pub rows: usize,
    /// False if the file continues after them.
    pub whole_file: bool,
}

/// Inspects a file.
pub fn look(path: &Path) -> Result<FileFacts, LogError> {
    let mut facts = match log::text_table(path, LOOK_BYTES)? {
        Some(table) => from_cells(&table),
        None => through_the_reader(path, &log::headers(path)?)?,
    };
    let headers: Vec<String> = facts.columns.iter().map(|column| column.header.clone()).collect();
    for (column, source) in facts.columns.iter_mut().zip(log::sources(&headers)) {
        column.source = source;
    }
    Ok(facts)
}

fn from_cells(table: &TextTable) -> FileFacts {
    let rows = &table.rows;
    let of = |(column, header): (usize, &String)| {
        let cells = || rows.iter().filter_map(|row| row.get(column)).map(String::as_str);
        // Times of the calendar count from the first row.
        let origin_ns = cells().next().and_then(log::stamp_ns);
        let seconds = |cell: &str| Some(1e-9 * log::stamp_ns(cell)?.saturating_sub(origin_ns?) as f64);
        let numbers: Vec<f64> = cells().filter_map(|cell| cell.parse().ok().or_else(|| seconds(cell))).collect();
        let filled = cells().filter(|cell| !cell.is_empty()).count();
        // A few words stand for values that are missing.
        let is_numeric = numbers.len() as f64 >= NUMERIC * filled as f64;
        let mut facts = if is_numeric { of_numbers(&numbers) } else { ColumnFacts::default() };
        facts.header.clone_from(header);
        facts.stated_unit = table.units.get(column).cloned().unwrap_or_default();
        if facts.numeric && origin_ns.is_some() {
            "s".clone_into(&mut facts.stated_unit);
        }
        facts.first = cells().take(SHOWN_CELLS).map(str::to_owned).collect();
        facts.changes = cells().zip(cells().skip(1)).filter(|(a, b)| a != b).count();
        facts.distinct = distinct(cells());
        facts
    };
    let columns = table.headers.iter().enumerate().map(of).collect();
    FileFacts { columns, rows: rows.len(), whole_file: table.is_whole }
}

fn distinct<'a>(cells: impl Iterator<Item = &'a str>) -> Option<Vec<String>> {
    let (mut seen, mut listed) = (BTreeSet::new(), Vec::new());
    for cell in cells {
        if seen.insert(cell) {
            listed.push(cell.to_owned());
            if listed.len() > MOST_DISTINCT {
                return None;
            }
        }
    }
    Some(listed)
}

fn of_numbers(values: &[f64]) -> ColumnFacts {
    let mut steps: Vec<f64> = values.windows(2).map(|w| w[1] - w[0]).collect();
    let falls = steps.iter().filter(|s| **s < 0.0).count();
    let starts = steps.iter().filter(|s| **s <= 0.0).count();
    let increasing = !steps.is_empty() && starts * ROWS_A_START <= steps.len();
    let middle = steps.len() / 2;
    let step = (!steps.is_empty()).then(|| *steps.select_nth_unstable_by(middle, f64::total_cmp).1);
    let range = values.iter().filter(|v| v.is_finite()).fold(None, |range, &v| match range {
        None => Some((v, v)),
        Some((low, high)) => Some((v.min(low), v.max(high))),
    });
    ColumnFacts {
        numeric: !values.is_empty(),
        range,
        increasing,
        falls,
        whole: values.iter().all(|v| v.fract() == 0.0),
        step,
        ..ColumnFacts::default()
    }
}

/// Facts about a file that is not text: every column is read under a meaningless name.
fn through_the_reader(path: &Path, headers: &[String]) -> Result<FileFacts, LogError> {
    let neutral = |at: usize| format!("column {}", at + 1);
    let mut hidden: Vec<usize> = (0..headers.len()).filter(|&at| has_a_meaning(&headers[at])).collect();
    let recordings = loop {
        let meta =
            Meta { columns: hidden.iter().map(|&at| (neutral(at), headers[at].clone())).collect(), ..Meta::default() };
        match log::load_with_meta(path, &meta) {
            // A column of words under the name of a quantity is read separately.
            Err(LogError::BadCell { column, .. }) if hidden.iter().any(|&at| headers[at] == column) => {
                hidden.retain(|&at| headers[at] != column);
            }
            other => break other?,
        }
    };
    let of = |at: usize| {
        let (own, name) = (&headers[at], neutral(at));
        let si = units::split(own).map(|(quantity, unit)| (format!("{quantity}_{}", unit.si), unit.factor));
        let mut values = Vec::new();
        for recording in &recordings {
            if let Some(found) = recording.channel(&name).or_else(|| recording.channel(own)) {
                values.extend_from_slice(found);
            } else if let Some((si, factor)) = &si
                && let Some(found) = recording.channel(si)
            {
                values.extend(found.iter().map(|v| v / factor));
            }
        }
        let mut facts = of_numbers(&values);
        facts.header.clone_from(own);
        let stated = recordings.first().and_then(|r| r.channels.iter().find(|c| c.name == name || c.name == *own));
        facts.stated_unit = stated.filter(|_| si.is_none()).map(|c| c.unit.clone()).unwrap_or_default();
        facts.first = values.iter().take(SHOWN_CELLS).map(f64::to_string).collect();
        facts.changes = values.windows(2).filter(|w| w[0] != w[1]).count();
        facts
    };
    Ok(FileFacts {
        columns: (0..headers.len()).map(of).collect(),
        rows: recordings.iter().map(haptics::recording::Recording::len).sum(),
        whole_file: true,
    })
}

/// True for a name that the reader would read as a quantity, or reject because of its unit.
fn has_a_meaning(header: &str) -> bool {
    !matches!(log::program_name(header, ""), Ok(None)) || header.starts_with("time")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file(text: &str) -> FileFacts {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("log.csv");
        std::fs::write(&path, text).expect("writable");
        look(&path).expect("a table")
    }

    #[test]
    fn a_german_table_is_looked_at() {
        let facts = file("# Prüfstand\nZeit [s];Kraft [N];Gerät;Nr\n0,0;1,5;Tür;1\n0,1;-2;Tür;1\n0,2;3;Lade;2\n");
        let [time, force, device, number] = &facts.columns[..] else { panic!("{facts:?}") };
        assert!(time.increasing && time.range == Some((0.0, 0.2)) && !time.whole);
        assert!((time.step.expect("a step") - 0.1).abs() < 1e-12);
        assert_eq!((force.range, force.numeric, force.increasing), (Some((-2.0, 3.0)), true, false));
        assert_eq!(force.first, ["1.5", "-2", "3"]);
        assert_eq!((device.numeric, device.changes), (false, 1));
        assert_eq!(device.distinct.as_deref(), Some(&["Tür".to_owned(), "Lade".to_owned()][..]));
        assert!(number.whole && number.changes == 1);
        assert!(facts.rows == 3 && facts.whole_file);
    }

    #[test]
    fn the_other_way_sees_the_same_numbers() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("log.csv");
        std::fs::write(&path, "t_ms,x_mm,fx1_lbf,q,time_s\n0,1,2,3,9\n10,5,4,6,8\n").expect("writable");
        let text = look(&path).expect("a table");
        let read = through_the_reader(&path, &log::headers(&path).expect("headers")).expect("a table");
        for (a, b) in text.columns.iter().zip(&read.columns) {
            assert_eq!((&a.header, a.range, a.increasing), (&b.header, b.range, b.increasing));
        }
    }

    #[test]
    fn a_container_is_looked_at_too() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("log.mcap");
        let names = ["q_m".to_owned(), "motor_A".to_owned()];
        let mut stream = log::McapStream::create(&path, &names, &Meta::default(), &[]).expect("creates");
        for i in 0..50 {
            stream.push(0.01 * f64::from(i), &[f64::from(i), -0.5]).expect("writes");
        }
        stream.finish().expect("ends");
        let facts = look(&path).expect("a table");
        let column = |name: &str| facts.columns.iter().find(|c| c.header == name).expect(name);
        assert_eq!((column("q_m").range, column("motor_A").range), (Some((0.0, 49.0)), Some((-0.5, -0.5))));
        assert!(column("t_s").increasing && facts.rows == 50);
    }
}
