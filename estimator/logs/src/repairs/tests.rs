//! Recordings with a known motion, spoiled by a logger.

use super::*;
use haptics::recording::Channel;

fn channel(name: &str, unit: &str, values: Vec<f64>) -> Channel {
    Channel { name: name.to_owned(), unit: unit.to_owned(), values }
}

/// A swing of two tones at 500 Hz, with a force.
fn swing(count: usize) -> Recording {
    let time_s: Vec<f64> = (0..count).map(|i| 0.002 * i as f64).collect();
    let angle = |t: &f64| 2.0 * (2.1 * t).sin() + 1.7 * (0.63 * t).cos();
    let rough = |i: usize| 1e-3 * ((i * 7919) % 1000) as f64;
    let force = time_s.iter().enumerate().map(|(i, t)| 3.0 * t.cos() + rough(i)).collect();
    let channels = vec![channel("q_rad", "rad", time_s.iter().map(angle).collect()), channel("tau_Nm", "Nm", force)];
    Recording { time_s: Some(time_s), channels, ..Recording::default() }
}

fn kinds(found: &[Warning]) -> Vec<&str> {
    found.iter().map(|warning| warning.kind.as_str()).collect()
}

#[test]
fn a_sound_recording_stays_as_it_is() {
    let (mut one, as_it_was) = (swing(4000), swing(4000));
    assert!(repair(&mut one).is_empty() && one == as_it_was);
    // An encoder that counts slowly is no held channel.
    let mut coarse = swing(4000);
    coarse.channels[0].values.iter_mut().for_each(|v| *v = (*v / 0.05).round() * 0.05);
    let before = coarse.clone();
    assert!(repair(&mut coarse).is_empty() && coarse == before);
}

#[test]
fn wrapped_angles_are_put_together() {
    let (mut wrapped, whole) = (swing(4000), swing(4000));
    let wrap = |v: &mut f64| *v = (*v + std::f64::consts::PI).rem_euclid(std::f64::consts::TAU) - std::f64::consts::PI;
    wrapped.channels[0].values.iter_mut().for_each(wrap);
    let found = repair(&mut wrapped);
    assert_eq!(kinds(&found), ["wrapped-angle"]);
    let turns = wrapped.channels[0].values[0] - whole.channels[0].values[0];
    let off = wrapped.channels[0].values.iter().zip(&whole.channels[0].values).map(|(a, b)| (a - b - turns).abs());
    assert!(off.fold(0.0, f64::max) < 1e-9);
}

#[test]
fn held_rows_are_left_out() {
    for every in [2, 3, 5, 10] {
        let (mut held, whole) = (swing(6000), swing(6000));
        let values = &mut held.channels[0].values;
        (0..values.len()).for_each(|i| values[i] = values[i / every * every]);
        let found = repair(&mut held);
        assert_eq!(kinds(&found), ["held-samples"], "{every}");
        let time = held.time_s.as_ref().expect("a clock");
        assert!((time[9] - time[8] - 0.002 * every as f64).abs() < 1e-9, "{every}: {:?}", &time[..10]);
        let expected = |k: usize| whole.channels[0].values[(time[k] / 0.002).round() as usize];
        assert!((0..time.len()).all(|k| held.channels[0].values[k] == expected(k)), "{every}");
    }
}

#[test]
fn bursts_are_spread() {
    let (mut bursts, whole) = (swing(4000), swing(4000));
    let time = bursts.time_s.as_mut().expect("a clock");
    (0..time.len()).for_each(|i| time[i] = 0.016 * (i / 8 + 1) as f64 + 1e-5 * (i % 8) as f64);
    let found = repair(&mut bursts);
    assert_eq!(kinds(&found), ["burst-stamps"]);
    let (time, true_s) = (bursts.time_s.expect("a clock"), whole.time_s.expect("a clock"));
    assert!(time.iter().zip(&true_s).all(|(a, b)| (a - b - 0.016).abs() < 1e-9));
}

#[test]
fn spikes_give_way_to_their_neighbours_unless_the_sidecar_says_no() {
    let spoiled = || {
        let mut one = swing(4000);
        (40..4000).step_by(97).for_each(|i| one.channels[1].values[i] += 40.0);
        one
    };
    let mut one = spoiled();
    assert_eq!(kinds(&repair(&mut one)), ["outlier"]);
    assert!(one.channels[1].values.iter().all(|v| v.abs() < 5.0));
    let mut kept = spoiled();
    kept.meta.other.insert(AS_RECORDED.to_owned(), serde_json::json!(["spikes"]));
    assert!(repair(&mut kept).is_empty() && kept.channels == spoiled().channels);
}
