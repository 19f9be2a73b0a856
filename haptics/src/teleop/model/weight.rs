//! Masses of things, from the forces of the far fingers while they alone bear one.
//!
//! F = m (a − g) along a − g, one unknown: recursive least squares with the guess as prior. Pictures follow each other so quickly that
//! their errors are alike; each counts as a tenth of one.

use super::super::picture::Picture;
use crate::Vec2;
use crate::world::{MAX_BLOCKS, World};

/// Standard deviation of a guess, relative to it.
const GUESS: f64 = 0.5;
/// Error of the net force of two fingers in one picture, with the error of the acceleration from velocity differences,
/// N.
const FORCE_N: f64 = 0.05;
/// Share of a picture that is news.
const NEWS: f64 = 0.1;
/// Least duration of a grasp, s: an object just taken up still swings.
const SETTLED_S: f64 = 0.1;
/// Time constant with which a mass of the model follows its estimate, s.
const BLEED_S: f64 = 0.1;
/// The model's masses stay within these factors of the guess: lighter, the model could not be stepped.
const FACTORS: [f64; 2] = [0.5, 4.0];

/// Knowledge of a body's mass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Weighed {
    /// Its index in the world.
    pub body: usize,
    /// Mass in the model at the start, kg.
    pub guess_kg: f64,
    /// Mass estimated from the forces, kg.
    pub mass_kg: f64,
    /// Standard error of that, kg.
    pub std_kg: f64,
}

/// Estimates for every body.
pub(super) struct Weights {
    known: Vec<Weighed>,
    gravity: Vec2,
    /// The body that was borne in the last picture, when that was, and since when, s.
    borne: Option<(usize, f64, f64)>,
    velocity: Vec2,
    force_n: Vec2,
    last: Option<usize>,
}

impl Weights {
    pub fn new(world: &World) -> Self {
        let guess =
            |(body, mass_kg): (usize, f64)| Weighed { body, guess_kg: mass_kg, mass_kg, std_kg: GUESS * mass_kg };
        let mut known = Vec::with_capacity(MAX_BLOCKS);
        known.extend(world.blocks.iter().map(|block| block.mass_kg).enumerate().map(guess));
        Self {
            known,
            gravity: world.gravity_vector(),
            borne: None,
            velocity: Vec2::zeros(),
            force_n: Vec2::zeros(),
            last: None,
        }
    }

    /// Estimated mass of the body that was carried last.
    pub fn last(&self) -> Option<Weighed> {
        self.last.and_then(|body| self.known.get(body)).copied()
    }

    /// Takes a picture of the far world.
    pub fn learn(&mut self, far: &Picture) {
        let body = far.grasp.body.filter(|_| far.grasp.aloft);
        let Some((index, state)) = body.and_then(|index| Some((index, far.bodies.get(index)?))) else {
            self.borne = None;
            return;
        };
        let (velocity, force_n) = (state.velocity_m_s, far.tip_force_n[0] + far.tip_force_n[1]);
        let before = self.borne.filter(|(body, ..)| *body == index);
        let since_s = before.map_or(far.time_s, |(.., since_s)| since_s);
        if let Some((_, last_s, _)) = before
            && far.time_s > last_s
            && far.time_s - since_s > SETTLED_S
        {
            let pull = (velocity - self.velocity) / (far.time_s - last_s) - self.gravity;
            self.update(index, pull, 0.5 * (force_n + self.force_n));
        }
        self.borne = Some((index, far.time_s, since_s));
        (self.velocity, self.force_n) = (velocity, force_n);
    }

    fn update(&mut self, index: usize, pull: Vec2, force_n: Vec2) {
        let Some(known) = self.known.get_mut(index) else { return };
        let size = pull.norm();
        if !(size > 1.0 && force_n.norm().is_finite()) {
            return;
        }
        let variance = known.std_kg * known.std_kg;
        let gain = variance * size / (variance * size * size + FORCE_N * FORCE_N / NEWS);
        let [least_kg, most_kg] = FACTORS.map(|factor| factor * known.guess_kg);
        let missing_n = force_n.dot(&pull) / size - known.mass_kg * size;
        known.mass_kg = (known.mass_kg + gain * missing_n).clamp(least_kg, most_kg);
        known.std_kg = (variance * (1.0 - gain * size)).max(0.0).sqrt();
        self.last = Some(index);
    }

    /// Lets the model's masses follow.
    pub fn bleed(&self, world: &mut World, dt_s: f64) {
        let share = 1.0 - (-dt_s / BLEED_S).exp();
        for (block, known) in world.blocks.iter_mut().zip(&self.known) {
            // Its content is a part of it that the model must be able to lose.
            let least_kg = block.content.map_or(0.0, |content| 1.1 * content.mass_kg);
            block.mass_kg += (known.mass_kg.max(least_kg) - block.mass_kg) * share;
        }
    }
}
