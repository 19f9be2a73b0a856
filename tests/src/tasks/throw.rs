//! Thrown cubes with something hidden: flight with spin, blows on one corner, slides; a tracker of our own looks.

use super::{Case, Truth};
use blind::Chance;
use estimator::diagnose::Options;
use haptics::recording::{Channel, Meta, Recording, Task};
use std::ops::{Add, Mul, Sub};

/// What is hidden.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Right lengths, elastic impacts, slides without friction.
    Nothing,
    /// Lengths off by some per cent.
    Scale,
    /// Dry friction under the slides.
    Dry,
    /// Friction that follows the speed.
    Viscous,
    /// Impacts that take speed.
    Loss,
}

impl Kind {
    /// All of them.
    pub const ALL: [(&'static str, Self); 5] = [
        ("throw: nothing", Self::Nothing),
        ("throw: scale", Self::Scale),
        ("throw: dry", Self::Dry),
        ("throw: viscous", Self::Viscous),
        ("throw: loss", Self::Loss),
    ];
}

#[derive(Clone, Copy, Debug, Default)]
struct V([f64; 3]);

impl Add for V {
    type Output = Self;
    fn add(self, o: Self) -> Self {
        Self([self.0[0] + o.0[0], self.0[1] + o.0[1], self.0[2] + o.0[2]])
    }
}

impl Sub for V {
    type Output = Self;
    fn sub(self, o: Self) -> Self {
        self + o * -1.0
    }
}

impl Mul<f64> for V {
    type Output = Self;
    fn mul(self, by: f64) -> Self {
        Self(self.0.map(|v| v * by))
    }
}

impl V {
    fn cross(self, o: Self) -> Self {
        let ([a, b, c], [d, e, f]) = (self.0, o.0);
        Self([b * f - c * e, c * d - a * f, a * e - b * d])
    }

    fn norm(self) -> f64 {
        self.0.iter().map(|v| v * v).sum::<f64>().sqrt()
    }
}

/// A quaternion (w, x, y, z) turned on by a small rotation, rad.
fn turned_by(q: [f64; 4], rotation: V) -> [f64; 4] {
    let angle = rotation.norm();
    let s = if angle > 1e-12 { (0.5 * angle).sin() / angle } else { 0.5 };
    let (a, [b, c, d]) = ((0.5 * angle).cos(), (rotation * s).0);
    let [w, x, y, z] = q;
    [
        a * w - b * x - c * y - d * z,
        a * x + b * w + c * z - d * y,
        a * y - b * z + c * w + d * x,
        a * z + b * y - c * x + d * w,
    ]
}

fn rotate(q: [f64; 4], v: V) -> V {
    let u = V([q[1], q[2], q[3]]);
    let t = u.cross(v) * 2.0;
    v + t * q[0] + u.cross(t)
}

/// What the table and the tracker do.
struct World {
    scale: f64,
    restitution: f64,
    mu: f64,
    drag_per_s: f64,
    half_m: f64,
    noise_m: f64,
}

/// How the throws are looked at.
#[derive(Clone, Copy, Debug)]
pub struct Sight {
    /// Samples a second.
    pub rate_hz: f64,
    /// How many.
    pub throws: usize,
    /// White noise of every number of the orientation.
    pub turn_noise: f64,
}

impl Default for Sight {
    fn default() -> Self {
        Self { rate_hz: 150.0, throws: 130, turn_noise: 0.0 }
    }
}

/// Steps of the integration a second, about.
const STEPS_HZ: f64 = 12_000.0;
/// How long a throw is followed, s.
const LONG_S: f64 = 110.0 / 150.0;

/// A case of a kind.
pub fn make(kind: Kind, seed: u64) -> (Case, Truth) {
    seen(kind, seed, &Sight::default())
}

/// The same, looked at in another way.
pub fn seen(kind: Kind, seed: u64, sight: &Sight) -> (Case, Truth) {
    let mut chance = Chance::new(seed, 79);
    let mut world = World {
        scale: 1.0,
        restitution: 1.0,
        mu: 0.0,
        drag_per_s: 0.0,
        half_m: chance.between(0.03, 0.06),
        noise_m: chance.of_order(3e-5, 1e-4),
    };
    let mut truth = Truth::default();
    match kind {
        Kind::Nothing => {}
        Kind::Scale => {
            world.scale = 1.0 + chance.of_order(0.008, 0.05) * chance.sign();
            truth.hidden = vec!["length-scale"];
            truth.value = Some(("epsilon", world.scale - 1.0));
        }
        Kind::Dry => {
            world.mu = chance.between(0.08, 0.4);
            truth.hidden = vec!["load-friction"];
            truth.value = Some(("mu", world.mu));
        }
        Kind::Viscous => {
            world.drag_per_s = chance.between(0.8, 4.0);
            truth.hidden = vec!["viscous-friction"];
            truth.value = Some(("c/m", world.drag_per_s));
        }
        Kind::Loss => {
            world.restitution = chance.between(0.2, 0.85);
            truth.hidden = vec!["velocity-loss"];
            truth.value = Some(("e", world.restitution));
        }
    }
    let recordings = (0..sight.throws).map(|k| throw(&world, sight, k, &mut chance)).collect();
    (Case { recordings, options: Options::default() }, truth)
}

/// One throw: it comes down on a corner, or flat and slides out.
fn throw(world: &World, sight: &Sight, trial: usize, chance: &mut Chance) -> Recording {
    let tumbles = trial.is_multiple_of(2);
    let parts = (STEPS_HZ / sight.rate_hz).round() as usize;
    let part = 1.0 / (sight.rate_hz * parts as f64);
    let mut place = V([0.0, 0.1, chance.between(0.2, 0.4)]);
    let mut speed = V([chance.between(-1.5, 1.5), chance.between(0.6, 1.6) * chance.sign(), chance.between(-0.4, 0.6)]);
    let mut q = [1.0, 0.0, 0.0, 0.0];
    let mut spin = V::default();
    if tumbles {
        q = turned_by(
            q,
            V([0.7 + chance.between(-0.3, 0.3), 0.6 + chance.between(-0.3, 0.3), chance.between(-2.0, 2.0)]),
        );
        spin = V([chance.between(-3.0, 3.0), chance.between(-3.0, 3.0), chance.between(-3.0, 3.0)]);
    }
    let mut flat = false;
    let mut rows: Vec<[f64; 7]> = Vec::new();
    for _ in 0..(LONG_S * sight.rate_hz).round() as usize {
        let seen = place * world.scale;
        let shaken: [f64; 3] = std::array::from_fn(|k| seen.0[k] + world.noise_m * chance.normal());
        let mut told = q;
        if sight.turn_noise > 0.0 {
            for v in &mut told {
                *v += sight.turn_noise * chance.normal();
            }
        }
        rows.push([shaken[0], shaken[1], shaken[2], told[0], told[1], told[2], told[3]]);
        for _ in 0..parts {
            if flat {
                let now = speed.norm();
                let slower = (now - (world.mu * 9.81 + world.drag_per_s * now) * part).max(0.0);
                speed = if now > 0.0 { speed * (slower / now) } else { speed };
                place = place + speed * part;
                continue;
            }
            speed.0[2] -= 9.81 * part;
            place = place + speed * part;
            q = turned_by(q, spin * part);
            if tumbles {
                knock(world, &mut speed, &mut spin, place, q);
            } else if place.0[2] < world.half_m {
                (flat, place.0[2], speed.0[2]) = (true, world.half_m, 0.0);
            }
        }
    }
    let channel = |k: usize, name: &str, unit: &str| Channel {
        name: name.to_owned(),
        unit: unit.to_owned(),
        values: rows.iter().map(|r| r[k]).collect(),
    };
    let names = [("x_m", "m"), ("y_m", "m"), ("z_m", "m"), ("qw", ""), ("qx", ""), ("qy", ""), ("qz", "")];
    let mut meta = Meta { up: Some("z".to_owned()), task: Some(Task::Mechanism), ..Meta::default() };
    meta.known.insert("half_width_m".to_owned(), world.half_m);
    Recording {
        name: format!("throw {trial}"),
        time_s: Some((0..rows.len()).map(|i| i as f64 / sight.rate_hz).collect()),
        channels: names.iter().enumerate().map(|(k, (name, unit))| channel(k, name, unit)).collect(),
        meta,
        ..Recording::default()
    }
}

/// A blow without friction on the lowest corner, if it is below the table and goes down. A cube's inertia is the same about every axis.
fn knock(world: &World, speed: &mut V, spin: &mut V, place: V, q: [f64; 4]) {
    let h = world.half_m;
    let corner = |k: u32| {
        let sign = |bit: u32| if k >> bit & 1 == 1 { h } else { -h };
        rotate(q, V([sign(0), sign(1), sign(2)]))
    };
    let low = (0..8).map(corner).min_by(|a, b| a.0[2].total_cmp(&b.0[2])).unwrap_or_default();
    let closing = (*speed + spin.cross(low)).0[2];
    if place.0[2] + low.0[2] >= 0.0 || closing >= 0.0 {
        return;
    }
    let up = V([0.0, 0.0, 1.0]);
    // Per unit of mass: a homogeneous cube of half width h has 2/3 h².
    let inertia = 2.0 / 3.0 * h * h;
    let lever = low.cross(up);
    let give = 1.0 + lever.norm().powi(2) / inertia;
    let impulse = -(1.0 + world.restitution) * closing / give;
    *speed = *speed + up * impulse;
    *spin = *spin + lever * (impulse / inertia);
}
