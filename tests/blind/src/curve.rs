//! Random functions that a seed repeats and that nobody stores: every place draws its own numbers when it is asked for.

use std::f64::consts::TAU;

/// Knots stand this far from their regular place at most, in knots.
///
/// Choice: gaps are unequal and stay above half a knot.
const JITTER: f64 = 0.25;
/// Units of a network.
///
/// Choice: enough that no two networks look alike.
const UNITS: i64 = 6;

/// A number between −√3 and √3 that belongs to one place of a seed: mean 0, variance 1. The mixer is splitmix64 (Steele, Lea & Flood
/// 2014).
pub fn unit(seed: u64, place: i64) -> f64 {
    let mut z = seed.wrapping_mul(0xd134_2543_de82_ef95) ^ place.cast_unsigned().wrapping_mul(0x9e37_79b9_7f4a_7c15);
    for factor in [0xbf58_476d_1ce4_e5b9_u64, 0x94d0_49bb_1331_11eb] {
        z = (z ^ (z >> 30)).wrapping_add(0x9e37_79b9_7f4a_7c15).wrapping_mul(factor);
    }
    let share = ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64;
    3_f64.sqrt() * (2.0 * share - 1.0)
}

/// The place that stands for `place` where `around` places make a turn.
fn wrapped(place: i64, around: Option<u32>) -> i64 {
    around.map_or(place, |turn| place.rem_euclid(i64::from(turn)))
}

/// Value noise: random values at uneven knots about 1 apart, joined smoothly. It comes again after `around` knots.
pub fn noise(seed: u64, x: f64, around: Option<u32>) -> f64 {
    let knot = |k: i64| k as f64 + JITTER / 3_f64.sqrt() * unit(seed ^ 0x5bd1, wrapped(k, around));
    let near = x.floor() as i64;
    let left = if x < knot(near) {
        near - 1
    } else if x >= knot(near + 1) {
        near + 1
    } else {
        near
    };
    let (from, to) = (knot(left), knot(left + 1));
    let way = ((x - from) / (to - from)).clamp(0.0, 1.0);
    let smooth = way * way * way * (10.0 - 15.0 * way + 6.0 * way * way);
    let (a, b) = (unit(seed, wrapped(left, around)), unit(seed, wrapped(left + 1, around)));
    a + (b - a) * smooth
}

/// Value noise that begins at 0, for odd functions without a jump.
pub fn from_rest(seed: u64, x: f64) -> f64 {
    noise(seed, x, None) - noise(seed, 0.0, None) * (-x * x).exp()
}

/// Value noise on three scales, the finer the weaker.
pub fn octaves(seed: u64, x: f64) -> f64 {
    (noise(seed, x, None) + 0.5 * noise(seed ^ 1, 2.3 * x, None) + 0.25 * noise(seed ^ 2, 5.1 * x, None)) / 1.15
}

/// Gaussian bumps of unequal height and width at random places, one for each unit of `x`. They come again after `around` of them.
pub fn bumps(seed: u64, x: f64, around: Option<u32>) -> f64 {
    let cell = x.floor() as i64;
    (cell - 3..=cell + 3)
        .map(|k| {
            let key = wrapped(k, around);
            let place = k as f64 + 0.5 + 0.25 * unit(seed ^ 0x1b87, key);
            let width = 0.42 + 0.13 * unit(seed ^ 0x3c6e, key);
            1.3 * unit(seed, key) * (-0.5 * ((x - place) / width).powi(2)).exp()
        })
        .sum()
}

/// A network of random weights with one hidden layer of tanh units.
pub fn network(seed: u64, inputs: [f64; 4]) -> f64 {
    let units = (0..UNITS).map(|j| {
        let weight = |k: i64| unit(seed, 8 * j + k);
        let sum = inputs.iter().zip(0..).fold(0.7 * weight(4), |sum, (x, k)| sum + 1.3 * weight(k) * x);
        weight(5) * sum.tanh()
    });
    units.sum::<f64>() / (UNITS as f64).sqrt()
}

/// A tone of about `hz` whose amplitude and phase wander within `period_s`.
pub fn tone(seed: u64, hz: f64, period_s: f64, time_s: f64) -> f64 {
    let wander = |key: u64| noise(seed + 2 * key, time_s / period_s, None);
    (1.0 + 0.6 * wander(1)) * (TAU * hz * time_s + 1.5 * wander(2)).sin()
}

/// A staircase of uneven steps about `step` wide: the middle of the step on which `value` stands.
pub fn staircase(seed: u64, value: f64, step: f64) -> f64 {
    if step <= 0.0 {
        return value;
    }
    let edge = |k: i64| k as f64 + 0.2 * unit(seed, k);
    let (x, near) = (value / step, (value / step).floor() as i64);
    let low = (near - 1..=near + 1).rev().find(|k| edge(*k) <= x).unwrap_or(near - 1);
    0.5 * step * (edge(low) + edge(low + 1))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Mean and variance of a function over many seeds.
    fn moments(f: impl Fn(u64) -> f64) -> (f64, f64) {
        let values: Vec<f64> = (0..4000).map(f).collect();
        let mean = values.iter().sum::<f64>() / 4000.0;
        (mean, values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / 4000.0)
    }

    #[test]
    fn numbers_of_a_place_have_mean_0_and_variance_1_and_neighbours_are_strangers() {
        let (mean, variance) = moments(|seed| unit(seed, 3));
        assert!(mean.abs() < 0.05 && (variance - 1.0).abs() < 0.05, "{mean} {variance}");
        let together = (0..4000).map(|k| unit(7, k) * unit(7, k + 1)).sum::<f64>() / 4000.0;
        let seeds = (0..4000).map(|k| unit(k, 5) * unit(k + 1, 5)).sum::<f64>() / 4000.0;
        assert!(together.abs() < 0.06 && seeds.abs() < 0.06, "{together} {seeds}");
    }

    #[test]
    fn curves_are_smooth_vary_and_come_round() {
        for f in [noise, bumps] {
            for seed in 0..20 {
                let at = |x: f64| f(seed, x, Some(6));
                let largest = (0..6000).map(|k| (at(1e-3 * f64::from(k + 1)) - at(1e-3 * f64::from(k))).abs());
                assert!(largest.fold(0.0, f64::max) < 0.02, "{seed}");
                assert!((at(0.3) - at(6.3)).abs() < 1e-3 && (at(-0.1) - at(5.9)).abs() < 1e-3, "{seed}");
            }
            let (_, variance) = moments(|seed| f(seed, 2.4, None));
            assert!((0.3..1.5).contains(&variance), "{variance}");
        }
        let (_, variance) = moments(|seed| network(seed, [0.5, -0.5, 1.0, 0.3]));
        assert!((0.2..1.5).contains(&variance), "{variance}");
    }

    #[test]
    fn a_staircase_rises_in_uneven_steps_and_stays_near() {
        let read: Vec<f64> = (0..10_000).map(|k| staircase(4, 1e-3 * f64::from(k) - 5.0, 0.5)).collect();
        assert!(read.windows(2).all(|w| w[1] >= w[0]));
        let mut heights: Vec<f64> = read.windows(2).map(|w| w[1] - w[0]).filter(|d| *d > 0.0).collect();
        heights.sort_by(f64::total_cmp);
        assert!((18..23).contains(&heights.len()) && heights[heights.len() - 1] > 1.2 * heights[0], "{heights:?}");
        assert!(read.iter().zip(0..).all(|(r, k)| (r - (1e-3 * f64::from(k) - 5.0)).abs() < 0.45));
    }
}
