//! Rows that hold nothing but plain numbers where numbers belong, straight into their columns.

use super::cells::{BATCH, Notation, is_skippable, length_ahead, number_ahead};
use super::decimal::Decimal;
#[cfg(target_arch = "x86_64")]
use super::{batch::Batch, simd};
use crate::plan::Use;

/// State for reading plain rows.
#[derive(Debug)]
pub struct Plain<'a> {
    /// Marks between and within numbers.
    notation: Notation,
    /// Use of each column.
    uses: &'a [Use],
    /// One vector a column; all that are read have the same length.
    columns: &'a mut [Vec<f64>],
    /// Indices of all delimiters and line ends of the block from the next row on, or farther back.
    #[cfg(target_arch = "x86_64")]
    ends: &'a [u32],
    #[cfg(target_arch = "x86_64")]
    batch: Option<Batch>,
}

/// Finds the ends for [`Plain::ends`]; nothing on processors that make no use of it.
pub fn find_ends(bytes: &[u8], delimiter: u8, ends: &mut Vec<u32>) {
    ends.clear();
    #[cfg(target_arch = "x86_64")]
    if simd::is_at_home() && u32::try_from(bytes.len()).is_ok() {
        // SAFETY: the processor has just been asked for every instruction that the function is compiled with.
        #[allow(unsafe_code, reason = "the only way to call a function that not every processor can run")]
        unsafe {
            simd::find_ends(bytes, delimiter, ends);
        }
    }
}

impl<'a> Plain<'a> {
    /// Reads into `columns`, one for each of `uses`; those that are read have the same length. `ends`: result of
    /// [`find_ends`] for the block.
    pub fn new(notation: Notation, uses: &'a [Use], columns: &'a mut [Vec<f64>], ends: &'a [u32]) -> Self {
        #[cfg(target_arch = "x86_64")]
        return Self { notation, uses, columns, ends, batch: None };
        #[cfg(not(target_arch = "x86_64"))]
        {
            let _ = ends;
            Self { notation, uses, columns }
        }
    }

    /// Reads rows from `at` on until one must be looked at more closely, or the bytes end: how many, and where the next one starts.
    pub fn rows(&mut self, bytes: &[u8], at: usize) -> (usize, usize) {
        let (mut rows, mut at, mut patience) = (0, at, 0);
        loop {
            let more;
            (more, at) = self.quick_rows(bytes, at);
            // A block that the quick way cannot read is tried with it less and less often.
            patience = if more > 0 { 1 } else { (2 * patience).clamp(1, BATCH) };
            rows += more;
            for _ in 0..patience {
                let Some(next) = self.row(bytes, at) else { return (rows, at) };
                (rows, at) = (rows + 1, next);
            }
        }
    }

    fn quick_rows(&mut self, bytes: &[u8], at: usize) -> (usize, usize) {
        #[cfg(target_arch = "x86_64")]
        if simd::is_at_home() {
            let comma = match self.notation.decimal {
                Decimal::Point => false,
                // Decimal commas stand in quotes, and quoted rows need a closer look.
                _ if self.notation.delimiter == b',' => false,
                // The vector instructions take every point for a decimal one.
                Decimal::Comma if memchr::memchr(b'.', &bytes[at..]).is_some() => return (0, at),
                Decimal::Either | Decimal::Comma => true,
            };
            // SAFETY: the processor has just been asked for every instruction that the function is compiled with.
            #[allow(unsafe_code, reason = "the only way to call a function that not every processor can run")]
            return unsafe {
                if comma { self.rows_avx2::<true>(bytes, at) } else { self.rows_avx2::<false>(bytes, at) }
            };
        }
        (0, at)
    }

    /// One row with the careful parser of numbers; where the next one starts.
    fn row(&mut self, bytes: &[u8], at: usize) -> Option<usize> {
        let known = self.known();
        let end = self.cells(bytes, at).and_then(|at| match bytes.get(at..) {
            Some([b'\n', ..]) => Some(at),
            Some([b'\r', b'\n', ..]) => Some(at + 1),
            _ => None,
        });
        if end.is_none() {
            self.forget(known);
        }
        end.map(|end| end + 1)
    }

    fn known(&self) -> usize {
        self.columns.iter().map(Vec::len).max().unwrap_or(0)
    }

    /// Drops the values of a row that was not read to its end.
    fn forget(&mut self, known: usize) {
        self.columns.iter_mut().for_each(|c| c.truncate(known));
    }

    /// The cells of one row; where its line ends.
    fn cells(&mut self, bytes: &[u8], mut at: usize) -> Option<usize> {
        let last = self.uses.len() - 1;
        for (column, (wanted, target)) in self.uses.iter().zip(self.columns.iter_mut()).enumerate() {
            match *wanted {
                Use::Number { factor, .. } => {
                    let (value, end) = number_ahead(bytes, at, self.notation)?;
                    target.push(value * factor);
                    at = end;
                }
                Use::Stamp { .. } => return None,
                Use::Ignore => {
                    let length = length_ahead(bytes.get(at..)?, self.notation.delimiter);
                    if !is_skippable(&bytes[at..at + length]) {
                        return None;
                    }
                    at += length;
                }
            }
            if column < last {
                if bytes.get(at) != Some(&self.notation.delimiter) {
                    return None;
                }
                at += 1;
            }
        }
        Some(at)
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2,bmi1,bmi2,lzcnt,popcnt,fma")]
    fn rows_avx2<const COMMA: bool>(&mut self, bytes: &[u8], mut at: usize) -> (usize, usize) {
        let (mut rows, width) = (0, self.uses.len());
        let behind = self.ends.iter().position(|&end| (end as usize) >= at).unwrap_or(self.ends.len());
        self.ends = &self.ends[behind..];
        let Some(&line_end) = self.ends.get(width - 1) else { return (0, at) };
        let mut batch = self.batch.take().unwrap_or_else(|| Batch::new(self.notation.delimiter, self.uses));
        batch.set_line_end(bytes[..line_end as usize].last() == Some(&b'\r'));
        loop {
            let (filled, starts) = batch.fill::<COMMA>(bytes, at, self.ends);
            let values = batch.values(filled);
            self.flush(values);
            let certain = values.len() / width;
            (rows, at) = (rows + certain, starts[certain]);
            self.ends = &self.ends[certain * width..];
            if certain < BATCH {
                self.batch = Some(batch);
                return (rows, at);
            }
        }
    }

    /// Distributes whole rows to the columns.
    fn flush(&mut self, rows: &[f64]) {
        let width = self.uses.len();
        for (column, (wanted, target)) in self.uses.iter().zip(self.columns.iter_mut()).enumerate() {
            if matches!(wanted, Use::Number { .. }) {
                target.extend(rows.chunks_exact(width).map(|row| row[column]));
            }
        }
    }
}

#[cfg(test)]
mod tests;
