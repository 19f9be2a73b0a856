//! Refines a free motion by integrating it: the whole record against the laws' own integrator (output error). Decay over
//! many swings says far more about friction than accelerations do.

use super::parameters::Term;
use super::signals::{Piece, Raw};
use crate::identify::limits::MOST_FIT_ROWS;
use crate::regression::bootstrap::block_bootstrap_within;
use crate::regression::linear::{LinearFit, least_squares};
use haptics::law::{Effect, Inertia, MAX_PARAMETERS, Motion, step_coordinate};
use std::ops::Range;

/// Largest number of segments that are integrated together: each brings two starting values.
/// Choice: no case of the ablation reads it.
const MAX_PIECES: usize = 6;
/// Inner step as a share of the inverse of the fastest rate of change: phase errors stay below 1e-6.
/// Choice: no case of the ablation reads it.
const INNER_STEP_SHARE: f64 = 0.005;
/// Largest number of Gauss-Newton steps.
/// Choice: no case of the ablation reads it.
const ITERATIONS: usize = 25;
/// Largest distance of the refined motion from the measured one, as a share of its size; beyond, the regression stands.
/// Choice: no case of the ablation reads it.
const ACCEPTED_SHARE: f64 = 0.05;

/// Measured samples of one segment.
struct Run {
    time_s: Vec<f64>,
    position: Vec<f64>,
    start: [f64; 2],
}

/// Refined ratios to the inertia, in the order of `terms`, as a fit with its covariance, and their errors by
/// resampling. `None` if the integration does not follow the record better than the start, or not well.
pub fn refine(raws: &[Raw], pieces: &[Piece], terms: &[Term], ratios: &[f64]) -> Option<(LinearFit, Option<Vec<f64>>)> {
    let runs = runs(raws, pieces)?;
    let p = terms.len();
    let mut values: Vec<f64> = ratios.to_vec();
    values.extend(runs.iter().flat_map(|r| r.start));
    let residual = |values: &[f64]| -> Vec<f64> {
        let moved =
            runs.iter().enumerate().flat_map(|(k, run)| simulate(terms, &values[..p], &values[p + 2 * k..], run));
        runs.iter().flat_map(|r| r.position.iter()).zip(moved).map(|(measured, made)| measured - made).collect()
    };
    let power = |r: &[f64]| r.iter().map(|v| v * v).sum::<f64>();
    let mut now = residual(&values);
    let start_power = power(&now);
    let mut fit = None;
    for _ in 0..ITERATIONS {
        let columns = jacobian(&values, &now, &residual);
        let step = least_squares(&columns, &now, None).ok()?;
        let better = (0..8).map(|k| 0.5_f64.powi(k)).find_map(|share| {
            let trial: Vec<f64> = values.iter().zip(&step.values).map(|(v, s)| v + share * s).collect();
            let left = residual(&trial);
            (power(&left) < power(&now)).then_some((trial, left))
        });
        fit = Some((step, columns));
        let Some((trial, left)) = better else { break };
        let done = power(&left) > (1.0 - 1e-9) * power(&now);
        (values, now) = (trial, left);
        if done {
            break;
        }
    }
    let size = power(&runs.iter().flat_map(|r| centred(&r.position)).collect::<Vec<f64>>());
    let follows = power(&now) < ACCEPTED_SHARE * ACCEPTED_SHARE * size && power(&now) <= start_power;
    let (mut fit, columns) = fit.filter(|_| follows)?;
    let mut stretches = Vec::new();
    for run in &runs {
        let first = stretches.last().map_or(0, |s: &Range<usize>| s.end);
        stretches.push(first..first + run.position.len());
    }
    let drawn = block_bootstrap_within(&columns, &now, None, &fit, &stretches);
    fit.values = values[..p].to_vec();
    fit.std_errors.truncate(p);
    fit.identified.truncate(p);
    fit.covariance = fit.covariance.view((0, 0), (p, p)).into_owned();
    fit.rms = (power(&now) / now.len().max(1) as f64).sqrt();
    fit.residuals = now;
    Some((fit, drawn.map(|drawn| drawn.errors()[..p].to_vec())))
}

fn centred(values: &[f64]) -> Vec<f64> {
    let mean = values.iter().sum::<f64>() / values.len().max(1) as f64;
    values.iter().map(|v| v - mean).collect()
}

/// The measured samples of every segment, thinned, with the filtered state at the first of them.
fn runs(raws: &[Raw], pieces: &[Piece]) -> Option<Vec<Run>> {
    if pieces.len() > MAX_PIECES || raws.len() != 1 && raws.len() != pieces.len() {
        return None;
    }
    let total: usize = pieces.iter().map(|p| p.motion.len()).sum();
    let every = total.div_ceil(MOST_FIT_ROWS).max(1);
    let make = |(k, piece): (usize, &Piece)| {
        let raw = if raws.len() == 1 { &raws[0] } else { &raws[k] };
        // The ends of the filtered signals are the weakest: begin where they are good.
        let begin = piece.usable.iter().position(|u| *u)?;
        let first = &piece.motion[begin];
        let end_s = piece.start_s + (piece.motion.len() as f64 - 0.5) * piece.period_s;
        let inside = raw.time_s.iter().zip(&raw.position).filter(|(t, _)| **t >= first.time_s && **t < end_s);
        let (time_s, position): (Vec<f64>, Vec<f64>) = inside.step_by(every).map(|(t, q)| (*t, *q)).unzip();
        (time_s.len() > 30).then_some(Run { time_s, position, start: [first.position, first.velocity] })
    };
    pieces.iter().enumerate().map(make).collect()
}

/// The laws of the terms, per unit of inertia.
fn effects(terms: &[Term], ratios: &[f64]) -> Vec<Effect> {
    let mut effects = vec![Effect::new(&Inertia, &[1.0])];
    for (term, &ratio) in terms.iter().zip(ratios) {
        let Some((law, index)) = term.law() else { continue };
        let mut parameters = [0.0; MAX_PARAMETERS];
        parameters[index] = ratio;
        effects.push(Effect::new(law, &parameters));
    }
    effects
}

/// Positions at the run's sample times, from the starting state `state[0..2]`.
fn simulate(terms: &[Term], ratios: &[f64], state: &[f64], run: &Run) -> Vec<f64> {
    let effects = effects(terms, ratios);
    let fastest = ratios.iter().fold(1.0_f64, |m, r| m.max(r.abs().sqrt()));
    let largest_step = INNER_STEP_SHARE / fastest;
    let mut motion = Motion { position: state[0], velocity: state[1], ..Motion::default() };
    let mut time = run.time_s.first().copied().unwrap_or(0.0);
    run.time_s
        .iter()
        .map(|&until| {
            // A swing has at least ten samples. A clock with a wrong unit would ask for work by its seconds.
            let steps = ((until - time) / largest_step).ceil().clamp(0.0, 50.0 / INNER_STEP_SHARE);
            for _ in 0..steps as usize {
                (motion.position, motion.velocity) =
                    step_coordinate(&effects, &motion, 0.0, 0.0, (until - time) / steps);
            }
            time = until;
            motion.position
        })
        .collect()
}

/// d(simulated)/d(value) by forward differences: the residual falls by it.
fn jacobian(values: &[f64], now: &[f64], residual: &impl Fn(&[f64]) -> Vec<f64>) -> Vec<Vec<f64>> {
    (0..values.len())
        .map(|j| {
            let step = 1e-5 * values[j].abs().max(1e-2);
            let mut moved = values.to_vec();
            moved[j] += step;
            residual(&moved).iter().zip(now).map(|(after, before)| (before - after) / step).collect()
        })
        .collect()
}
