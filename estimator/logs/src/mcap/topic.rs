//! The messages of one topic as columns: one row a message, one column a field.

use crate::raw::{Cells, is_missing};
use haptics::recording::Labels;
use std::collections::HashMap;

/// More fields than this in one topic are no recording.
pub const MAX_FIELDS: usize = 2000;
/// Longer lists of numbers (images, point clouds, maps) are passed over.
pub const MAX_ITEMS: usize = 64;
/// Messages nest no deeper than this.
pub const MAX_DEPTH: usize = 24;

/// Columns that grow row by row.
#[derive(Debug, Default)]
pub struct Topic {
    /// Paths of the fields, e.g. `wrench.force.x`, `position[0]`; empty when the message is a bare value.
    pub fields: Vec<String>,
    /// One column a field.
    pub columns: Vec<Cells>,
    /// Log time of every row, ns.
    pub log_ns: Vec<u64>,
    /// Channel of the file that every row came through: publishers of one topic may have one each.
    pub channels: Vec<u16>,
    /// True once a list was too long to be kept.
    pub long_lists: bool,
    /// Parts of the schema seen so far, for the limit on wild nesting.
    pub nodes: usize,
    lookup: HashMap<String, usize>,
    /// Column where the next field is expected: messages repeat their order.
    next: usize,
    /// Cells appended so far, for the limit on memory.
    cells: usize,
}

impl Topic {
    /// Starts the row of a message that came through `channel`.
    pub fn begin(&mut self, log_ns: u64, channel: u16) {
        self.log_ns.push(log_ns);
        self.channels.push(channel);
        self.next = 0;
    }

    /// Fills the fields that the message did not mention.
    pub fn end(&mut self) {
        let rows = self.log_ns.len();
        for column in &mut self.columns {
            if column.len() < rows {
                column.pad(rows);
            }
        }
        self.cells += self.columns.len() + 1;
    }

    /// Bytes held, about.
    pub fn bytes(&self) -> usize {
        8 * self.cells
    }

    /// Bytes of the texts that are held; not cheap, therefore not asked at every message.
    pub fn text_bytes(&self) -> usize {
        self.columns.iter().filter(|c| matches!(c, Cells::Text(_))).map(Cells::bytes).sum()
    }

    /// The column of a field, made when it is new.
    pub fn column(&mut self, field: &str, text: bool) -> Result<usize, String> {
        if self.fields.get(self.next).is_some_and(|f| f == field) {
            self.next += 1;
            return Ok(self.next - 1);
        }
        if let Some(&column) = self.lookup.get(field) {
            self.next = column + 1;
            return Ok(column);
        }
        if self.fields.len() == MAX_FIELDS {
            return Err(format!("it has more than {MAX_FIELDS} different fields"));
        }
        let mut cells = if text { Cells::Text(Labels::default()) } else { Cells::Numbers(Vec::new()) };
        cells.pad(self.log_ns.len().saturating_sub(1));
        self.cells += self.log_ns.len();
        self.fields.push(field.to_owned());
        self.columns.push(cells);
        self.lookup.insert(field.to_owned(), self.fields.len() - 1);
        self.next = self.fields.len();
        Ok(self.fields.len() - 1)
    }

    /// Puts a number into the current row.
    pub fn number(&mut self, column: usize, value: f64) {
        let rows = self.log_ns.len();
        match &mut self.columns[column] {
            Cells::Numbers(values) if values.len() < rows => values.push(value),
            Cells::Text(texts) if texts.len() < rows => texts.push(&value.to_string()),
            // A field that comes twice in a message: the first one counts.
            _ => {}
        }
    }

    /// Puts a text into the current row. A column of numbers becomes one of text.
    pub fn text(&mut self, column: usize, value: &str) {
        let rows = self.log_ns.len();
        if let Cells::Numbers(values) = &self.columns[column] {
            let mut texts = Labels::default();
            for &v in values {
                texts.push(&if is_missing(v) { String::new() } else { v.to_string() });
            }
            self.columns[column] = Cells::Text(texts);
        }
        if let Cells::Text(texts) = &mut self.columns[column]
            && texts.len() < rows
        {
            texts.push(value);
        }
    }

    /// Puts the rows in the order of their log time (a recorder may write its buffers one after the other).
    pub fn sort(&mut self) {
        if self.log_ns.is_sorted() {
            return;
        }
        let mut order: Vec<usize> = (0..self.log_ns.len()).collect();
        order.sort_by_key(|&i| self.log_ns[i]);
        self.keep(&order);
    }

    /// Keeps the rows `keep`, in that order.
    pub fn keep(&mut self, keep: &[usize]) {
        self.log_ns = keep.iter().map(|&i| self.log_ns[i]).collect();
        self.channels = keep.iter().map(|&i| self.channels[i]).collect();
        self.columns = self.columns.iter().map(|c| c.gathered(keep)).collect();
    }

    /// A copy of the rows `rows`, without the columns that have no value there.
    pub fn part(&self, rows: &[usize]) -> Self {
        let mut part = Self {
            fields: self.fields.clone(),
            columns: self.columns.iter().map(|c| c.gathered(rows)).collect(),
            log_ns: rows.iter().map(|&i| self.log_ns[i]).collect(),
            channels: rows.iter().map(|&i| self.channels[i]).collect(),
            ..Self::default()
        };
        let filled: HashMap<String, bool> =
            part.fields.iter().cloned().zip(part.columns.iter().map(has_value)).collect();
        part.forget(|field| filled.get(field) == Some(&false));
        part
    }

    /// Puts other columns in place of all that are there.
    pub fn replace(&mut self, columns: Vec<(String, Cells)>) {
        (self.fields, self.columns) = columns.into_iter().unzip();
        self.lookup.clear();
    }

    /// Drops the columns whose field `unwanted` names.
    pub fn forget(&mut self, unwanted: impl Fn(&str) -> bool) {
        let keep: Vec<bool> = self.fields.iter().map(|f| !unwanted(f)).collect();
        let mut kept = keep.iter();
        self.fields.retain(|_| *kept.next().unwrap_or(&true));
        let mut kept = keep.iter();
        self.columns.retain(|_| *kept.next().unwrap_or(&true));
        self.lookup.clear();
    }

    /// The column of a field.
    pub fn find(&self, field: &str) -> Option<&Cells> {
        self.fields.iter().position(|f| f == field).map(|at| &self.columns[at])
    }
}

/// `a.b[3]` → (`a.b`, `3`).
pub fn split_item(field: &str) -> Option<(&str, &str)> {
    field.strip_suffix(']')?.rsplit_once('[')
}

/// True for a column with a value in any row.
fn has_value(cells: &Cells) -> bool {
    match cells {
        Cells::Numbers(values) => values.iter().any(|&v| !is_missing(v)),
        Cells::Text(texts) => texts.iter().any(|text| !text.is_empty()),
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// A topic with these rows of fields.
    pub fn topic(rows: &[&[(&str, &str)]]) -> Topic {
        let mut topic = Topic::default();
        for (i, row) in rows.iter().enumerate() {
            topic.begin(i as u64, 0);
            for (field, value) in *row {
                if let Ok(number) = value.parse() {
                    let column = topic.column(field, false).expect("few");
                    topic.number(column, number);
                } else {
                    let column = topic.column(field, true).expect("few");
                    topic.text(column, value);
                }
            }
            topic.end();
        }
        topic
    }

    #[test]
    fn fields_may_come_late_or_not_at_all() {
        let topic = topic(&[&[("a", "1")], &[("b", "2"), ("a", "3")], &[("b", "x")]]);
        let Some(Cells::Numbers(a)) = topic.find("a") else { panic!("a holds numbers") };
        assert!(a[0] == 1.0 && a[1] == 3.0 && is_missing(a[2]));
        let b = topic.find("b").expect("there");
        assert_eq!([b.text(0), b.text(1), b.text(2)], ["", "2", "x"]);
    }
}
