//! Cells with a unit behind their number (`3.7 mm`), as dashboards and spreadsheets write them, and numbers with their unit in the
//! next cell (`3.7,mm`), as force gauges do. A column whose units measure the same in every row is one of numbers.

use super::cells::{Notation, number};
use super::decimal::Decimal;
use super::layout;
use crate::plan::is_like_a_clock;
use crate::units::Dimension;
use crate::written_units::{Written, in_header, parse};
use haptics::recording::Meta;
use std::borrow::Cow;

/// A table with units behind its numbers.
pub struct UnitCells {
    delimiter: u8,
    /// Unit of each column; empty for a column without one.
    pub units: Vec<String>,
    /// True for a column whose unit stands in the next one.
    in_next: Vec<bool>,
    /// True if the numbers have decimal commas.
    has_comma: bool,
}

/// Columns whose cells are text, though it may look like a number with a unit: a label of `0"` is no length.
const TEXTS: [&str; 2] = ["trial", "label"];

/// The units behind the numbers of the later rows at the start of a text; none if all columns hold numbers or words.
pub fn of(start: &[u8], meta: Option<&Meta>) -> Option<UnitCells> {
    let stated = meta.into_iter().flat_map(|meta| {
        TEXTS.iter().filter_map(|text| meta.columns.get(*text)).chain(meta.select.keys()).map(String::as_str)
    });
    let texts: Vec<&str> = TEXTS.into_iter().chain(stated).collect();
    // With decimal commas, a row may hold more commas than delimiters.
    [b'|', b'\t', b';', b','].into_iter().find_map(|delimiter| with_delimiter(start, delimiter, &texts))
}

/// `texts`: names of the columns of text.
fn with_delimiter(start: &[u8], delimiter: u8, texts: &[&str]) -> Option<UnitCells> {
    let mut records = layout::records(start, delimiter, layout::LOOKED_AT);
    // The last one may be cut off.
    records.pop();
    let later = &records[records.len() / 2..];
    let width = later.first()?.cells.len();
    if later.len() < 2 || later.iter().any(|record| record.cells.len() != width) {
        return None;
    }
    let is_text = |column: usize| {
        let mut cells = records.iter().filter_map(|record| record.cells.get(column));
        cells.any(|cell| texts.contains(&cell.as_str()))
    };
    let in_next = columns_with_unit_in_next(&records[0], later);
    let unit = |column: usize| {
        if is_text(column) || in_next[column] {
            return in_next[column].then(|| later[0].cells[column + 1].clone());
        }
        let mut units = later.iter().map(|record| &record.cells[column]).filter(|cell| !cell.is_empty());
        let (_, unit) = parted(units.next()?)?;
        let is_known = matches!(parse(unit, &[]), Written::Known(..));
        let fits = |cell: &String| parted(cell).is_some_and(|(_, other)| other == unit || ratio(other, unit).is_some());
        (is_known && units.all(fits)).then(|| unit.to_owned())
    };
    let units: Vec<String> = (0..width).map(|column| unit(column).unwrap_or_default()).collect();
    let has_comma = later.iter().flat_map(|record| &record.cells).any(|cell| cell.contains(',') && !cell.contains('.'));
    let found = UnitCells { delimiter, units, in_next, has_comma };
    let is_one = found.with_units().next().is_some() && !records.iter().any(|record| found.has_other_units(record));
    is_one.then_some(found)
}

/// True for each column of numbers whose unit stands in the next one. `names`: the first record; `later`: rows.
fn columns_with_unit_in_next(names: &layout::Record, later: &[layout::Record]) -> Vec<bool> {
    let width = later[0].cells.len();
    let name = |column: usize| names.cells.get(column).map_or("", String::as_str);
    let holds_numbers = |column: usize| column < width && later.iter().all(|record| is_number(&record.cells[column]));
    let holds_units = |column: usize| {
        let first = later[0].cells.get(column).map_or("", String::as_str);
        is_mechanical(first) && later.iter().all(|record| ratio(&record.cells[column], first).is_some())
    };
    let is_pair = |column: usize| {
        let (own, next) = (name(column), name(column + 1).to_lowercase());
        if !holds_units(column + 1)
            || !holds_numbers(column)
            || !in_header(own, &[]).1.is_empty()
            || is_like_a_clock(own)
        {
            return false;
        }
        let of = next.split([' ', '_', '.', '-']).filter(|word| !["unit", "units", "einheit"].contains(word));
        let of = of.collect::<Vec<_>>().join("_");
        // A unit between two numbers may be that of the second.
        let is_last = !holds_numbers(column + 2) || holds_units(column + 3);
        let has_word = next.contains("unit") || next.contains("einheit");
        has_word && !of.is_empty() && own.to_lowercase().starts_with(&of)
            || is_last && (has_word && of.is_empty() || is_mechanical(&next))
    };
    (0..width).map(is_pair).collect()
}

impl UnitCells {
    fn with_units(&self) -> impl Iterator<Item = (usize, &str)> {
        self.units.iter().enumerate().filter(|(_, unit)| !unit.is_empty()).map(|(column, unit)| (column, unit.as_str()))
    }

    /// True for a row of numbers with units of which one is not that of its column.
    fn has_other_units(&self, record: &layout::Record) -> bool {
        let unit_of = |column: usize| self.parted(record, column).map(|(_, unit)| unit);
        self.with_units().all(|(column, _)| unit_of(column).is_some())
            && self
                .with_units()
                .any(|(column, own)| unit_of(column).is_none_or(|unit| unit != own && ratio(unit, own).is_none()))
    }

    /// A number in another unit, with the decimal mark of the table.
    fn times(&self, number: &str, [factor, own]: [f64; 2]) -> String {
        let product = value(number).map_or_else(|| number.to_owned(), |value| (value * factor / own).to_string());
        if self.has_comma { product.replace('.', ",") } else { product }
    }

    /// A number of a record and its unit.
    fn parted<'r>(&self, record: &'r layout::Record, column: usize) -> Option<(&'r str, &'r str)> {
        let cell = record.cells.get(column)?;
        if self.in_next.get(column) == Some(&true) {
            return Some((cell.as_str(), record.cells.get(column + 1)?.as_str())).filter(|(cell, _)| is_number(cell));
        }
        parted(cell)
    }

    /// The text without these units, and with numbers in the unit of their column. A cell with a unit of something else stays, and is
    /// refused later.
    pub fn taken_out(&self, text: &[u8]) -> Vec<u8> {
        let (mut plain, mut at) = (Vec::with_capacity(text.len()), 0);
        for record in layout::records(text, self.delimiter, usize::MAX) {
            plain.extend_from_slice(&text[at..record.start]);
            for (column, cell) in record.cells.iter().enumerate() {
                let own = self.units.get(column).map_or("", String::as_str);
                let number = self.parted(&record, column).filter(|_| !own.is_empty());
                let cell = match number {
                    Some((number, unit)) if unit == own => Cow::from(number),
                    Some((number, unit)) => Cow::from(
                        ratio(unit, own).map_or_else(|| format!("{number} {unit}"), |ratio| self.times(number, ratio)),
                    ),
                    None => Cow::from(cell),
                };
                plain.extend((column > 0).then_some(self.delimiter));
                plain.extend_from_slice(quoted(&cell, self.delimiter).as_bytes());
            }
            at = record.end;
        }
        plain.extend_from_slice(&text[at..]);
        plain
    }
}

/// A number and the unit behind it.
fn parted(cell: &str) -> Option<(&str, &str)> {
    let end = cell.rfind(|c: char| c.is_ascii_digit() || matches!(c, '.' | ','))? + 1;
    let (digits, unit) = (&cell[..end], cell[end..].trim());
    (!unit.is_empty() && is_number(digits)).then_some((digits, unit))
}

fn value(cell: &str) -> Option<f64> {
    number(cell.as_bytes(), Notation { decimal: Decimal::Either, ..Notation::default() })
}

fn is_number(cell: &str) -> bool {
    value(cell).is_some()
}

/// SI values of two units that measure the same mechanical quantity.
fn ratio(unit: &str, own: &str) -> Option<[f64; 2]> {
    match (parse(unit, &[]), parse(own, &[])) {
        (Written::Known(a, factor), Written::Known(b, own)) if a == b && a != Dimension::Other => Some([factor, own]),
        _ => None,
    }
}

/// True for the unit of a length, an angle, a force, or another mechanical quantity.
fn is_mechanical(text: &str) -> bool {
    matches!(parse(text, &[]), Written::Known(dimension, _) if dimension != Dimension::Other)
}

/// A cell as a record holds it: in quotes if a delimiter or a quote is part of it.
fn quoted(cell: &str, delimiter: u8) -> String {
    let needs_quotes = cell.contains(['"', '\n']) || cell.contains(char::from(delimiter));
    if needs_quotes { format!("\"{}\"", cell.replace('"', "\"\"")) } else { cell.to_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ROWS: &str = "t,wheel,place\n0,0\",1 mm\n1,1\",2 mm\n2,1\",3 mm\n3,2\",4 mm\n4,2\",5 mm\n5,2\"";

    #[test]
    fn a_unit_in_the_next_cell_is_that_of_the_number() {
        let text = b"t_s,force,force_unit,flag\n0,1.5,kN,N\n1,1.6,kN,N\n2,1.7,kN,N\n3,1.8,kN,N\n4,1900,N,N\n5,2,mm,N\n";
        let found = of(text, None).expect("units");
        assert_eq!(found.units, ["", "kN", "", ""]);
        let plain = String::from_utf8(found.taken_out(text)).expect("text");
        assert!(plain.contains("3,1.8,kN,N\n4,1.9,N,N\n5,2 mm,mm,N\n"), "{plain}");
        let before = b"time,unit,value,pos_mm\n0,N,1,2\n1,N,2,2\n2,N,1,3\n3,N,1,4\n4,N,1,4\n";
        assert!(of(before, None).is_none(), "the unit of a number behind it");
        let commas = "t_s;f\n0;1,5 kN\n1;2,5 kN\n2;3,5 kN\n3;900 N\n4;1234 N\n5;2,5 kN\n";
        let plain = of(commas.as_bytes(), None).expect("units").taken_out(commas.as_bytes());
        assert!(String::from_utf8_lossy(&plain).contains("3;0,9\n4;1,234\n"), "{}", String::from_utf8_lossy(&plain));
        assert!(of(b"t_s,force,flag\n0,1,N\n1,2,N\n2,3,N\n3,4,N\n", None).is_none());
    }

    /// A label that looks like inches stays text if the sidecar says that it is one.
    #[test]
    fn columns_of_text_keep_their_marks() {
        let found = of(ROWS.as_bytes(), None).expect("units");
        assert_eq!(found.units, ["", "\"", "mm"]);
        for stated in [r#"{"columns":{"trial":"wheel"}}"#, r#"{"select":{"wheel":["0\""]}}"#] {
            let meta: Meta = serde_json::from_str(stated).expect("a sidecar");
            assert_eq!(of(ROWS.as_bytes(), Some(&meta)).expect("units").units, ["", "", "mm"], "{stated}");
        }
    }
}
