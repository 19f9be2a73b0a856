//! What is hidden in a crank that one finger or two turn, as others would record it: a sensor that drifts, a grasp that moves along the handle's
//! arm, a joint's wrong zero.
//!
//! Strokes are sums of waves, forces are those of a weight, dry friction and oil; links are bent by the law of cosines. No formula is the
//! estimator's.

use estimator::diagnose::{Findings, Options, Verdict, diagnose};
use haptics::recording::{Channel, HandMeta, Meta, Recording, Task};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};
use std::f64::consts::TAU;

const RATE_HZ: f64 = 200.0;
const LASTS_S: f64 = 24.0;
/// The handle is held between these, s.
const HELD_S: [f64; 2] = [1.6, 22.4];
const RADIUS_M: f64 = 0.022;
const CENTER_M: [f64; 2] = [0.02, 0.1];
const LINK_M: f64 = 0.08;
/// Half the distance between two fingers' bases and between their tips, m.
const APART_M: f64 = 0.04;
const WIDE_M: f64 = 0.008;

/// What is hidden, nothing by default.
#[derive(Clone, Copy, Default)]
struct Hidden {
    /// What the sensor's vertical zero goes up by over the recording, N.
    drift_n: f64,
    /// From this time on the grasp is farther out on the arm by this, s and m.
    outward: Option<(f64, f64)>,
    /// Gravity out of phase with the handle, N.
    eccentric_n: f64,
    /// Waves a turn, and their size, N.
    ripple: (f64, f64),
    /// What the left finger's top joint is wrong by, rad.
    joint_rad: f64,
    two_fingers: bool,
    /// Grip of both fingers beyond 1.3 N, N.
    firmer_n: f64,
    /// Weight of a handle that hangs on the bearing, N: it loads that beside the fingers' pull, and its mass is held on the circle there.
    handle_n: f64,
    /// Way by which the soft pads of a firm grip let the tips move against the handle, m/N.
    soft_m_n: f64,
    /// Whether it is turned one way, and pulled outward all the time.
    one_way: bool,
}

/// One instant: places and net force.
struct Instant {
    place_m: [f64; 2],
    force_n: [f64; 2],
    held: bool,
    /// Way by which each open finger is off the handle, m.
    off_m: f64,
}

fn noise(rng: &mut StdRng, size: f64) -> f64 {
    size * ((0..12).map(|_| rng.random::<f64>()).sum::<f64>() - 6.0)
}

fn instants(rng: &mut StdRng, hidden: Hidden) -> Vec<Instant> {
    let waves: Vec<(f64, f64, f64)> = [0.09_f64, 0.21, 0.43, 0.7]
        .iter()
        .map(|hz| (hz * rng.random_range(0.9..1.1), 0.5 / hz.sqrt(), rng.random_range(0.0..TAU)))
        .collect();
    let (wide, steady) = if hidden.one_way { (0.2, 2.6) } else { (2.4, 0.0) };
    let angle = |t: f64| {
        steady * t + wide * waves.iter().map(|(hz, size, phase)| size * (TAU * hz * t + phase).sin()).sum::<f64>()
    };
    let ease = |x: f64| x.clamp(0.0, 1.0).powi(2) * (3.0 - 2.0 * x.clamp(0.0, 1.0));
    let one = |k: usize| {
        let t = k as f64 / RATE_HZ;
        let now = t.clamp(HELD_S[0] + 0.2, HELD_S[1] - 0.2);
        let (a, rate) = (angle(now), RADIUS_M * (angle(now + 1e-5) - angle(now - 1e-5)) / 2e-5);
        let rate = if now == t { rate } else { 0.0 };
        let (sin, cos) = a.sin_cos();
        // On its way to the handle, or from it.
        let away = 1.0 - ease((t - 0.6) / 0.9) + ease((t - HELD_S[1] - 0.05) / 0.8);
        let arm = RADIUS_M + hidden.outward.map_or(0.0, |(from_s, by_m)| if t > from_s { by_m } else { 0.0 });
        let place_m = [CENTER_M[0] + arm * cos + 0.004 * away, CENTER_M[1] + arm * sin - 0.012 * away];
        let held = (HELD_S[0]..HELD_S[1]).contains(&t);
        let firm = if held { ease((t - HELD_S[0]) / 0.15) * ease((HELD_S[1] - t) / 0.15) } else { 0.0 };
        let outward_n = if hidden.one_way { 3.5 } else { 0.0 };
        let pull_n = outward_n + 1.2 * (TAU * 0.27 * t + 1.0).sin() + 0.5 * (TAU * 0.61 * t).cos();
        let ripple_n = hidden.ripple.1 * (hidden.ripple.0 * a).cos();
        let weight_n = if hidden.handle_n > 0.0 { hidden.handle_n } else { 0.2 };
        let load_n = pull_n + hidden.handle_n * (rate * rate / (9.81 * RADIUS_M) - sin);
        let along_n =
            weight_n * cos + hidden.eccentric_n * sin + 0.12 * load_n.abs() * rate.signum() + 1.1 * rate + ripple_n;
        let force_n = [firm * (pull_n * cos - along_n * sin), firm * (pull_n * sin + along_n * cos)];
        let off_m = 0.003 * (1.0 - ease((t - 1.3) / 0.28) + ease((t - HELD_S[1] - 0.02) / 0.28));
        Instant { place_m, force_n, held, off_m }
    };
    (0..(LASTS_S * RATE_HZ) as usize).map(one).collect()
}

/// Angles of both links of a finger that stands at `base` and reaches `tip`, rad.
fn joints(base: [f64; 2], tip: [f64; 2], side: f64) -> [f64; 2] {
    let (x, y) = (tip[0] - base[0], tip[1] - base[1]);
    let far = x.hypot(y);
    let (towards, opening) = (y.atan2(x), (0.5 * far / LINK_M).acos());
    [towards + side * opening, towards - side * opening]
}

fn recording(seed: u64, hidden: Hidden) -> Recording {
    let mut rng = StdRng::seed_from_u64(seed);
    let instants = instants(&mut rng, hidden);
    let mut channels: Vec<(String, Vec<f64>)> = Vec::new();
    let fingers: &[(&str, f64)] = if hidden.two_fingers { &[("1", -1.0), ("2", 1.0)] } else { &[("", 0.0)] };
    let share = 1.0 / fingers.len() as f64;
    for (finger, (ending, side)) in fingers.iter().enumerate() {
        let base = [side * APART_M, 0.0];
        let wrong = if finger == 0 { hidden.joint_rad } else { 0.0 };
        let (mut bottom, mut top) = (Vec::new(), Vec::new());
        for instant in &instants {
            let gives_m = instant.force_n.map(|force_n| hidden.soft_m_n * force_n);
            let tip =
                [instant.place_m[0] + gives_m[0] + side * (WIDE_M + instant.off_m), instant.place_m[1] + gives_m[1]];
            let [first, second] = joints(base, tip, if *side < 0.0 { 1.0 } else { -1.0 });
            bottom.push(first + noise(&mut rng, 8e-5));
            top.push(second + wrong + noise(&mut rng, 8e-5));
        }
        channels.push((format!("qb{ending}_rad"), bottom));
        channels.push((format!("qt{ending}_rad"), top));
        for axis in 0..2 {
            let of = |(k, instant): (usize, &Instant)| {
                let squeeze_n = if axis == 0 && instant.held { -(1.3 + hidden.firmer_n) * side } else { 0.0 };
                let drift_n = if axis == 1 { hidden.drift_n * k as f64 / instants.len() as f64 } else { 0.0 };
                share * (instant.force_n[axis] + drift_n) + squeeze_n
            };
            let values: Vec<f64> = instants.iter().enumerate().map(of).collect();
            let values = values.into_iter().map(|v| v + noise(&mut rng, 0.02)).collect();
            channels.push((format!("f{}{ending}_N", ["x", "y"][axis]), values));
        }
    }
    let channel = |(name, values): (String, Vec<f64>)| Channel { name, unit: String::new(), values };
    let hand = if hidden.two_fingers {
        HandMeta {
            link_m: Some(LINK_M),
            base1_m: Some([-APART_M, 0.0]),
            base2_m: Some([APART_M, 0.0]),
            ..HandMeta::default()
        }
    } else {
        HandMeta { link_m: Some(LINK_M), base_m: Some([0.0, 0.0]), ..HandMeta::default() }
    };
    Recording {
        name: "a crank".to_owned(),
        time_s: Some((0..instants.len()).map(|k| k as f64 / RATE_HZ).collect()),
        channels: channels.into_iter().map(channel).collect(),
        meta: Meta { task: Some(Task::Crank), hand: Some(hand), ..Meta::default() },
        ..Recording::default()
    }
}

fn asked(seed: u64, hidden: Hidden) -> Findings {
    diagnose(&[recording(seed, hidden)], &Options::default()).expect("it can be diagnosed")
}

fn ids(found: &Findings) -> Vec<&str> {
    found.causes.iter().map(|c| c.id.as_str()).collect()
}

fn value(found: &Findings, id: &str, name: &str) -> f64 {
    let cause = found.causes.iter().find(|c| c.id == id);
    cause.and_then(|c| c.parameters.iter().find(|p| p.name == name)).map_or(f64::NAN, |p| p.value)
}

const SEEDS: [u64; 3] = [1, 2, 3];

#[test]
fn nothing_is_said_of_one_finger_or_two_that_hide_nothing() {
    for seed in SEEDS {
        for two_fingers in [false, true] {
            let found = asked(seed, Hidden { two_fingers, ..Hidden::default() });
            assert_eq!(found.verdict, Verdict::None, "{seed} {two_fingers}: {:?}", ids(&found));
        }
    }
}

#[test]
fn a_sensor_that_drifts_lets_go_in_the_end_all_the_same() {
    for seed in SEEDS {
        for drift_n in [0.3, 0.6] {
            let found = asked(seed, Hidden { drift_n, ..Hidden::default() });
            assert_eq!(ids(&found), ["force-drift"], "{seed} {drift_n}");
            let rate = value(&found, "force-drift", "ry") * LASTS_S;
            assert!((rate / drift_n - 1.0).abs() < 0.1, "{seed}: {rate} for {drift_n} N");
        }
    }
}

#[test]
fn a_grasp_that_moves_along_the_arm_slips() {
    for seed in SEEDS {
        let (from_s, by_m) = (11.3, 4e-4);
        let found = asked(seed, Hidden { outward: Some((from_s, by_m)), ..Hidden::default() });
        assert_eq!(ids(&found), ["fingertip-slip"], "{seed}");
        let (way_m, time_s) = (value(&found, "fingertip-slip", "dr"), value(&found, "fingertip-slip", "time"));
        assert!((way_m / by_m - 1.0).abs() < 0.05 && (time_s - from_s).abs() < 0.1, "{seed}: {way_m} m at {time_s} s");
    }
}

/// Soft pads give with the true force. Beside the recorded one, which drifts, the path seems to move.
#[test]
fn a_sensor_that_drifts_behind_soft_pads_is_no_slip() {
    for seed in SEEDS {
        let hidden = Hidden { drift_n: 0.8, soft_m_n: 2e-4, two_fingers: true, ..Hidden::default() };
        assert_eq!(ids(&asked(seed, hidden)), ["force-drift"], "{seed}");
    }
}

#[test]
fn a_joint_of_one_of_two_fingers_is_off_by_what_is_said() {
    for seed in SEEDS {
        for joint_rad in [0.01, -0.035] {
            for two_fingers in [false, true] {
                let found = asked(seed, Hidden { joint_rad, two_fingers, ..Hidden::default() });
                assert_eq!(ids(&found)[0], "joint-offset", "{seed} {two_fingers}: {:?}", ids(&found));
                assert!(!ids(&found).contains(&"length-scale"), "{seed} {two_fingers}: {:?}", ids(&found));
                let said = value(&found, "joint-offset", if two_fingers { "delta1" } else { "delta" });
                assert!(
                    (said.abs() / joint_rad.abs() - 1.0).abs() < 0.05,
                    "{seed} {two_fingers}: {said} for {joint_rad}"
                );
            }
        }
    }
}

#[test]
fn a_mass_off_the_axis_between_two_fingers_is_no_mirrored_axis() {
    for seed in SEEDS {
        let found = asked(seed, Hidden { eccentric_n: 0.7, two_fingers: true, ..Hidden::default() });
        assert_eq!(ids(&found), ["eccentric-mass"], "{seed}");
    }
}

/// The difference of two gripping forces is a constant: with a wrong sign of one of them, every effect vanishes.
#[test]
fn a_light_crank_in_a_firm_grip_has_no_mirrored_axis() {
    for seed in SEEDS {
        let hidden = Hidden { ripple: (5.0, 0.25), two_fingers: true, firmer_n: 4.0, ..Hidden::default() };
        assert_eq!(ids(&asked(seed, hidden)), ["position-ripple"], "{seed}");
    }
}

#[test]
fn a_ripple_has_the_length_that_it_has() {
    for seed in SEEDS {
        for waves in [3.0, 4.0, 7.0] {
            let found = asked(seed, Hidden { ripple: (waves, 0.06), ..Hidden::default() });
            assert_eq!(ids(&found), ["position-ripple"], "{seed}");
            let length_m = value(&found, "position-ripple", "lambda");
            assert!((length_m * waves / (TAU * RADIUS_M) - 1.0).abs() < 0.02, "{seed}: {length_m} m for {waves} waves");
        }
    }
}

fn is_on_the_bearing(found: &Findings) -> bool {
    found.warnings.iter().any(|w| w.contains("the load on the bearing"))
}

/// What only goes one way makes of the handle's weight on the bearing a pull a quarter turn ahead of gravity's.
#[test]
fn a_handle_that_hangs_on_its_bearing_is_no_eccentric_mass() {
    for seed in SEEDS {
        for one_way in [false, true] {
            let found = asked(seed, Hidden { handle_n: 1.5, one_way, ..Hidden::default() });
            assert_eq!(found.verdict, Verdict::None, "{seed} {one_way}: {:?}", ids(&found));
            assert!(is_on_the_bearing(&found), "{seed} {one_way}: {:?}", found.warnings);
        }
    }
}

#[test]
fn what_is_hidden_beside_a_handle_on_its_bearing_is_named_alone() {
    for seed in SEEDS {
        let hidden = Hidden { handle_n: 1.5, one_way: true, ripple: (5.0, 0.25), ..Hidden::default() };
        let found = asked(seed, hidden);
        assert_eq!(ids(&found), ["position-ripple"], "{seed}");
        assert!(is_on_the_bearing(&found), "{seed}: {:?}", found.warnings);
    }
}

#[test]
fn a_mass_off_the_axis_that_is_turned_one_way_is_one() {
    for seed in SEEDS {
        let found = asked(seed, Hidden { eccentric_n: 0.3, one_way: true, ..Hidden::default() });
        assert!(ids(&found).contains(&"eccentric-mass") && !is_on_the_bearing(&found), "{seed}: {:?}", ids(&found));
    }
}

/// What else is hidden may keep the handle from being seen at first: it is asked for once more beside that.
#[test]
fn a_handle_on_its_bearing_is_seen_beside_what_hides_it() {
    let drift = Hidden { drift_n: 0.8, handle_n: 0.6, one_way: true, ..Hidden::default() };
    let ripple = Hidden { ripple: (3.0, 0.6), handle_n: 0.6, ..Hidden::default() };
    for (seed, hidden, id) in [(1, drift, "force-drift"), (4, ripple, "position-ripple")] {
        let found = asked(seed, hidden);
        assert_eq!(ids(&found), [id], "{seed}");
        assert!(is_on_the_bearing(&found), "{seed}: {:?}", found.warnings);
    }
}
