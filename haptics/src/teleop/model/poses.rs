//! Correction of poses: the difference between a late picture and the model of its time, less the correction since, is
//! bled into the model at a bounded rate.
//!
//! A correction moves a thing without a velocity, so that a contact feels it only through its depth. A held thing that
//! is moved by [`TOUCHED_M_S`] changes a pad's force by some tens of N/s, far below the safety stage's slew limit.
//! Untouched things may move faster.

use super::super::picture::{Grasp, Picture};
use crate::Vec2;
use crate::world::{BodyState, State, Surface};

/// Time constant of a correction, s.
const BLEED_S: f64 = 0.15;
/// Fastest correction of a touched thing, m/s.
const TOUCHED_M_S: f64 = 0.02;
/// Fastest correction of an untouched thing, m/s: a finger may come to touch it.
const FREE_M_S: f64 = 0.1;
/// Metres that a radian counts as: half of a usual block's size.
const RADIAN_M: f64 = 0.01;
/// Differences below this are not corrected, m: pads and springs give as much.
const ENOUGH_M: f64 = 4e-4;

/// Correction of one thing: place, m, and angle, rad.
type Shift = (Vec2, f64);

/// Correction of everything since the start.
#[derive(Clone)]
pub(super) struct Corrected {
    bodies: Vec<Shift>,
    crank_rad: f64,
    switch_m: f64,
}

impl Corrected {
    pub fn none(bodies: usize) -> Self {
        Self { bodies: vec![(Vec2::zeros(), 0.0); bodies], crank_rad: 0.0, switch_m: 0.0 }
    }

    /// Overwrites; allocates nothing.
    pub fn copy_from(&mut self, other: &Self) {
        for (kept, shift) in self.bodies.iter_mut().zip(&other.bodies) {
            *kept = *shift;
        }
        (self.crank_rad, self.switch_m) = (other.crank_rad, other.switch_m);
    }
}

/// Corrections under way.
pub(super) struct Poses {
    corrected: Corrected,
    /// Final correction of everything.
    wanted: Corrected,
    /// True for each body that a finger touches.
    touched: Vec<bool>,
    /// Objects in the model's hand.
    now: Grasp,
    /// State that is taken over as a whole at the next tick.
    discrete: Option<Discrete>,
    /// With it: for each body, its wall broken, and the mass that ran out, kg.
    spilled: Vec<(bool, f64)>,
}

/// State without values in between.
struct Discrete {
    membrane: crate::world::MembraneState,
    branch: f64,
}

impl Poses {
    pub fn new(state: &State) -> Self {
        let none = Corrected::none(state.bodies.len());
        Self {
            corrected: none.clone(),
            wanted: none,
            touched: vec![false; state.bodies.len()],
            now: Grasp::default(),
            discrete: None,
            spilled: vec![(false, 0.0); state.bodies.len()],
        }
    }

    /// Correction of everything since the start.
    pub fn corrected(&self) -> &Corrected {
        &self.corrected
    }

    /// Compares a picture of the far world with the model `then`, corrected as it was then. `now`: present grasp of the
    /// model's hand.
    pub fn compare(&mut self, then: &Picture, corrected_then: &Corrected, far: &Picture, now: Grasp) {
        self.now = now;
        // Both hold it: only its pose in the hand counts. The far hand is on springs, and a moment behind.
        let in_hand = then.grasp.body.filter(|body| far.grasp.body == Some(*body));
        let off_m = middle(far) - middle(then);
        for (index, (wanted, before)) in self.wanted.bodies.iter_mut().zip(&corrected_then.bodies).enumerate() {
            let (Some(near), Some(far)) = (then.bodies.get(index), far.bodies.get(index)) else { continue };
            let carried_m = if in_hand == Some(index) { off_m } else { Vec2::zeros() };
            let shift_m = beyond(far.center_m - near.center_m - carried_m, ENOUGH_M);
            let turn_rad = beyond(Vec2::new(far.angle_rad - near.angle_rad, 0.0), ENOUGH_M / RADIAN_M).x;
            *wanted = (before.0 + shift_m, before.1 + turn_rad);
        }
        // A handle that both hands hold is where the fingers are; the same with a knob that is pushed.
        if then.grasp.handle && far.grasp.handle {
            self.wanted.crank_rad = self.corrected.crank_rad;
        } else {
            self.wanted.crank_rad = corrected_then.crank_rad + far.crank.angle_rad - then.crank.angle_rad;
        }
        if then.grasp.knob || far.grasp.knob || now.knob {
            self.wanted.switch_m = self.corrected.switch_m;
        } else {
            self.wanted.switch_m = corrected_then.switch_m + far.switch.at_m - then.switch.at_m;
            self.discrete = Some(Discrete { membrane: far.membrane, branch: far.switch.branch });
            for (spilled, body) in self.spilled.iter_mut().zip(&far.bodies) {
                *spilled = (body.broken, body.leaked_kg);
            }
        }
        if then.grasp.body.is_some() || far.grasp.body.is_some() || now.body.is_some() {
            self.discrete = None;
        }
    }

    /// Corrects the model's state by the allowance of one tick.
    pub fn bleed(&mut self, state: &mut State, dt_s: f64) {
        let share = 1.0 - (-dt_s / BLEED_S).exp();
        self.touched.fill(false);
        for contact in state.contacts.iter().filter(|c| matches!(c.on, Surface::Finger(_))) {
            if let Surface::Block(index) = contact.by
                && let Some(touched) = self.touched.get_mut(usize::from(index))
            {
                *touched = true;
            }
        }
        let all = self.corrected.bodies.iter_mut().zip(&self.wanted.bodies);
        for (((done, wanted), body), touched) in all.zip(&mut state.bodies).zip(&self.touched) {
            let most_m = if *touched { TOUCHED_M_S } else { FREE_M_S } * dt_s;
            shift(body, done, wanted, share, most_m);
        }
        let most_m = if self.now.handle { TOUCHED_M_S } else { FREE_M_S } * dt_s;
        let turn_rad = limited((self.wanted.crank_rad - self.corrected.crank_rad) * share, most_m / RADIAN_M);
        state.crank.angle_rad += turn_rad;
        self.corrected.crank_rad += turn_rad;
        let slide_m = limited((self.wanted.switch_m - self.corrected.switch_m) * share, FREE_M_S * dt_s);
        state.switch.at_m += slide_m;
        self.corrected.switch_m += slide_m;
        if let Some(Discrete { membrane, branch }) = self.discrete.take() {
            state.membrane = membrane;
            state.switch.branch = branch;
            for (body, spilled) in state.bodies.iter_mut().zip(&self.spilled) {
                (body.broken, body.leaked_kg) = *spilled;
            }
        }
    }
}

fn shift(body: &mut BodyState, done: &mut Shift, wanted: &Shift, share: f64, most_m: f64) {
    let way_m = (wanted.0 - done.0) * share;
    let size_m = way_m.norm();
    let way_m = if size_m > most_m { way_m * (most_m / size_m) } else { way_m };
    let turn_rad = limited((wanted.1 - done.1) * share, most_m / RADIAN_M);
    body.center_m += way_m;
    body.angle_rad += turn_rad;
    done.0 += way_m;
    done.1 += turn_rad;
}

fn limited(value: f64, most: f64) -> f64 {
    value.clamp(-most, most)
}

/// Part of a difference beyond a tolerance.
fn beyond(difference: Vec2, enough: f64) -> Vec2 {
    let size = difference.norm();
    if size > enough { difference * (1.0 - enough / size) } else { Vec2::zeros() }
}

fn middle(picture: &Picture) -> Vec2 {
    0.5 * (picture.input.tip_in_world[0] + picture.input.tip_in_world[1])
}
