//! Carry that would settle the open questions of the net force: the same terms on a recording that has not been made
//! yet.

use super::net_force::Carry;
use super::signals::Seen;
use crate::diagnose::contract::{Alternative, Experiment, NextExperiment};
use crate::diagnose::experiment::proposal::{LIKELY, SURE_BY_MOTION, power};
use crate::diagnose::experiment::strokes::FREE_S;
use crate::diagnose::experiment::waypoints::HAND_SPEEDS_M_S;
use crate::diagnose::hypotheses::axis::Axis;
use crate::diagnose::hypotheses::{force_bias, force_drift, gravity_tilt, mass_change};
use estimation::segment::threshold::percentile;
use nalgebra::{DMatrix, DVector};

/// The library: id, words, and duration without touch before and after, s.
const LIBRARY: [(&str, &str, f64); 2] = [
    (
        "carry-let-go",
        "let go for two seconds before and after the carry, and hold the block still in between: a drift of the sensor stays, a lost \
         weight does not",
        FREE_S,
    ),
    ("carry-still", "lift the block and hold it still", 0.0),
];
/// Lengths of a carry, s. The shortest that is likely to suffice is asked for: a leak soon ends, and a drift does not
/// stay linear for long.
/// Choice: no case of the ablation reads it.
const HELD_S: Axis = Axis::geometric(4.0, 16.0, 3);

/// Predicted row: time, s, and kind.
#[derive(Clone, Copy, PartialEq)]
enum Place {
    /// Both fingers along the vertical, with the time since the block was lifted, s.
    Carried(f64),
    /// Side force of the same.
    Side,
    /// A free finger (first) along an axis (second: x, y).
    Free(usize, usize),
}

type Row = (f64, Place);

/// Rows of a carry that lasts for some seconds, with free fingers before and after.
fn imagine(seconds: f64, free_s: f64, period_s: f64) -> Vec<Row> {
    let times = |from: f64, long: f64| (0..(long / period_s) as usize).map(move |k| from + k as f64 * period_s);
    let mut rows: Vec<Row> = times(free_s, seconds).map(|t| (t, Place::Carried(t - free_s))).collect();
    rows.extend(times(free_s, seconds).map(|t| (t, Place::Side)));
    for from in [0.0, free_s + seconds] {
        for (finger, axis) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
            rows.extend(times(from, free_s).map(|t| (t, Place::Free(finger, axis))));
        }
    }
    rows
}

/// Regressors of all forms of a cause on these rows; `None` for causes of other channels.
fn columns(id: &str, rows: &[Row], weight_n: f64) -> Option<Vec<Vec<f64>>> {
    let of = |f: &dyn Fn(f64, Place) -> f64| rows.iter().map(|(t, place)| f(*t, *place)).collect::<Vec<f64>>();
    let channel = |finger: usize, axis: usize, size: fn(f64) -> f64| {
        of(&|t, place| match place {
            Place::Carried(_) if axis == 1 => size(t),
            Place::Side if axis == 0 => size(t),
            Place::Free(f, a) if f == finger && a == axis => size(t),
            _ => 0.0,
        })
    };
    let all = |size: fn(f64) -> f64| [(0, 0), (0, 1), (1, 0), (1, 1)].map(|(f, a)| channel(f, a, size)).to_vec();
    match id {
        mass_change::ID => Some(vec![of(&|_, place| if let Place::Carried(held) = place { held } else { 0.0 })]),
        force_drift::ID => Some(all(|t| t)),
        force_bias::ID => Some(all(|_| 1.0)),
        gravity_tilt::ID => Some(vec![of(&|_, place| if place == Place::Side { weight_n } else { 0.0 })]),
        _ => None,
    }
}

/// Sum of squares of an effect that the weight and a rival cannot explain.
fn unexplained(effect: &[f64], beside: &[Vec<f64>]) -> f64 {
    let beside: Vec<&Vec<f64>> = beside.iter().filter(|c| c.iter().any(|v| *v != 0.0)).collect();
    let matrix = DMatrix::from_fn(effect.len(), beside.len(), |i, j| beside[j][i]);
    let target = DVector::from_column_slice(effect);
    let mut gram = matrix.tr_mul(&matrix);
    for k in 0..gram.ncols() {
        gram[(k, k)] *= 1.0 + 1e-9;
    }
    let Some(solver) = gram.cholesky() else { return 0.0 };
    let solved = solver.solve(&matrix.tr_mul(&target));
    (target - matrix * solved).norm_squared()
}

/// Recording that would settle the first open question of this channel, if there is one.
pub fn propose(open: &[Alternative], carry: &Carry<'_>, seen: &[Seen<'_>]) -> Option<NextExperiment> {
    let first = open.first()?;
    let study = &carry.compared.study;
    let solved = study.solved.as_ref()?;
    let picks = study.picks();
    let chosen = picks.iter().position(|p| study.candidates[*p].id == first.instead_of)?;
    let own = &study.candidates[picks[chosen]];
    let size = solved.values[study.system.own(&picks, chosen)].iter().map(|v| v * v).sum::<f64>().sqrt();
    let period_s = seen.iter().map(|s| s.period_s).fold(0.0, f64::max).max(1e-3);
    let weight_n = study.target.iter().copied().fold(0.0, f64::max);
    // Noise that is correlated between rows hides slow effects more.
    let slow = 1.0 - study.system.coefficients.iter().sum::<f64>();
    let variance = solved.variance(study.system.rows);
    let rivals: Vec<&Alternative> = open.iter().filter(|a| a.instead_of == first.instead_of).collect();
    let mut best: Option<NextExperiment> = None;
    for seconds in HELD_S.values() {
        for (id, words, free_s) in LIBRARY {
            let rows = imagine(seconds, free_s, period_s);
            let weight: Vec<f64> = rows
                .iter()
                .map(|r| if matches!(r.1, Place::Free(..)) { std::f64::consts::SQRT_2 } else { 1.0 })
                .collect();
            let weigh = |mut c: Vec<f64>| {
                c.iter_mut().zip(&weight).for_each(|(v, w)| *v *= w);
                c
            };
            let weighs = rows.iter().map(|r| f64::from(u8::from(matches!(r.1, Place::Carried(_))))).collect();
            let mut least = f64::INFINITY;
            for rival in &rivals {
                // Either of the two may be true. A drift of one finger represents the drift of both.
                for (a, b) in [(own.id, rival.id.as_str()), (rival.id.as_str(), own.id)] {
                    let vertical = usize::from(a.starts_with("force") && b != gravity_tilt::ID);
                    let effect = columns(a, &rows, weight_n)?.swap_remove(vertical);
                    let effect: Vec<f64> = weigh(effect).iter().map(|v| v * size).collect();
                    let mut beside: Vec<Vec<f64>> = columns(b, &rows, weight_n)?.into_iter().map(&weigh).collect();
                    beside.push(weigh(Clone::clone(&weighs)));
                    least = least.min(unexplained(&effect, &beside) * slow * slow / variance.max(f64::MIN_POSITIVE));
                }
            }
            let power = SURE_BY_MOTION * power(least);
            if best.as_ref().is_none_or(|b| power > b.expected_power + 1e-3) {
                let separates = std::iter::once(own.id.to_owned()).chain(rivals.iter().map(|r| r.id.clone())).collect();
                let experiment = Some(asked(id, seconds, free_s, seen));
                best = Some(NextExperiment { motion: words.to_owned(), separates, expected_power: power, experiment });
            }
        }
        if best.as_ref().is_some_and(|b| b.expected_power > LIKELY) {
            break;
        }
    }
    best
}

/// Height, speed and grip of the first block's recorded carries.
fn asked(id: &str, seconds: f64, free_s: f64, seen: &[Seen<'_>]) -> Experiment {
    let (mut heights, mut places, mut speeds) = (Vec::new(), Vec::new(), Vec::new());
    for one in seen {
        for i in one.carried(1) {
            heights.push(one.place[1][i]);
            places.push(one.place[0][i]);
            speeds.push(one.velocity[1][i].abs());
        }
    }
    let lifted = percentile(&mut heights.clone(), 0.9) - percentile(&mut heights, 0.02);
    let grip = seen.iter().map(|s| s.blocks.levels.usual_grip_n).fold(0.0, f64::max);
    Experiment {
        id: id.to_owned(),
        seconds,
        free_s,
        middle: percentile(&mut places, 0.5),
        half_range: 0.5 * lifted.max(4e-3),
        fast: percentile(&mut speeds, 0.95).max(HAND_SPEEDS_M_S.0),
        across_n: grip,
        ..Experiment::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_letting_go_tells_a_drift_from_a_leak() {
        let left = |free_s: f64| {
            let rows = imagine(10.0, free_s, 0.03);
            let effect = columns("mass-change", &rows, 0.4).expect("a cause of the net force").swap_remove(0);
            let mut beside = columns("force-drift", &rows, 0.4).expect("another");
            beside.push(rows.iter().map(|r| f64::from(u8::from(matches!(r.1, Place::Carried(_))))).collect());
            unexplained(&effect, &beside) / unexplained(&effect, &beside[beside.len() - 1..])
        };
        assert!(left(2.0) > 0.2 && left(0.0) < 1e-3, "{} {}", left(2.0), left(0.0));
    }
}
