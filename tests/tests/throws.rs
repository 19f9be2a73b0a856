//! Thrown cubes at any rate of the tracker, with few throws and with noisy orientations: a body flies, hits and slides for some time, not for some
//! samples.

use blind::Chance;
use estimator::diagnose::{Cause, Findings, Options, Verdict, diagnose};
use estimator::identify::mechanism;
use haptics::recording::{Channel, Recording};
use tests::tasks::throw::{Kind, Sight, seen};

fn diagnosed(kind: Kind, seed: u64, sight: &Sight) -> (Findings, Option<f64>) {
    let (case, truth) = seen(kind, seed, sight);
    let found = diagnose(&case.recordings, &case.options).unwrap_or_else(|e| panic!("{kind:?} {sight:?}: {e}"));
    for cause in &found.causes {
        println!("{kind:?} {seed} {} Hz: {} {:?}", sight.rate_hz, cause.id, cause.parameters);
    }
    (found, truth.value.map(|(_, value)| value))
}

fn cause<'a>(found: &'a Findings, id: &str) -> &'a Cause {
    found.causes.iter().find(|c| c.id == id).unwrap_or_else(|| panic!("{id} is named: {:?}", found.not_excited))
}

#[test]
fn dry_friction_is_found_at_any_rate_and_with_noisy_orientations() {
    for (rate_hz, turn_noise) in [(50.0, 0.0), (60.0, 2e-3), (75.0, 0.0), (250.0, 2e-3), (500.0, 2e-3)] {
        let (found, mu) = diagnosed(Kind::Dry, 3, &Sight { rate_hz, throws: 40, turn_noise });
        let dry = cause(&found, "load-friction");
        let mu = mu.expect("a friction");
        assert!((dry.parameters[0].value / mu - 1.0).abs() < 0.03, "{rate_hz} Hz: {dry:?}, truth {mu}");
        let others = ["viscous-friction", "quadratic-drag", "stribeck"];
        assert!(found.causes.iter().all(|c| !others.contains(&c.id.as_str())), "{rate_hz} Hz: {:?}", found.causes);
    }
}

#[test]
fn losses_at_impacts_are_found_with_few_throws_at_any_rate() {
    for (rate_hz, seed) in [(75.0, 1), (150.0, 2), (150.0, 3), (500.0, 4)] {
        let (found, e) = diagnosed(Kind::Loss, seed, &Sight { rate_hz, throws: 40, turn_noise: 1e-3 });
        let (lost, e) = (cause(&found, "velocity-loss"), e.expect("a restitution"));
        let [value] = lost.parameters.as_slice() else { panic!("{lost:?}") };
        let error = 4.0 * value.std_error.max(0.01);
        assert!((value.value - e).abs() < error && value.std_error < 0.06, "{rate_hz} Hz: {lost:?}, truth {e}");
    }
}

#[test]
fn nothing_is_found_where_nothing_is_at_any_rate() {
    for rate_hz in [50.0, 75.0, 300.0] {
        let (found, _) = diagnosed(Kind::Nothing, 5, &Sight { rate_hz, throws: 60, turn_noise: 0.0 });
        assert!(found.causes.is_empty(), "{rate_hz} Hz: {:?}", found.causes);
    }
}

#[test]
fn one_throw_is_a_throw_and_a_swing_is_none() {
    for rate_hz in [60.0, 150.0, 500.0] {
        let (case, _) = seen(Kind::Dry, 7, &Sight { rate_hz, throws: 2, turn_noise: 0.0 });
        let fit = mechanism::fit(&case.recordings[1..]).expect("one throw");
        let fall = fit.parameters.iter().find(|p| p.name == "free_fall_m_s2").expect("it falls");
        let (value, error) = (fall.value.expect("so fast"), fall.std_error.expect("so well"));
        assert!((value - 9.81).abs() < 4.0 * error.max(0.02), "{rate_hz} Hz: {value} ± {error}");
        assert!(fit.constraints.is_empty());
    }
    let fit = mechanism::fit(&[swing()]);
    println!("{:?}", fit.as_ref().map(|f| &f.parameters));
    assert!(fit.map_or(true, |f| f.parameters.iter().all(|p| p.name != "free_fall_m_s2")));
}

/// A bob on an arm that is let go with the arm level: at first it falls.
fn swing() -> Recording {
    const ARM_M: f64 = 0.4;
    let (mut angle, mut rate) = (0.0_f64, 0.0);
    let mut points = Vec::new();
    for k in 0..15_000 {
        if k % 100 == 0 {
            points.push((ARM_M * angle.cos(), -ARM_M * angle.sin()));
        }
        rate += 1e-4 * (9.81 / ARM_M * angle.cos() - 0.2 * rate);
        angle += 1e-4 * rate;
    }
    let channel = |name: &str, of: &dyn Fn(&(f64, f64)) -> f64| Channel {
        name: name.to_owned(),
        unit: "m".to_owned(),
        values: points.iter().map(of).collect(),
    };
    Recording {
        name: "swing".to_owned(),
        time_s: Some((0..points.len()).map(|i| 0.01 * i as f64).collect()),
        channels: vec![channel("x_m", &|p| p.0), channel("y_m", &|p| p.1)],
        ..Recording::default()
    }
}

#[test]
fn where_nothing_but_falls_can_be_compared_the_figures_are_those_of_the_falls() {
    let (case, _) = seen(Kind::Scale, 9, &Sight { throws: 6, ..Sight::default() });
    // Only until the ground comes.
    let falls: Vec<Recording> =
        case.recordings.iter().map(|r| r.slice(haptics::recording::Span { first: 0, end: 24 })).collect();
    let found = diagnose(&falls, &case.options).expect("falls");
    assert_eq!(found.baseline.of.as_deref(), Some("height of the flights"));
    let (before, floor) = (found.baseline.heldout_rms_n, found.noise_floor_n);
    assert!((1e-6..1e-2).contains(&floor) && before >= floor && found.end.heldout_rms_n >= floor, "{floor} {before}");
}

/// A ball that flies through air for a while: quadratic drag over its mass, 1/m, and a spin across its plane, 1/s. The
/// integrator is Euler's at a tenth of a millisecond, and the tracker's noise is 0.2 mm.
fn ball(drag_per_m: f64, spin_hz: f64, throw: u64, rate_hz: f64) -> Recording {
    let mut chance = Chance::new(throw, 31);
    let angle = chance.between(0.5, 1.1);
    let speed = chance.between(5.0, 8.0);
    let (mut place, mut velocity) = ([0.0, 1.2], [speed * angle.cos(), speed * angle.sin()]);
    let (mut time_s, mut seen) = (Vec::new(), [Vec::new(), Vec::new()]);
    let every = (1e4 / rate_hz).round() as usize;
    for k in 0..9000 {
        if k % every == 0 {
            time_s.push(1e-4 * k as f64);
            (0..2).for_each(|axis| seen[axis].push(place[axis] + 2e-4 * chance.normal()));
        }
        let fast = f64::hypot(velocity[0], velocity[1]);
        let pull = [
            -drag_per_m * fast * velocity[0] - spin_hz * velocity[1],
            -9.81 - drag_per_m * fast * velocity[1] + spin_hz * velocity[0],
        ];
        for axis in 0..2 {
            velocity[axis] += 1e-4 * pull[axis];
            place[axis] += 1e-4 * (velocity[axis] - 0.5e-4 * pull[axis]);
        }
    }
    let channel =
        |name: &str, values: &Vec<f64>| Channel { name: name.to_owned(), unit: "m".to_owned(), values: values.clone() };
    let channels = vec![channel("x_m", &seen[0]), channel("y_m", &seen[1])];
    Recording { name: format!("throw {throw}"), time_s: Some(time_s), channels, ..Recording::default() }
}

#[test]
fn a_ball_through_air_is_a_throw_with_its_drag_and_its_spin_and_no_scale() {
    for (drag_per_m, spin_hz) in [(0.0, 0.0), (0.05, 0.0), (0.3, 0.0), (0.08, 1.0)] {
        for (count, rate_hz) in [(1, 200.0), (3, 100.0)] {
            let throws: Vec<Recording> = (0..count).map(|k| ball(drag_per_m, spin_hz, 11 + k, rate_hz)).collect();
            let found = diagnose(&throws, &Options::default()).expect("an answer");
            let of = format!("{drag_per_m} 1/m, {spin_hz} 1/s, {count} at {rate_hz} Hz: {:?}", found.causes);
            let named: Vec<&str> = found.causes.iter().filter(|c| c.posterior >= 0.95).map(|c| c.id.as_str()).collect();
            if drag_per_m == 0.0 {
                assert!(named.is_empty() && found.verdict == Verdict::None, "{of} {:?}", found.verdict);
                continue;
            }
            assert_eq!(named, ["quadratic-drag"], "{of}");
            let k = &found.causes[0].parameters[0];
            assert!((k.value - drag_per_m).abs() < 4.0 * k.std_error.max(1e-3 * drag_per_m), "{of}");
            assert_eq!(found.warnings.iter().any(|w| w.contains("spins")), spin_hz > 0.0, "{of} {:?}", found.warnings);
            let fit = mechanism::fit(&throws).expect("a throw");
            let value = |name: &str| fit.parameters.iter().find(|p| p.name == name).and_then(|p| p.value);
            let fall = value("free_fall_m_s2").expect("it falls");
            assert!((fall - 9.81).abs() < 0.05, "{of}: {fall} m/s²");
            assert!(value("drag_per_mass_1_m").is_some_and(|k| (k / drag_per_m - 1.0).abs() < 0.1), "{of}");
        }
    }
}

/// Sets of one to three flights with a tracker of another rate and noise each, at most one effect of the air in each.
#[test]
fn of_sixty_sets_of_flights_nearly_all_show_their_drag_and_none_a_false_one() {
    let (mut with_drag, mut named, mut misled) = (0, 0, Vec::new());
    for set in 0..60 {
        let mut chance = Chance::new(set, 7_700_001);
        let (drag_per_m, spin_hz) = match set % 3 {
            0 => (0.0, 0.0),
            1 => (chance.between(0.04, 0.2), 0.0),
            _ => (chance.between(0.04, 0.2), chance.between(0.3, 1.2)),
        };
        let (count, rate_hz) = (1 + set / 3 % 3, [100.0, 200.0][set as usize / 9 % 2]);
        let throws: Vec<Recording> =
            (0..count).map(|k| ball(drag_per_m, spin_hz, 1000 + 3 * set + k, rate_hz)).collect();
        let found = diagnose(&throws, &Options::default()).expect("an answer");
        let certain: Vec<&str> = found.causes.iter().filter(|c| c.posterior >= 0.95).map(|c| c.id.as_str()).collect();
        with_drag += usize::from(drag_per_m > 0.0);
        named += usize::from(drag_per_m > 0.0 && certain == ["quadratic-drag"]);
        let false_ones = certain.iter().filter(|id| drag_per_m == 0.0 || **id != "quadratic-drag").count();
        if false_ones > 0 {
            misled.push(format!("{set}: {drag_per_m:.3} 1/m, {spin_hz:.2} 1/s: {certain:?}"));
        }
        if certain.is_empty() && drag_per_m > 0.0 {
            println!("{set}: {count} at {rate_hz} Hz, {drag_per_m:.3} 1/m, {spin_hz:.2} 1/s: {:?}", found.causes);
        }
    }
    println!("{named} of {with_drag} named; {misled:?}");
    assert!(named as f64 >= 0.9 * with_drag as f64, "{named} of {with_drag}");
    assert!(misled.is_empty(), "{misled:?}");
}
