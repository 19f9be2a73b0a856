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

/// Two sensors in alternating rows share the force, which has a new value in every second row.
#[test]
fn sensors_in_turn_are_doubted_and_their_rows_stay() {
    let mut one = swing(4000);
    for channel in &mut one.channels {
        channel.values = (0..4000).map(|row| channel.values[row / 2]).collect();
    }
    let mut held = one.clone();
    one.channels[0].values.iter_mut().skip(1).step_by(2).for_each(|angle| *angle = 2.0 * *angle + 0.3);
    assert!(!kinds(&repair(&mut one)).contains(&"held-samples") && one.len() == 4000);
    assert_eq!(kinds(&checks::warnings(&one)), ["alternation"]);
    assert_eq!(kinds(&repair(&mut held)), ["held-samples"]);
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
fn an_angle_that_turns_by_more_than_a_quarter_in_a_sample_is_put_together() {
    let mut fast = swing(4000);
    let whole: Vec<f64> = (0..4000).map(|i| 400.0 * (0.0065 * f64::from(i)).sin()).collect();
    fast.channels[0].values = whole.iter().map(|angle| angle.rem_euclid(std::f64::consts::TAU)).collect();
    assert_eq!(kinds(&repair(&mut fast)), ["wrapped-angle"]);
    assert!(fast.channels[0].values.iter().zip(&whole).all(|(a, b)| (a - b).abs() < 1e-9));
}

#[test]
fn a_scale_that_starts_anew_goes_on() {
    let mut scale = swing(4000);
    let whole: Vec<f64> = (0..4000).map(|i| 0.02 + 0.31 * (0.004 * f64::from(i)).sin().powi(2)).collect();
    scale.channels[0] = channel("q_m", "m", whole.iter().map(|place| place.rem_euclid(0.1)).collect());
    assert_eq!(kinds(&repair(&mut scale)), ["wrapped-counter"]);
    assert!(scale.channels[0].values.iter().zip(&whole).all(|(a, b)| (a - b).abs() < 1e-9));
}

#[test]
fn rows_of_a_stuck_sensor_are_left_out() {
    for k in 0..2 {
        let (mut stuck, whole) = (swing(4000), swing(4000));
        let held = stuck.channels[k].values[1000];
        stuck.channels[k].values[1000..1160].fill(held);
        let found = repair(&mut stuck);
        assert_eq!(kinds(&found), ["stuck-channel"], "{k}");
        let left: Vec<f64> = [&whole.channels[k].values[..1001], &whole.channels[k].values[1160..]].concat();
        assert_eq!(stuck.channels[k].values, left);
    }
}

#[test]
fn a_position_that_drops_to_zero_for_some_rows_is_left_out_there() {
    let (mut dropped, whole) = (swing(4000), swing(4000));
    dropped.channels[0].values[2000..2020].fill(0.0);
    // A motion passes zero, too.
    let passes = (1..3999).find(|&i| whole.channels[0].values[i - 1] * whole.channels[0].values[i + 1] < 0.0);
    dropped.channels[0].values[passes.expect("a passage")] = 0.0;
    let found = repair(&mut dropped);
    assert_eq!((kinds(&found), dropped.len()), (vec!["sentinel"], 3980));
}

#[test]
fn counters_go_on_where_they_run_over() {
    // A position in steps of 0.5 µm, and a force in mN, with a sign and without one.
    for (name, unit, least, low) in [("q_m", "m", 5e-7, 0.0), ("f_N", "N", 1e-3, -32_768.0), ("f_N", "N", 1e-3, 0.0)] {
        let (mut one, size) = (swing(4000), 40_000.0);
        let counts: Vec<f64> = one.channels[0].values.iter().map(|v| (v / 3.7 * size).round()).collect();
        let wrapped = counts.iter().map(|count| least * ((count - low).rem_euclid(65_536.0) + low)).collect();
        one.channels[0] = channel(name, unit, wrapped);
        one.channels.truncate(1);
        let found = repair(&mut one);
        assert_eq!(kinds(&found), ["wrapped-counter"], "{name}");
        let shift = one.channels[0].values[0] - least * counts[0];
        assert!(unit == "m" || shift.abs() < 1e-9, "forces are about zero");
        let off = one.channels[0].values.iter().zip(&counts).map(|(v, count)| (v - least * count - shift).abs());
        assert!(off.fold(0.0, f64::max) < 1e-9);
    }
}

/// Dry friction of 2 N that reverses in one row, in steps of 1 mN: 4 N are nearly 12 bits.
#[test]
fn friction_that_reverses_is_no_counter() {
    let mut one = swing(4000);
    let force = |i: usize| if (i / 450).is_multiple_of(2) { 2.03 } else { -2.03 };
    let rough = |i: usize| 1e-3 * ((i * 7919) % 40) as f64;
    one.channels[1] =
        channel("f_N", "N", (0..4000).map(|i| ((force(i) - rough(i)) * 1e3_f64).round() * 1e-3).collect());
    assert!(repair(&mut one).iter().all(|warning| warning.kind != "wrapped-counter"));
}

#[test]
fn a_torque_that_switches_between_its_limits_is_no_counter() {
    let mut one = swing(4000);
    let switched = |i: usize| if (i / 300).is_multiple_of(2) { 32.767 } else { -32.768 + 0.001 * (i % 7) as f64 };
    one.channels[1].values = (0..4000).map(switched).collect();
    let before = one.clone();
    assert!(
        repair(&mut one).iter().all(|warning| warning.kind != "wrapped-counter") && one.channels == before.channels
    );
}

/// Positions of a slow source, put on the rows of a faster logger by straight lines, as a resampling does.
#[test]
fn interpolated_positions_are_read_at_their_own_rate() {
    for (every, quantum) in [(20.0, 0.0), (20.0, 1e-4), (33.3, 1e-6)] {
        let (mut lines, whole) = (swing(6000), swing(6000));
        let (time, exact) = (whole.time_s.clone().expect("a clock"), &whole.channels[0].values);
        let known: Vec<f64> = (0..6000).map(|k| f64::from(k) * every).take_while(|row| *row < 5998.0).collect();
        let at = |row: f64| exact[row as usize] + row.fract() * (exact[row as usize + 1] - exact[row as usize]);
        for row in 0..6000 {
            let k = ((row as f64 / every) as usize).min(known.len() - 2);
            let share = (row as f64 - known[k]) / every;
            let value = at(known[k]) + share * (at(known[k + 1]) - at(known[k]));
            lines.channels[0].values[row] = if quantum > 0.0 { (value / quantum).round() * quantum } else { value };
        }
        let found = repair(&mut lines);
        assert_eq!(kinds(&found), ["held-samples"], "{every} {quantum}");
        assert!(found[0].text.contains("is interpolated in between"), "{}", found[0].text);
        let step = (time[5999] - lines.time_s.as_ref().expect("a clock")[0]) / lines.len() as f64;
        assert!((step / (0.002 * every) - 1.0).abs() < 0.05, "{step}");
    }
}

/// A logger that polls its source misses or repeats a value whenever their clocks beat, and rounded times skip every few rows. Neither
/// interpolates.
#[test]
fn polled_positions_and_rounded_times_are_not_interpolated() {
    for (source_hz, poll_hz) in [(480.0, 500.0), (950.0, 1000.0), (500.0, 480.0), (125.0, 100.0)] {
        let mut polled = swing(4000);
        let newest = |row: usize| (row as f64 * source_hz / poll_hz).floor() / source_hz;
        let swung = |t: f64| 0.05 * (4.1 * t).sin() + 0.02 * (9.7 * t).cos();
        polled.time_s = Some((0..4000).map(|row| f64::from(row) / poll_hz).collect());
        polled.channels[0].values = (0..4000).map(|row| swung(newest(row))).collect();
        assert!(repair(&mut polled).is_empty(), "{source_hz} {poll_hz}");
    }
    for rate_hz in [60.0, 75.0] {
        let mut rounded = swing(4000);
        rounded.time_s = Some((0..4000).map(|row| (f64::from(row) / rate_hz * 100.0).round() / 100.0).collect());
        assert!(repair(&mut rounded).iter().all(|warning| warning.kind != "held-samples"), "{rate_hz}");
    }
}

/// A drive at constant speed between its turns bends its position at the turns alone.
#[test]
fn a_triangle_stays_as_it_is() {
    let mut sweep = swing(8000);
    let triangle = |row: usize| (row % 100).abs_diff(50) as f64 * 0.01;
    sweep.channels[0].values = (0..8000).map(triangle).collect();
    let before = sweep.clone();
    assert!(repair(&mut sweep).is_empty() && sweep == before);
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
    kept.meta.as_recorded = vec!["spikes".to_owned()];
    assert!(repair(&mut kept).is_empty() && kept.channels == spoiled().channels);
}

#[test]
fn numbers_that_stand_for_no_value_are_left_out_with_their_rows() {
    let put = |channel: usize, value: f64, rows: &[std::ops::Range<usize>]| {
        let mut one = swing(4000);
        rows.iter().cloned().flatten().for_each(|row| one.channels[channel].values[row] = value);
        one
    };
    let runs = [0..3, 900..940, 2500..2501];
    for value in [-999.0, -9.99, 65_535.0, 655.35, f64::to_radians(9999.0), -32_768e-3] {
        for channel in 0..2 {
            let mut spoilt = put(channel, value, &runs);
            let found = repair(&mut spoilt);
            assert_eq!((kinds(&found), spoilt.len()), (vec!["sentinel"], 3956), "{value}");
            let (whole, time) = (swing(4000), spoilt.time_s.as_ref().expect("a clock"));
            let row = |k: usize| (time[k] / 0.002).round() as usize;
            let same =
                (0..time.len()).all(|k| spoilt.channels[channel].values[k] == whole.channels[channel].values[row(k)]);
            assert!(same, "{value}");
        }
    }
    // A dropout to zero of an angle; a torque may vanish.
    let mut dropped = put(0, 0.0, &[700..720, 1900..1950]);
    assert_eq!((kinds(&repair(&mut dropped)), dropped.len()), (vec!["sentinel"], 3930));
    let mut released = put(1, 0.0, &[700..720, 1900..1950]);
    assert_eq!((repair(&mut released).len(), released.len()), (0, 4000));
    // A position that is never near 0, and one with two places only.
    let mut far = swing(4000);
    far.channels[0].values.iter_mut().for_each(|v| *v += 20.0);
    far.channels[0].values[700..720].fill(0.0);
    assert_eq!((kinds(&repair(&mut far)), far.len()), (vec!["sentinel"], 3980));
    let mut places = swing(4000);
    places.channels[0].values.iter_mut().enumerate().for_each(|(i, v)| *v = if i % 900 < 600 { 0.3 } else { 0.0 });
    assert!(repair(&mut places).is_empty());
    // Two numbers in use, and one that stands in every twentieth row.
    let mut two = put(0, -999.0, &runs);
    two.channels[0].values[2000..2010].fill(65_535.0);
    assert_eq!((kinds(&repair(&mut two)), two.len()), (vec!["sentinel"; 2], 3946));
    let mut often = put(1, -999.0, &[]);
    (0..4000).step_by(20).for_each(|row| often.channels[1].values[row] = -999.0);
    assert_eq!((kinds(&repair(&mut often)), often.len()), (vec!["sentinel"], 3800));
    let mut kept = put(0, -999.0, &runs);
    kept.meta.as_recorded = ["sentinels", "stuck-channel", "spikes"].map(str::to_owned).into();
    assert!(repair(&mut kept).is_empty() && kept.len() == 4000);
}

#[test]
fn rows_at_a_stop_are_left_out() {
    let mut stopped = swing(16_000);
    let limits = [-2.0, 2.1];
    stopped.channels[0].values.iter_mut().for_each(|v| *v = v.clamp(limits[0], limits[1]));
    let at_stop = stopped.channels[0].values.iter().filter(|v| limits.contains(v)).count();
    let found = repair(&mut stopped);
    assert_eq!((kinds(&found), stopped.len()), (vec!["stuck-channel"], 16_000 - at_stop), "{found:?}");
    stopped.warnings = found;
    assert!(checks::warnings(&stopped).is_empty(), "the gaps are told already");
    // The turning points of encoders are no stops, and neither are places at which a hand pauses.
    let pause: fn(f64) -> f64 = |t| {
        let (stroke, s) = ((t / 2.0).floor(), (t % 2.0).min(1.0));
        let way = s.powi(3) * (10.0 - 15.0 * s + 6.0 * s * s);
        if stroke % 2.0 == 0.0 { way } else { 1.0 - way }
    };
    let sampled = |position: fn(f64) -> f64, quantum: f64, period_s: f64| {
        let mut moved = swing(8000);
        let time_s: Vec<f64> = (0..8000).map(|i| period_s * f64::from(i)).collect();
        moved.channels[0].values = time_s.iter().map(|t| (position(*t) / quantum).round() * quantum).collect();
        moved.time_s = Some(time_s);
        moved
    };
    let turns = [sampled(|t| (12.9 * t).sin(), 0.05, 0.02), sampled(|t| 2.0 * (2.1 * t).sin(), 0.01, 0.002)];
    for mut moved in turns.into_iter().chain([sampled(pause, 0.001, 0.002)]) {
        assert!(repair(&mut moved).is_empty() && moved.len() == 8000);
    }
}

#[test]
fn motion_through_zero_and_a_travel_of_999_are_measured() {
    let mut rest = swing(4000);
    rest.channels[0].values.iter_mut().enumerate().for_each(|(i, v)| *v = if i < 1500 { 0.0 } else { *v - 1.7 });
    let before = rest.channels[0].values[1600];
    assert!(repair(&mut rest).is_empty() && rest.channels[0].values[1600] == before);
    let mut travel = swing(4000);
    travel.channels[0].values.iter_mut().for_each(|v| *v *= 999.0 / 3.7);
    let top = travel.channels[0].values.iter().copied().fold(f64::MIN, f64::max);
    travel.channels[0].values.iter_mut().for_each(|v| *v *= 999.0 / top);
    assert!(repair(&mut travel).is_empty() && travel.len() == 4000);
}

#[test]
fn a_velocity_alone_gives_the_position_with_its_drift() {
    let whole = swing(4000);
    let time = whole.time_s.clone().expect("a clock");
    let position = |t: f64| 0.2 * (3.0 * t).sin();
    let mut fast = whole.clone();
    fast.channels[0] = channel("dq_m_s", "m_s", time.iter().map(|t| 0.6 * (3.0 * t).cos()).collect());
    let found = repair(&mut fast);
    assert_eq!(kinds(&found), ["integrated"]);
    let made = fast.channel("q_m").expect("a position");
    let off = time.iter().zip(made).map(|(t, q)| (q - position(*t)).abs()).fold(0.0, f64::max);
    assert!(off < 1e-4, "{off}");
    // An accelerometer with an offset, from rest to rest.
    let end = time[time.len() - 1];
    let turn = std::f64::consts::TAU / end;
    let mut slow = whole.clone();
    slow.channels[0] = channel("ddq_m_s2", "m_s2", time.iter().map(|t| 0.3 * (turn * t).sin() + 0.05).collect());
    assert_eq!(kinds(&repair(&mut slow)), ["integrated", "integrated"]);
    let made = slow.channel("dq_m_s").expect("a velocity");
    let right = |t: f64| 0.3 / turn * (1.0 - (turn * t).cos());
    let off = time.iter().zip(made).map(|(t, v)| (v - right(*t)).abs()).fold(0.0, f64::max);
    assert!(off < 1e-3 && slow.channel("q_m").is_some(), "{off}");
}

/// A source of any ratio to the logger's rate is told, and its values are moved to the rows.
#[test]
fn a_source_with_another_clock_is_moved_to_the_rows() {
    for ratio in [1.5, 2.7, 3.3, 7.3] {
        let place = |t: f64| (6.0 * t).sin() + 0.3 * (17.0 * t).sin();
        let rate_hz = 500.0;
        let held = |row: usize| place((((row as f64 - 0.2) / ratio).floor() * ratio + 0.2) / rate_hz);
        let rows = 5000;
        let values = |of: &dyn Fn(usize) -> f64| (0..rows).map(of).collect::<Vec<f64>>();
        let mut recording = Recording {
            time_s: Some(values(&|row| row as f64 / rate_hz)),
            channels: vec![channel("q_m", "m", values(&held)), channel("f_N", "N", values(&|row| (row as f64).sqrt()))],
            ..Recording::default()
        };
        let said = held_samples::take_out(&mut recording).expect("held").text;
        let rate = format!("{:.4} Hz", rate_hz / ratio);
        assert!(said.contains(&rate[..4]), "{ratio}: {said}");
        let time = recording.time_s.as_deref().expect("a clock");
        let off = time.iter().zip(&recording.channels[0].values).map(|(t, value)| (value - place(*t)).abs());
        // Half a row is 6e-3. Few ratios show all of the lag: of 1.5, a quarter of a row stays unknown.
        let inner: Vec<f64> = off.skip(40).take(time.len() - 80).collect();
        let rms = (inner.iter().map(|off| off * off).sum::<f64>() / inner.len() as f64).sqrt();
        assert!(rms < 2e-3, "{ratio}: {rms}");
    }
}
