//! A column of lists as one column an item.

use super::column::{Sink, another_kind};
use crate::raw::{Cells, MISSING};
use haptics::recording::Labels;
use parquet::column::page::PageReader;
use parquet::column::reader::ColumnReaderImpl;
use parquet::data_type::{ByteArray, DataType};
use parquet::errors::ParquetError;

/// Longer lists (images, point clouds) are left out, as in MCAP.
pub const MAX_ITEMS: usize = 64;
/// Items that are decoded at a time, about.
const BATCH: usize = 1 << 14;

/// The columns of a list, which grow with the longest one.
#[derive(Debug, Default)]
pub struct List {
    /// One column an item; a cell without a value where a list is shorter.
    pub items: Vec<Cells>,
    /// Fewest and most items of a row.
    pub lengths: Option<(usize, usize)>,
    /// Rows so far.
    rows: usize,
    text: bool,
}

/// A list that is being read.
pub struct Items<'a> {
    /// Its columns.
    pub list: &'a mut List,
    /// Number of rows to read.
    pub rows: usize,
    /// Level of a value that is there.
    pub level: i16,
    /// Level from which there is an item.
    pub item_level: i16,
    /// Room that further columns may take, bytes.
    pub room: &'a mut u64,
    /// Rows of the whole file.
    pub all_rows: u64,
}

/// True if the pages of a column hold at most `limit` values: the library reserves room for all values of a row.
pub fn fits(mut pages: Box<dyn PageReader>, limit: u64) -> Result<bool, ParquetError> {
    let mut sum = 0_u64;
    while let Some(page) = pages.peek_next_page()? {
        let values = page.num_levels.or(page.num_rows).unwrap_or(0);
        sum = sum.saturating_add(if page.is_dict { 0 } else { values as u64 });
        if sum > limit {
            return Ok(false);
        }
        pages.skip_next_page()?;
    }
    Ok(true)
}

impl List {
    /// A list of texts or of numbers.
    pub fn new(text: bool) -> Self {
        Self { text, ..Self::default() }
    }

    /// True once a list was too long; its columns are dropped then.
    pub fn is_too_long(&self) -> bool {
        self.lengths.is_some_and(|(_, most)| most > MAX_ITEMS)
    }

    /// A sentence about lists that differ in length, or are not kept.
    pub fn said(&self, name: &str) -> Option<String> {
        match self.lengths {
            Some((_, most)) if most > MAX_ITEMS => Some(format!(
                "the column `{name}` is not read: it holds lists of {most} items, and at most {MAX_ITEMS} are read"
            )),
            None | Some((_, 0)) => Some(format!("the column `{name}` is not read: its lists are empty")),
            Some((fewest, most)) if fewest != most => Some(format!(
                "the column `{name}` holds lists of {fewest} to {most} items; an item has no value in rows whose list is shorter"
            )),
            Some(_) => None,
        }
    }

    fn end_row(&mut self, items: usize) {
        let (fewest, most) = self.lengths.unwrap_or((items, items));
        self.lengths = Some((fewest.min(items), most.max(items)));
        self.rows += 1;
        if self.is_too_long() {
            self.items.clear();
        }
    }
}

impl Items<'_> {
    /// The column of item `place`, filled up to the current row; none if the list is not kept.
    fn cells(&mut self, place: usize) -> Result<Option<&mut Cells>, ParquetError> {
        if place >= MAX_ITEMS || self.list.is_too_long() {
            return Ok(None);
        }
        if place == self.list.items.len() {
            let bytes = 8_u64.saturating_mul(self.all_rows);
            *self.room = self.room.checked_sub(bytes).ok_or_else(|| {
                ParquetError::General("its lists hold more values than a file of this size".to_owned())
            })?;
            let text = self.list.text;
            self.list.items.push(if text { Cells::Text(Labels::default()) } else { Cells::Numbers(Vec::new()) });
        }
        let rows = self.list.rows;
        let cells = &mut self.list.items[place];
        cells.pad(rows);
        Ok(Some(cells))
    }

    /// Reads row by row; `take` gets every item with its place and its value, if it has one.
    fn each<T: DataType>(
        &mut self,
        mut reader: ColumnReaderImpl<T>,
        mut take: impl FnMut(&mut Cells, Option<&T::T>) -> Result<(), ParquetError>,
    ) -> Result<(), ParquetError> {
        let (mut values, mut levels, mut repeats) = (Vec::new(), Vec::new(), Vec::new());
        let (mut left, mut batch) = (self.rows, 1);
        while left > 0 && !self.list.is_too_long() {
            values.clear();
            levels.clear();
            repeats.clear();
            let (records, _, _) =
                reader.read_records(left.min(batch), Some(&mut levels), Some(&mut repeats), &mut values)?;
            if records == 0 || records > left {
                let why = "a column has another number of rows than the file says";
                return Err(ParquetError::General(why.to_owned()));
            }
            let (mut next, mut place) = (values.iter(), 0);
            for (at, (&level, &repeat)) in levels.iter().zip(&repeats).enumerate() {
                if repeat == 0 && at > 0 {
                    self.list.end_row(place);
                    place = 0;
                }
                if level >= self.item_level {
                    let value = if level == self.level { next.next() } else { None };
                    if let Some(cells) = self.cells(place)? {
                        take(cells, value)?;
                    }
                    place += 1;
                }
            }
            self.list.end_row(place);
            left -= records;
            batch = (2 * batch).min(BATCH / self.list.lengths.map_or(1, |(_, most)| most).max(1)).max(1);
        }
        let rows = self.list.rows;
        self.list.items.iter_mut().for_each(|cells| cells.pad(rows));
        Ok(())
    }
}

impl Sink for Items<'_> {
    fn numbers<T: DataType>(
        &mut self,
        reader: ColumnReaderImpl<T>,
        mut convert: impl FnMut(&T::T) -> f64,
    ) -> Result<(), ParquetError> {
        self.each(reader, |cells, value| {
            let Cells::Numbers(to) = cells else { return Err(another_kind()) };
            to.push(value.map_or(MISSING, &mut convert));
            Ok(())
        })
    }

    fn texts<T: DataType<T = ByteArray>>(&mut self, reader: ColumnReaderImpl<T>) -> Result<(), ParquetError> {
        self.each(reader, |cells, value| {
            let Cells::Text(to) = cells else { return Err(another_kind()) };
            to.push(value.map_or(Ok(""), |v| v.as_utf8())?);
            Ok(())
        })
    }
}
