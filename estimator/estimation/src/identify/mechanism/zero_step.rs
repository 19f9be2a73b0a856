//! A step in what the fit leaves of the force: somebody zeroed the force sensor, or knocked it, in the middle of a
//! recording.

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
/// The step: when, from the clock of the recording, and how large, N or N m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ZeroStep {
    /// Time of the first sample after the step, s.
    pub time_s: f64,
    /// Force after the step less that before it, N or N m.
    pub size: f64,
}

impl ZeroStep {
    /// Force of the step at a time, N or N m.
    pub fn force_at(&self, time_s: f64) -> f64 {
        if time_s >= self.time_s { self.size } else { 0.0 }
    }

    /// Root mean square of the residual of a fit of these terms beside the step, N or N m; infinite where there is none.
    pub fn residual_beside(&self, pieces: &[Piece], terms: &[Term], known: &Known) -> f64 {
        let force = |piece: &Piece| -> Vec<f64> {
            piece.applied_force().iter().zip(piece.times_s()).map(|(force, t)| force - self.force_at(t)).collect()
        };
        System::stack(pieces, terms, known, force).solve().map_or(f64::INFINITY, |fit| fit.rms)
    }
}

/// The step in the residual of one recording's fit of these terms; `None` if no step takes half of the residual's
/// power, or if a straight drift takes as much. A spring takes part, because a mechanism that goes over to another place
/// and stays there feels a step.
pub fn zero_step(pieces: &[Piece], terms: &[Term], known: &Known) -> Option<ZeroStep> {
    let system = System::stack(pieces, terms, known, Piece::applied_force);
    if system.target.len() < LEAST_SEGMENT_ROWS {
        return None;
    }
    let time_s = System::stack(pieces, &[], &Known::default(), |piece| piece.times_s().collect()).target;
    // The weights follow from a fit that the step spoils, so the next round takes it from the fit.
    let (mut rest, mut found) = (system.clone(), (None, false));
    for _ in 0..WEIGHTING_ROUNDS {
        let weights = rest.solve().ok().and_then(|fit| rest.weights(&fit));
        found = scan(&system, &time_s, &weights.unwrap_or_else(|| vec![1.0; time_s.len()]));
        let step: ZeroStep = found.0.filter(|_| found.1)?;
        rest.target = system.target.iter().zip(&time_s).map(|(force, t)| force - step.force_at(*t)).collect();
    }
    found.0.filter(|_| found.1)
}

/// The best step beside the terms of the system; true if it takes enough of the residual's power, and more than a drift does.
fn scan(system: &System, time_s: &[f64], weights: &[f64]) -> (Option<ZeroStep>, bool) {
    let rows = time_s.len();
    let root = |i: usize| weights[i].sqrt();
    let place: Vec<f64> = system.motion.iter().map(|(position, _)| *position).collect();
    let columns: Vec<&Vec<f64>> = system.columns.iter().chain([&place]).collect();
    let own = DMatrix::from_fn(rows, columns.len() + 1, |i, j| root(i) * columns.get(j).map_or(1.0, |c| c[i])).qr().q();
    let beside = |values: &dyn Fn(usize) -> f64| {
        let values = DVector::from_fn(rows, |i, _| root(i) * values(i));
        &values - &own * own.tr_mul(&values)
    };
    let residual = beside(&|i| system.target[i]);
    let ramp = beside(&|i| time_s[i] - time_s[0]);
    let by_ramp = ramp.dot(&residual).powi(2) / ramp.norm_squared().max(f64::MIN_POSITIVE);
    // A residual of rounding errors holds no step.
    let weighted = DVector::from_fn(rows, |i, _| root(i) * system.target[i]);
    if residual.norm() <= ROUNDING * weighted.norm() {
        return (None, false);
    }
    // From the last row on: sums over the rows after a step.
    let whole: f64 = weights.iter().sum();
    let (mut product, mut weight, mut shared) = (0.0, 0.0, DVector::zeros(own.ncols()));
    let mut best = (0.0, None);
    for i in (0..rows).rev() {
        product += root(i) * residual[i];
        weight += weights[i];
        shared += root(i) * own.row(i).transpose();
        let alone = weight - shared.norm_squared();
        if i.min(rows - i) < LEAST_SEGMENT_ROWS || alone < STEP_ALONE * weight * (1.0 - weight / whole) || alone <= 0.0
        {
            continue;
        }
        let taken = product * product / alone;
        if taken > best.0 {
            best = (taken, Some(ZeroStep { time_s: time_s[i], size: product / alone }));
        }
    }
    (best.1, best.0 > (OF_POWER * residual.norm_squared()).max(by_ramp))
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
            zero_step: None,
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

    fn found(beside_n: &dyn Fn(f64) -> f64) -> Option<ZeroStep> {
        let terms = [Term::Inertia, Term::Viscous, Term::Coulomb, Term::Offset];
        let known = Known::from_meta(&haptics::recording::Meta::default(), Coordinate::Linear);
        zero_step(&pieces(beside_n), &terms, &known)
    }

    #[test]
    fn a_tare_in_the_middle_is_a_step_and_a_drift_or_a_wave_is_none() {
        let step = found(&|t| if t >= 12.5 { -3.1 } else { 0.0 }).expect("a step");
        assert!((step.time_s - 17.5).abs() < 0.05 && (step.size + 3.1).abs() < 0.1, "{step:?}");
        assert_eq!(found(&|_| 0.0), None);
        assert_eq!(found(&|t| 0.1 * t), None);
        assert_eq!(found(&|t| 0.5 * (0.9 * t).sin()), None);
    }
}
