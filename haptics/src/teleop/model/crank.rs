//! Resistance of the crank, from the forces of the far fingers while they turn it: recursive least squares on the
//! regressors of its laws, with the guess as prior.

use super::super::picture::Picture;
use crate::Vec2;
use crate::law::{Effect, Enters, Memory, Motion};
use crate::world::{Crank, World};
use nalgebra::{SMatrix, SVector};

/// Largest number of parameters that are followed.
const MOST: usize = 8;
/// Standard deviation of a guess, relative to it.
const GUESS: f64 = 0.5;
/// Error of the drive in one picture, N.
const FORCE_N: f64 = 0.05;
/// Share of a picture that is news: neighbours have the same errors.
const NEWS: f64 = 0.1;
/// Slower, friction does not know its direction, m/s.
const MOVING_M_S: f64 = 0.01;
/// Time constant with which the model's laws follow, s.
const BLEED_S: f64 = 0.2;
/// A parameter stays within these factors of its guess.
const FACTORS: [f64; 2] = [0.2, 5.0];

type Column = SVector<f64, MOST>;

/// The linear parameters of a crank's laws.
pub(super) struct CrankLaws {
    crank: Option<Crank>,
    /// Effect and parameter of each place.
    places: [(usize, usize); MOST],
    used: usize,
    guess: Column,
    values: Column,
    covariance: SMatrix<f64, MOST, MOST>,
    before: Option<Turn>,
}

/// One picture of a crank that is turned.
#[derive(Clone, Copy)]
struct Turn {
    motion: Motion,
    drive_n: f64,
}

impl CrankLaws {
    pub fn new(world: &World) -> Self {
        let mut laws = Self {
            crank: world.crank.clone(),
            places: [(0, 0); MOST],
            used: 0,
            guess: Column::zeros(),
            values: Column::zeros(),
            covariance: SMatrix::zeros(),
            before: None,
        };
        for (index, effect) in world.crank.iter().flat_map(|crank| crank.effects.iter().enumerate()) {
            for (parameter, spec) in effect.law().parameters().iter().enumerate() {
                let value = effect.values[parameter];
                // A parameter with the guess zero has no scale for its uncertainty.
                if effect.enabled && spec.enters == Enters::Linear && value != 0.0 && laws.used < MOST {
                    laws.places[laws.used] = (index, parameter);
                    laws.guess[laws.used] = value;
                    laws.covariance[(laws.used, laws.used)] = (GUESS * value).powi(2);
                    laws.used += 1;
                }
            }
        }
        laws.values = laws.guess;
        laws
    }

    /// Takes a picture of the far world.
    pub fn learn(&mut self, far: &Picture) {
        let now = self.crank.as_ref().filter(|_| far.grasp.handle).map(|crank| turn(crank, far));
        if let (Some(before), Some(now)) = (self.before, now) {
            let span_s = now.motion.time_s - before.motion.time_s;
            let even = before.motion.velocity * now.motion.velocity > 0.0;
            if span_s > 0.0 && even && now.motion.velocity.abs() > MOVING_M_S {
                self.update(&between(&before, &now, span_s));
            }
        }
        self.before = now;
    }

    fn update(&mut self, turn: &Turn) {
        let Some(crank) = &self.crank else { return };
        let mut column = Column::zeros();
        let mut known_n = 0.0;
        for (index, effect) in crank.effects.iter().enumerate().filter(|(_, effect)| effect.enabled) {
            let columns = effect.columns(&turn.motion, &Memory::default());
            let followed = (0..self.used).filter(|k| self.places[*k].0 == index);
            let mut any = false;
            for k in followed {
                (column[k], any) = (columns[self.places[k].1], true);
            }
            known_n += if any { 0.0 } else { effect.force(&turn.motion) };
        }
        let spread = self.covariance * column;
        let variance = column.dot(&spread) + FORCE_N * FORCE_N / NEWS;
        let missing_n = turn.drive_n - known_n - column.dot(&self.values);
        if !(variance > 0.0 && missing_n.is_finite()) {
            return;
        }
        let gain = spread / variance;
        self.values += gain * missing_n;
        self.covariance -= gain * spread.transpose();
        for k in 0..self.used {
            let ends = FACTORS.map(|factor| factor * self.guess[k]);
            self.values[k] = self.values[k].clamp(ends[0].min(ends[1]), ends[0].max(ends[1]));
        }
    }

    /// Lets the model's laws follow.
    pub fn bleed(&self, world: &mut World, dt_s: f64) {
        let share = 1.0 - (-dt_s / BLEED_S).exp();
        let Some(crank) = &mut world.crank else { return };
        for (k, (index, parameter)) in self.places.iter().enumerate().take(self.used) {
            if let Some(value) = crank.effects.get_mut(*index).and_then(|e: &mut Effect| e.values.get_mut(*parameter)) {
                *value += (self.values[k] - *value) * share;
            }
        }
    }
}

fn turn(crank: &Crank, far: &Picture) -> Turn {
    let (sin, cos) = far.crank.angle_rad.sin_cos();
    let force_n = far.tip_force_n[0] + far.tip_force_n[1];
    let motion = Motion {
        time_s: far.time_s,
        position: crank.radius_m * far.crank.angle_rad,
        velocity: crank.radius_m * far.crank.rate_rad_s,
        acceleration: 0.0,
        direction: far.crank.rate_rad_s.signum(),
        normal_force_n: force_n.dot(&Vec2::new(cos, sin)),
        up_along: cos,
    };
    Turn { motion, drive_n: force_n.dot(&Vec2::new(-sin, cos)) }
}

/// The mean of two pictures, with the acceleration between them.
fn between(a: &Turn, b: &Turn, span_s: f64) -> Turn {
    let mean = |of: fn(&Motion) -> f64| 0.5 * (of(&a.motion) + of(&b.motion));
    let motion = Motion {
        time_s: mean(|m| m.time_s),
        position: mean(|m| m.position),
        velocity: mean(|m| m.velocity),
        acceleration: (b.motion.velocity - a.motion.velocity) / span_s,
        direction: b.motion.direction,
        normal_force_n: mean(|m| m.normal_force_n),
        up_along: mean(|m| m.up_along),
    };
    Turn { motion, drive_n: 0.5 * (a.drive_n + b.drive_n) }
}
