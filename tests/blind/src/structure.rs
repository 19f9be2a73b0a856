//! Structured model error: real forces, and faults of a force sensor, that no law of the catalogue describes.
//!
//! The first number of a shape is the seed of the random functions ([`curve`]), except for creep; a size is N, or a share of a force
//! that is there. Friction is modulated by an exponential: it never pushes.

use super::chance::Chance;
use super::curve;
use super::draw::{Bench, Spec, Structure};
use super::effect::Effect;
use super::lag::{Creep, Resonance};
use super::plan::Log;
use super::plant::{Hidden, Instant, Loads, Plant};
use super::sensor::Sensor;
use super::simulate::{Sample, Setup};
use std::f64::consts::TAU;

/// A mechanism moves within this span, rad.
const SPAN: f64 = 5.0;
/// A motion counts as turned round from this speed on, rad/s.
const TURNED: f64 = 0.15;

impl Hidden {
    /// Seed of its random functions.
    fn seed(&self) -> u64 {
        self.shape[0] as u64
    }

    /// A random function of time in one of the two forms, variance about 1.
    fn over_time(&self, axis: u64, time_s: f64) -> f64 {
        let x = time_s / self.shape[1];
        if self.form == 0 { curve::noise(self.seed() + axis, x, None) } else { curve::octaves(self.seed() + axis, x) }
    }

    /// A random function of the place in one of the two forms: it comes again at every turn of a crank.
    fn over_place(&self, plant: &Plant, now: &Instant) -> f64 {
        let knots = self.shape[1];
        let (x, around) = if plant.is_crank() {
            (now.angle.rem_euclid(TAU) / TAU * knots, Some(knots as u32))
        } else {
            (now.turned / SPAN * knots, None)
        };
        if self.form == 0 { curve::bumps(self.seed(), x, around) } else { curve::noise(self.seed(), x, around) }
    }

    /// Dry friction that is `exp(size g)` times what it was.
    fn modulated(&self, base: &Loads, g: f64) -> Loads {
        let more = (self.size * g).exp() - 1.0;
        Loads { forward_n: base.forward_n * more, backward_n: base.backward_n * more, ..Loads::default() }
    }

    /// Resistance that a structure adds to that of `plant`, whose own is `base`; none for anything else.
    pub fn structured_loads(&self, plant: &Plant, base: &Loads, now: &Instant) -> Loads {
        let smooth = |force_n: f64| Loads { smooth_n: force_n, ..Loads::default() };
        match self.effect {
            Effect::AngleField => smooth(self.size * self.over_place(plant, now)),
            Effect::SpeedField => {
                let x = now.speed.abs() / self.shape[1];
                let force = curve::from_rest(self.seed(), x);
                smooth(self.size * now.speed.signum() * force)
            }
            Effect::LoadField => {
                let across = if self.form == 0 { now.across_n } else { now.across_n.abs() };
                self.modulated(base, curve::noise(self.seed(), across / self.shape[1], None))
            }
            Effect::StateField => {
                let turned = if plant.is_crank() { now.angle } else { 0.8 * now.turned };
                let load = if plant.is_crank() { now.across_n } else { 0.0 };
                let inputs = [turned.cos(), turned.sin(), now.speed / self.shape[1], load];
                smooth(self.size * curve::network(self.seed(), inputs))
            }
            Effect::FrictionOverAngle => self.modulated(base, self.over_place(plant, now)),
            Effect::FrictionWander => self.modulated(base, self.over_time(0, now.time_s)),
            _ => Loads::default(),
        }
    }

    /// The force `f` as a sensor with this structure tells it.
    pub fn told(&self, f: [f64; 2], sample: &Sample) -> [f64; 2] {
        let with = |wrong: [f64; 2]| [f[0] + self.size * wrong[0], f[1] + self.size * wrong[1]];
        match self.effect {
            Effect::SensorWander => with([0, 1].map(|axis| self.over_time(axis, sample.time_s))),
            Effect::SensorCreep | Effect::Ringing => with(sample.wake_n),
            Effect::Hum => with([0, 1].map(|axis| self.hum(axis, sample.time_s))),
            // The gauge itself moves in steps; noise comes after it.
            Effect::Steps => {
                [curve::staircase(self.seed(), f[0], self.size), curve::staircase(self.seed() + 1, f[1], self.size)]
            }
            _ => f,
        }
    }

    /// A tone whose amplitude and phase wander.
    fn hum(&self, axis: u64, time_s: f64) -> f64 {
        let [_, hz, period_s] = self.shape;
        curve::tone(self.seed() + axis, hz, period_s, time_s)
    }

    /// Way from the handle to where the grasp has wandered, m: by itself, or as the pad gives way to the force in time.
    pub fn grasp_m(&self, time_s: f64, wake_n: [f64; 2]) -> [f64; 2] {
        if self.form == 0 {
            let period_s = self.shape[1];
            [0, 1].map(|axis| self.size * curve::noise(self.seed() + axis, time_s / period_s, None))
        } else {
            wake_n.map(|n| self.size * n)
        }
    }
}

/// Traces of the past in a sensor or a pad.
#[derive(Clone, Copy, Debug, Default)]
pub struct Wake {
    /// The force of the past, N.
    creep: Creep,
    /// A resonance.
    ring: Resonance,
    /// Direction of the motion, and for how long it has lasted, s.
    way: (f64, f64),
    /// Number of reversals.
    turns: i64,
}

/// One step of the motion, as a [`Wake`] feels it.
pub struct Push {
    /// Force on the handle, N.
    pub force_n: [f64; 2],
    /// Direction of the motion.
    pub along: [f64; 2],
    /// Speed, rad/s.
    pub speed: f64,
    /// Length of the step, s.
    pub step_s: f64,
}

impl Wake {
    /// Follows a step; returns what is left of the past, for a size of 1.
    pub fn follow(&mut self, hidden: &Hidden, push: &Push) -> [f64; 2] {
        match hidden.effect {
            Effect::SensorCreep => {
                self.creep.follow(push.force_n, hidden.shape[0], push.step_s);
                self.creep.past(hidden.form)
            }
            Effect::GraspCreep => {
                self.creep.follow(push.force_n, hidden.shape[2], push.step_s);
                self.creep.past(0)
            }
            Effect::Ringing => {
                let now = self.resonate(hidden, push);
                push.along.map(|d| d * now)
            }
            _ => [0.0; 2],
        }
    }

    /// Each reversal strikes the resonance: by chance, or the harder the longer the motion had gone the other way.
    fn resonate(&mut self, hidden: &Hidden, push: &Push) -> f64 {
        let [seed, hz, decay_s] = hidden.shape;
        self.ring.swing(hz, decay_s, push.step_s);
        self.way.1 += push.step_s;
        let way = push.speed.signum();
        if push.speed.abs() > TURNED && way * self.way.0 <= 0.0 {
            let hard =
                if hidden.form == 0 { 1.0 + 0.4 * curve::unit(seed as u64, self.turns) } else { self.way.1.min(1.5) };
            self.ring.strike(way * hard);
            self.way = (way, 0.0);
            self.turns += 1;
        }
        self.ring.value()
    }
}

/// A structure in some shape, of about the wanted size; from a source of its own, so that everything else is as without it.
pub fn guess(spec: &Spec, plant: &Plant, sensor: &Sensor, structure: &Structure, chance: &mut Chance) -> Hidden {
    let e = structure.ratio * sensor.floor_n();
    let base_n = if spec.bench.is_crank() { 0.6 * plant.load_friction } else { plant.dry_n.max(1e-3) };
    let size = match structure.effect {
        Effect::SensorCreep => 2.0 * e,
        Effect::LoadField | Effect::FrictionOverAngle | Effect::FrictionWander => (1.5 * e / base_n).min(1.0),
        Effect::GraspCreep => 2.0 * plant.radius_m * e,
        Effect::Ringing | Effect::Steps => 3.5 * e,
        _ => 1.5 * e,
    };
    let effect = structure.effect;
    Hidden { effect, form: structure.form, size, shape: shape(spec, effect, chance) }
}

fn shape(spec: &Spec, effect: Effect, chance: &mut Chance) -> [f64; 3] {
    let seed = f64::from(chance.whole(0, u32::MAX));
    let speed = spec.bench.usual_speed() * if spec.log == Log::Slow { 0.2 } else { 1.0 };
    let knots = |chance: &mut Chance, low: u32, high: u32| f64::from(chance.whole(low, high));
    match effect {
        Effect::SensorWander => [seed, chance.of_order(1.0, 8.0), 0.0],
        Effect::SensorCreep => [chance.of_order(0.3, 4.0), 0.0, 0.0],
        Effect::AngleField => [seed, knots(chance, 5, 11), 0.0],
        Effect::SpeedField => [seed, 2.5 * speed / knots(chance, 4, 6), 0.0],
        Effect::LoadField => [seed, chance.of_order(0.3, 0.8), 0.0],
        Effect::StateField => [seed, speed * chance.of_order(0.7, 1.5), 0.0],
        Effect::FrictionOverAngle => [seed, knots(chance, 4, 8), 0.0],
        Effect::FrictionWander => [seed, chance.of_order(2.0, 10.0), 0.0],
        Effect::GraspCreep => [seed, chance.of_order(3.0, 10.0), chance.of_order(0.5, 4.0)],
        Effect::Ringing => [seed, chance.of_order(8.0, 25.0), chance.of_order(0.05, 0.25)],
        Effect::Hum => [seed, chance.of_order(10.0, 45.0), chance.of_order(0.7, 4.0)],
        _ => [seed, 0.0, 0.0],
    }
}

/// Sizes beyond which a structure would be another thing: a hand that damps less than a force pushes would shake by itself.
pub fn limited(setup: &Setup, hidden: &Hidden, size: f64) -> f64 {
    match hidden.effect {
        Effect::SensorCreep => size.min(0.6),
        Effect::LoadField | Effect::FrictionOverAngle | Effect::FrictionWander => size.min(1.2),
        Effect::GraspCreep if hidden.form == 0 => size.min(0.2 * setup.plant.radius_m),
        Effect::SpeedField | Effect::StateField => {
            let damping = setup.habits.damping + setup.plant.viscous;
            size.min(0.45 * damping * hidden.shape[1])
        }
        _ => size,
    }
}

/// Force that a wandering grasp adds to the one along the motion, at one sample: the force is split along a direction that is a little
/// off. `direction` is the true one, `radius_m` the crank's.
pub fn turned_n(hidden: &Hidden, sample: &Sample, radius_m: f64) -> f64 {
    let (sin, cos) = sample.angle.sin_cos();
    let off = hidden.grasp_m(sample.time_s, sample.wake_n);
    let (x, y) = (radius_m * cos + off[0], radius_m * sin + off[1]);
    let length = x.hypot(y).max(1e-9);
    sample.force_n[1] * (x / length - cos) - sample.force_n[0] * (y / length - sin)
}

/// True where a structure can be seen in such a motion.
pub fn shows_in(effect: Effect, bench: Bench, log: Log) -> bool {
    match effect {
        Effect::Ringing => log.reverses() && log != Log::Slow,
        // Curves over the speed that are steep enough would shake a slow hand.
        Effect::SpeedField | Effect::StateField => log != Log::Slow,
        Effect::LoadField | Effect::GraspCreep => bench.is_crank(),
        _ => true,
    }
}
