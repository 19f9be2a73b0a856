//! Some rows at a time with vector instructions: taken apart first, rounded then. Two short loops are faster than one long one.

use super::cells::{BATCH, is_skippable};
use super::simd;
use crate::plan::Use;

/// Notation of a cell.
#[derive(Clone, Copy, Debug)]
struct Format {
    /// Delimiter or line end behind the cell.
    mark: u8,
    /// Number of bytes between the cell and that mark.
    less: u32,
    /// Unit conversion, scale and sign; NaN for a cell that is not read.
    factor: f64,
}

/// Room for [`BATCH`] rows.
#[derive(Debug)]
pub struct Batch {
    cells: Vec<Format>,
    written: Vec<simd::Written>,
    factors: Vec<f64>,
    values: Vec<f64>,
}

impl Batch {
    /// For rows with a cell for each of `uses`.
    pub fn new(delimiter: u8, uses: &[Use]) -> Self {
        let format = |wanted: &Use| Format {
            mark: delimiter,
            less: 0,
            factor: if let Use::Number { factor, .. } = *wanted { factor } else { f64::NAN },
        };
        let room = uses.len() * BATCH;
        Self {
            cells: uses.iter().map(format).collect(),
            written: vec![simd::ZERO; room],
            factors: vec![0.0; room],
            values: vec![0.0; room],
        }
    }

    /// Says whether lines end with a carriage return too.
    pub fn set_line_end(&mut self, carriage_return: bool) {
        if let Some(last) = self.cells.last_mut() {
            (last.mark, last.less) = if carriage_return { (b'\r', 1) } else { (b'\n', 0) };
        }
    }

    /// Takes rows apart from `at` on, until one is none of plain numbers: how many, and where each starts and the last one ends.
    #[target_feature(enable = "avx2,bmi1,bmi2,lzcnt,popcnt,fma")]
    pub fn fill<const COMMA: bool>(&mut self, bytes: &[u8], at: usize, ends: &[u32]) -> (usize, [usize; BATCH + 1]) {
        let width = self.cells.len();
        let mut starts = [at; BATCH + 1];
        let mut filled = 0;
        for ends in ends.chunks_exact(width).take(BATCH) {
            let first = filled * width;
            let row = (&mut self.written[first..][..width], &mut self.factors[first..][..width]);
            let Some(next) = row_avx2::<COMMA>(&self.cells, bytes, starts[filled], ends, row) else { break };
            filled += 1;
            starts[filled] = next;
        }
        (filled, starts)
    }

    /// The numbers of the first `filled` rows, up to the first row with one that is not certain; row by row.
    #[target_feature(enable = "avx2,bmi1,bmi2,lzcnt,popcnt,fma")]
    pub fn values(&mut self, filled: usize) -> &[f64] {
        let width = self.cells.len();
        let fours = (filled * width).div_ceil(4);
        let certain = simd::quotients(
            &self.written.as_chunks().0[..fours],
            &self.factors.as_chunks().0[..fours],
            &mut self.values.as_chunks_mut().0[..fours],
        );
        let values = &self.values[..filled * width];
        let doubtful = if certain { None } else { values.iter().position(|v| v.is_nan()) };
        doubtful.map_or(values, |at| &values[..at / width * width])
    }
}

/// Takes one row apart; where the next one starts.
#[inline]
#[target_feature(enable = "avx2,bmi1,bmi2,lzcnt,popcnt,fma")]
fn row_avx2<const COMMA: bool>(
    cells: &[Format],
    bytes: &[u8],
    mut at: usize,
    ends: &[u32],
    (row, factors): (&mut [simd::Written], &mut [f64]),
) -> Option<usize> {
    const BEFORE: u32 = simd::REACH as u32 - 1;
    let mut met = simd::Digits::none();
    for (((cell, &end), written), factor) in cells.iter().zip(ends).zip(row).zip(factors) {
        // For the first cells of the block this goes beyond its end.
        let first = end.wrapping_sub(BEFORE + cell.less) as usize;
        let around: &[u8; simd::REACH] = bytes.get(first..first + simd::REACH)?.first_chunk()?;
        if around[simd::REACH - 1] != cell.mark {
            return None;
        }
        let end = end as usize;
        if cell.factor.is_nan() {
            if !is_skippable(bytes.get(at..end)?) {
                return None;
            }
            (*written, *factor) = (simd::ZERO, 1.0);
        } else {
            let length = (end - cell.less as usize).wrapping_sub(at);
            let (number, sign) = simd::number::<COMMA>(around, length, &mut met)?;
            (*written, *factor) = (number, f64::from_bits(cell.factor.to_bits() ^ sign));
        }
        at = end + 1;
    }
    (met.only() && bytes.get(at - 1) == Some(&b'\n')).then_some(at)
}
