//! Transmissions that are generated: a driven input, a gap and a spring to an output that is loaded and rubs. The signs of the sensors are
//! somebody's choice, and whichever it was, the same is found.

use estimator::diagnose::{Cause, Findings, Options, diagnose};
use haptics::recording::{Channel, Recording};
use std::f64::consts::{PI, TAU};

const STEP_S: f64 = 2e-5;
/// One sample in so many steps: 200 Hz.
const EVERY: usize = 250;
const LONG_S: f64 = 30.0;

/// What is hidden: half of the gap, rad; stiffness behind it, N m/rad; dry friction of the input, N m.
struct Hidden {
    gap: f64,
    stiffness: f64,
    dry: f64,
}

/// White, the same every time.
struct Noise(u64);

impl Noise {
    fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn normal(&mut self) -> f64 {
        (-2.0 * self.uniform().max(1e-12).ln()).sqrt() * (TAU * self.uniform()).cos()
    }
}

/// An input that is moved to and fro drives an output with inertia; a motor loads that, more and less.
fn recording(seed: u64, hidden: &Hidden) -> Recording {
    let mut noise = Noise(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1);
    let (slow, fast) = (0.15 + 0.1 * noise.uniform(), 0.35 + 0.15 * noise.uniform());
    let (mut out, mut speed) = (0.0_f64, 0.0_f64);
    let mut columns = vec![Vec::new(); 4];
    let mut time_s = Vec::new();
    for k in 0..(LONG_S / STEP_S) as usize {
        let t = k as f64 * STEP_S;
        let q = 0.35 * (TAU * slow * t).sin() + 0.15 * (TAU * fast * t + 0.7).sin();
        let rate = 0.35 * TAU * slow * (TAU * slow * t).cos() + 0.15 * TAU * fast * (TAU * fast * t + 0.7).cos();
        let away = q - out;
        let wound = if away.abs() > hidden.gap { away - hidden.gap.copysign(away) } else { 0.0 };
        let through = hidden.stiffness * wound + if wound == 0.0 { 0.0 } else { 0.02 * (rate - speed) };
        // A motor that is turned: it drags, now more, now less, and is never let go.
        let load = (0.06 + 0.03 * (TAU * 0.07 * t).sin()) * (speed / 0.01).tanh() + 0.01 * speed;
        speed += STEP_S * (through - load) / 2e-4;
        out += STEP_S * speed;
        if k % EVERY == 0 {
            let dry = hidden.dry * (2.0 / PI) * (rate / 2e-3).atan();
            time_s.push(t);
            let exact = [q, out, through + dry + 1e-3 * rate, load];
            let size = [1e-4, 1e-4, 1e-3, 1e-3];
            columns.iter_mut().zip(exact).zip(size).for_each(|((c, v), s)| c.push(v + s * noise.normal()));
        }
    }
    let names = ["q_rad", "q_out_rad", "tau_Nm", "jaw_torque_Nm"];
    let channel = |(name, values): (&str, Vec<f64>)| Channel { name: name.to_owned(), unit: String::new(), values };
    Recording {
        name: format!("run {seed}"),
        time_s: Some(time_s),
        channels: names.into_iter().zip(columns).map(channel).collect(),
        ..Recording::default()
    }
}

fn turned(recording: &Recording, names: &[&str]) -> Recording {
    let mut other = recording.clone();
    for channel in other.channels.iter_mut().filter(|c| names.contains(&c.name.as_str())) {
        channel.values.iter_mut().for_each(|v| *v = -*v);
    }
    other
}

fn named<'a>(found: &'a Findings, id: &str) -> Option<&'a Cause> {
    found.causes.iter().find(|c| c.id == id)
}

fn value(found: &Findings, id: &str, name: &str) -> f64 {
    let cause = named(found, id).unwrap_or_else(|| panic!("{id}: {:?}", found.causes));
    assert!(cause.standing.is_some(), "it competes with structured errors: {cause:?}");
    cause.parameters.iter().find(|p| p.name == name).unwrap_or_else(|| panic!("{name}: {cause:?}")).value
}

/// An input on paper: two sines, seen in steps. The output stays behind by an exact gap, a give and a delay; the force has the load, dry friction and a
/// little drag. `loads`: dry loads of the runs, N m.
fn on_paper(seed: u64, hidden: &OnPaper, loads: &[f64]) -> Vec<Recording> {
    let run = |(k, load): (usize, &f64)| {
        let mut noise = Noise((seed + 31 * k as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1);
        let (slow, phase) = (0.15 + 0.2 * noise.uniform(), TAU * noise.uniform());
        let input = |t: f64| 0.45 * (TAU * slow * t + phase).sin() + 0.1 * (2.7 * TAU * slow * t).sin();
        let (mut place, mut columns) = (input(0.0), vec![Vec::new(); 4]);
        let mut time_s = Vec::new();
        for i in 0..4000 {
            let t = 0.005 * f64::from(i);
            let (q, rate) = (input(t), (input(t + 1e-5) - input(t - 1e-5)) / 2e-5);
            place = place.clamp(q - hidden.half_gap, q + hidden.half_gap);
            let turning = rate.signum();
            let late = if hidden.late_s > 0.0 { input(t - hidden.late_s) } else { place };
            let step = |v: f64, size: f64| (v / size).round() * size;
            time_s.push(t);
            let exact = [
                step(q, 1.5e-4),
                step(hidden.ratio * late, 2e-4),
                load * (turning + 0.3) + hidden.dry * turning + 2e-3 * rate + 1e-3 * noise.normal(),
                load * (turning + 0.3) + 5e-4 * noise.normal(),
            ];
            columns.iter_mut().zip(exact).for_each(|(c, v)| c.push(v));
        }
        let names = ["q_rad", "q_out_rad", "tau_Nm", "jaw_torque_Nm"];
        let channel = |(name, values): (&str, Vec<f64>)| Channel { name: name.to_owned(), unit: String::new(), values };
        Recording {
            name: format!("run {k}"),
            time_s: Some(time_s),
            channels: names.into_iter().zip(columns).map(channel).collect(),
            ..Recording::default()
        }
    };
    loads.iter().enumerate().map(run).collect()
}

struct OnPaper {
    half_gap: f64,
    ratio: f64,
    late_s: f64,
    dry: f64,
}

fn found_on_paper(seed: u64, hidden: &OnPaper, loads: &[f64]) -> Findings {
    let found = diagnose(&on_paper(seed, hidden, loads), &Options::default()).expect("runs");
    for cause in &found.causes {
        println!("{seed} {}: {:?}", cause.id, cause.parameters);
    }
    found
}

#[test]
fn an_exact_gap_is_all_of_the_lost_motion_and_brings_nothing_with_it() {
    for (seed, ratio) in [(1, 1.0), (2, 0.914), (3, 1.0)] {
        let hidden = OnPaper { half_gap: 0.025, ratio, late_s: 0.0, dry: 0.0 };
        let found = found_on_paper(seed, &hidden, &[0.02, 0.03, 0.045]);
        let (share, half) = (value(&found, "backlash", "share"), value(&found, "backlash", "delta"));
        assert!((share - 1.0).abs() < 0.02 && (half / hidden.half_gap - 1.0).abs() < 0.01, "{seed}: {share} {half}");
        let beside = ["hysteresis", "pad-compliance", "time-delay"];
        assert!(beside.iter().all(|id| named(&found, id).is_none()), "{seed}: {:?}", found.causes);
    }
}

#[test]
fn a_delay_does_not_go_with_the_ratio_and_none_is_made_up() {
    for (seed, late_s) in [(4, 0.03), (5, 0.0)] {
        let hidden = OnPaper { half_gap: 0.0, ratio: 0.914, late_s, dry: 0.0 };
        let found = found_on_paper(seed, &hidden, &[0.02, 0.03, 0.045]);
        if late_s == 0.0 {
            assert!(named(&found, "time-delay").is_none() && named(&found, "backlash").is_none(), "{:?}", found.causes);
        } else {
            let tau = value(&found, "time-delay", "tau");
            assert!((tau / late_s - 1.0).abs() < 0.03, "{tau}");
        }
    }
}

#[test]
fn dry_friction_beside_a_load_that_turns_round_with_the_motion_is_right_or_said_to_be_open() {
    for seed in 6..9 {
        let hidden = OnPaper { half_gap: 0.0, ratio: 1.0, late_s: 0.0, dry: 0.04 };
        // Unlike loads tell them apart.
        let found = found_on_paper(seed, &hidden, &[0.02, 0.03, 0.045]);
        let dry = value(&found, "coulomb-friction", "Fc");
        assert!((dry / hidden.dry - 1.0).abs() < 0.05, "{seed}: {dry}");
        // One load does not.
        let found = found_on_paper(seed, &hidden, &[0.03]);
        if let Some(dry) = named(&found, "coulomb-friction") {
            let fc = &dry.parameters[0];
            assert!((fc.value - hidden.dry).abs() < 2.0 * fc.std_error, "{seed}: {fc:?}");
            assert!(found.alternatives.iter().any(|a| a.instead_of == "coulomb-friction"), "{:?}", found.alternatives);
        } else {
            assert!(found.not_excited.iter().any(|n| n.id == "coulomb-friction"), "{:?}", found.not_excited);
        }
    }
}

#[test]
fn the_same_is_found_whichever_way_the_sensors_count() {
    let hidden = Hidden { gap: 0.02, stiffness: 12.0, dry: 0.05 };
    for seed in 1..4 {
        let runs = [recording(seed, &hidden), recording(seed + 100, &hidden)];
        let signs: [&[&str]; 4] = [&[], &["q_out_rad"], &["tau_Nm"], &["q_out_rad", "tau_Nm"]];
        for names in signs {
            let found = diagnose(&runs.each_ref().map(|r| turned(r, names)), &Options::default()).expect("two runs");
            for cause in &found.causes {
                println!("{seed} {names:?} {}: {:?}", cause.id, cause.parameters);
            }
            let half = value(&found, "backlash", "delta");
            assert!((0.7..1.5).contains(&(half / hidden.gap)), "{seed} {names:?}: {half}");
            let dry = value(&found, "coulomb-friction", "Fc");
            assert!((0.8..1.2).contains(&(dry / hidden.dry)), "{seed} {names:?}: {dry}");
            let forward = |id: &str| named(&found, id).and_then(|c| Some(c.gain.rollout.as_ref()?.share));
            assert!(forward("coulomb-friction").is_some_and(|share| share > 0.8), "{seed} {names:?}: {found:?}");
            let still = named(&found, "backlash").and_then(|c| c.gain.no_rollout.as_deref());
            assert!(still.is_some_and(|why| why.contains("at once")), "{seed} {names:?}: {still:?}");
            let stiffness = value(&found, "pad-compliance", "k");
            assert!((0.5..2.0).contains(&(stiffness / hidden.stiffness)), "{seed} {names:?}: {stiffness}");
            let sign = named(&found, "axis-sign").map(|c| c.parameters[0].name.as_str());
            assert_eq!(sign, names.contains(&"tau_Nm").then_some("which: tau_Nm"), "{seed} {names:?}");
            let said = found.warnings.iter().any(|w| w.contains("runs against"));
            assert_eq!(said, names.contains(&"q_out_rad"), "{seed} {names:?}: {:?}", found.warnings);
        }
    }
}
