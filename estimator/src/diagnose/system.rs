//! Whitened normal equations of all columns, block by block: every fit, comparison and cross-validation is then a small solve.

use super::candidate::Candidate;
use nalgebra::{DMatrix, DVector};

/// Highest order of the whitening autoregression.
const LARGEST_ORDER: usize = 6;
/// Rows of a block are this many at least, and there are this many blocks at most.
const LEAST_BLOCK: usize = 12;
const MOST_BLOCKS: usize = 20;
/// Every so many-th block is locked: it takes part in the gain only.
const LOCKED_EVERY: usize = 4;
/// Rows so close to a locked block take no part, s.
const GUARD_S: f64 = 0.1;
/// Rows that are multiplied at a time (a block of the product's own, so that sums are what they were), and the fewest: a handful would be
/// multiplied in another way. Columns at a time.
const TILE: usize = 256;
const LEAST_TILE: usize = 8;
const PANEL: usize = 64;
/// Folds of the cross-validation.
pub const FOLDS: usize = 5;

/// Rows as the system sees them.
pub struct Rows<'a> {
    pub y: &'a [f64],
    /// Rows of one number follow each other without a gap.
    pub stretch: &'a [usize],
    /// Rows that may be held out; the others always train.
    pub testable: &'a [Held],
    /// When each row was, s: what belongs together is held out together.
    pub time_s: &'a [f64],
    /// Weight of each row, 0 … 1: what its noise is smaller by.
    pub weight: &'a [f64],
    pub period_s: f64,
}

/// Whether a row may be held out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Held {
    /// It trains always.
    Never,
    /// Folds test it. It is another quantity than the force: locked blocks test it for what it is about alone.
    ByFolds,
    /// Folds test it, and locked blocks.
    Fully,
}

/// What a row is used for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Use {
    /// Trains always.
    Always,
    /// Trains, and is tested by the fold of this number.
    Fold(usize),
    /// Tests only; the number of its block.
    Locked(usize),
    /// The same for a row of [`Held::ByFolds`]: only the gain of what such rows are about is tested by it.
    Beside(usize),
    /// Beside a locked block.
    Guard,
}

/// Blocks of the rows that may be held out.
pub fn uses(rows: &Rows<'_>) -> Vec<Use> {
    let mut testable: Vec<usize> = (0..rows.y.len()).filter(|i| rows.testable[*i] != Held::Never).collect();
    testable.sort_by(|a, b| rows.time_s[*a].total_cmp(&rows.time_s[*b]));
    let blocks = (testable.len() / LEAST_BLOCK).clamp(1, MOST_BLOCKS);
    let guard = (GUARD_S / rows.period_s).round().max(1.0) as usize;
    let block_of = |k: usize| k * blocks / testable.len();
    let locked = |block: usize| blocks >= LOCKED_EVERY && block % LOCKED_EVERY == LOCKED_EVERY - 1;
    let mut uses = vec![Use::Always; rows.y.len()];
    let mut open = 0;
    let mut fold_of = vec![0; blocks];
    for (block, fold) in fold_of.iter_mut().enumerate() {
        if !locked(block) {
            *fold = open % FOLDS;
            open += 1;
        }
    }
    for (k, &i) in testable.iter().enumerate() {
        let block = block_of(k);
        uses[i] = if locked(block) {
            if rows.testable[i] == Held::Fully { Use::Locked(block) } else { Use::Beside(block) }
        } else {
            let near = |other: Option<usize>| other.is_some_and(|j| j < testable.len() && locked(block_of(j)));
            if near(k.checked_sub(guard)) || near(Some(k + guard)) { Use::Guard } else { Use::Fold(fold_of[block]) }
        };
    }
    uses
}

/// Autoregression that whitens a residual: coefficients of the lags from 1 on, chosen by BIC.
pub fn whitener(residual: &[f64], rows: &Rows<'_>, used: &[Use]) -> Vec<f64> {
    let trains = |i: usize| matches!(used[i], Use::Always | Use::Fold(_));
    let mut lags = [0.0; LARGEST_ORDER + 1];
    let mut count = 0.0_f64;
    for i in 0..residual.len() {
        if !trains(i) {
            continue;
        }
        count += 1.0;
        for (lag, sum) in lags.iter_mut().enumerate() {
            if i >= lag && rows.stretch[i - lag] == rows.stretch[i] && trains(i - lag) {
                *sum += residual[i] * residual[i - lag];
            }
        }
    }
    if lags[0] <= 0.0 || count < 40.0 {
        return Vec::new();
    }
    // Levinson's recursion.
    let (mut coefficients, mut innovation): (Vec<f64>, f64) = (Vec::new(), lags[0]);
    let mut best = (count * innovation.ln(), Vec::new());
    for order in 1..lags.len() {
        let predicted: f64 = coefficients.iter().zip(lags[1..order].iter().rev()).map(|(a, r)| a * r).sum();
        let reflection = ((lags[order] - predicted) / innovation).clamp(-0.999, 0.999);
        let before = coefficients.clone();
        for (a, b) in coefficients.iter_mut().zip(before.iter().rev()) {
            *a -= reflection * b;
        }
        coefficients.push(reflection);
        innovation *= 1.0 - reflection * reflection;
        let bic = count * innovation.ln() + order as f64 * count.ln();
        if bic < best.0 {
            best = (bic, coefficients.clone());
        }
    }
    best.1
}

/// A column through weights and whitening. The first rows of a stretch, whose past is unknown, are scaled to the same noise.
pub fn whiten(values: &[f64], rows: &Rows<'_>, coefficients: &[f64]) -> Vec<f64> {
    let weighted = |i: usize| values[i] * rows.weight[i];
    let mut out = vec![0.0; values.len()];
    let mut since = 0;
    for (i, whitened) in out.iter_mut().enumerate() {
        since = if i > 0 && rows.stretch[i] == rows.stretch[i - 1] { since + 1 } else { 0 };
        // Without its whole past a row is left out.
        if since < coefficients.len() {
            continue;
        }
        let past: f64 = coefficients.iter().enumerate().map(|(k, a)| a * weighted(i - k - 1)).sum();
        *whitened = weighted(i) - past;
    }
    out
}

/// Rows that whitening leaves something of.
fn whole(rows: &Rows<'_>, order: usize) -> Vec<bool> {
    let mut since = 0;
    (0..rows.y.len())
        .map(|i| {
            since = if i > 0 && rows.stretch[i] == rows.stretch[i - 1] { since + 1 } else { 0 };
            since >= order
        })
        .collect()
}

/// Normal equations of all columns and the target, which is the last one.
pub struct System {
    /// Of the rows that train.
    pub train: DMatrix<f64>,
    pub rows: f64,
    /// Of each fold, and how many rows it has.
    pub folds: Vec<(DMatrix<f64>, f64)>,
    /// Candidates' columns.
    pub places: Vec<std::ops::Range<usize>>,
    pub base: usize,
    pub coefficients: Vec<f64>,
    pub uses: Vec<Use>,
    /// Mean square of each column over all rows, for the support guard.
    energy: Vec<(f64, f64)>,
}

/// A solved subset of the columns.
#[derive(Clone, Debug)]
pub struct Solved {
    pub columns: Vec<usize>,
    pub values: Vec<f64>,
    /// Inverse of the normal matrix.
    pub inverse: DMatrix<f64>,
    /// Sum of the squared residuals.
    pub rss: f64,
}

impl System {
    pub fn new(base: &[Vec<f64>], candidates: &[Candidate], rows: &Rows<'_>, coefficients: Vec<f64>) -> Self {
        let uses = uses(rows);
        let whole = whole(rows, coefficients.len());
        let mut columns: Vec<Vec<f64>> = Vec::new();
        let mut places = Vec::new();
        let mut push = |values: &[f64]| columns.push(whiten(values, rows, &coefficients));
        for column in base {
            push(column);
        }
        let mut at = base.len();
        for candidate in candidates {
            for column in &candidate.columns {
                push(column);
            }
            places.push(at..at + candidate.columns.len());
            at += candidate.columns.len();
        }
        push(rows.y);
        let pick = |wanted: &dyn Fn(Use) -> bool| -> Vec<usize> {
            (0..rows.y.len()).filter(|i| whole[*i] && wanted(uses[*i])).collect()
        };
        // A row of little weight is less than one observation: it leaves as little as it says.
        let counted = |picked: &[usize]| picked.iter().map(|i| rows.weight[*i].powi(2)).sum::<f64>();
        let always = pick(&|u| u == Use::Always);
        let mut train = gram(&columns, &always);
        let mut count = counted(&always);
        let mut folds = Vec::new();
        for fold in 0..FOLDS {
            let picked = pick(&|u| u == Use::Fold(fold));
            let part = gram(&columns, &picked);
            train += &part;
            count += counted(&picked);
            folds.push((part, counted(&picked)));
        }
        // What is neither fitted nor tested needs no support.
        let looked_at = pick(&|u| !matches!(u, Use::Guard | Use::Beside(_)));
        let trained = looked_at.iter().filter(|i| !matches!(uses[**i], Use::Locked(_))).count();
        let energy = columns
            .iter()
            .enumerate()
            .map(|(c, values)| {
                let all = looked_at.iter().map(|i| values[*i].powi(2)).sum::<f64>() / looked_at.len().max(1) as f64;
                (train[(c, c)] / (trained.max(1) as f64), all)
            })
            .collect();
        Self { train, rows: count, folds, places, base: base.len(), coefficients, uses, energy }
    }

    fn target(&self) -> usize {
        self.train.ncols() - 1
    }

    /// Columns of the base and of the chosen candidates.
    pub fn columns(&self, chosen: &[usize]) -> Vec<usize> {
        (0..self.base).chain(chosen.iter().flat_map(|c| self.places[*c].clone())).collect()
    }

    /// Whether the rows that train see enough of a candidate: otherwise it would explode where it was not fitted.
    pub fn supported(&self, candidate: usize) -> bool {
        const LEAST_SHARE: f64 = 0.3;
        self.places[candidate]
            .clone()
            .all(|c| self.energy[c].0 > LEAST_SHARE * self.energy[c].1 && self.energy[c].1 > 0.0)
    }

    /// Least squares on the rows that train.
    pub fn solve(&self, chosen: &[usize]) -> Option<Solved> {
        solve(&self.train, &self.columns(chosen), self.target())
    }

    /// The sum of squared errors on every fold by a fit to all the others.
    pub fn cross_validate(&self, chosen: &[usize]) -> Option<Vec<f64>> {
        let mut all = self.columns(chosen);
        all.push(self.target());
        let small = |of: &DMatrix<f64>| DMatrix::from_fn(all.len(), all.len(), |i, j| of[(all[i], all[j])]);
        let whole = small(&self.train);
        let columns: Vec<usize> = (0..all.len() - 1).collect();
        self.folds
            .iter()
            .map(|(part, _)| {
                let part = small(part);
                let solved = solve(&(&whole - &part), &columns, columns.len())?;
                Some(squares(&part, &columns, &solved.values, columns.len()))
            })
            .collect()
    }

    /// Share of a candidate's (whitened, trained) columns that the chosen ones do not explain: the least of its columns.
    pub fn distinct(&self, candidate: usize, chosen: &[usize]) -> f64 {
        let columns = self.columns(chosen);
        self.places[candidate]
            .clone()
            .map(|c| {
                let own = self.train[(c, c)];
                match solve(&self.train, &columns, c) {
                    Some(solved) if own > 0.0 => (solved.rss / own).max(0.0),
                    _ => 0.0,
                }
            })
            .fold(1.0, f64::min)
    }
}

/// Products of all columns with each other, summed over the picked rows. As products of matrices, not column by column: several times as
/// fast. Tile by tile, which stay in the cache, and on one side of the diagonal only: the other is the same.
pub fn gram(columns: &[Vec<f64>], picked: &[usize]) -> DMatrix<f64> {
    let count = columns.len();
    let mut gram = DMatrix::zeros(count, count);
    let mut tile = DMatrix::zeros(TILE + LEAST_TILE, count);
    let panels = count.div_ceil(PANEL).max(1);
    let mut rest = picked;
    while !rest.is_empty() {
        let (rows, later) = rest.split_at(if rest.len() < TILE + LEAST_TILE { rest.len() } else { TILE });
        rest = later;
        for (mut tile, column) in tile.column_iter_mut().zip(columns) {
            for (value, row) in tile.iter_mut().zip(rows) {
                *value = column[*row];
            }
        }
        let across = tile.rows(0, rows.len()).transpose();
        for panel in 0..panels {
            let (first, end) = (panel * count / panels, (panel + 1) * count / panels);
            let part = tile.view((0, first), (rows.len(), end - first));
            let below = &across.rows(first, count - first);
            gram.view_mut((first, first), (count - first, end - first)).gemm(1.0, below, &part, 1.0);
        }
    }
    gram.fill_upper_triangle_with_lower_triangle();
    gram
}

/// Least squares of column `target` on `columns`, out of a matrix of all products. A breath of ridge keeps equal columns apart.
pub fn solve(gram: &DMatrix<f64>, columns: &[usize], target: usize) -> Option<Solved> {
    const RIDGE: f64 = 1e-10;
    let p = columns.len();
    let scale: Vec<f64> =
        columns.iter().map(|c| gram[(*c, *c)].sqrt()).map(|s| if s > 0.0 { s } else { 1.0 }).collect();
    let normal = DMatrix::from_fn(p, p, |i, j| {
        gram[(columns[i], columns[j])] / (scale[i] * scale[j]) + if i == j { RIDGE } else { 0.0 }
    });
    let right = DVector::from_fn(p, |i, _| gram[(columns[i], target)] / scale[i]);
    let cholesky = normal.cholesky()?;
    let scaled = cholesky.solve(&right);
    let inverse = cholesky.inverse();
    let values: Vec<f64> = (0..p).map(|i| scaled[i] / scale[i]).collect();
    let rss = squares(gram, columns, &values, target).max(1e-12 * gram[(target, target)]);
    let inverse = DMatrix::from_fn(p, p, |i, j| inverse[(i, j)] / (scale[i] * scale[j]));
    Some(Solved { columns: columns.to_vec(), values, inverse, rss })
}

/// Σ (y − Σ value × column)².
fn squares(gram: &DMatrix<f64>, columns: &[usize], values: &[f64], target: usize) -> f64 {
    let mut sum = gram[(target, target)];
    for (i, a) in columns.iter().zip(values) {
        sum -= 2.0 * a * gram[(*i, target)];
        for (j, b) in columns.iter().zip(values) {
            sum += a * b * gram[(*i, *j)];
        }
    }
    sum.max(0.0)
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
}
