use super::*;
use rand::{RngExt as _, SeedableRng as _, rngs::StdRng};
use rand_distr::StandardNormal;

/// Readings every 20 ms: free until 2 s, carried from 3 s to 13 s, free again until 15 s; autocorrelated noise of 4 mN.
struct Made {
    carried: (Vec<f64>, Vec<f64>),
    free: (Vec<f64>, Vec<f64>),
    across: Vec<f64>,
}

fn make(seed: u64, weight_n_s: f64, bias_n_s: f64, after: bool) -> Made {
    let mut rng = StdRng::seed_from_u64(seed);
    let mut made = Made { carried: Default::default(), free: Default::default(), across: Vec::new() };
    let (mut state, mut sideways) = (0.0, 0.0);
    for i in 0..750 {
        let t = 0.02 * f64::from(i);
        state = 0.6 * state + 3.2e-3 * rng.sample::<f64, _>(StandardNormal);
        sideways = 0.6 * sideways + 3.2e-3 * rng.sample::<f64, _>(StandardNormal);
        let bias = 0.008 + bias_n_s * t;
        if (3.0..13.0).contains(&t) {
            made.carried.0.push(t);
            made.carried.1.push(0.4 + weight_n_s * (t - 3.0) + bias + state);
            made.across.push(sideways);
        } else if t < 2.0 || (after && t > 13.5) {
            made.free.0.push(t);
            made.free.1.push(bias + state);
        }
    }
    made
}

fn answer(made: &Made) -> LeakAnswer {
    let carried = Series { time_s: &made.carried.0, force_n: &made.carried.1 };
    let free = Series { time_s: &made.free.0, force_n: &made.free.1 };
    let weighing = Weighing { across_n: Some(&made.across), ..Weighing::new(carried, free, 9.81) };
    leak_or_drift(&weighing).expect("enough samples")
}

/// Verdicts of sixty drawn readings.
fn verdicts(weight_n_s: f64, bias_n_s: f64, after: bool) -> Vec<LeakAnswer> {
    (0..60).map(|seed| answer(&make(seed, weight_n_s, bias_n_s, after))).collect()
}

fn count(answers: &[LeakAnswer], verdict: Verdict) -> usize {
    answers.iter().filter(|a| a.verdict == verdict).count()
}

#[test]
fn a_leak_and_a_drift_are_told_apart_when_the_hand_was_free_afterwards() {
    let (leak, drift) = (verdicts(-0.01, 0.0, true), verdicts(0.0, -0.01, true));
    let (both, none) = (verdicts(-0.01, -0.01, true), verdicts(0.0, 0.0, true));
    println!(
        "leak {} drift {} both {} steady {}",
        count(&leak, Verdict::Leak),
        count(&drift, Verdict::SensorDrift),
        count(&both, Verdict::Both),
        count(&none, Verdict::Steady)
    );
    assert!(count(&leak, Verdict::Leak) >= 55 && count(&leak, Verdict::SensorDrift) == 0);
    assert!(count(&drift, Verdict::SensorDrift) >= 55 && count(&drift, Verdict::Leak) == 0);
    assert!(count(&both, Verdict::Both) >= 55);
    assert!(count(&none, Verdict::Steady) >= 57);
    let held = |a: &LeakAnswer| {
        let found = a.leak_kg_s.expect("free before and after");
        (found.value - 0.01 / 9.81).abs() < 1.96 * found.std_error
    };
    assert!(leak.iter().filter(|a| held(a)).count() >= 52, "95 % intervals of the rate hold it");
}

#[test]
fn without_a_free_phase_afterwards_it_cannot_be_told() {
    for (weight, bias) in [(-0.01, 0.0), (0.0, -0.01)] {
        let answers = verdicts(weight, bias, false);
        assert!(answers.iter().all(|a| matches!(a.verdict, Verdict::CannotTell | Verdict::Steady)));
        let asked = answers.iter().filter_map(|a| a.motion.as_deref()).all(|m| m.contains("let go"));
        assert!(asked && answers[0].leak_kg_s.is_none(), "{:?}", answers[0]);
    }
}

#[test]
fn another_object_weighed_before_and_after_serves_as_well() {
    let made = make(3, -0.01, 0.0, true);
    let other: Vec<f64> = made.free.1.iter().map(|f| f + 0.25).collect();
    let others = [Series { time_s: &made.free.0, force_n: &other }];
    let carried = Series { time_s: &made.carried.0, force_n: &made.carried.1 };
    let weighing = Weighing { others: &others, ..Weighing::new(carried, Series::default(), 9.81) };
    assert_eq!(leak_or_drift(&weighing).expect("enough samples").verdict, Verdict::Leak);
}

#[test]
fn bad_input_ends_in_a_sentence() {
    let short = Series { time_s: &[0.0, 1.0], force_n: &[0.1, 0.1] };
    assert!(leak_or_drift(&Weighing::new(short, short, 9.81)).is_err());
    let odd = Series { time_s: &[0.0, 1.0], force_n: &[0.1] };
    assert!(leak_or_drift(&Weighing::new(odd, short, 9.81)).expect_err("odd").to_string().contains("one force"));
    let nan = Series { time_s: &[0.0, 1.0], force_n: &[f64::NAN, 0.0] };
    assert!(leak_or_drift(&Weighing::new(nan, short, 9.81)).is_err());
    assert!(leak_or_drift(&Weighing::new(short, short, 0.0)).is_err());
}
