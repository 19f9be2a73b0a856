//! Gram matrices of regressors, on which a comparison spends much of its time.

use nalgebra::DMatrix;

/// Number of rows multiplied at a time: a block of the matrix product's own, so that sums stay equal to the bit.
/// Derived: the block of rows of the `matrixmultiply` crate (its KC for f64), so that sums stay equal to the bit.
const TILE: usize = 256;
/// Number of columns multiplied at a time.
/// Derived: 64 columns of 256 rows take 128 KiB and fit in the cache of a core.
pub(crate) const PANEL: usize = 64;

/// Gram matrix of all columns over the picked rows. It is computed as matrix products, which are several times as fast
/// as single columns. The tiles fit in the cache, and only one side of the diagonal is computed.
pub fn gram(columns: &[Vec<f64>], picked: &[usize]) -> DMatrix<f64> {
    let all: Vec<usize> = (0..columns.len()).collect();
    let mut gram = DMatrix::zeros(columns.len(), columns.len());
    add(&mut gram, (columns, &all), 0, picked);
    gram.fill_upper_triangle_with_lower_triangle();
    gram
}

/// The same if many columns are known: `had` is their Gram matrix over the same rows, `from` the index of each column
/// in it.
pub fn more(columns: &[Vec<f64>], picked: &[usize], had: &DMatrix<f64>, from: &[Option<usize>]) -> DMatrix<f64> {
    // Known columns come first.
    let (old, new): (Vec<usize>, Vec<usize>) = (0..columns.len()).partition(|c| from[*c].is_some());
    let order = [old.as_slice(), new.as_slice()].concat();
    let mut sorted = DMatrix::zeros(columns.len(), columns.len());
    add(&mut sorted, (columns, &order), old.len(), picked);
    let mut place = vec![0; columns.len()];
    order.iter().enumerate().for_each(|(k, c)| place[*c] = k);
    DMatrix::from_fn(columns.len(), columns.len(), |i, j| match (from[i], from[j]) {
        (Some(a), Some(b)) => had[(a, b)],
        // Below the diagonal, or its mirror image.
        _ => sorted[(place[i].max(place[j]), place[i].min(place[j]))],
    })
}

/// Least number of rows and columns, below which another algorithm is used.
/// Derived: the next power of two above the 5 up to which `nalgebra` multiplies by another algorithm.
const LEAST_SIDE: usize = 8;
/// Number of columns of a strip.
/// Choice: halved or doubled, none of 90 answers changes.
pub const STRIP: usize = 24;

/// Columns with weighted rows.
pub struct Weighed<'a> {
    pub columns: &'a [&'a [f64]],
    pub weight: &'a [f64],
}

impl Weighed<'_> {
    fn fill(&self, tile: &mut [f64], column: usize, rows: &[usize]) {
        let column = self.columns[column];
        if is_run(rows) {
            let run = rows[0]..rows[0] + rows.len();
            let weighed = column[run.clone()].iter().zip(&self.weight[run]);
            tile.iter_mut().zip(weighed).for_each(|(value, (v, w))| *value = v * w);
        } else {
            tile.iter_mut().zip(rows).for_each(|(value, row)| *value = column[*row] * self.weight[*row]);
        }
    }

    /// Products of the columns `of` with those of `with` and, if `own`, with each other within each of the `strips`.
    /// They equal those of [`gram`] to the bit. One row for each of `of`; a strip's own products follow those `with`.
    pub fn products(&self, strips: &[Vec<usize>], with: &[usize], own: bool, picked: &[usize]) -> Vec<DMatrix<f64>> {
        // Too few columns are repeated.
        let enough = |columns: &[usize]| -> Vec<usize> {
            columns.iter().copied().cycle().take(columns.len().max(LEAST_SIDE)).collect()
        };
        let (asked, count) = (strips, with.len());
        let strips: Vec<Vec<usize>> = strips.iter().map(|strip| enough(strip)).collect();
        let widest = strips.iter().map(Vec::len).max().unwrap_or(0);
        let with = enough(with);
        let mut sums: Vec<DMatrix<f64>> = strips
            .iter()
            .map(|strip| DMatrix::zeros(strip.len(), with.len() + if own { strip.len() } else { 0 }))
            .collect();
        let mut tile = DMatrix::zeros(TILE + LEAST_SIDE, with.len() + widest);
        let mut turned = DMatrix::zeros(widest, TILE + LEAST_SIDE);
        let mut rest = picked;
        while !rest.is_empty() {
            let (rows, later) = rest.split_at(if rest.len() < TILE + LEAST_SIDE { rest.len() } else { TILE });
            rest = later;
            let fill = |tile: &mut DMatrix<f64>, place: usize, column: usize| {
                let mut place = tile.column_mut(place);
                self.fill(&mut place.as_mut_slice()[..rows.len()], column, rows);
            };
            with.iter().enumerate().for_each(|(k, column)| fill(&mut tile, k, *column));
            for (strip, sum) in strips.iter().zip(&mut sums) {
                strip.iter().enumerate().for_each(|(k, column)| fill(&mut tile, with.len() + k, *column));
                let mut across = turned.view_mut((0, 0), (strip.len(), rows.len()));
                tile.view((0, with.len()), (rows.len(), strip.len())).transpose_to(&mut across);
                let beside = tile.view((0, 0), (rows.len(), sum.ncols()));
                sum.gemm(1.0, &across, &beside, 1.0);
            }
        }
        let made = strips.iter().zip(sums).zip(asked);
        made.map(|((strip, sum), asked)| {
            // Without what was there twice.
            let place = |j: usize| if j < count { j } else { sum.ncols() - strip.len() + j - count };
            DMatrix::from_fn(asked.len(), count + if own { asked.len() } else { 0 }, |i, j| sum[(i, place(j))])
        })
        .collect()
    }
}

/// Mean squares of columns over these rows, several columns at a time, because each sum is a chain of dependent
/// additions.
pub fn mean_squares(columns: &Weighed<'_>, rows: &[usize]) -> Vec<f64> {
    let Weighed { columns, weight } = columns;
    let mut means = Vec::with_capacity(columns.len());
    for columns in columns.chunks(LEAST_SIDE) {
        let mut sums = [0.0; LEAST_SIDE];
        for rows in rows.chunk_by(|a, b| a + 1 == *b) {
            let rows = rows[0]..rows[0] + rows.len();
            let weight = &weight[rows.clone()];
            // Unused places hold an arbitrary column.
            let mut here = [weight; LEAST_SIDE];
            here.iter_mut().zip(columns).for_each(|(here, column)| *here = &column[rows.clone()]);
            for (k, weight) in weight.iter().enumerate() {
                sums.iter_mut().zip(&here).for_each(|(sum, here)| *sum += (here[k] * weight).powi(2));
            }
        }
        means.extend(sums[..columns.len()].iter().map(|sum| sum / rows.len().max(1) as f64));
    }
    means
}

/// True if increasing numbers follow each other without a gap.
fn is_run(rows: &[usize]) -> bool {
    rows.first().zip(rows.last()).is_some_and(|(first, last)| last - first + 1 == rows.len())
}

/// Adds the products of columns in this order, below the diagonal: those from number `first` on, with each other and
/// with all before.
fn add(sum: &mut DMatrix<f64>, (columns, order): (&[Vec<f64>], &[usize]), first: usize, picked: &[usize]) {
    let count = order.len();
    let mut tile = DMatrix::zeros(TILE + LEAST_SIDE, count);
    let mut turned = DMatrix::zeros(count - first, TILE + LEAST_SIDE);
    let panels = (count - first).div_ceil(PANEL).max(1);
    let bound = |panel: usize| first + panel * (count - first) / panels;
    let mut rest = picked;
    while !rest.is_empty() && first < count {
        let (rows, later) = rest.split_at(if rest.len() < TILE + LEAST_SIDE { rest.len() } else { TILE });
        rest = later;
        for (mut tile, column) in tile.column_iter_mut().zip(order) {
            let column = &columns[*column];
            // Most rows follow each other.
            if let (Some(tile), true) = (tile.as_mut_slice().get_mut(..rows.len()), is_run(rows)) {
                tile.copy_from_slice(&column[rows[0]..rows[0] + rows.len()]);
                continue;
            }
            for (value, row) in tile.iter_mut().zip(rows) {
                *value = column[*row];
            }
        }
        let tile = tile.rows(0, rows.len());
        let mut across = turned.columns_mut(0, rows.len());
        tile.columns(first, count - first).transpose_to(&mut across);
        if first > 0 {
            let old = tile.columns(0, first);
            sum.view_mut((first, 0), (count - first, first)).gemm(1.0, &across, &old, 1.0);
        }
        for panel in 0..panels {
            let (begin, end) = (bound(panel), bound(panel + 1));
            let below = across.rows(begin - first, count - begin);
            let part = tile.columns(begin, end - begin);
            sum.view_mut((begin, begin), (count - begin, end - begin)).gemm(1.0, &below, &part, 1.0);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn products_of_some_columns_are_to_the_bit_those_among_many_others() {
        let wave = |c: usize, i: usize| (0.37 * (i * (c + 1)) as f64).sin() + 0.01 * c as f64;
        let weight: Vec<f64> = (0..1500).map(|i| 0.5 + 0.5 * wave(3, i).abs()).collect();
        let columns: Vec<Vec<f64>> = (0..150).map(|c| (0..1500).map(|i| wave(c, i)).collect()).collect();
        let weigh = |column: &Vec<f64>| column.iter().zip(&weight).map(|(v, w)| v * w).collect::<Vec<f64>>();
        let whole: Vec<Vec<f64>> = columns.iter().map(weigh).collect();
        let columns: Vec<&[f64]> = columns.iter().map(Vec::as_slice).collect();
        let some = Weighed { columns: &columns, weight: &weight };
        let picked: Vec<usize> = (0..1500).filter(|i| i % 700 < 400).collect();
        let all = gram(&whole, &picked);
        for (strips, with, own) in [
            (vec![vec![0, 1, 2], (20..44).collect(), vec![7]], vec![149, 3], true),
            (vec![(50..150).collect()], (0..70).collect::<Vec<_>>(), false),
        ] {
            let found = some.products(&strips, &with, own, &picked);
            for (strip, found) in strips.iter().zip(&found) {
                let beside: Vec<usize> = if own { [with.as_slice(), strip].concat() } else { with.clone() };
                assert_eq!(found.shape(), (strip.len(), beside.len()));
                for (i, a) in strip.iter().enumerate() {
                    for (j, b) in beside.iter().enumerate() {
                        assert_eq!(found[(i, j)].to_bits(), all[(*a, *b)].to_bits(), "{a} {b}");
                    }
                }
            }
        }
        let square = |c: usize| picked.iter().map(|i| whole[c][*i].powi(2)).sum::<f64>() / picked.len() as f64;
        let wanted: Vec<u64> = (0..150).map(|c| square(c).to_bits()).collect();
        let found: Vec<u64> = mean_squares(&some, &picked).into_iter().map(f64::to_bits).collect();
        assert_eq!(found, wanted);
    }

    #[test]
    fn products_in_tiles_are_those_of_whole_columns() {
        let wave = |c: usize, i: usize| (0.37 * (i * (c + 1)) as f64).sin() + 0.01 * c as f64;
        for (count, rows) in [(1, 5), (3, 700), (70, 256), (150, 263), (64, 264), (130, 1000), (7, 0)] {
            let columns: Vec<Vec<f64>> = (0..count).map(|c| (0..2 * rows).map(|i| wave(c, i)).collect()).collect();
            // Every other row.
            let picked: Vec<usize> = (0..rows).map(|r| 2 * r).collect();
            let found = gram(&columns, &picked);
            for i in 0..count {
                for j in 0..count {
                    let sum: f64 = picked.iter().map(|r| columns[i][*r] * columns[j][*r]).sum();
                    assert!((found[(i, j)] - sum).abs() < 1e-9 * (1.0 + rows as f64), "{count} {rows}: {i} {j}");
                    assert_eq!(found[(i, j)].to_bits(), found[(j, i)].to_bits());
                }
            }
        }
    }

    #[test]
    fn products_with_columns_that_were_there_are_taken_over_and_the_others_made() {
        let wave = |c: usize, i: usize| (0.37 * (i * (c + 1)) as f64).sin() + 0.01 * c as f64;
        let column = |c: usize| -> Vec<f64> { (0..900).map(|i| wave(c, i)).collect() };
        let picked: Vec<usize> = (0..900).filter(|i| i % 3 != 1).collect();
        for (had, now) in [
            ((0..90).collect::<Vec<_>>(), (0..150).rev().collect::<Vec<_>>()),
            (vec![3, 1, 2], vec![1, 7, 3]),
            (vec![0], vec![1, 2]),
            (vec![5, 6], vec![6, 5]),
        ] {
            let from: Vec<Option<usize>> = now.iter().map(|c| had.iter().position(|h| h == c)).collect();
            let columns: Vec<Vec<f64>> = now.iter().map(|c| column(*c)).collect();
            let before = gram(&had.iter().map(|c| column(*c)).collect::<Vec<_>>(), &picked);
            let (found, anew) = (more(&columns, &picked, &before, &from), gram(&columns, &picked));
            assert!((&found - &anew).abs().max() < 1e-9, "{had:?} {now:?}");
            assert!(found == found.transpose());
            // Known products are not computed again.
            let wrong = DMatrix::from_element(had.len(), had.len(), 7.0);
            let taken = more(&columns, &picked, &wrong, &from);
            let known = |i: usize, j: usize| from[i].is_some() && from[j].is_some();
            let places = || (0..now.len()).flat_map(|i| (0..now.len()).map(move |j| (i, j)));
            assert!(places().all(|(i, j)| known(i, j) == (taken[(i, j)] == 7.0)), "{had:?} {now:?}");
        }
    }
}
