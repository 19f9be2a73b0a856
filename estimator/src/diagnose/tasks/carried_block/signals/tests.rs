//! A block that is picked up, carried and put down by two fingers with noisy force sensors.

use crate::diagnose::tasks::carried_block::recorded::{reach, recorded};
use crate::diagnose::tasks::carried_block::signals::Seen;
use haptics::recording::Recording;

const WEIGHT_N: f64 = 0.34;
const NOISE_N: f64 = 0.03;
const RATE_HZ: f64 = 100.0;
/// Time of the block's contact with the ground, s.
const TOUCHDOWN_S: f64 = 6.2;

/// `kept_n`: lift that goes on for a second after the block has met the ground. `leak_n_s`: weight that runs out in the
/// air.
fn recording(seed: u64, kept_n: f64, leak_n_s: f64) -> Recording {
    let_down_in(0.1, seed, kept_n, leak_n_s)
}

/// The same with a transfer of the load to the ground within `over_s`.
fn let_down_in(over_s: f64, seed: u64, kept_n: f64, leak_n_s: f64) -> Recording {
    recorded(seed, (RATE_HZ, 10.0), NOISE_N, &|t| {
        let grip_n = 2.0 * (reach(t, 1.1, 1.3) - reach(t, 8.2, 8.4));
        let weight_n = WEIGHT_N - leak_n_s * (t.min(TOUCHDOWN_S) - 2.1).max(0.0);
        let let_down = reach(t, TOUCHDOWN_S, TOUCHDOWN_S + over_s) * (weight_n - kept_n) + reach(t, 7.2, 7.4) * kept_n;
        let lift_n = reach(t, 1.8, 2.1) * weight_n - let_down;
        let open_m = 0.008 * (1.0 - reach(t, 0.5, 1.1) + reach(t, 8.4, 9.0));
        let x_m = 0.04 * reach(t, 4.0, 4.9);
        let y_m = -0.1 + 0.03 * (reach(t, 2.1, 3.1) - reach(t, 5.0, TOUCHDOWN_S));
        [x_m - 0.01 - open_m, y_m, x_m + 0.01 + open_m, y_m, grip_n, 0.5 * lift_n, -grip_n, 0.5 * lift_n]
    })
}

/// Times of the rows in which the block stands at the end of its carry.
fn standing_s(recording: &Recording) -> Vec<f64> {
    let seen = Seen::of(recording).expect("a carried block");
    let (_, standing) = seen.put(1, &[], [0.0; 2]);
    standing.into_iter().map(|i| seen.time_s(i)).collect()
}

/// Motion downward after touchdown is not lowering: it is a slip, or pads that yield under the load.
#[test]
fn a_block_stands_from_when_the_load_goes_over_and_not_from_when_the_fingers_stop() {
    let mut recording = recording(3, 0.0, 0.0);
    let time_s = recording.time_s.clone().expect("a clock");
    for channel in recording.channels.iter_mut().filter(|c| c.name.starts_with('y')) {
        channel
            .values
            .iter_mut()
            .zip(&time_s)
            .for_each(|(y, t)| *y -= 2e-3 * reach(*t, TOUCHDOWN_S, TOUCHDOWN_S + 0.2));
    }
    let seen = Seen::of(&recording).expect("a carried block");
    let rest: Vec<usize> =
        (0..time_s.len()).filter(|i| (TOUCHDOWN_S + 0.5..TOUCHDOWN_S + 1.5).contains(&time_s[*i])).collect();
    let (from_s, samples) = seen.put(1, &rest, [0.0; 2]);
    assert!((TOUCHDOWN_S..TOUCHDOWN_S + 0.08).contains(&from_s), "{from_s}");
    assert!(seen.time_s(samples[0]) < TOUCHDOWN_S + 0.1 && samples.ends_with(&rest), "{}", seen.time_s(samples[0]));
}

/// A careful hand takes a third of a second to put down. A slip meanwhile comes long before a quarter of the load is
/// transferred.
#[test]
fn a_load_that_goes_over_slowly_is_followed_back_to_where_it_began() {
    for seed in 0..8 {
        let recording = let_down_in(0.35, seed, 0.0, 0.0);
        let time_s = recording.time_s.clone().expect("a clock");
        let seen = Seen::of(&recording).expect("a carried block");
        let rest: Vec<usize> =
            (0..time_s.len()).filter(|i| (TOUCHDOWN_S + 0.5..TOUCHDOWN_S + 1.5).contains(&time_s[*i])).collect();
        let (from_s, _) = seen.put(1, &rest, [0.0; 2]);
        assert!((TOUCHDOWN_S - 0.01..TOUCHDOWN_S + 0.115).contains(&from_s), "seed {seed}: {from_s}");
    }
}

#[test]
fn noise_does_not_put_down_a_block_that_hangs() {
    for seed in 0..24 {
        let standing = standing_s(&recording(seed, 0.0, 0.0));
        // A row is a mean over some hundredths of a second.
        let early: Vec<&f64> = standing.iter().filter(|t| **t < TOUCHDOWN_S - 0.02).collect();
        assert!(early.is_empty(), "seed {seed}: {early:?}");
    }
}

#[test]
fn a_block_that_is_held_up_by_half_stands_all_the_same() {
    for seed in 0..8 {
        let standing = standing_s(&recording(seed, 0.5 * WEIGHT_N, 0.0));
        assert!(standing.iter().all(|t| *t > TOUCHDOWN_S - 0.02), "seed {seed}: {standing:?}");
        let late = standing.iter().filter(|t| **t > TOUCHDOWN_S + 0.1).count();
        assert!(late > 5, "seed {seed}: {standing:?}");
    }
}

#[test]
fn what_has_run_out_hangs_until_it_meets_the_ground() {
    for seed in 0..8 {
        let standing = standing_s(&recording(seed, 0.0, 0.05));
        let early: Vec<&f64> = standing.iter().filter(|t| **t < TOUCHDOWN_S - 0.02).collect();
        assert!(early.is_empty(), "seed {seed}: {early:?}");
    }
}
