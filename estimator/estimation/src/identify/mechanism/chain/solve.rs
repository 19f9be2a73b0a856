//! One regression over all joints of all recordings at one cut-off, and the row of cut-offs that are tried.

use super::joints::{JointRows, Joints};
use crate::identify::mechanism::regress::WEIGHTING_ROUNDS;
use crate::regression::linear::{LinearFit, least_squares};
use foundation::estimate::EstimateError;
use haptics::law::object::TWO_LINK;

/// Indices of the parameters that must not depend on the cut-off: inertias and gravity. The model is least true for
/// friction.
/// Derived: positions in [`TWO_LINK`].
pub const FIRM: [usize; 5] = [0, 1, 2, 4, 5];
/// Indices of the Coulomb friction of each joint.
/// Derived: positions in [`TWO_LINK`].
const DRY: [usize; 2] = [7, 9];
/// Ratio of a cut-off to the one below it.
/// Derived: half an octave, √2.
const CUTOFF_STEP: f64 = std::f64::consts::SQRT_2;
/// Lowest cut-off, as a share of the frequency of the motion.
/// Choice: no case of the ablation reads it.
const BELOW_MOTION: f64 = 0.5;
/// Highest cut-off, as a share of that of the light filter.
/// Choice: no case of the ablation reads it.
const BELOW_LIGHT: f64 = 1.0 / 3.0;

/// One row of the regression.
#[derive(Clone, Debug)]
pub struct Row {
    /// Index of the recording.
    pub recording: usize,
    /// Index of the joint, from 0.
    pub joint: usize,
    /// Place in the recording, 0 … 1.
    pub place: f64,
    /// The model's columns.
    pub columns: [f64; TWO_LINK.len()],
    /// Torque, N m.
    pub torque: f64,
    doubt: f64,
}

/// The answer at one cut-off.
pub struct Solution {
    /// Cut-off of the filter, Hz.
    pub cutoff_hz: f64,
    /// Values, the model's first, then the torques' zeros.
    pub fit: LinearFit,
    /// Rows, in the order of the fit's residuals.
    pub rows: Vec<Row>,
    /// Index of the zero's regressor for each recording and joint; `None` without rows.
    zeros: Vec<[Option<usize>; 2]>,
}

impl Solution {
    /// The torque of a row by this solution, N m.
    pub fn predicted_nm(&self, row: &Row) -> f64 {
        let zero = self.zeros[row.recording][row.joint].map_or(0.0, |k| self.fit.values[k]);
        row.columns.iter().zip(&self.fit.values).map(|(c, v)| c * v).sum::<f64>() + zero
    }

    /// Sum of the squares of the relative differences of the firm values.
    pub fn changes(&self, other: &Self) -> f64 {
        let change = |k: &usize| (other.fit.values[*k] / self.fit.values[*k] - 1.0).powi(2);
        finite(FIRM.iter().map(change).sum())
    }

    /// Sum of the squares of their relative errors.
    pub fn scatter(&self) -> f64 {
        finite(FIRM.iter().map(|k| (self.fit.std_errors[*k] / self.fit.values[*k]).powi(2)).sum())
    }
}

fn finite(value: f64) -> f64 {
    if value.is_finite() { value } else { f64::MAX }
}

/// Solutions at all cut-offs, lowest first.
pub fn tried(pieces: &[Joints], held: &[[bool; 2]]) -> Result<Vec<Solution>, EstimateError> {
    let mut motion: Vec<f64> = pieces.iter().map(Joints::motion_hz).collect();
    motion.sort_by(f64::total_cmp);
    let lowest = BELOW_MOTION * motion.get(motion.len() / 2).copied().unwrap_or(1.0);
    let highest = BELOW_LIGHT * pieces.iter().map(|p| p.light_hz).fold(f64::INFINITY, f64::min);
    let ladder = std::iter::successors(Some(lowest), |c| Some(c * CUTOFF_STEP)).take_while(|c| *c <= highest);
    ladder.map(|cutoff_hz| solve(pieces, held, cutoff_hz, |_| true)).collect()
}

/// Solves for the rows that are kept; each joint of each recording counts by how well it is met, and less where it may stick.
pub fn solve(
    pieces: &[Joints],
    held: &[[bool; 2]],
    cutoff_hz: f64,
    kept: impl Fn(&Row) -> bool,
) -> Result<Solution, EstimateError> {
    let mut rows = Vec::new();
    for piece in pieces {
        for joint in (0..2).filter(|j| !held[piece.recording][*j]) {
            rows.extend(in_rows(piece.recording, &piece.rows(joint, cutoff_hz)).filter(&kept));
        }
    }
    let mut zeros = vec![[None; 2]; held.len()];
    let mut count = TWO_LINK.len();
    for row in &rows {
        let zero = &mut zeros[row.recording][row.joint];
        if zero.is_none() {
            *zero = Some(count);
            count += 1;
        }
    }
    let mut columns: Vec<Vec<f64>> = (0..TWO_LINK.len()).map(|k| rows.iter().map(|r| r.columns[k]).collect()).collect();
    columns.resize(count, vec![0.0; rows.len()]);
    for (i, row) in rows.iter().enumerate() {
        if let Some(k) = zeros[row.recording][row.joint] {
            columns[k][i] = 1.0;
        }
    }
    let torque: Vec<f64> = rows.iter().map(|r| r.torque).collect();
    let mut fit = least_squares(&columns, &torque, None)?;
    for _ in 0..WEIGHTING_ROUNDS {
        let weights = weights(&rows, &fit, &zeros, count);
        fit = least_squares(&columns, &torque, Some(&weights))?;
    }
    Ok(Solution { cutoff_hz, fit, rows, zeros })
}

fn in_rows(recording: usize, rows: &JointRows) -> impl Iterator<Item = Row> + '_ {
    (0..rows.torque.len()).map(move |i| Row {
        recording,
        joint: rows.joint,
        place: rows.place[i],
        columns: std::array::from_fn(|k| rows.columns[k][i]),
        torque: rows.torque[i],
        doubt: rows.doubt[i],
    })
}

/// One over the variance of a row: of its recording and joint, and of the friction that may be missing.
fn weights(rows: &[Row], fit: &LinearFit, zeros: &[[Option<usize>; 2]], count: usize) -> Vec<f64> {
    let mut sums = vec![(0.0, 0.0); count];
    let group = |row: &Row| zeros[row.recording][row.joint].unwrap_or(0);
    for (row, residual) in rows.iter().zip(&fit.residuals) {
        let sum = &mut sums[group(row)];
        *sum = (sum.0 + residual * residual, sum.1 + 1.0);
    }
    let total: (f64, f64) = sums.iter().fold((0.0, 0.0), |a, b| (a.0 + b.0, a.1 + b.1));
    // No joint is met so well that it alone would count.
    let least = 1e-3 * total.0 / f64::max(total.1, 1.0);
    rows.iter()
        .map(|row| {
            let (sum, n) = sums[group(row)];
            let missing = row.doubt * fit.values[DRY[row.joint]].powi(2);
            1.0 / ((sum / n).max(least) + missing).max(f64::MIN_POSITIVE)
        })
        .collect()
}
