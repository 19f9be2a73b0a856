//! A finger that comes to a crank's handle, turns it back and forth and goes away again, with a sensor that has noise
//! and a bias.

use crate::identify::crank;
use crate::segment::segment;
use crate::segment::segmentation::Segmentation;
use foundation::tasks::{SystemState, Thresholds};
use haptics::Vec2;
use haptics::recording::{Channel, Recording, Task};
use rand::{RngExt as _, SeedableRng as _};
use std::f64::consts::TAU;

const RADIUS_M: f64 = 0.025;
const CENTER_M: Vec2 = Vec2::new(0.003, -0.1);
const WEIGHT_N: f64 = 0.2;
/// The handle is held between these, s.
pub(crate) const HELD_S: (f64, f64) = (1.5, 18.5);
const LENGTH_S: f64 = 20.0;
const RATE_HZ: f64 = 200.0;

fn ease(share: f64) -> f64 {
    let u = share.clamp(0.0, 1.0);
    u * u * (3.0 - 2.0 * u)
}

/// Position of the finger, m, and its force, N.
fn state(t: f64) -> (Vec2, Vec2) {
    let turn = |t: f64| 2.2 * (0.9 * t).sin() + 0.8 * (0.41 * t).cos();
    let step = 1e-4;
    let angle = turn(t.clamp(HELD_S.0, HELD_S.1));
    let speed = RADIUS_M * (turn(t + step) - turn(t - step)) / (2.0 * step);
    let (out, along) = (Vec2::new(angle.cos(), angle.sin()), Vec2::new(-angle.sin(), angle.cos()));
    let away = 1.0 - ease((t - 0.3) / 1.1) + ease((t - HELD_S.1 - 0.1) / 1.0);
    let position = CENTER_M + out * RADIUS_M + Vec2::new(0.004, 0.009) * away;
    if !(HELD_S.0..HELD_S.1).contains(&t) {
        return (position, Vec2::zeros());
    }
    let firm = ease((t - HELD_S.0) / 0.2) * ease((HELD_S.1 - t) / 0.2);
    // Now and then the hand hardly pulls.
    let pull = firm * (1.0 + 0.6 * (0.83 * t).sin() + 0.35 * (2.3 * t).cos());
    let tangential = WEIGHT_N * angle.cos() + 0.08 * pull.abs() * (speed / 1e-3).tanh() + 1.1 * speed;
    (position, out * pull + along * tangential * firm)
}

/// The finger's recording.
pub(crate) fn recording(seed: u64, noise_n: f64, bias_n: Vec2) -> Recording {
    let mut rng = rand::rngs::StdRng::seed_from_u64(seed);
    let mut normal = move || {
        let (a, b): (f64, f64) = (rng.random_range(1e-12..1.0), rng.random());
        (-2.0 * a.ln()).sqrt() * (TAU * b).cos()
    };
    let names = ["x_m", "y_m", "fx_N", "fy_N"];
    let mut columns = vec![Vec::new(); names.len()];
    let mut time_s = Vec::new();
    // Noise that partly remembers, as that of a real sensor.
    let mut slow = Vec2::zeros();
    for i in 0..(LENGTH_S * RATE_HZ) as u32 {
        let t = f64::from(i) / RATE_HZ;
        let (position, force) = state(t);
        let keep = (-1.0 / (RATE_HZ * 0.03)).exp();
        slow = slow * keep + Vec2::new(normal(), normal()) * (1.0 - keep * keep).sqrt();
        let noise = (Vec2::new(normal(), normal()) * 0.84 + slow * 0.54) * noise_n;
        let measured = force + bias_n + noise;
        let values = [position.x + 1e-5 * normal(), position.y + 1e-5 * normal(), measured.x, measured.y];
        columns.iter_mut().zip(values).for_each(|(c, v)| c.push(v));
        time_s.push(t);
    }
    let channel = |(name, values): (&str, Vec<f64>)| Channel { name: name.to_owned(), unit: String::new(), values };
    let mut recording = Recording {
        name: "crank".to_owned(),
        time_s: Some(time_s),
        channels: names.into_iter().zip(columns).map(channel).collect(),
        ..Recording::default()
    };
    recording.meta.task = Some(Task::Crank);
    recording
}

fn segmented(recording: &Recording) -> Segmentation {
    segment(recording, None, None).expect("a crank")
}

/// The handle is let go at both ends, and nothing chatters. Under much noise a pull that is hardly there may pass for none, for a tenth
/// of the time.
fn assert_held(found: &Segmentation, words: &str) {
    let free: Vec<_> = found.states.iter().filter(|i| i.state == SystemState::FreeMotion).collect();
    let ([first, ..], [.., last]) = (free.as_slice(), free.as_slice()) else { panic!("{words}: never free") };
    assert!(first.t0 == 0.0 && (first.t1 - HELD_S.0).abs() < 0.15, "{words}: until {}", first.t1);
    assert!((last.t0 - HELD_S.1).abs() < 0.15, "{words}: from {}", last.t0);
    let between: f64 = free.iter().map(|i| i.t1 - i.t0).sum::<f64>() - (first.t1 - first.t0) - (last.t1 - last.t0);
    assert!(between < 0.1 * (HELD_S.1 - HELD_S.0), "{words}: {:?}", found.states);
    assert!(free.iter().all(|i| i.t1 - i.t0 > 0.1), "{words}: {:?}", found.states);
}

fn assert_centre(recording: &Recording, words: &str) {
    let (fit, _) = crank::fit(recording, None).expect("a crank");
    for (name, truth) in [("center_x_m", CENTER_M.x), ("center_y_m", CENTER_M.y), ("weight_N", WEIGHT_N)] {
        let parameter = fit.parameters.iter().find(|p| p.name == name).expect("every crank has it");
        let (value, error) = (parameter.value.expect("seen"), parameter.std_error.expect("seen"));
        assert!((value - truth).abs() < 5.0 * error, "{words}: {name} is {value} ± {error}, not {truth}");
    }
}

#[test]
fn noise_is_not_taken_for_contact() {
    for (seed, noise_n) in [(1, 0.02), (2, 0.06), (3, 0.1)] {
        let (recording, words) = (recording(seed, noise_n, Vec2::zeros()), format!("noise of {noise_n} N"));
        let found = segmented(&recording);
        assert_held(&found, &words);
        assert!(found.thresholds.force_n < 0.6, "{words}: {}", found.thresholds.force_n);
        assert_centre(&recording, &words);
    }
}

#[test]
fn a_bias_is_not_taken_for_contact() {
    for (seed, bias) in [(4, Vec2::new(0.12, 0.0)), (5, Vec2::new(0.2, -0.1)), (6, Vec2::new(-0.1, 0.45))] {
        let (recording, words) = (recording(seed, 0.015, bias), format!("bias of {bias:?} N"));
        let found = segmented(&recording);
        assert_held(&found, &words);
        assert!(found.warnings.iter().any(|w| w.contains("bias is subtracted")), "{words}: {:?}", found.warnings);
        assert_centre(&recording, &words);
    }
}

#[test]
fn a_steady_pull_on_a_handle_that_is_never_let_go_is_no_bias() {
    let whole = recording(7, 0.015, Vec2::zeros());
    let time_s = whole.time_s.clone().expect("timed");
    // Between two seconds at rest under a steady pull of the sensor's range, the same turning.
    let inside: Vec<usize> = (0..time_s.len()).filter(|i| (2.0..18.0).contains(&time_s[*i])).collect();
    let (first, last) = (inside[0], inside[inside.len() - 1]);
    let rest = 2 * RATE_HZ as usize;
    let order: Vec<usize> = [first].repeat(rest).into_iter().chain(inside).chain([last].repeat(rest)).collect();
    let mut held = whole.clone();
    held.time_s = Some((0..order.len()).map(|i| i as f64 / RATE_HZ).collect());
    for (channel, source) in held.channels.iter_mut().zip(&whole.channels) {
        channel.values = order.iter().map(|i| source.values[*i]).collect();
        let noise = source.values[..rest].iter().map(|v| v - source.values[..rest].iter().sum::<f64>() / rest as f64);
        if channel.name.starts_with('f') {
            let pull = if channel.name == "fx_N" { 0.25 } else { 0.3 };
            for (k, noise) in noise.enumerate() {
                channel.values[k] = pull + noise;
                let back = channel.values.len() - 1 - k;
                channel.values[back] = pull + noise;
            }
        }
    }
    let found = segmented(&held);
    let free: f64 = found.states.iter().filter(|i| i.state == SystemState::FreeMotion).map(|i| i.t1 - i.t0).sum();
    assert!(free < 0.3, "{:?}", found.states);
    assert!(!found.warnings.iter().any(|w| w.contains("bias")), "{:?}", found.warnings);
}

#[test]
fn a_stated_threshold_is_kept() {
    let given = Thresholds { velocity_m_s: 0.01, force_n: 0.3 };
    let found = segment(&recording(8, 0.06, Vec2::zeros()), None, Some(given)).expect("a crank");
    assert_eq!(found.thresholds, given);
}
