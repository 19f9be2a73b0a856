//! Whitened normal equations of all regressors, one set per block: every fit, comparison and cross-validation is
//! then a small solve.

use super::gram;
use super::gram::{Weighed, gram, mean_squares};
use super::layout::{Held, Layout, Use};
use super::noise_model::Whitening;
use crate::diagnose::data::limits::FEWEST;
use crate::diagnose::hypotheses::candidate::Candidate;
use nalgebra::{Cholesky, DMatrix, DVector, Dyn};
use std::collections::HashMap;
use std::ops::Range;

/// Least number of rows of a block.
/// Choice: halved, 5 of 89 answers change; doubled, 9 of 89 answers change (1 to right).
pub(crate) const LEAST_BLOCK: usize = 12;
/// Largest number of blocks.
/// Choice: halved, 36 of 90 answers change (1 to wrong, 1 to right); doubled, 38 of 89 answers change (1 to wrong, 3 to right).
pub(crate) const MOST_BLOCKS: usize = 20;
/// Every so many-th block is locked: it is used for the gain only.
/// Choice: halved, 44 of 90 answers change (1 to wrong, 2 to right); doubled, 30 of 90 answers change (1 to right).
pub(crate) const LOCKED_EVERY: usize = 4;
/// Guard time beside a locked block, s: rows within it are not used.
/// Choice: halved, 14 of 89 answers change (1 to wrong); doubled, 20 of 89 answers change (1 to wrong, 1 to right).
const GUARD_S: f64 = 0.1;
/// Rounding error of sums over the rows.
/// Derived: far above the rounding of a sum of ones (1e-16 times the rows) and far below one row.
pub(crate) const ROUNDING: f64 = 1e-6;
/// Least remaining share of a column's power. Below it, no remaining row determines the coefficient.
/// Choice: halved, 1 of 90 answers change (1 to right); doubled, 1 of 90 answers change.
pub(crate) const LEAST_LEFT: f64 = 0.3;
/// Ridge of scaled normal equations, which keeps them regular for equal columns.
/// Derived: far above the rounding of a scaled sum of squares (1e-16) and far below the distinct share of any regressor.
pub(crate) const NUMERICAL_RIDGE: f64 = 1e-10;
/// Folds of the cross-validation.
/// Choice: halved, 3 of 90 answers change; doubled, 2 of 90 answers change.
pub const FOLDS: usize = 5;

/// Use of each row: blocks of the rows that may be held out.
pub fn uses(layout: &Layout) -> Vec<Use> {
    let mut testable: Vec<usize> = (0..layout.rows()).filter(|i| layout.held[*i] != Held::Never).collect();
    testable.sort_by(|a, b| layout.time_s[*a].total_cmp(&layout.time_s[*b]));
    // Single observations (a blow, not a sample of a motion) are independent of their neighbours.
    let is_alone = layout.segment.windows(2).all(|pair| pair[0] != pair[1]);
    // Blocks have equal information, not equal numbers of rows. A block of a stick phase tests nothing, and without the
    // only moving block nothing can be trained.
    let mut said = 0.0;
    let before: Vec<f64> = testable
        .iter()
        .map(|i| {
            let own = if layout.may_stand { layout.weight[*i].powi(2) } else { 1.0 };
            said += own;
            said - own
        })
        .collect();
    let least = if is_alone { FEWEST } else { LEAST_BLOCK };
    let most = ((said + ROUNDING) as usize / FEWEST).clamp(1, MOST_BLOCKS);
    let blocks = (testable.len() / least).clamp(1, most);
    let guard = if is_alone { 0 } else { (GUARD_S / layout.period_s).round().max(1.0) as usize };
    let block_of = |k: usize| ((before[k] * blocks as f64 / said.max(1e-300)) as usize).min(blocks - 1);
    let locked = |block: usize| blocks >= LOCKED_EVERY && block % LOCKED_EVERY == LOCKED_EVERY - 1;
    let mut uses = vec![Use::Always; layout.rows()];
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
            if layout.held[i] == Held::Fully { Use::Locked(block) } else { Use::Beside(block) }
        } else {
            let near = |other: Option<usize>| other.is_some_and(|j| j < testable.len() && locked(block_of(j)));
            if near(k.checked_sub(guard)) || near(Some(k + guard)) { Use::Guard } else { Use::Fold(fold_of[block]) }
        };
    }
    uses
}

/// Normal equations of all regressors and the target, which comes last.
pub struct System {
    /// Normal equations of the training rows.
    pub train: DMatrix<f64>,
    pub rows: f64,
    /// Normal equations of each fold, and its number of rows.
    pub folds: Vec<(DMatrix<f64>, f64)>,
    /// Index ranges of the candidates' regressors.
    pub places: Vec<Range<usize>>,
    pub base: usize,
    /// Regressors of the base model that can only resist: a negative coefficient is no explanation.
    pub resisting: Vec<usize>,
    /// Jackknife block of each row, for several block lengths; empty if the rows have no common blocks.
    pub pieces: Vec<Vec<usize>>,
    pub coefficients: Vec<f64>,
    pub uses: Vec<Use>,
    /// Mean square of each regressor over all rows, for the support guard.
    pub(crate) energy: Vec<(f64, f64)>,
    /// Products over the rows that always train.
    pub(crate) always: DMatrix<f64>,
    /// All regressors, for the products with those of a later system.
    pub(crate) whitened: Vec<Vec<f64>>,
}

/// Part of an earlier system that is used again.
struct Known {
    system: System,
    /// Index of each regressor in it.
    from: Vec<Option<usize>>,
}

/// All regressors in the order of a system, the target last.
pub(crate) fn columns_of<'a>(base: &'a [Vec<f64>], candidates: &'a [Candidate], y: &'a [f64]) -> Vec<&'a [f64]> {
    let of_candidates = candidates.iter().flat_map(|c| &c.regressors);
    base.iter().chain(of_candidates.map(|column| &**column)).map(Vec::as_slice).chain([y]).collect()
}

/// Index in `had` of the column that is equal to the bit; each of them is used once.
fn origins(columns: &[&[f64]], had: &[&[f64]]) -> Vec<Option<usize>> {
    let mark = |column: &[f64]| column.iter().fold(0_u64, |sum, v| sum.wrapping_add(v.to_bits()));
    let mut marks: HashMap<u64, Vec<usize>> = HashMap::new();
    had.iter().enumerate().for_each(|(h, column)| marks.entry(mark(column)).or_default().push(h));
    let same = |a: &[f64], b: &[f64]| a.len() == b.len() && a.iter().zip(b).all(|(a, b)| a.to_bits() == b.to_bits());
    let mut origin = |column: &&[f64]| {
        let marked = marks.get_mut(&mark(column))?;
        let place = marked.iter().position(|h| same(column, had[*h]))?;
        Some(marked.swap_remove(place))
    };
    columns.iter().map(&mut origin).collect()
}

/// Index range of each candidate's regressors, after those of the model.
pub(crate) fn places(base: usize, candidates: &[Candidate]) -> Vec<Range<usize>> {
    let mut end = base;
    let place = |candidate: &Candidate| {
        let start = end;
        end += candidate.regressors.len();
        start..end
    };
    candidates.iter().map(place).collect()
}

/// Effective number of observations: a row of little weight counts as less than one.
pub(crate) fn counted(picked: &[usize], layout: &Layout) -> f64 {
    picked.iter().map(|i| layout.weight[*i].powi(2)).sum::<f64>()
}

/// Mean square of each regressor over the training rows, from their products, and over all `whole` rows in use.
pub(crate) fn energy(train: &DMatrix<f64>, columns: &Weighed<'_>, uses: &[Use], whole: &[bool]) -> Vec<(f64, f64)> {
    // Rows that are neither fitted nor tested need no support.
    let is_looked_at = |i: &usize| whole[*i] && !matches!(uses[*i], Use::Guard | Use::Beside(_));
    let looked_at: Vec<usize> = (0..uses.len()).filter(is_looked_at).collect();
    let trained = looked_at.iter().filter(|i| !matches!(uses[**i], Use::Locked(_))).count().max(1) as f64;
    let all = mean_squares(columns, &looked_at).into_iter().enumerate();
    all.map(|(c, all)| (train[(c, c)] / trained, all)).collect()
}

/// A solved subset of the regressors.
#[derive(Clone, Debug)]
pub struct Solved {
    pub columns: Vec<usize>,
    pub values: Vec<f64>,
    /// Inverse of the normal matrix.
    pub inverse: DMatrix<f64>,
    /// Sum of the squared residuals.
    pub rss: f64,
}

impl Solved {
    /// Residual variance of one of this many rows.
    pub fn variance(&self, rows: f64) -> f64 {
        self.rss / (rows - self.columns.len() as f64).max(1.0)
    }

    /// Standard error of the i-th value, from this many rows.
    pub fn std_error(&self, i: usize, rows: f64) -> f64 {
        (self.variance(rows) * self.inverse[(i, i)]).sqrt()
    }
}

impl System {
    pub fn new(
        base: &[Vec<f64>],
        candidates: &[Candidate],
        y: &[f64],
        layout: &Layout,
        coefficients: Vec<f64>,
    ) -> Self {
        Self::build(columns_of(base, candidates, y), (base.len(), candidates), layout, coefficients, None)
    }

    /// A system of the same rows and weights as `had`, whitened alike: it takes known products of regressors from it.
    /// `had_columns`: all columns of that one.
    pub fn after(
        had: Self,
        had_columns: &[&[f64]],
        base: &[Vec<f64>],
        candidates: &[Candidate],
        y: &[f64],
        layout: &Layout,
    ) -> Self {
        let columns = columns_of(base, candidates, y);
        let coefficients = had.coefficients.clone();
        let known = (had.uses == uses(layout)).then(|| Known { from: origins(&columns, had_columns), system: had });
        Self::build(columns, (base.len(), candidates), layout, coefficients, known)
    }

    fn build(
        columns: Vec<&[f64]>,
        (base, candidates): (usize, &[Candidate]),
        layout: &Layout,
        coefficients: Vec<f64>,
        known: Option<Known>,
    ) -> Self {
        let uses = uses(layout);
        let white = Whitening::new(&layout.segment, &layout.weight, &coefficients);
        let whole = white.leaves();
        let (from, mut had) = known.map_or_else(|| (vec![None; columns.len()], None), |k| (k.from, Some(k.system)));
        let mut taken = |c: usize| Some(std::mem::take(&mut had.as_mut()?.whitened[from[c]?]));
        let columns: Vec<Vec<f64>> =
            columns.into_iter().enumerate().map(|(c, values)| taken(c).unwrap_or_else(|| white.of(values))).collect();
        let pick = |wanted: &dyn Fn(Use) -> bool| -> Vec<usize> {
            (0..layout.rows()).filter(|i| whole[*i] && wanted(uses[*i])).collect()
        };
        let products = |part: &dyn Fn(&System) -> &DMatrix<f64>, picked: &[usize]| match &had {
            Some(had) => gram::more(&columns, picked, part(had), &from),
            None => gram(&columns, picked),
        };
        let counted = |picked: &[usize]| counted(picked, layout);
        let picked = pick(&|u| u == Use::Always);
        let always = products(&|had| &had.always, &picked);
        let mut train = always.clone();
        let mut count = counted(&picked);
        let mut folds = Vec::new();
        for fold in 0..FOLDS {
            let picked = pick(&|u| u == Use::Fold(fold));
            let part = products(&|had| &had.folds[fold].0, &picked);
            train += &part;
            count += counted(&picked);
            folds.push((part, counted(&picked)));
        }
        let slices: Vec<&[f64]> = columns.iter().map(Vec::as_slice).collect();
        let all_alike = vec![1.0; layout.rows()];
        let energy = energy(&train, &Weighed { columns: &slices, weight: &all_alike }, &uses, &whole);
        let places = places(base, candidates);
        Self {
            train,
            rows: count,
            folds,
            places,
            base,
            resisting: Vec::new(),
            pieces: Vec::new(),
            coefficients,
            uses,
            energy,
            always,
            whitened: columns,
        }
    }

    pub(crate) fn target(&self) -> usize {
        self.train.ncols() - 1
    }

    /// Takes the last columns of the base out by their posterior, given the prior precision of each coefficient relative
    /// to the noise's: Gram matrices become those of rows whose noise includes these columns. False if that fails.
    pub fn marginalize(&mut self, from: usize, precision: &[f64]) -> bool {
        let out = from..from + precision.len();
        let kept: Vec<usize> = (0..self.train.ncols()).filter(|c| !out.contains(c)).collect();
        let left = |gram: &DMatrix<f64>| -> Option<DMatrix<f64>> {
            let size = out.len();
            let mut own = gram.view((from, from), (size, size)).into_owned();
            (0..size).for_each(|i| own[(i, i)] += precision[i]);
            let beside = DMatrix::from_fn(size, kept.len(), |i, j| gram[(from + i, kept[j])]);
            let solved = own.cholesky()?.l_dirty().solve_lower_triangular(&beside)?;
            let mut rest = DMatrix::from_fn(kept.len(), kept.len(), |i, j| gram[(kept[i], kept[j])]);
            rest.gemm_tr(-1.0, &solved, &solved, 1.0);
            Some(rest)
        };
        let Some(train) = left(&self.train) else { return false };
        for (fold, _) in &mut self.folds {
            let Some(others) = left(&(&self.train - &*fold)) else { return false };
            *fold = &train - others;
        }
        self.always = train.clone();
        self.folds.iter().for_each(|(fold, _)| self.always -= fold);
        self.train = train;
        self.base = from;
        let shift = |place: &mut Range<usize>| *place = place.start - out.len()..place.end - out.len();
        self.places.iter_mut().for_each(shift);
        self.energy.drain(out.clone());
        self.whitened.drain(out);
        true
    }

    /// Columns of the base and of the chosen candidates.
    pub fn columns(&self, chosen: &[usize]) -> Vec<usize> {
        (0..self.base).chain(chosen.iter().flat_map(|c| self.places[*c].clone())).collect()
    }

    /// Indices of the values of the k-th of these candidates in a solution with them.
    pub fn own(&self, chosen: &[usize], k: usize) -> Range<usize> {
        let first = self.base + chosen[..k].iter().map(|c| self.places[*c].len()).sum::<usize>();
        first..first + self.places[chosen[k]].len()
    }

    /// True if the training rows contain enough of a candidate; otherwise it would be huge where it was not fitted.
    pub fn supported(&self, candidate: usize) -> bool {
        self.places[candidate]
            .clone()
            .all(|c| self.energy[c].0 > LEAST_LEFT * self.energy[c].1 && self.energy[c].1 > 0.0)
    }

    /// Least squares on the rows that train.
    pub fn solve(&self, chosen: &[usize]) -> Option<Solved> {
        solve(&self.train, &self.columns(chosen), self.target())
    }

    /// The values and the sum of the squared residuals alone of [`Self::solve`].
    pub fn least(&self, chosen: &[usize]) -> Option<(Vec<f64>, f64)> {
        let columns = self.columns(chosen);
        let (values, rss, _) = scaled(&self.train, &columns, self.target())?;
        Some((values, rss))
    }

    /// The same, but resisting regressors with a negative coefficient are left out.
    pub fn least_sound(&self, chosen: &[usize]) -> Option<(Vec<f64>, f64)> {
        let (mut values, mut rss) = self.least(chosen)?;
        let mut columns = self.columns(chosen);
        // A regressor left out stays out: the next removal rarely makes it admissible again.
        while let Some(k) =
            self.resisting.iter().find_map(|r| columns.iter().position(|c| c == r).filter(|k| values[*k] < 0.0))
        {
            columns.remove(k);
            (values, rss, _) = scaled(&self.train, &columns, self.target())?;
        }
        let out: Vec<usize> = (0..self.base).filter(|c| !columns.contains(c)).collect();
        for c in out {
            values.insert(c, 0.0);
        }
        Some((values, rss))
    }

    /// Sum of squared errors on every fold by a fit to all the others.
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

    /// Share of a candidate's (whitened, training) regressors that the chosen ones do not explain: the least of them.
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

/// Least squares of column `target` on `columns`, from their Gram matrix.
pub fn solve(gram: &DMatrix<f64>, columns: &[usize], target: usize) -> Option<Solved> {
    let (values, rss, Scaled { cholesky, scale }) = scaled(gram, columns, target)?;
    let (p, inverse) = (columns.len(), cholesky.inverse());
    let inverse = DMatrix::from_fn(p, p, |i, j| inverse[(i, j)] / (scale[i] * scale[j]));
    Some(Solved { columns: columns.to_vec(), values, inverse, rss })
}

/// Scaled and factored normal equations.
pub(crate) struct Scaled {
    pub(crate) cholesky: Cholesky<f64, Dyn>,
    pub(crate) scale: Vec<f64>,
}

/// Factors the normal equations. A small ridge keeps them regular for equal columns.
pub(crate) fn factored(gram: &DMatrix<f64>, columns: &[usize]) -> Option<Scaled> {
    let p = columns.len();
    let scale: Vec<f64> =
        columns.iter().map(|c| gram[(*c, *c)].sqrt()).map(|s| if s > 0.0 { s } else { 1.0 }).collect();
    let normal = DMatrix::from_fn(p, p, |i, j| {
        gram[(columns[i], columns[j])] / (scale[i] * scale[j]) + if i == j { NUMERICAL_RIDGE } else { 0.0 }
    });
    Some(Scaled { cholesky: normal.cholesky()?, scale })
}

/// The values of [`solve`], the residual sum of squares, and the factors from which the errors follow.
pub(crate) fn scaled(gram: &DMatrix<f64>, columns: &[usize], target: usize) -> Option<(Vec<f64>, f64, Scaled)> {
    let made = factored(gram, columns)?;
    let right = DVector::from_fn(columns.len(), |i, _| gram[(columns[i], target)] / made.scale[i]);
    let found = made.cholesky.solve(&right);
    let values: Vec<f64> = (0..columns.len()).map(|i| found[i] / made.scale[i]).collect();
    let rss = squares(gram, columns, &values, target).max(1e-12 * gram[(target, target)]);
    Some((values, rss, made))
}

/// Residual sum of squares Σ (y − Σ value × column)².
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

    /// Blocks of rows of these weights, 50 a second.
    fn of(weight: &[f64]) -> Vec<Use> {
        let layout = Layout::of(vec![0; weight.len()], &vec![true; weight.len()], 0.02).weighted(weight.to_vec());
        uses(&Layout { may_stand: true, ..layout })
    }

    #[test]
    fn rows_that_say_as_much_are_held_out_in_blocks_of_as_many() {
        let found = of(&[1.0; 600]);
        let locked = |block: usize| found.iter().filter(|u| **u == Use::Locked(block)).count();
        assert_eq!([3, 7, 11, 15, 19].map(locked), [30; 5]);
        let folds: Vec<usize> = (0..FOLDS).map(|f| found.iter().filter(|u| **u == Use::Fold(f)).count()).collect();
        assert!(folds.iter().all(|n| (70..=90).contains(n)), "{folds:?}");
    }

    #[test]
    fn something_that_stands_for_most_of_the_time_still_trains_on_motion_whatever_is_held_out() {
        // Motion during two of thirty seconds.
        let weight: Vec<f64> = (0..1500).map(|i| if (700..800).contains(&i) { 1.0 } else { 0.01 }).collect();
        let found = of(&weight);
        let said = |wanted: &dyn Fn(Use) -> bool| {
            let rows = weight.iter().zip(&found).filter(|(_, u)| wanted(**u));
            rows.map(|(w, _)| w * w).sum::<f64>()
        };
        for fold in 0..FOLDS {
            let share = said(&|u| u == Use::Fold(fold)) / said(&|u| matches!(u, Use::Fold(_)));
            assert!((0.08..0.4).contains(&share), "fold {fold}: {share}");
        }
        assert!(said(&|u| matches!(u, Use::Locked(_))) > 15.0, "what is locked has to tell something");
    }

    #[test]
    fn what_resists_is_nothing_rather_than_less_than_nothing() {
        let x: Vec<f64> = (0..600).map(|i| (0.1 * f64::from(i)).sin()).collect();
        let least = |slope: f64| {
            let y: Vec<f64> = x.iter().map(|x| 2.0 + slope * x).collect();
            let layout = Layout { may_stand: true, ..Layout::of(vec![0; 600], &[true; 600], 0.02) };
            let mut system = System::new(&[x.clone(), vec![1.0; 600]], &[], &y, &layout, Vec::new());
            system.resisting = vec![0];
            let [plain, sound] = [system.least(&[]), system.least_sound(&[])].map(|found| found.expect("solved"));
            (plain, sound)
        };
        let ((plain, _), (sound, _)) = least(3.0);
        assert!((sound[0] - 3.0).abs() < 1e-6 && sound == plain, "{sound:?}");
        let ((plain, rss), (sound, more)) = least(-3.0);
        assert!((plain[0] + 3.0).abs() < 1e-6 && sound[0] == 0.0 && (sound[1] - 2.0).abs() < 0.2, "{sound:?}");
        assert!(more > rss + 100.0, "{more} after {rss}");
    }
}
