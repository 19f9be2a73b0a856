//! Parameters that are not the same throughout a recording: another gain or sign of its force, another load, or a
//! defect of the mechanism from some time on.

use super::parameters::{Known, Term};
use super::regress::System;
use super::signals::Piece;
use crate::agreement::SHORTER;
use crate::identify::limits::{LEAST_FIT_ROWS, ROUNDING, SIGNIFICANT};
use nalgebra::{DMatrix, DVector};

/// A change between two parts of a recording.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Change {
    /// Time of the first row after it, s.
    pub time_s: f64,
    /// Root mean square of the residual of one fit, and of two, before and after the change, N or N m.
    pub rms: [f64; 2],
    /// Force after the change in forces of the fit before it, if this factor takes as much of the residual.
    pub gain: Option<f64>,
}

/// Sums of one part of a recording: normal matrix and vector, and weighted power of the target.
#[derive(Clone)]
struct Sums {
    normal: DMatrix<f64>,
    vector: DVector<f64>,
    power: f64,
}

impl Sums {
    fn of(system: &System, weights: &[f64], scales: &[f64], rows: std::ops::Range<usize>) -> Self {
        let p = system.columns.len();
        let mut sums = Self { normal: DMatrix::zeros(p, p), vector: DVector::zeros(p), power: 0.0 };
        for i in rows {
            let row = DVector::from_fn(p, |j, _| system.columns[j][i] * scales[j]);
            sums.normal.ger(weights[i], &row, &row, 1.0);
            sums.vector.axpy(weights[i] * system.target[i], &row, 1.0);
            sums.power += weights[i] * system.target[i].powi(2);
        }
        sums
    }

    fn plus(mut self, other: &Self, sign: f64) -> Self {
        self.normal += sign * &other.normal;
        self.vector += sign * &other.vector;
        self.power += sign * other.power;
        self
    }

    /// Fitted values, and the power that they leave. `None` if the motion does not tell them apart.
    fn solve(&self) -> Option<(DVector<f64>, f64)> {
        let values = self.normal.clone().cholesky()?.solve(&self.vector);
        let left = self.power - values.dot(&self.vector);
        Some((values, left.max(0.0)))
    }
}

/// The change between two parts of one recording, if one fit of these terms leaves three times the residual of two. If the power of two
/// fits were half, 26 of 480 mechanisms with structured error had a change, because their friction or zero wanders; so, 2 of 960 have.
/// A spring takes part, as beside the other defects.
pub fn change(pieces: &[Piece], terms: &[Term], known: &Known) -> Option<Change> {
    let terms: Vec<Term> = terms.iter().copied().chain([Term::Spring]).collect();
    let system = System::stack(pieces, &terms, known, Piece::applied_force);
    let time_s = System::stack(pieces, &[], &Known::default(), |piece| piece.times_s().collect()).target;
    let rows = time_s.len();
    // Each side of a cut has two parts at least: a shorter one does not disagree.
    let parts = 2 * SHORTER;
    if rows < parts * LEAST_FIT_ROWS {
        return None;
    }
    let fit = system.solve().ok()?;
    let weights = system.weights(&fit).unwrap_or_else(|| vec![1.0; rows]);
    let scale = |column: &Vec<f64>| column.iter().map(|c| c * c).sum::<f64>().sqrt().max(f64::MIN_POSITIVE).recip();
    let scales: Vec<f64> = system.columns.iter().map(scale).collect();
    let start = |part: usize| part * rows / parts;
    let mut whole = Sums::of(&system, &weights, &scales, 0..0);
    let mut before = Vec::new();
    for part in 0..parts {
        whole = whole.plus(&Sums::of(&system, &weights, &scales, start(part)..start(part + 1)), 1.0);
        before.push(whole.clone());
    }
    let (_, of_one) = whole.solve()?;
    let cuts = (1..parts - 2).filter_map(|part| {
        let after = whole.clone().plus(&before[part], -1.0);
        let ((first, left), (_, right)) = (before[part].solve()?, after.solve()?);
        Some((start(part + 1), first, after, left + right))
    });
    let (row, first, after, of_two) = cuts.min_by(|a, b| a.3.total_cmp(&b.3))?;
    let is_enough = |left: f64| SIGNIFICANT.powi(2) * left < of_one;
    if !is_enough(of_two) || of_one <= ROUNDING.powi(2) * whole.power {
        return None;
    }
    // The target after the change as a multiple of the first fit.
    let own = (&after.normal * &first).dot(&first);
    let gain = first.dot(&after.vector) / own;
    let by_gain = after.power - gain * first.dot(&after.vector);
    let of_before = before.iter().zip(1..).find(|(_, part)| start(*part) == row)?.0.solve()?.1;
    let gain = (is_enough(of_before + by_gain) && by_gain < 2.0 * after.solve()?.1).then_some(gain);
    let total: f64 = weights.iter().sum();
    Some(Change { time_s: time_s[row], rms: [of_one, of_two].map(|power| (power / total).sqrt()), gain })
}
