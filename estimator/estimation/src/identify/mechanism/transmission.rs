//! Ratio, play and give of a gear, a cable or a linkage: from an input coordinate to an output one.
//!
//! The output follows the input through a gap: it stays in place until the input has crossed the gap, and from there on
//! is pushed by one side or the other (the play operator; Nordin & Gutman, Automatica 38, 2002). The residual may
//! follow the load. Half the gap is searched, everything else is linear.

use crate::identify::limits::SIGNIFICANT;
use crate::regression::bootstrap::block_bootstrap;
use crate::regression::linear::least_squares;
use foundation::estimate::Parameter;
use haptics::recording::Recording;

/// The object's name.
const OBJECT: &str = "transmission";
/// The output's columns.
const OUTPUTS: [(&str, &str, &str); 2] = [("q_out_rad", "q_rad", "rad"), ("q_out_m", "q_m", "m")];
/// Number of half gaps that are tried first.
/// Choice: no case of the ablation reads it.
const TRIES: usize = 40;
/// Number of steps of the golden section about the best one.
/// Derived: 0.618²⁴ = 1e-5 of the bracket remains.
const CLOSER: usize = 24;
/// Largest half gap, as a share of the input's way.
/// Choice: no case of the ablation reads it.
const LARGEST: f64 = 0.25;
/// Largest number of samples in the fit: slow motions are sampled far too often.
/// Choice: no case of the ablation reads it.
const ROWS: usize = 3000;
/// Share of the recording in which the gap's side is not known yet.
/// Choice: no case of the ablation reads it.
const UNSETTLED_SHARE: f64 = 0.02;
/// Least number of reversals of the input that show a gap.
/// Choice: no case of the ablation reads it.
const REVERSALS: usize = 2;

/// A value with its standard error by covariance and by resampling.
#[derive(Clone, Copy)]
struct Value {
    best: f64,
    error: f64,
    resampled: Option<f64>,
}

/// One recording's answer.
struct Found {
    ratio: Value,
    gap: Value,
    give: Option<Value>,
    rms: f64,
    samples: usize,
}

/// Parameters of the transmission, when the recordings have an output coordinate; else nothing.
pub(super) fn parameters(recordings: &[Recording]) -> Vec<Parameter> {
    let Some((_, _, unit)) = OUTPUTS.iter().find(|(out, _, _)| recordings.iter().any(|r| r.channel(out).is_some()))
    else {
        return Vec::new();
    };
    let found: Vec<Found> = recordings.iter().filter_map(one).collect();
    let samples = recordings.iter().map(Recording::len).sum();
    let names = ["ratio".to_owned(), format!("backlash_{unit}"), format!("compliance_{unit}_{}", load(unit))];
    if found.is_empty() {
        let why = "the input does not turn round twice, so that play and ratio cannot be told apart";
        return names.iter().map(|n| Parameter::unidentified(OBJECT, n, samples, why)).collect();
    }
    let rms = (found.iter().map(|f| f.rms * f.rms).sum::<f64>() / found.len() as f64).sqrt();
    let how = |what: &str| {
        format!("{what}; the output is met within {rms:.2e} {unit} (root mean square) in {} recordings", found.len())
    };
    let used = found.iter().map(|f| f.samples).sum();
    let mut all = Vec::new();
    let mut push = |name: &str, values: Vec<Value>, text: &str| {
        if let Some(Value { best: value, error, resampled }) = together(&values) {
            all.push(if error * SIGNIFICANT < value.abs() {
                Parameter::identified(OBJECT, name, value, error, used, &how(text)).with_bootstrap(resampled)
            } else {
                let why = format!("{value:.2e} ± {error:.2e} {unit} cannot be told from none");
                Parameter::unidentified(OBJECT, name, used, &why)
            });
        }
    };
    push(&names[0], found.iter().map(|f| f.ratio).collect(), "output over input beyond the gap");
    push(&names[1], found.iter().map(|f| f.gap).collect(), "the whole gap, at the input");
    push(&names[2], found.iter().filter_map(|f| f.give).collect(), "what follows the load at the input beyond the gap");
    all
}

fn load(unit: &str) -> &'static str {
    if unit == "rad" { "Nm" } else { "N" }
}

/// Mean by the errors; where the recordings disagree, the error of their scatter.
fn together(values: &[Value]) -> Option<Value> {
    if values.is_empty() {
        return None;
    }
    let weight = |e: f64| e.max(1e-300).powi(-2);
    let sum: f64 = values.iter().map(|v| weight(v.error)).sum();
    let mean = values.iter().map(|v| v.best * weight(v.error)).sum::<f64>() / sum;
    let n = values.len() as f64;
    let plain = values.iter().map(|v| v.best).sum::<f64>() / n;
    let scatter = (values.iter().map(|v| (v.best - plain).powi(2)).sum::<f64>() / (n * (n - 1.0)).max(1.0)).sqrt();
    if n > 1.0 && scatter > sum.powf(-0.5) {
        // Recordings that differ by more than their errors count alike.
        let few = crate::regression::long_run_variance::inflation(n - 1.0).sqrt();
        return Some(Value { best: plain, error: scatter * few, resampled: None });
    }
    // The same weighted mean with each one's own resampled error.
    let drawn: Option<f64> = values.iter().map(|v| Some((v.resampled? * weight(v.error)).powi(2))).sum();
    Some(Value { best: mean, error: sum.powf(-0.5), resampled: drawn.map(|drawn| drawn.sqrt() / sum) })
}

fn one(recording: &Recording) -> Option<Found> {
    let (out, input, unit) = OUTPUTS.iter().find(|(out, _, _)| recording.channel(out).is_some())?;
    let (input, output) = (recording.channel(input)?, recording.channel(out)?);
    let load = recording.channel(if *unit == "rad" { "tau_Nm" } else { "f_N" });
    let (low, high) = input.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(*v), h.max(*v)));
    let way = high - low;
    if !way.is_finite() || way <= 0.0 || reversals(input, 0.1 * way) < REVERSALS {
        return None;
    }
    let stride = input.len().div_ceil(ROWS);
    let first = (UNSETTLED_SHARE * input.len() as f64) as usize;
    let rows: Vec<usize> = (first..input.len()).step_by(stride).collect();
    let target: Vec<f64> = rows.iter().map(|&i| output[i]).collect();
    let columns = |half: f64, slope: bool| {
        let (place, side) = play(input, half);
        let mut columns = vec![vec![1.0; rows.len()], rows.iter().map(|&i| place[i]).collect()];
        columns.extend(load.map(|f| rows.iter().map(|&i| f[i]).collect()));
        if slope {
            columns.push(rows.iter().map(|&i| side[i]).collect());
        }
        columns
    };
    let solve = |half: f64, slope: bool| least_squares(&columns(half, slope), &target, None).ok();
    let cost = |half: f64| solve(half, false).map_or(f64::INFINITY, |f| f.rms);
    let step = LARGEST * way / TRIES as f64;
    let coarse = (0..=TRIES).map(|k| k as f64 * step).min_by(|a, b| cost(*a).total_cmp(&cost(*b)))?;
    let (mut a, mut b) = ((coarse - step).max(0.0), coarse + step);
    // Golden section.
    for _ in 0..CLOSER {
        let (c, d) = (b - 0.618 * (b - a), a + 0.618 * (b - a));
        if cost(c) < cost(d) { b = d } else { a = c }
    }
    let half = 0.5 * (a + b);
    let fit = solve(half, true)?;
    let last = fit.values.len() - 1;
    // The output moves by −ratio · side a unit of half gap.
    let drawn = block_bootstrap(&columns(half, true), &target, None, &fit);
    let of = |best: f64, column: usize, by: f64| Value {
        best,
        error: fit.std_errors[column] * by,
        resampled: drawn.as_ref().map(|drawn| drawn[column] * by),
    };
    let ratio = of(fit.values[1], 1, 1.0);
    let gap = of(2.0 * half, last, 2.0 / ratio.best.abs().max(1e-12));
    let give = load.map(|_| of(fit.values[2], 2, 1.0));
    Some(Found { ratio, gap, give, rms: fit.rms, samples: rows.len() })
}

/// Place of the output at ratio one behind a gap of twice `half`, and the side that pushes (+1: the input is ahead).
fn play(input: &[f64], half: f64) -> (Vec<f64>, Vec<f64>) {
    let mut place = input.first().copied().unwrap_or(0.0);
    let mut side = 0.0;
    input
        .iter()
        .map(|q| {
            if q - half > place {
                (place, side) = (q - half, 1.0);
            } else if q + half < place {
                (place, side) = (q + half, -1.0);
            }
            (place, side)
        })
        .unzip()
}

/// Number of reversals of the input by more than `least`.
fn reversals(input: &[f64], least: f64) -> usize {
    let (mut extreme, mut forward, mut count) = (input[0], None, 0);
    for q in input {
        match forward {
            None if (q - input[0]).abs() > least => (forward, extreme) = (Some(*q > input[0]), *q),
            Some(true) if *q > extreme => extreme = *q,
            Some(false) if *q < extreme => extreme = *q,
            Some(way) if (q - extreme).abs() > least => {
                (forward, extreme) = (Some(!way), *q);
                count += 1;
            }
            _ => {}
        }
    }
    count
}

#[cfg(test)]
mod tests {
    use super::*;
    use haptics::recording::Channel;
    use rand::{RngExt as _, SeedableRng as _, rngs::StdRng};
    use rand_distr::StandardNormal;

    /// A shaft that drives a stage through dogs: integrated with stiff dogs and friction on the stage, nothing of the play operator.
    fn drive(gap: f64, ratio: f64, give: f64, seed: u64) -> Recording {
        let mut rng = StdRng::seed_from_u64(seed);
        let (n, dt) = (4000, 0.005);
        let (mut stage, mut input, mut output, mut torque) = (0.0_f64, Vec::new(), Vec::new(), Vec::new());
        for i in 0..n {
            let t = f64::from(i) * dt;
            let q = 0.5 * (1.9 * t).sin() + 0.1 * (0.7 * t).sin();
            // Quasi-static: the stage stays where friction holds it unless a dog pushes.
            let push = if q - stage > 0.5 * gap {
                1.0
            } else if stage - q > 0.5 * gap {
                -1.0
            } else {
                0.0
            };
            stage = if push == 0.0 { stage } else { q - push * 0.5 * gap };
            let load = 0.05 * (1.3 * t).cos();
            let noise = |rng: &mut StdRng| 5e-4 * rng.sample::<f64, _>(StandardNormal);
            input.push(q);
            output.push(0.3 + ratio * stage + give * load + noise(&mut rng));
            torque.push(load);
        }
        let channel = |name: &str, unit: &str, values| Channel { name: name.to_owned(), unit: unit.to_owned(), values };
        Recording {
            name: "drive".to_owned(),
            time_s: Some((0..n).map(|i| f64::from(i) * dt).collect()),
            channels: vec![
                channel("q_rad", "rad", input),
                channel("q_out_rad", "rad", output),
                channel("tau_Nm", "Nm", torque),
            ],
            ..Recording::default()
        }
    }

    #[test]
    fn play_ratio_and_give_come_back_with_errors_that_hold() {
        let mut held = [0; 3];
        for seed in 0..30 {
            let mut rng = StdRng::seed_from_u64(700 + seed);
            let truth = [rng.random_range(0.5..1.5), rng.random_range(0.01..0.15), rng.random_range(0.1..0.6)];
            let found = parameters(&[drive(truth[1], truth[0], truth[2], seed)]);
            for (k, parameter) in found.iter().enumerate() {
                let (value, error) = (parameter.value.expect("seen"), parameter.std_error.expect("an error"));
                held[k] += usize::from((value - truth[k]).abs() < 1.96 * error);
                assert!((value / truth[k] - 1.0).abs() < 0.05, "{parameter:?} {truth:?}");
            }
        }
        println!("{held:?} of 30");
        assert!(held.iter().all(|h| *h >= 24), "{held:?}");
    }

    #[test]
    fn without_a_gap_none_is_named() {
        let found = parameters(&[drive(0.0, 1.0, 0.3, 4)]);
        assert!(found[0].identified && !found[1].identified, "{found:?}");
    }
}
