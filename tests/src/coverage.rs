//! Judging stated errors: over worlds that the estimator was never tuned on, the 95 % intervals of every parameter hold the truth
//! in 92 to 98 % of the recordings.
//!
//! `TOUCHSTONE_COVERAGE=500` runs as many worlds as that statement needs; without it fewer are drawn, whose scatter is allowed for.
//! `TOUCHSTONE_SEED` draws others.

use crate::generate::Truth;
use estimator::estimate::Fit;
use rayon::prelude::*;
use std::collections::BTreeMap;

/// Noise of the sensors relative to good ones; the resolution stays.
pub const LEVELS: [f64; 3] = [0.3, 1.0, 3.0];
/// Share of the intervals `value ± 1.96 errors` that are to hold the truth.
const WANTED: std::ops::RangeInclusive<f64> = 0.92..=0.98;
/// A share of few recordings may lie outside by this many of its own standard deviations.
const SCATTER: f64 = 3.0;

/// Error in units of the standard error, and the relative standard error, by parameter.
pub type Scores = BTreeMap<(String, String), (f64, f64)>;

/// The seeds to run: `usual` of them from `first` on, unless the environment says otherwise.
pub fn seeds(first: u64, usual: u64) -> std::ops::Range<u64> {
    let number = |name: &str| std::env::var(name).ok().and_then(|s| s.parse::<u64>().ok());
    let first = number("TOUCHSTONE_SEED").unwrap_or(first);
    first..first + number("TOUCHSTONE_COVERAGE").unwrap_or(usual)
}

/// Scores of every true value that the fit gives a number for.
pub fn score(fit: &Fit, truth: &Truth) -> Scores {
    let of = |(name, true_value): (&(String, String), &f64)| {
        let found = fit.parameter(&name.0, &name.1)?;
        let (value, error) = (found.value?, found.std_error?);
        Some((name.clone(), ((value - true_value) / error, error / true_value.abs())))
    };
    truth.iter().filter_map(of).collect()
}

/// Scores of every seed at every level; `scores` gives those of one seed, a level each.
pub fn over(
    seeds: std::ops::Range<u64>,
    scores: impl Fn(u64) -> Vec<Scores> + Sync + Send,
) -> [Vec<Scores>; LEVELS.len()] {
    let all: Vec<Vec<Scores>> = seeds.into_par_iter().map(scores).collect();
    std::array::from_fn(|level| all.iter().map(|seed| seed[level].clone()).collect())
}

/// Prints a line a parameter and demands what the head of this file says. `shown`: the share of recordings in which a parameter must
/// have a number; `cautious`: parameters whose intervals may be wider than that, with the share of the truth that they hold at most.
pub fn demand(levels: &[Vec<Scores>; LEVELS.len()], shown: &dyn Fn(&str) -> f64, cautious: &dyn Fn(&str) -> f64) {
    let mut wrong = Vec::new();
    for (level, all) in LEVELS.iter().zip(levels) {
        println!("sensor noise × {level}");
        let mut names: Vec<&(String, String)> = all.iter().flat_map(Scores::keys).collect();
        names.sort();
        names.dedup();
        for name in names {
            let z: Vec<f64> = all.iter().filter_map(|s| s.get(name)).map(|s| s.0).collect();
            let n = z.len() as f64;
            let share = z.iter().filter(|z| z.abs() <= 1.96).count() as f64 / n;
            let mean = z.iter().sum::<f64>() / n;
            let rms = (z.iter().map(|z| z * z).sum::<f64>() / n).sqrt();
            let mut errors: Vec<f64> = all.iter().filter_map(|s| s.get(name)).map(|s| s.1).collect();
            errors.sort_by(f64::total_cmp);
            println!(
                "{:>10} {:<24} held {share:.3} of {n:.0}, z mean {mean:+.2} rms {rms:.2}, median relative error {:.5}",
                name.0,
                name.1,
                errors[errors.len() / 2]
            );
            let slack = |wanted: f64| SCATTER * (wanted * (1.0 - wanted) / n).sqrt();
            let most = WANTED.end().max(cautious(&name.1));
            if !(WANTED.start() - slack(*WANTED.start())..=most + slack(most)).contains(&share) {
                wrong.push(format!("{} {} at noise × {level}: {share:.3} of {n:.0}", name.0, name.1));
            }
            if n < shown(&name.1) * all.len() as f64 {
                wrong.push(format!("{} {} at noise × {level}: shown by {n:.0} of {}", name.0, name.1, all.len()));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
