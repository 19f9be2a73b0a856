//! Standard errors that are true: over worlds that the estimator was never tuned on, at three levels of sensor noise, the 95 %
//! intervals of every parameter hold the truth in 92 to 98 % of the recordings.
//!
//! `TOUCHSTONE_COVERAGE=500` runs as many worlds as that statement needs; without it a hundred are drawn, whose scatter is allowed
//! for. `TOUCHSTONE_SEED` draws others.

use estimator::estimate::Fit;
use haptics::device::Skill;
use haptics::recording::Recording;
use haptics::servo::recorder::SensorModel;
use haptics::world::World;
use rayon::prelude::*;
use std::collections::BTreeMap;
use tests::generate::{Performance, Truth, crank_world, perform_at_levels, stacking_world};

/// Noise of the sensors relative to good ones; the resolution stays.
const LEVELS: [f64; 3] = [0.3, 1.0, 3.0];
/// Share of the intervals `value ± 1.96 errors` that are to hold the truth.
const WANTED: std::ops::RangeInclusive<f64> = 0.92..=0.98;
/// A share of few recordings may lie outside by this many of its own standard deviations.
const SCATTER: f64 = 3.0;
/// What a recording cannot show it must say, and may not say often.
const LEAST_SHOWN: f64 = 0.95;

fn count() -> u64 {
    std::env::var("TOUCHSTONE_COVERAGE").ok().and_then(|s| s.parse().ok()).unwrap_or(100)
}

/// The estimator was tuned on seeds around 100 000; these it never saw.
fn seeds() -> std::ops::Range<u64> {
    let first = std::env::var("TOUCHSTONE_SEED").ok().and_then(|s| s.parse().ok()).unwrap_or(5_000);
    first..first + count()
}

/// Error in units of the standard error, and the relative standard error, by parameter.
type Scores = BTreeMap<(String, String), (f64, f64)>;

/// `center_error_m`: how well the generator itself knows the crank's centre along y.
fn score(fit: &Fit, truth: &Truth, center_error_m: f64) -> Scores {
    truth
        .iter()
        // A slip is an accident of a few recordings: tests/friction.rs judges what is made of it.
        .filter(|(name, _)| name.1 != "friction")
        .filter_map(|(name, true_value)| {
            let found = fit.parameter(&name.0, &name.1)?;
            let (value, error) = (found.value?, found.std_error?);
            let known_to = if name.1 == "center_y_m" { center_error_m } else { 0.0 };
            Some((name.clone(), ((value - true_value) / error.hypot(known_to), error / true_value.abs())))
        })
        .collect()
}

/// Prints a line a parameter and demands what the head of this file says.
fn demand(level: f64, all: &[Scores]) {
    println!("sensor noise × {level}");
    let mut names: Vec<&(String, String)> = all.iter().flat_map(Scores::keys).collect();
    names.sort();
    names.dedup();
    let mut wrong = Vec::new();
    for name in names {
        let z: Vec<f64> = all.iter().filter_map(|s| s.get(name)).map(|s| s.0).collect();
        let n = z.len() as f64;
        let share = z.iter().filter(|z| z.abs() <= 1.96).count() as f64 / n;
        let mean = z.iter().sum::<f64>() / n;
        let rms = (z.iter().map(|z| z * z).sum::<f64>() / n).sqrt();
        let relative = all.iter().filter_map(|s| s.get(name)).map(|s| s.1).sum::<f64>() / n;
        println!(
            "{:>8} {:<22} held {share:.3} of {n:.0}, z mean {mean:+.2} rms {rms:.2}, mean relative error {relative:.5}",
            name.0, name.1
        );
        let slack = |wanted: f64| SCATTER * (wanted * (1.0 - wanted) / n).sqrt();
        let low = WANTED.start() - slack(*WANTED.start());
        // Where the generator knows the truth hardly better than the fit does, intervals are too wide by that.
        let high = if name.1 == "center_y_m" { 1.0 } else { WANTED.end() + slack(*WANTED.end()) };
        if !(low..=high).contains(&share) || n < LEAST_SHOWN * all.len() as f64 {
            wrong.push(format!("{} {} at noise × {level}: {share:.3} of {n:.0}", name.0, name.1));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Scores of every seed at every level.
fn scores(draw: fn(u64) -> (World, Truth), fit: fn(&Recording, &Truth, u64) -> Fit) -> [Vec<Scores>; LEVELS.len()] {
    let sensors = LEVELS.map(|level| SensorModel::TYPICAL.noisier(level));
    let all: Vec<Vec<Scores>> = seeds()
        .into_par_iter()
        .map(|seed| {
            let (world, mut truth) = draw(seed);
            let performances = perform_at_levels(&world, seed, Skill::default(), 5, &sensors);
            // The centre that a fit can know is that of the grasp points' circle.
            if let Some(center) = truth.get_mut(&("crank".to_owned(), "center_y_m".to_owned())) {
                *center += performances[0].grasp_offset_y_m;
            }
            let scored = |p: &Performance| score(&fit(&p.recording, &truth, seed), &truth, p.grasp_offset_error_m);
            performances.iter().map(scored).collect()
        })
        .collect();
    std::array::from_fn(|level| all.iter().map(|seed| seed[level].clone()).collect())
}

fn fit_blocks(recording: &Recording, truth: &Truth, seed: u64) -> Fit {
    let (fit, segmentation) = estimator::identify::block::fit(recording, None).expect("blocks were carried");
    assert_eq!(segmentation.sequence(), "132313231", "seed {seed}");
    for block in ["block-1", "block-2"] {
        let bound = fit.parameter(block, "friction_lower_bound").expect("always reported");
        let (value, error) = (bound.value.expect("a firm grip"), bound.std_error.expect("with its error"));
        let friction = truth[&(block.to_owned(), "friction".to_owned())];
        assert!(value - 2.0 * error <= friction, "seed {seed}: bound {value} ± {error} above {friction}");
    }
    fit
}

#[test]
fn stacked_blocks_are_covered() {
    for (level, scores) in LEVELS.iter().zip(scores(stacking_world, fit_blocks)) {
        demand(*level, &scores);
    }
}

#[test]
fn cranks_are_covered() {
    let fit = |recording: &Recording, _: &Truth, _| estimator::identify::crank::fit(recording, None).expect("turned").0;
    for (level, scores) in LEVELS.iter().zip(scores(crank_world, fit)) {
        demand(*level, &scores);
    }
}
