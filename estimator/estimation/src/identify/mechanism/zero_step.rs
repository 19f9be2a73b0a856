//! Steps in the residual of the force: somebody zeroed the force sensor, or knocked it, in the middle of a recording.

use super::parameters::{Known, Term};
use super::regress::{System, WEIGHTING_ROUNDS};
use super::signals::Piece;
use crate::identify::limits::{LEAST_SEGMENT_ROWS, ROUNDING};
use nalgebra::{DMatrix, DVector};

/// Share of the residual's power that a defect takes at least. Structured errors that wander are not one step.
/// Source: the first step of a diagnosis (`force-step`) takes as much.
pub(super) const OF_POWER: f64 = 0.5;
/// Least share of a step that the model's own terms do not describe.
/// Choice: not varied. A step at an end, and one that goes with the place, have less.
const STEP_ALONE: f64 = 0.3;
/// A step: when, from the clock of the recording, and how large, N or N m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ZeroStep {
    /// Time of the first sample after the step, s.
    pub time_s: f64,
    /// Force after the step less that before it, N or N m.
    pub size: f64,
}

/// Force of some steps at a time, N or N m.
pub fn force_at(steps: &[ZeroStep], time_s: f64) -> f64 {
    steps.iter().filter(|step| time_s >= step.time_s).map(|step| step.size).sum()
}

/// Segments with these steps, and the root mean square of the residual of a fit of these terms beside them, N or N m; infinite
/// where there is none.
pub fn with_steps(steps: &[ZeroStep], pieces: &[Piece], terms: &[Term], known: &Known) -> (Vec<Piece>, f64) {
    let stepped = pieces.iter().map(|piece| Piece { zero_steps: steps.to_vec(), ..piece.clone() });
    let stepped: Vec<Piece> = stepped.collect();
    let terms: Vec<Term> = terms.iter().copied().chain([Term::ZeroStep]).collect();
    let fit = System::stack(&stepped, &terms, known, Piece::applied_force).solve();
    (stepped, fit.map_or(f64::INFINITY, |fit| fit.rms))
}

/// The steps in the residual of one recording's fit of these terms. Each takes half of the power that those before it
/// leave, and more than a straight drift does. A spring takes part, because a mechanism that goes over to another
/// place and stays there feels a step.
pub fn zero_steps(pieces: &[Piece], terms: &[Term], known: &Known) -> Vec<ZeroStep> {
    let system = System::stack(pieces, terms, known, Piece::applied_force);
    let mut steps = Vec::new();
    if system.target.len() < LEAST_SEGMENT_ROWS {
        return steps;
    }
    let time_s = System::stack(pieces, &[], &Known::default(), |piece| piece.times_s().collect()).target;
    // The weights follow from a fit that the steps spoil, so the next round takes them from the fit.
    let mut rest = system.clone();
    for _ in 0..WEIGHTING_ROUNDS {
        let weights = rest.solve().ok().and_then(|fit| rest.weights(&fit));
        steps = Scan::of(&system, &time_s, weights.unwrap_or_else(|| vec![1.0; time_s.len()])).steps();
        if steps.is_empty() {
            break;
        }
        let force = system.target.iter().zip(&time_s);
        rest.target = force.map(|(force, t)| force - force_at(&steps, *t)).collect();
    }
    steps
}

/// The weighted residual of one recording beside a model, to which steps are added.
#[derive(Clone)]
struct Scan<'a> {
    time_s: &'a [f64],
    weights: Vec<f64>,
    /// Orthonormal regressors of the model and of the steps found.
    own: Vec<DVector<f64>>,
    residual: DVector<f64>,
}

impl<'a> Scan<'a> {
    fn of(system: &System, time_s: &'a [f64], weights: Vec<f64>) -> Self {
        let place: Vec<f64> = system.motion.iter().map(|(position, _)| *position).collect();
        let columns: Vec<&Vec<f64>> = system.columns.iter().chain([&place]).collect();
        let of = |i: usize, j: usize| weights[i].sqrt() * columns.get(j).map_or(1.0, |column| column[i]);
        let own = DMatrix::from_fn(time_s.len(), columns.len() + 1, of).qr().q();
        let target = DVector::from_fn(time_s.len(), |i, _| weights[i].sqrt() * system.target[i]);
        let mut residual = &target - &own * own.tr_mul(&target);
        // A residual of rounding errors holds no step.
        if residual.norm() <= ROUNDING * target.norm() {
            residual.fill(0.0);
        }
        let own = own.column_iter().map(nalgebra::Matrix::into_owned).collect();
        Self { time_s, weights, own, residual }
    }

    /// The steps in the order of time.
    fn steps(&self) -> Vec<ZeroStep> {
        let (mut beside, mut rows, mut found) = (self.clone(), Vec::new(), 0);
        let mut left = [beside.residual.norm_squared(), beside.left_by_drift()];
        // A step takes little where its opposite follows. Two steps leave 0.19 of a wave (1 − 8/π²), and must leave less.
        while rows.len() < found + 2
            && let Some(row) = beside.best_row()
        {
            rows.push(row);
            beside.add(&beside.step(row));
            let share = (1.0 - OF_POWER).powi(if rows.len() == found + 1 { 1 } else { 3 });
            let rest = beside.residual.norm_squared();
            if rest < (share * left[0]).min(left[1]) {
                (left, found) = ([rest, beside.left_by_drift()], rows.len());
            }
        }
        rows.truncate(found);
        rows.sort_unstable();
        self.sized(&rows, left[1] < (1.0 - OF_POWER) * left[0])
    }

    /// Steps from these rows on, with their sizes by least squares, also beside a straight drift.
    fn sized(&self, rows: &[usize], beside_drift: bool) -> Vec<ZeroStep> {
        let mut beside = self.clone();
        if beside_drift {
            beside.add(&beside.drift());
        }
        let columns: Vec<DVector<f64>> = rows.iter().map(|row| beside.step(*row)).collect();
        let normal = DMatrix::from_fn(rows.len(), rows.len(), |i, j| columns[i].dot(&columns[j]));
        let products = DVector::from_fn(rows.len(), |i, _| columns[i].dot(&beside.residual));
        let sizes = normal.cholesky().map(|normal| normal.solve(&products));
        let steps = sizes.iter().flat_map(DVector::iter).zip(rows);
        steps.map(|(size, row)| ZeroStep { time_s: self.time_s[*row], size: *size }).collect()
    }

    /// Regressor of a step from a row on, beside the model.
    fn step(&self, row: usize) -> DVector<f64> {
        self.beside(|i| if i >= row { 1.0 } else { 0.0 })
    }

    fn drift(&self) -> DVector<f64> {
        self.beside(|i| self.time_s[i] - self.time_s[0])
    }

    /// Power that a drift leaves.
    fn left_by_drift(&self) -> f64 {
        let drift = self.drift();
        let taken = drift.dot(&self.residual).powi(2) / drift.norm_squared().max(f64::MIN_POSITIVE);
        self.residual.norm_squared() - taken
    }

    fn beside(&self, values: impl Fn(usize) -> f64) -> DVector<f64> {
        let mut column = DVector::from_fn(self.time_s.len(), |i, _| self.weights[i].sqrt() * values(i));
        for own in &self.own {
            column.axpy(-own.dot(&column), own, 1.0);
        }
        column
    }

    /// Takes a regressor beside the model into it.
    fn add(&mut self, column: &DVector<f64>) {
        let column = column / column.norm().max(f64::MIN_POSITIVE);
        self.residual.axpy(-column.dot(&self.residual), &column, 1.0);
        self.own.push(column);
    }

    /// The first row of the step that takes most of the residual.
    fn best_row(&self) -> Option<usize> {
        let rows = self.time_s.len();
        let whole: f64 = self.weights.iter().sum();
        // From the last row on: sums over the rows after a step.
        let (mut product, mut weight, mut shared) = (0.0, 0.0, vec![0.0; self.own.len()]);
        let mut best = (0.0, None);
        for i in (0..rows).rev() {
            let root = self.weights[i].sqrt();
            product += root * self.residual[i];
            weight += self.weights[i];
            shared.iter_mut().zip(&self.own).for_each(|(sum, own)| *sum += root * own[i]);
            let alone = weight - shared.iter().map(|sum| sum * sum).sum::<f64>();
            let is_told = alone > 0.0 && alone >= STEP_ALONE * weight * (1.0 - weight / whole);
            if i.min(rows - i) >= LEAST_SEGMENT_ROWS && is_told && product * product > best.0 * alone {
                best = (product * product / alone, Some(i));
            }
        }
        best.1
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use haptics::law::{Coordinate, Motion};

    const PERIOD_S: f64 = 0.01;

    /// 20 s of a mechanism that swings to and fro, with this force beside its own 0.3 kg and 2 N of friction.
    fn pieces(beside_n: &dyn Fn(f64) -> f64) -> Vec<Piece> {
        let motion: Vec<Motion> = (0..2000)
            .map(|k| {
                let t = PERIOD_S * f64::from(k);
                let (sin, cos) = (2.0 * t).sin_cos();
                Motion {
                    time_s: t,
                    position: 0.1 * sin,
                    velocity: 0.2 * cos,
                    acceleration: -0.4 * sin,
                    ..Motion::default()
                }
            })
            .collect();
        let direction: Vec<f64> = motion.iter().map(|m| (m.velocity / 0.01).clamp(-1.0, 1.0)).collect();
        let noise = |k: usize| 0.03 * ((k as f64 * 12.989).sin() * 43_758.5).fract();
        let force = motion.iter().zip(&direction).enumerate();
        let force = force.map(|(k, (m, d))| 0.3 * m.acceleration + 2.0 * d + noise(k) + beside_n(m.time_s)).collect();
        vec![Piece {
            usable: vec![true; motion.len()],
            motion,
            direction,
            force: Some(force),
            zero_steps: Vec::new(),
            is_late: false,
            force_noise: 0.02,
            period_s: PERIOD_S,
            cutoff_hz: 20.0,
            velocity_noise: 1e-3,
            noise: <_>::default(),
            from_resolution: 0.0,
            accelerates: true,
            first: 0,
            start_s: 5.0,
        }]
    }

    fn found(beside_n: &dyn Fn(f64) -> f64) -> Vec<ZeroStep> {
        let terms = [Term::Inertia, Term::Viscous, Term::Coulomb, Term::Offset];
        let known = Known::from_meta(&haptics::recording::Meta::default(), Coordinate::Linear);
        zero_steps(&pieces(beside_n), &terms, &known)
    }

    /// Times and sizes of the steps, s and N.
    fn assert_steps(beside_n: &dyn Fn(f64) -> f64, wanted: &[(f64, f64)]) {
        let found = found(beside_n);
        let is_near = |(step, (time_s, size)): (&ZeroStep, &(f64, f64))| {
            (step.time_s - time_s).abs() < 0.05 && (step.size - size).abs() < 0.1
        };
        assert!(found.len() == wanted.len() && found.iter().zip(wanted).all(is_near), "{found:?}, not {wanted:?}");
    }

    fn since(time_s: f64, size: f64) -> impl Fn(f64) -> f64 {
        move |t| if t >= time_s { size } else { 0.0 }
    }

    #[test]
    fn a_tare_in_the_middle_is_a_step_and_a_drift_or_a_wave_is_none() {
        assert_steps(&since(12.5, -3.1), &[(17.5, -3.1)]);
        for none in [|_: f64| 0.0, |t: f64| 0.1 * t, |t: f64| 0.5 * (0.9 * t).sin(), |t: f64| 0.5 * (0.47 * t).sin()] {
            assert_steps(&none, &[]);
        }
    }

    #[test]
    fn several_steps_are_found_and_a_drift_beside_one_is_none() {
        assert_steps(&|t| since(6.0, 2.0)(t) + since(13.0, -2.0)(t), &[(11.0, 2.0), (18.0, -2.0)]);
        assert_steps(&|t| since(6.0, 2.0)(t) + since(13.0, 1.5)(t), &[(11.0, 2.0), (18.0, 1.5)]);
        assert_steps(&|t| 0.05 * t + since(12.0, 1.0)(t), &[(17.0, 1.0)]);
    }
}
