//! Slides whose recorded rate contradicts their clock, and slides whose friction falls with the speed.

use blind::Chance;
use estimator::diagnose::{Options, Verdict, diagnose};
use estimator::estimate::{Fit, Parameter};
use estimator::identify::mechanism::fit;
use estimator::log;
use haptics::recording::{Channel, Recording};

/// A seed on which nothing was chosen.
const SEED: u64 = 7_450_001;

/// A slide of 2 kg that a hand moves for 20 s, at 500 Hz. `friction`: over the speed, N. `clock`: recorded seconds a second.
fn slide(chance: &mut Chance, friction: &dyn Fn(f64) -> f64, clock: f64) -> Recording {
    let rates: Vec<[f64; 3]> =
        (0..5).map(|_| [chance.between(1.0, 6.0), chance.between(0.0, 6.0), chance.between(0.01, 0.04)]).collect();
    moved(chance, &rates, friction, clock)
}

/// The same under a sum of waves: rate in rad/s, phase, and size in m of each.
fn moved(chance: &mut Chance, rates: &[[f64; 3]], friction: &dyn Fn(f64) -> f64, clock: f64) -> Recording {
    let mut columns = vec![Vec::new(); 4];
    for k in 0..10_000 {
        let t = 0.002 * f64::from(k);
        let sum = |of: &dyn Fn(&[f64; 3]) -> f64| rates.iter().map(of).sum::<f64>();
        let place = sum(&|[w, phase, size]| size * (w * t + phase).sin());
        let speed = sum(&|[w, phase, size]| size * w * (w * t + phase).cos());
        let acceleration = -sum(&|[w, phase, size]| size * w * w * (w * t + phase).sin());
        let force = 2.0 * acceleration + friction(speed.abs()) * (speed / 1e-4).tanh();
        let row =
            [clock * t, place + 2e-6 * chance.normal(), speed + 1e-3 * chance.normal(), force + 0.02 * chance.normal()];
        columns.iter_mut().zip(row).for_each(|(column, value)| column.push(value));
    }
    let mut columns = columns.into_iter();
    let time_s = columns.next();
    let named = [("q_m", "m"), ("dq_m_s", "m/s"), ("f_N", "N")].into_iter().zip(columns);
    let channels =
        named.map(|((name, unit), values)| Channel { name: name.to_owned(), unit: unit.to_owned(), values }).collect();
    let mut recording = Recording { name: "slide".to_owned(), time_s, channels, ..Recording::default() };
    recording.warnings = log::check(&recording);
    recording
}

fn value(fit: &Fit, name: &str) -> Option<f64> {
    fit.parameters.iter().find(|p: &&Parameter| p.name == name && p.identified)?.value
}

#[test]
fn a_clock_that_contradicts_the_rate_leaves_no_mass_and_no_viscous_friction() {
    let mut chance = Chance::new(SEED, 1);
    for clock in [1.0, 2.0, 0.4, 1.02] {
        let found = fit(&[slide(&mut chance, &|speed| 0.8 + 3.0 * speed, clock)]).expect("a fit");
        let [mass, viscous, dry] = ["mass_kg", "viscous_N_s_m", "coulomb_N"].map(|name| value(&found, name));
        let is_right = (clock - 1.0).abs() < 0.05;
        assert_eq!((mass.is_some(), viscous.is_some()), (is_right, is_right), "{clock}: {mass:?} {viscous:?}");
        assert!(dry.is_some_and(|dry| (dry - 0.8).abs() < 0.1), "{clock}: {dry:?}");
    }
}

#[test]
fn friction_that_falls_with_the_speed_is_no_negative_viscous_friction() {
    let mut chance = Chance::new(SEED, 2);
    let mut fallen = 0;
    for _ in 0..8 {
        let found =
            fit(&[slide(&mut chance, &|speed| 0.6 + 1.0 / (1.0 + (speed / 0.08).powi(2)), 1.0)]).expect("a fit");
        assert!(value(&found, "viscous_N_s_m").is_none_or(|viscous| viscous > -0.1), "{:?}", found.parameters);
        assert!(value(&found, "mass_kg").is_some_and(|mass| (mass - 2.0).abs() < 0.2), "{:?}", found.parameters);
        let dry = value(&found, "coulomb_N").expect("dry friction");
        assert!((0.6..1.6).contains(&dry), "{dry}");
        fallen += usize::from(found.warnings.iter().any(|w| w.contains("falls as the speed rises")));
    }
    assert!(fallen >= 6, "{fallen} of 8");
}

/// Stamps of arrival at 250 Hz, late by up to 3 ms, leave a white residual far above the noise of the force.
#[test]
fn a_jittering_clock_is_not_taken_for_noise() {
    let mut chance = Chance::new(SEED, 3);
    let verdict = |chance: &mut Chance, late_s: f64| {
        let waves = [[1.95, 0.06], [4.6, 0.03], [8.6, 0.013], [13.3, 0.006], [18.2, 0.003]];
        let waves = waves.map(|[rate, size]| [rate, chance.between(0.0, 6.0), size]);
        let mut slide = moved(chance, &waves, &|speed| 1.2 + 3.0 * speed, 1.0);
        slide.keep(&(0..5_000).map(|k| 2 * k).collect::<Vec<_>>());
        slide.channels.retain(|channel| channel.name != "dq_m_s");
        slide.time_s.iter_mut().flatten().for_each(|t| *t += chance.between(0.0, late_s));
        diagnose(&[slide], &Options::default()).expect("an answer").verdict
    };
    assert_eq!(verdict(&mut chance, 0.0), Verdict::None);
    for _ in 0..3 {
        assert_eq!(verdict(&mut chance, 0.003), Verdict::Unexplained);
    }
}
