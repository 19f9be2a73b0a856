//! Products of columns, which a comparison spends much of its time on.

use nalgebra::DMatrix;

/// Rows that are multiplied at a time (a block of the product's own, so that sums are what they were), and the fewest: a handful would be
/// multiplied in another way. Columns at a time.
const TILE: usize = 256;
const LEAST_TILE: usize = 8;
const PANEL: usize = 64;

/// Products of all columns with each other, summed over the picked rows. As products of matrices, not column by column: several times as
/// fast. Tile by tile, which stay in the cache, and on one side of the diagonal only: the other is the same.
pub fn gram(columns: &[Vec<f64>], picked: &[usize]) -> DMatrix<f64> {
    let all: Vec<usize> = (0..columns.len()).collect();
    let mut gram = DMatrix::zeros(columns.len(), columns.len());
    add(&mut gram, (columns, &all), 0, picked);
    gram.fill_upper_triangle_with_lower_triangle();
    gram
}

/// The same where many columns were there before: `had` are their products over the same rows, `from` which of them each column was.
pub fn more(columns: &[Vec<f64>], picked: &[usize], had: &DMatrix<f64>, from: &[Option<usize>]) -> DMatrix<f64> {
    // Those that were there first.
    let (old, new): (Vec<usize>, Vec<usize>) = (0..columns.len()).partition(|c| from[*c].is_some());
    let order = [old.as_slice(), new.as_slice()].concat();
    let mut sorted = DMatrix::zeros(columns.len(), columns.len());
    add(&mut sorted, (columns, &order), old.len(), picked);
    let mut place = vec![0; columns.len()];
    order.iter().enumerate().for_each(|(k, c)| place[*c] = k);
    DMatrix::from_fn(columns.len(), columns.len(), |i, j| match (from[i], from[j]) {
        (Some(a), Some(b)) => had[(a, b)],
        // Below the diagonal, or beside it.
        _ => sorted[(place[i].max(place[j]), place[i].min(place[j]))],
    })
}

/// Whether increasing numbers follow each other without a gap.
fn is_run(rows: &[usize]) -> bool {
    rows.first().zip(rows.last()).is_some_and(|(first, last)| last - first + 1 == rows.len())
}

/// Adds the products of columns in this order: of those from number `first` on, with each other and all before, below the diagonal.
fn add(sum: &mut DMatrix<f64>, (columns, order): (&[Vec<f64>], &[usize]), first: usize, picked: &[usize]) {
    let count = order.len();
    let mut tile = DMatrix::zeros(TILE + LEAST_TILE, count);
    let mut turned = DMatrix::zeros(count - first, TILE + LEAST_TILE);
    let panels = (count - first).div_ceil(PANEL).max(1);
    let bound = |panel: usize| first + panel * (count - first) / panels;
    let mut rest = picked;
    while !rest.is_empty() && first < count {
        let (rows, later) = rest.split_at(if rest.len() < TILE + LEAST_TILE { rest.len() } else { TILE });
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
            // What was known is not made again.
            let wrong = DMatrix::from_element(had.len(), had.len(), 7.0);
            let taken = more(&columns, &picked, &wrong, &from);
            let known = |i: usize, j: usize| from[i].is_some() && from[j].is_some();
            let places = || (0..now.len()).flat_map(|i| (0..now.len()).map(move |j| (i, j)));
            assert!(places().all(|(i, j)| known(i, j) == (taken[(i, j)] == 7.0)), "{had:?} {now:?}");
        }
    }
}
