//! A force sensor whose error is structured.

use super::family::Family;
use super::structure::Structure;
use blind::curve;
use blind::lag::{Creep, Resonance};

/// An instant, as a sensor meets it.
#[derive(Clone, Copy, Debug)]
pub struct Moment {
    /// Time, s.
    pub time_s: f64,
    /// Time since the reading before, s.
    pub step_s: f64,
    /// Place of the sensor, m.
    pub place_m: [f64; 2],
    /// Something was touched or let go since the reading before.
    pub is_struck: bool,
}

/// A sensor of two axes and its past.
#[derive(Clone, Copy, Debug, Default)]
pub struct ErringSensor {
    number: u64,
    creep: Creep,
    ring: [Resonance; 2],
    blows: i64,
    /// Time since the last blow, s.
    calm_s: f64,
    stuck_n: [f64; 2],
}

impl ErringSensor {
    /// The sensor of a number: each errs in its own way.
    pub fn new(number: usize) -> Self {
        Self { number: number as u64, ..Self::default() }
    }

    /// The reading of a force, N.
    pub fn read(&mut self, by: &Structure, force_n: [f64; 2], now: &Moment) -> [f64; 2] {
        // Functions of different axes have nothing in common.
        let axes = [0, 1].map(|axis: u64| 64 * (2 * self.number + axis + 1));
        let key = |axis: usize| by.seed + axes[axis];
        let with = |wrong: [f64; 2]| [0, 1].map(|axis: usize| force_n[axis] + by.size * wrong[axis]);
        match by.family {
            Family::SensorWander => with(axes.map(|axis| by.over_time(axis, now.time_s))),
            Family::SensorCreep => {
                self.creep.follow(force_n, by.shape[0], now.step_s);
                with(self.creep.past(by.form))
            }
            Family::SensorPlace => {
                let own = Structure { seed: key(0), ..*by };
                with(own.over_plane(now.place_m))
            }
            Family::LoadField => {
                if by.form == 0 {
                    with([0.0, curve::from_rest(key(1), force_n[0].abs() / by.shape[0])])
                } else {
                    let load_n = force_n[0].hypot(force_n[1]);
                    let share = curve::from_rest(key(0), load_n / by.shape[0]);
                    with(force_n.map(|f| f * share))
                }
            }
            Family::FingerRoll => turned(force_n, by.size * roll(by, key(0), force_n, now)),
            Family::Ringing => with(self.ringing(by, key(0), now)),
            Family::Hum => with([0, 1].map(|axis| {
                let tone = |hz: f64, more: u64| curve::tone(key(axis) + more, hz, by.shape[1], now.time_s);
                if by.form == 0 {
                    tone(by.shape[0], 0)
                } else {
                    0.8 * (tone(by.shape[0], 0) + tone(1.37 * by.shape[0], 8))
                }
            })),
            Family::Steps if by.form == 0 => {
                [0, 1].map(|axis: usize| curve::staircase(key(axis), force_n[axis], by.size))
            }
            Family::Steps => {
                for (stuck, now) in self.stuck_n.iter_mut().zip(force_n) {
                    if (now - *stuck).abs() > by.size {
                        *stuck = now;
                    }
                }
                self.stuck_n
            }
            _ => force_n,
        }
    }

    /// Two axes ring at slightly different frequencies. A blow is as hard as chance has it, or as the calm before it was long.
    fn ringing(&mut self, by: &Structure, key: u64, now: &Moment) -> [f64; 2] {
        let [hz, decay_s] = by.shape;
        self.blows += i64::from(now.is_struck);
        self.calm_s += now.step_s;
        for (axis, ring) in self.ring.iter_mut().enumerate() {
            ring.swing(hz * (1.0 + 0.13 * axis as f64), decay_s, now.step_s);
            if now.is_struck {
                let drawn = curve::unit(key + axis as u64, self.blows);
                ring.strike(if by.form == 0 { 1.0 + 0.4 * drawn } else { drawn.signum() * self.calm_s.min(1.5) });
            }
        }
        if now.is_struck {
            self.calm_s = 0.0;
        }
        self.ring.map(|ring| ring.value())
    }
}

/// Angle of the axes: over the place of the finger, or as its pad is sheared.
fn roll(by: &Structure, key: u64, force_n: [f64; 2], now: &Moment) -> f64 {
    let [place_m, shear] = by.shape;
    let [x, y] = now.place_m;
    if by.form == 0 {
        curve::noise(key, (0.5 * x + y) / place_m, None)
    } else {
        // Without a load there is nothing to roll on.
        let load_n = force_n[0].abs();
        let slope = force_n[1] / load_n.max(0.2);
        curve::from_rest(key, slope / shear) * (load_n / 0.2).min(1.0)
    }
}

/// A force, read along axes that are turned by an angle.
fn turned([x, y]: [f64; 2], angle_rad: f64) -> [f64; 2] {
    let (sin, cos) = angle_rad.sin_cos();
    [cos * x + sin * y, cos * y - sin * x]
}
