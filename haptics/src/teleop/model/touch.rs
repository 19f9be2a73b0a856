//! Feel of things under the far fingers: friction from slips, or from grips that hold though they should slip;
//! stiffness of a wall from its deflection.
//!
//! One unknown each, with the guess as prior (a scalar Kalman filter). Coulomb: a sliding contact has |Ft| = µ Fn, any
//! other one µ ≥ |Ft| / Fn. A wall in series with the pad: depth − pad(Fn) = Fn / k.

use super::super::picture::Picture;
use crate::Vec2;
use crate::world::{Pad, Rect, World};

/// Standard deviation of a guess, relative to it.
const GUESS: f64 = 0.5;
/// Error of a ratio of forces in one picture.
const RATIO: f64 = 0.05;
/// Error of how deep a finger is in a wall, m.
const DEPTH_M: f64 = 5e-5;
/// Share of a picture that is news: neighbours have the same errors.
const NEWS: f64 = 0.1;
/// Less force says nothing, N.
const PRESSES_N: f64 = 0.2;
/// Slower along the face, nothing slides; faster into it, dampers press as well, m/s.
const SLIDES_M_S: f64 = 5e-3;
const RESTS_M_S: f64 = 3e-3;
/// Largest share of a motion along the face that the pad's shear takes up while the finger slides.
const SHEARS: f64 = 0.2;
/// Newton's steps to a pad's compression.
const STEPS: usize = 6;
/// Time constant with which the model follows, s.
const BLEED_S: f64 = 0.2;
/// Everything stays within these factors of its guess.
const FACTORS: [f64; 2] = [0.1, 5.0];

/// One number that is learnt.
#[derive(Clone, Copy)]
struct Learnt {
    guess: f64,
    value: f64,
    variance: f64,
}

impl Learnt {
    fn of(guess: f64) -> Self {
        Self { guess, value: guess, variance: (GUESS * guess).powi(2) }
    }

    fn update(&mut self, measured: f64, std: f64) {
        let gain = self.variance / (self.variance + std * std / NEWS);
        if gain.is_finite() && measured.is_finite() {
            self.put(self.value + gain * (measured - self.value));
            self.variance *= 1.0 - gain;
        }
    }

    fn put(&mut self, value: f64) {
        let ends = FACTORS.map(|factor| factor * self.guess);
        self.value = value.clamp(ends[0], ends[1]);
    }
}

/// A finger on a face in one picture.
#[derive(Clone, Copy)]
struct Press {
    time_s: f64,
    /// Into the face and along it, N.
    normal_n: f64,
    tangent_n: f64,
    /// The finger's speed into the body and along its face, m/s.
    into_m_s: f64,
    along_m_s: f64,
    /// Distance behind the face, m.
    depth_m: f64,
}

/// Friction of every body, and the give of every wall, m/N.
pub(super) struct Touch {
    pad: Pad,
    half_m: Vec<Vec2>,
    friction: Vec<Learnt>,
    give: Vec<Option<Learnt>>,
    before: [Option<(usize, Press)>; 2],
}

impl Touch {
    pub fn new(world: &World) -> Self {
        let half_m = |block: &crate::world::Block| Vec2::new(0.5 * block.width_m, 0.5 * block.height_m);
        Self {
            pad: world.pad,
            half_m: world.blocks.iter().map(half_m).collect(),
            friction: world.blocks.iter().map(|block| Learnt::of(block.finger_friction)).collect(),
            give: world.blocks.iter().map(|b| b.wall.map(|wall| Learnt::of(1.0 / wall.stiffness_n_m))).collect(),
            before: [None; 2],
        }
    }

    /// Takes a picture of the far world.
    pub fn learn(&mut self, far: &Picture) {
        for finger in 0..2 {
            let now = far.grasp.body.and_then(|body| Some((body, self.press(far, body, finger)?)));
            let before = std::mem::replace(&mut self.before[finger], now);
            if let (Some((body, now)), Some((was, before))) = (now, before)
                && body == was
                && now.time_s > before.time_s
            {
                self.rub(body, &before, &now);
                self.squeeze(body, &now);
            }
        }
    }

    fn press(&self, far: &Picture, body: usize, finger: usize) -> Option<Press> {
        let (state, half_m) = (far.bodies.get(body)?, *self.half_m.get(body)?);
        let axis_x = Vec2::new(state.angle_rad.cos(), state.angle_rad.sin());
        let rect = Rect { center_m: state.center_m, half_m, axis_x };
        let tip = far.input.tip_in_world[finger];
        let local = rect.to_local(tip);
        let face = if local.x.abs() * half_m.y >= local.y.abs() * half_m.x {
            if local.x > 0.0 { 0 } else { 2 }
        } else if local.y > 0.0 {
            1
        } else {
            3
        };
        let (normal, distance_m) = rect.face(face);
        let along = Vec2::new(normal.y, -normal.x);
        let arm_m = tip - state.center_m;
        let surface = state.velocity_m_s + state.rate_rad_s * Vec2::new(-arm_m.y, arm_m.x);
        let slip = far.input.tip_velocity[finger] - surface;
        let force_n = far.tip_force_n[finger];
        let press = Press {
            time_s: far.time_s,
            normal_n: -force_n.dot(&normal),
            tangent_n: force_n.dot(&along),
            into_m_s: -slip.dot(&normal),
            along_m_s: slip.dot(&along),
            depth_m: distance_m - arm_m.dot(&normal),
        };
        (press.normal_n > PRESSES_N).then_some(press)
    }

    fn rub(&mut self, body: usize, before: &Press, now: &Press) {
        let Some(friction) = self.friction.get_mut(body) else { return };
        let ratio = now.tangent_n.abs() / now.normal_n;
        let loads_n_s = (now.tangent_n - before.tangent_n).abs() / (now.time_s - before.time_s);
        let even = before.along_m_s * now.along_m_s > 0.0 && now.along_m_s * now.tangent_n > 0.0;
        let slides = even && before.along_m_s.abs().min(now.along_m_s.abs()) > SLIDES_M_S;
        if slides && loads_n_s < SHEARS * self.pad.shear_stiffness_n_m * now.along_m_s.abs() {
            friction.update(ratio, RATIO * friction.guess);
        } else if ratio > friction.value && now.along_m_s.abs() < SLIDES_M_S {
            friction.put(ratio);
        }
    }

    fn squeeze(&mut self, body: usize, now: &Press) {
        let Some(Some(give)) = self.give.get_mut(body) else { return };
        if now.into_m_s.abs() < RESTS_M_S {
            let wall_m = now.depth_m - compression_m(&self.pad, now.normal_n);
            give.update(wall_m / now.normal_n, DEPTH_M / now.normal_n);
        }
    }

    /// Lets the model's friction and walls follow.
    pub fn bleed(&self, world: &mut World, dt_s: f64) {
        let share = 1.0 - (-dt_s / BLEED_S).exp();
        for ((block, friction), give) in world.blocks.iter_mut().zip(&self.friction).zip(&self.give) {
            block.finger_friction += (friction.value - block.finger_friction) * share;
            if let (Some(wall), Some(give)) = (&mut block.wall, give) {
                let now_m_n = 1.0 / wall.stiffness_n_m;
                wall.stiffness_n_m = 1.0 / (now_m_n + (give.value - now_m_n) * share);
            }
        }
    }
}

/// Compression of a pad under a force, m: Newton's method from the solution of a linear pad.
fn compression_m(pad: &Pad, force_n: f64) -> f64 {
    let cushion = pad.elastic();
    (0..STEPS).fold(force_n / pad.stiffness_n_m, |pressed_m, _| {
        pressed_m - (cushion.force_n(pressed_m) - force_n) / cushion.stiffness_n_m(pressed_m)
    })
}
