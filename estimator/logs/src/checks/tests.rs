//! Each fault once, and signals that must not be taken for one.

use super::*;
use haptics::recording::Span;

fn channel(name: &str, values: Vec<f64>) -> Channel {
    let unit = units::split(name).map_or(String::new(), |(_, u)| u.si.to_owned());
    Channel { name: name.to_owned(), unit, values }
}

fn wave(n: usize) -> Vec<f64> {
    (0..n).map(|i| (i as f64 * 0.05).sin() + 1e-3 * (i as f64 * 17.3).sin()).collect()
}

fn recording(time_s: Vec<f64>, channels: Vec<Channel>) -> Recording {
    Recording { time_s: Some(time_s), channels, ..Recording::default() }
}

fn kinds(warnings: &[Warning]) -> Vec<&str> {
    warnings.iter().map(|w| w.kind.as_str()).collect()
}

#[test]
fn a_clean_recording_has_no_warnings() {
    let time = (0..1000).map(|i| f64::from(i) * 1e-3).collect();
    let other = (0..1000).map(|i| (f64::from(i) * 0.03).cos() + 1e-3 * (f64::from(i) * 23.1).sin()).collect();
    assert!(warnings(&recording(time, vec![channel("q_m", wave(1000)), channel("f_N", other)])).is_empty());
}

#[test]
fn a_position_that_leaps_and_stays_is_doubted_with_the_parts() {
    let time: Vec<f64> = (0..2000).map(|i| f64::from(i) * 1e-3).collect();
    let mut zeroed = wave(2000);
    let at = zeroed[1199];
    zeroed[1200..].iter_mut().for_each(|v| *v -= at + 3.0);
    let found = warnings(&recording(time.clone(), vec![channel("q_m", zeroed)]));
    assert_eq!(kinds(&found), ["leap"]);
    assert_eq!(found[0].spans, [Span { first: 1199, end: 1201 }]);
    let windows = serde_json::json!([{ "from_s": 0.0, "to_s": 1.199 }, { "from_s": 1.2, "to_s": 1.999 }]);
    assert_eq!(found[0].suggested.as_ref().and_then(|entries| entries.get("windows")), Some(&windows));
    // A snap takes some samples, and its speed shows before and behind it.
    let snap = |i: usize| wave(2000)[i] + 0.4 * (1.0 + ((i as f64 - 1000.0) / 3.0).tanh());
    assert!(warnings(&recording(time, vec![channel("q_m", (0..2000).map(snap).collect())])).is_empty());
}

#[test]
fn gaps_dropped_samples_and_jumps_are_told_apart() {
    let mut time: Vec<f64> = (0..400).map(|i| f64::from(i) * 0.01).collect();
    time[100..].iter_mut().for_each(|t| *t += 0.02);
    let q = |time: &[f64]| channel("q_m", time.iter().map(|t| (3.0 * t).sin()).collect());
    let dropped = warnings(&recording(time.clone(), vec![q(&time)]));
    assert_eq!(kinds(&dropped), ["dropped-samples"]);
    assert_eq!(dropped[0].spans, [Span { first: 99, end: 101 }]);
    assert!(dropped[0].text.starts_with("2 sample(s)"));

    time[200..].iter_mut().for_each(|t| *t += 0.5);
    assert_eq!(kinds(&warnings(&recording(time.clone(), vec![q(&time)]))), ["gap", "dropped-samples"]);

    let mut late: Vec<f64> = (0..400).map(|i| f64::from(i) * 0.01).collect();
    let smooth = q(&late);
    late[200..].iter_mut().for_each(|t| *t += 5.0);
    assert_eq!(kinds(&warnings(&recording(late, vec![smooth]))), ["clock-jump"]);
}

#[test]
fn a_rate_of_another_size_than_its_position_s_is_doubted_and_a_filtered_or_noisy_one_is_not() {
    let time: Vec<f64> = (0..4000).map(|i| f64::from(i) * 5e-3).collect();
    let place: Vec<f64> = time.iter().map(|t| (1.3 * t).sin() + 0.4 * (3.1 * t).sin()).collect();
    let doubts = |rate: Vec<f64>| {
        let found =
            warnings(&recording(time.clone(), vec![channel("q_rad", place.clone()), channel("dq_rad_s", rate)]));
        found.into_iter().filter(|w| w.kind == "unit").map(|w| w.text).collect::<Vec<_>>()
    };
    let rate: Vec<f64> = time.iter().map(|t| 1.3 * (1.3 * t).cos() + 1.24 * (3.1 * t).cos()).collect();
    let noisy = |scale: f64, size: f64| -> Vec<f64> {
        rate.iter().enumerate().map(|(i, v)| scale * v + size * (i as f64 * 17.3).sin()).collect()
    };
    let twice = doubts(noisy(2.0, 0.5));
    assert!(twice.len() == 1 && twice[0].contains("0.50 times") && twice[0].contains("a factor of 2.0"), "{twice:?}");
    assert!(doubts(noisy(1.0, 0.5)).is_empty());
    // A first-order low-pass of 0.3 s takes a fifth of the amplitude and more.
    let mut state = rate[0];
    let late = rate.iter().map(|v| {
        state += (v - state) * 5e-3 / 0.3;
        state
    });
    assert!(doubts(late.collect()).is_empty());
}

#[test]
fn millimetres_read_as_metres_are_doubted_by_their_speed() {
    let time: Vec<f64> = (0..2000).map(|i| f64::from(i) * 5e-3).collect();
    let doubts = |size_m: f64| {
        let place = time.iter().map(|t| size_m * ((3.8 * t).sin() + 0.4 * (8.2 * t).sin())).collect();
        let found = warnings(&recording(time.clone(), vec![channel("q_m", place)]));
        found.into_iter().filter(|w| w.kind == "unit").collect::<Vec<_>>()
    };
    let found = doubts(80.0);
    assert!(found.len() == 1 && found[0].text.contains("faster than a mechanism"), "{found:?}");
    assert_eq!(found[0].suggested.as_ref().expect("a factor")["scale"]["q_m"], 1e-3);
    assert!(doubts(0.08).is_empty() && doubts(3.0).is_empty());
}

#[test]
fn a_force_that_repeats_another_channel_later_is_no_force() {
    let time: Vec<f64> = (0..2000).map(|i| f64::from(i) * 1e-3).collect();
    let source = wave(2000);
    let force = (0..2000).map(|i| source[usize::saturating_sub(i, 30)]).collect();
    let other = (0..2000).map(|i| (f64::from(i) * 0.03).cos() + 1e-3 * (f64::from(i) * 23.1).sin()).collect();
    let channels = vec![channel("q_m", other), channel("f_N", force), channel("command", source)];
    let found = warnings(&recording(time, channels));
    assert_eq!(kinds(&found), ["copied-channel"]);
    assert!(found[0].text.starts_with("f_N is the same, 30 samples late, as command from 0.03"), "{}", found[0].text);
}

#[test]
fn stuck_channels_are_found_and_rest_is_not_one() {
    let time: Vec<f64> = (0..1000).map(|i| f64::from(i) * 1e-3).collect();
    let mut force = wave(1000);
    let held = force[300];
    force[300..420].fill(held);
    let found = warnings(&recording(time.clone(), vec![channel("f_N", force)]));
    assert_eq!((kinds(&found), found[0].spans[0]), (vec!["stuck-channel"], Span { first: 300, end: 420 }));
    assert_eq!(kinds(&warnings(&recording(time.clone(), vec![channel("fx_N", vec![0.7; 1000])]))), ["stuck-channel"]);
    // A slide that comes to rest, stays, and leaves slowly again.
    let rest: Vec<f64> = (0..1000)
        .map(|i: i32| f64::from((i - 300).min(0) + (i - 700).max(0)) * 1e-4 + f64::from(i % 2) * 0.0)
        .collect();
    assert!(warnings(&recording(time, vec![channel("q_m", rest)])).is_empty());
}

#[test]
fn an_impossible_value_is_named_with_its_row() {
    let time: Vec<f64> = (0..1000).map(|i| f64::from(i) * 1e-3).collect();
    let mut force = wave(1000);
    force[50] = 1e300;
    let found = warnings(&recording(time.clone(), vec![channel("fx1_N", force)]));
    assert_eq!(kinds(&found), ["outlier"]);
    assert!(found[0].text.contains("fx1_N is 1e300 in row 51"), "{}", found[0].text);
    // Mostly zero, then a blow, as in contact.
    let blow: Vec<f64> = (0..1000).map(|i| if i > 980 { 30.0 + f64::from(i % 7) } else { 0.0 }).collect();
    assert!(!kinds(&warnings(&recording(time, vec![channel("fx1_N", blow)]))).contains(&"outlier"));
}

#[test]
fn long_clipping_is_a_limit_and_not_a_stuck_channel() {
    let time: Vec<f64> = (0..1000).map(|i| f64::from(i) * 1e-3).collect();
    // A grip force that is beyond the sensor for six tenths of the recording.
    let grip: Vec<f64> = (0..1000)
        .map(|i: i32| (0.8 - (f64::from(i - 500) / 350.0).powi(2) + 1e-3 * (f64::from(i) * 17.3).sin()).min(0.1))
        .collect();
    let found = warnings(&recording(time, vec![channel("fx1_N", grip)]));
    assert_eq!(kinds(&found), ["saturation"]);
}

#[test]
fn a_clipped_force_is_saturated_and_a_quantised_one_is_not() {
    let time: Vec<f64> = (0..1000).map(|i| f64::from(i) * 1e-3).collect();
    let clipped: Vec<f64> = wave(1000).into_iter().map(|v| v.clamp(-0.9, 0.9)).collect();
    let found = warnings(&recording(time.clone(), vec![channel("f_N", clipped)]));
    assert!(kinds(&found).contains(&"saturation"), "{found:?}");
    let coarse: Vec<f64> = wave(1000).into_iter().map(|v| (v * 20.0).round() / 20.0).collect();
    assert!(warnings(&recording(time, vec![channel("f_N", coarse)])).is_empty());
}

#[test]
fn a_force_of_one_direction_is_saturated_and_that_of_a_throw_is_not() {
    let time: Vec<f64> = (0..6000).map(|i| 0.002 * f64::from(i)).collect();
    let position = |t: &f64| 0.05 * (2.1 * t).sin() + 0.03 * (5.3 * t).sin();
    // Twice the velocity, friction of 0.2 N, and the acceleration.
    let force = |t: &f64| {
        let velocity = 0.105 * (2.1 * t).cos() + 0.159 * (5.3 * t).cos();
        let acceleration = -0.2205 * (2.1 * t).sin() - 0.8427 * (5.3 * t).sin();
        (acceleration + 2.0 * velocity + 0.2 * velocity.signum()).max(0.0)
    };
    let pulled = |position: Vec<f64>, force: Vec<f64>| {
        recording(time.clone(), vec![channel("q_m", position), channel("f_N", force)])
    };
    let one_sided = pulled(time.iter().map(position).collect(), time.iter().map(force).collect());
    let found = warnings(&one_sided);
    assert_eq!(kinds(&found), ["saturation"], "{found:?}");
    assert!(found[0].text.contains("never measured"), "{}", found[0].text);
    // Pushed, and let go: it swings to both sides, or slows down.
    let push = |t: &f64| if t % 2.0 < 0.2 { 3.0 * (t * 15.0).sin().abs() + 0.1 } else { 0.0 };
    for let_go in [|t: &f64| 0.05 * (12.0 * t).sin(), |t: &f64| 0.3 * (1.0 - (-(t % 2.0)).exp())] {
        let found = warnings(&pulled(time.iter().map(let_go).collect(), time.iter().map(push).collect()));
        assert!(!kinds(&found).contains(&"saturation"), "{found:?}");
    }
}

#[test]
fn steps_that_noise_crosses_are_not_coarse() {
    use rand::{RngExt, SeedableRng};
    let time: Vec<f64> = (0..2000).map(|i| f64::from(i) * 1e-3).collect();
    let mut rng = rand::rngs::StdRng::seed_from_u64(5);
    // Steps of an eighth of a slow force's range, behind noise of a number of steps.
    let mut kinds_behind = |noise: f64| {
        let mut reading = |i: i32| {
            let spread = 3.0_f64.sqrt() * noise;
            let more = if spread > 0.0 { rng.random_range(-spread..spread) } else { 0.0 };
            (4.0 * (f64::from(i) * 0.01).sin() + more).round() * 0.1
        };
        let force = (0..2000).map(&mut reading).collect();
        let found = warnings(&recording(time.clone(), vec![channel("f_N", force)]));
        found.into_iter().map(|w| w.kind).collect::<Vec<_>>()
    };
    assert_eq!(kinds_behind(0.0), ["quantised"]);
    assert_eq!(kinds_behind(0.3), ["quantised"]);
    assert!(kinds_behind(1.5).is_empty());
}

#[test]
fn a_limit_that_two_sensors_reach_on_both_sides_is_seen_in_all_of_them_together() {
    let time: Vec<f64> = (0..2000).map(|i| f64::from(i) * 1e-3).collect();
    // A slow force with a steep stroke wherever `strokes` says so: up to its side of ±2 N, and held there for a number
    // of samples.
    let force = |strokes: &[(usize, f64, usize)]| {
        let mut values: Vec<f64> = wave(2000).iter().map(|v| 0.4 * v).collect();
        for (k, (at, side, held)) in strokes.iter().enumerate() {
            let flank = 1.2 + 0.01 * k as f64;
            values[*at] = side * flank;
            values[at + 1..=at + held].fill(2.0 * side);
            values[at + held + 1] = side * (flank + 0.005);
        }
        values
    };
    let saturated = |along: &[(usize, f64, usize)], across: &[(usize, f64, usize)]| {
        let channels = vec![channel("fx_N", force(along)), channel("fy_N", force(across))];
        let found = warnings(&recording(time.clone(), channels));
        found.into_iter().filter(|w| w.kind == "saturation").filter_map(|w| w.column).collect::<Vec<_>>()
    };
    // Three, three and two samples: too few on any one side.
    assert_eq!(saturated(&[(300, 1.0, 3), (900, -1.0, 3)], &[(1300, 1.0, 2)]), ["fx_N", "fy_N"]);
    assert!(saturated(&[(300, 1.0, 3), (900, -1.0, 3)], &[]).is_empty());
}
