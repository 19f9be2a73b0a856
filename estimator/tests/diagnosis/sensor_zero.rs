//! A constant force along a slide that rests before and after its motion.

use estimator::diagnose::{Options, diagnose};
use haptics::recording::{Channel, Recording};
use rand::RngExt as _;
use rand::SeedableRng as _;
use rand::rngs::StdRng;

/// A slide of 1 kg that is moved back and forth with dry and viscous friction and a constant of 0.4 N, between
/// rests of 1.5 s.
fn slid(at_rest_n: f64, trembles_n: f64) -> Recording {
    let time: Vec<f64> = (0..6000).map(|i| f64::from(i) * 4e-3).collect();
    let moves = |t: f64| (1.5..22.5).contains(&t);
    let place = |t: f64| if moves(t) { 0.05 * (1.0 - (std::f64::consts::TAU * (t - 1.5) / 3.0).cos()) } else { 0.0 };
    let force = |t: f64| {
        if !moves(t) {
            return at_rest_n + trembles_n * (9.0 * t).sin();
        }
        let w = std::f64::consts::TAU / 3.0;
        let (s, c) = (w * (t - 1.5)).sin_cos();
        let (v, a) = (0.05 * w * s, 0.05 * w * w * c);
        a + 3.0 * v + 0.8 * v.signum() + 0.4
    };
    let mut random = StdRng::seed_from_u64(7);
    let mut of = |name: &str, unit: &str, of: &dyn Fn(f64) -> f64, size: f64| Channel {
        name: name.to_owned(),
        unit: unit.to_owned(),
        values: time.iter().map(|t| of(*t) + size * random.random_range(-1.0..1.0)).collect(),
    };
    let channels = vec![of("q_m", "m", &place, 2e-6), of("f_N", "N", &force, 0.03)];
    Recording { name: "slide".to_owned(), time_s: Some(time), channels, ..Recording::default() }
}

#[test]
fn what_the_untouched_sensor_reads_tells_a_bias_from_what_is_moved() {
    let named = |recording: Recording| {
        let found = diagnose(&[recording], &Options::default()).expect("an answer");
        let others: Vec<String> = found.alternatives.iter().map(|a| a.id.clone()).collect();
        (found.causes.iter().map(|c| c.id.clone()).collect::<Vec<_>>(), others)
    };
    let (causes, others) = named(slid(0.4, 0.0));
    assert!(causes == ["force-bias"] && others.is_empty(), "{causes:?} or {others:?}");
    let (causes, others) = named(slid(0.0, 0.0));
    assert!(causes == ["friction-asymmetry"] && others == ["gravity-tilt"], "{causes:?} or {others:?}");
    // A hand that holds on gives no evidence.
    let (causes, others) = named(slid(0.0, 0.2));
    assert!(causes == ["force-bias"] && others.contains(&"friction-asymmetry".to_owned()), "{causes:?} or {others:?}");
}
