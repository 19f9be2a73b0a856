//! Through the instruments into a table with its sidecar.

use super::arm::Arm;
use super::chance::Chance;
use super::clock::Clock;
use super::draw::{self, Bench, LINK_M, Spec};
use super::effect::Effect;
use super::measure::Known;
use super::sensor::{self, Sensor, quantised};
use super::simulate::{Sample, Setup};
use haptics::recording::{Channel, HandMeta, Meta, Recording, Task};

/// m/s²
pub const GRAVITY: f64 = 9.81;
/// Half the distance between two fingers on a handle, m.
const HALF_GRIP_M: f64 = 0.008;

struct Columns {
    names: Vec<(String, &'static str)>,
    values: Vec<Vec<f64>>,
    force_at: usize,
}

/// Through the instruments into a table. `zero_m`: where a mechanism's coordinate begins; drawn by its first recording.
pub fn record(
    spec: &Spec,
    setup: &Setup,
    sensor: &Sensor,
    arm: &Arm,
    samples: &[Sample],
    chance: &mut Chance,
    zero_m: &mut Option<f64>,
) -> Recording {
    let clock = clock(setup);
    let samples = &clock.read(samples);
    let mut columns = match spec.bench {
        Bench::OneFinger => finger(setup, sensor, arm, samples, chance, ("", 1.0, 0.0), &|_, told| told),
        Bench::TwoFingers => two_fingers(setup, sensor, arm, samples, chance),
        Bench::Linear | Bench::Angular => mechanism(spec, setup, sensor, samples, chance, zero_m),
    };
    let kept = sensor::spoil(&setup.hidden, &mut columns.values, columns.force_at, spec.rate_hz);
    let keep =
        |values: Vec<f64>| -> Vec<f64> { values.into_iter().zip(&kept).filter(|(_, k)| **k).map(|(v, _)| v).collect() };
    let mut stamps = Chance::new(setup.seed, 10);
    let time_s = keep((0..samples.len()).map(|i| clock.stamp(i as f64 / spec.rate_hz, &mut stamps)).collect());
    let channels = columns
        .names
        .into_iter()
        .zip(columns.values)
        .map(|((name, unit), values)| Channel { name, unit: unit.to_owned(), values: keep(values) })
        .collect();
    let name = format!("blind-{}", setup.seed);
    Recording { name, time_s: Some(time_s), channels, meta: meta(spec, setup, arm, *zero_m), ..Recording::default() }
}

/// The clocks of a recording; a hidden delay is a case of its own.
pub fn clock(setup: &Setup) -> Clock {
    let late = setup.hidden.iter().any(|h| h.effect == Effect::Delay);
    if late { Clock::default() } else { Clock::draw(setup.rate_hz, setup.seed) }
}

fn meta(spec: &Spec, setup: &Setup, arm: &Arm, zero_m: Option<f64>) -> Meta {
    let mut meta = Meta { rate_hz: Some(spec.rate_hz), ..Meta::default() };
    if spec.bench.is_crank() {
        let two = spec.bench == Bench::TwoFingers;
        let beside = |side: f64| Some([arm.base_m[0] + side * HALF_GRIP_M, arm.base_m[1]]);
        meta.task = Some(Task::Crank);
        meta.hand = Some(HandMeta {
            link_m: Some(LINK_M),
            base_m: (!two).then_some(arm.base_m),
            base1_m: if two { beside(-1.0) } else { None },
            base2_m: if two { beside(1.0) } else { None },
        });
        if draw::known(spec) == Known::CrankOfKnownWeight {
            meta.known.insert("weight_N".to_owned(), setup.plant.weight_n);
        }
    } else {
        meta.task = Some(Task::Mechanism);
    }
    state_hung(&mut meta, setup, zero_m);
    meta
}

/// Who hangs a weight on writes it down.
fn state_hung(meta: &mut Meta, setup: &Setup, zero_m: Option<f64>) {
    let hung = setup.plant.hung;
    if hung.force <= 0.0 {
        return;
    }
    let mut state = |name: &str, value: f64| {
        meta.known.insert(name.to_owned(), value);
    };
    if setup.center_m.is_some() {
        state("added_weight_N", hung.force);
    } else {
        // Force and inertia tell the lever: F = W l, J = W l² / g.
        let lever_m = GRAVITY * hung.inertia / hung.force;
        state("added_weight_N", hung.force / lever_m);
        state("added_lever_m", lever_m);
        state("added_level_rad", hung.level + zero_m.unwrap_or(0.0));
    }
}

/// How far two fingers are open beyond what they hold, m: they close as they arrive, and open to let go.
fn opening(setup: &Setup, time_s: f64) -> f64 {
    let [from, until] = setup.hold_s;
    let away = ((from - 0.02 - time_s) / 0.2).max((time_s - until) / 0.15).clamp(0.0, 1.0);
    0.004 * away * away * (3.0 - 2.0 * away)
}

/// The columns of one finger: its name's ending, its share of the noise, the side on which it opens (0: neither), and what its sensor
/// tells of the net force.
fn finger(
    setup: &Setup,
    sensor: &Sensor,
    arm: &Arm,
    samples: &[Sample],
    chance: &mut Chance,
    (ending, part, side): (&str, f64, f64),
    share: &dyn Fn(&Sample, [f64; 2]) -> [f64; 2],
) -> Columns {
    let names = [("qb", "rad"), ("qt", "rad"), ("dqb", "rad_s"), ("dqt", "rad_s"), ("fx", "N"), ("fy", "N")]
        .map(|(quantity, unit)| (format!("{quantity}{ending}_{unit}"), unit));
    let mut values = vec![Vec::new(); 6];
    let mut noise = [(); 2].map(|()| sensor.noise(setup.rate_hz, part, chance));
    for s in samples {
        let wide = |time_s: f64| side * opening(setup, time_s);
        let tip = [s.tip_m[0] + wide(s.time_s), s.tip_m[1]];
        let speed = [s.tip_speed[0] + (wide(s.time_s + 1e-5) - wide(s.time_s - 1e-5)) / 2e-5, s.tip_speed[1]];
        let (angles, rates) = sensor::joints(arm, &setup.hidden, tip, speed);
        let told = share(s, sensor::force(&setup.hidden, None, s, setup.effects_s));
        for k in 0..2 {
            values[k].push(quantised(angles[k] + sensor.angle_noise * chance.normal(), sensor.angle_step));
            values[2 + k].push(rates[k] + sensor.rate_noise * chance.normal());
            let read = quantised(told[k] + noise[k].next(chance), part * sensor.step_n);
            values[4 + k].push(rail(setup, read));
        }
    }
    Columns { names: names.to_vec(), values, force_at: 4 }
}

/// What clips, clips the noise too.
fn rail(setup: &Setup, read: f64) -> f64 {
    setup.hidden.iter().filter(|h| h.effect == Effect::Saturation).fold(read, |read, h| {
        let level = h.shape[1] / (1.0 + h.size);
        read.clamp(-level, level)
    })
}

/// Two fingers beside each other on the handle share the load and squeeze; what is wrong with a sensor is in the left one.
fn two_fingers(setup: &Setup, sensor: &Sensor, arm: &Arm, samples: &[Sample], chance: &mut Chance) -> Columns {
    let squeeze_n = chance.between(0.8, 1.6);
    let slow_hz = chance.between(0.1, 0.4);
    let squeeze = |s: &Sample| {
        if s.held { squeeze_n * (1.0 + 0.2 * (std::f64::consts::TAU * slow_hz * s.time_s).sin()) } else { 0.0 }
    };
    let part = std::f64::consts::FRAC_1_SQRT_2;
    // The fingers stand as far apart as they grip: each bends like the one in the middle would.
    let left = finger(setup, sensor, arm, samples, chance, ("1", part, -1.0), &|s, told| {
        [told[0] - 0.5 * s.force_n[0] + squeeze(s), told[1] - 0.5 * s.force_n[1]]
    });
    let right = finger(setup, sensor, arm, samples, chance, ("2", part, 1.0), &|s, _| {
        [0.5 * s.force_n[0] - squeeze(s), 0.5 * s.force_n[1]]
    });
    Columns {
        names: [left.names, right.names].concat(),
        values: [left.values, right.values].concat(),
        force_at: left.force_at,
    }
}

fn mechanism(
    spec: &Spec,
    setup: &Setup,
    sensor: &Sensor,
    samples: &[Sample],
    chance: &mut Chance,
    zero_m: &mut Option<f64>,
) -> Columns {
    let [path, speed, force] = if spec.bench == Bench::Linear {
        [("q_m", "m"), ("dq_m_s", "m_s"), ("f_N", "N")]
    } else {
        [("q_rad", "rad"), ("dq_rad_s", "rad_s"), ("tau_Nm", "Nm")]
    };
    let with_speed = chance.happens(0.6);
    let mut noise = sensor.noise(setup.rate_hz, 1.0, chance);
    let drawn = chance.between(-0.5, 0.5) * setup.plant.radius_m;
    let start = *zero_m.get_or_insert(drawn);
    let (mut q, mut dq, mut f) = (Vec::new(), Vec::new(), Vec::new());
    for s in samples {
        q.push(quantised(start + s.tip_m[0] + sensor.angle_noise * chance.normal(), sensor.angle_step));
        dq.push(s.tip_speed[0] + sensor.rate_noise * chance.normal());
        let told = sensor::force(&setup.hidden, None, s, setup.effects_s)[0];
        f.push(rail(setup, quantised(told + noise.next(chance), sensor.step_n)));
    }
    let named = |(name, unit): (&str, &'static str)| (name.to_owned(), unit);
    if with_speed {
        Columns { names: vec![named(path), named(speed), named(force)], values: vec![q, dq, f], force_at: 2 }
    } else {
        Columns { names: vec![named(path), named(force)], values: vec![q, f], force_at: 1 }
    }
}
