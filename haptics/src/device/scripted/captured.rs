//! Movements of the scripted operator with a needle, a barrel and a switch that reveal their properties.

use super::builder::Builder;
use super::movement::Goal;
use super::skill::Mistake;
use crate::Vec2;
use crate::device::impedance::HandImpedance;
use crate::world::{Membrane, Shape, State, World};

/// Spread of an expert's pinch: a hand that varies more holds more firmly.
const EXPERT_SPREAD: f64 = 0.06;
/// Spare opening around hub, barrel and knob, m on both sides together.
const CLEARANCE_M: f64 = 0.006;
/// A hand comes to a barrel this far above its rim, m.
const RIM_M: f64 = 0.003;

impl Builder<'_> {
    /// Takes the needle out of its place, pierces the sheet twice, some way apart, and leaves the needle in the second hole.
    pub fn pierce_sheet(&mut self, world: &World, state: &State, mistakes: &[Mistake]) {
        let Some(membrane) = &world.membrane else { return };
        let Some((held, [point_below_m, grip])) = self.take_needle(world, state) else { return };
        let needle_m = held.aperture_m;
        let at = |point: Vec2| Goal { center_m: point + point_below_m + grip, ..held };
        let over_m = if mistakes.contains(&Mistake::Overshoot) { 0.006 } else { 0.001 };
        let depth_m = Self::piercing_depth_m(membrane) + over_m;
        for side in [-1.0, 1.0] {
            let place = membrane.center_m + Vec2::new(side * self.between(0.003, 0.006), 0.0);
            let above = place + Vec2::new(0.0, 0.004);
            self.aim(0.9, at(above));
            self.wait(0.4);
            self.reach(2.6, at(place - Vec2::new(0.0, depth_m)));
            self.wait(0.5);
            if side < 0.0 {
                self.reach(1.8, at(above));
                self.wait(0.4);
            }
        }
        self.reach(0.5, Goal { aperture_m: needle_m + CLEARANCE_M, pinch_n: 0.0, ..self.at() });
        self.reach(0.8, Goal { center_m: self.at().center_m + Vec2::new(0.0, 0.012), ..self.at() });
    }

    /// Takes hold of the needle where it stands. The grasp, and the way from the needle's point to its middle and on to the fingers, m.
    pub(super) fn take_needle(&mut self, world: &World, state: &State) -> Option<(Goal, [Vec2; 2])> {
        let index = world.blocks.iter().position(|b| b.shape == Shape::Needle)?;
        let (needle, start) = (&world.blocks[index], state.bodies[index].center_m);
        let point_below_m = Vec2::new(0.0, 0.5 * needle.height_m);
        // Held by its upper third: the lower part goes in.
        let grip = Vec2::new(0.0, needle.height_m / 6.0);
        let open = Goal { center_m: start + grip, aperture_m: needle.width_m + CLEARANCE_M, pinch_n: 0.0 };
        self.aim(0.9, Goal { center_m: open.center_m + Vec2::new(0.0, 0.010), ..open });
        self.reach(0.6, open);
        let pinch_n = self.choose_pinch(1.4 * self.skill().pinch_n, 0.2);
        let held = Goal { aperture_m: needle.width_m, pinch_n, ..open };
        self.reach(0.5, held);
        self.wait(0.5);
        Some((held, [point_below_m, grip]))
    }

    /// Depth of the hand at which the membrane is pierced, m. It is deeper than the needle because the arms yield;
    /// their deflection is released at the puncture.
    pub(super) fn piercing_depth_m(membrane: &Membrane) -> f64 {
        membrane.law.puncture_depth_m() + 0.5 * membrane.law.puncture_n / HandImpedance::default().stiffness_n_m
    }

    /// Weighs the barrel, finds out its constraint, squeezes its wall, and puts it back.
    pub fn examine_barrel(&mut self, world: &World, state: &State, mistakes: &[Mistake]) {
        let Some(index) = world.blocks.iter().position(|b| b.shape == Shape::Barrel) else { return };
        let (barrel, start) = (&world.blocks[index], state.bodies[index].center_m);
        let open = Goal { center_m: start, aperture_m: barrel.width_m + CLEARANCE_M, pinch_n: 0.0 };
        let up = |y: f64, goal: &Goal| Goal { center_m: goal.center_m + Vec2::new(0.0, y), ..*goal };
        // Over its rim, so that opening fingers, as tall as their pads, do not land on it.
        let over_m = (0.5 * (barrel.height_m + world.pad.face_m) + RIM_M).max(0.020);
        self.aim(0.9, up(over_m, &open));
        self.reach(0.7, open);
        // Heavier than it looks: more than twice the least pinch that lifts it, because no pinch is steady; more if it
        // varies.
        let spare = 2.2 + 10.0 * (self.skill().pinch_spread - EXPERT_SPREAD).max(0.0);
        let least_n = 0.5 * barrel.mass_kg * world.gravity_m_s2 / barrel.finger_friction.max(0.05);
        let usual_n = self.choose_pinch((spare * least_n).max(self.skill().pinch_n), 0.1);
        let held = Goal { aperture_m: barrel.width_m, pinch_n: usual_n, ..open };
        self.reach(0.6, held);
        self.wait(0.5);
        let give_m = 0.5 * barrel.mass_kg * world.gravity_m_s2 / HandImpedance::default().stiffness_n_m;
        let lifted = up(0.008 + give_m, &held);
        self.reach(1.0, lifted);
        self.wait(1.5);
        if let Some(cable) = &barrel.cable {
            // Away from where it is tied, until it is taut and a little further.
            let away = (start - cable.anchor_m).x.signum();
            let far = lifted.center_m.y - give_m - cable.anchor_m.y;
            let reach_m = (cable.length_m.powi(2) - far.powi(2)).max(0.0).sqrt();
            // An operator unsure of the hand pulls until the resistance shows.
            let until_m = 0.6 * self.skill().aim_error_m;
            let x = cable.anchor_m.x + away * (reach_m + until_m + self.between(0.0015, 0.0025));
            self.reach(1.8, Goal { center_m: Vec2::new(x, lifted.center_m.y), ..lifted });
            self.wait(0.8);
            self.reach(1.5, lifted);
        }
        let put_down = up(-0.0006, &held);
        self.reach(1.0, put_down);
        self.wait(0.4);
        let hard = if mistakes.contains(&Mistake::Crush) { 3.5 } else { 1.25 };
        self.reach(0.8, Goal { pinch_n: hard * usual_n, ..put_down });
        self.wait(0.8);
        self.reach(0.8, Goal { pinch_n: 0.3 * usual_n, ..put_down });
        self.reach(0.5, Goal { pinch_n: 0.0, aperture_m: open.aperture_m, ..put_down });
        self.reach(0.8, up(over_m, &open));
    }

    /// Pushes the switch over and back, `times` throws in all, with the knob between the open fingers.
    pub fn throw_switch(&mut self, world: &World, state: &State, times: usize) {
        let Some(switch) = &world.switch else { return };
        let ends = [switch.curve.points.first(), switch.curve.points.last()].map(|p| p.map_or(0.0, |p| p.at_m));
        let knob = switch.knob_in_world(state.switch.at_m);
        let opening_m = 2.0 * switch.knob_radius_m + CLEARANCE_M;
        let around = Goal { center_m: knob, aperture_m: opening_m, pinch_n: 0.0 };
        self.aim(0.9, Goal { center_m: knob + Vec2::new(0.0, 0.020), ..around });
        self.reach(0.8, around);
        self.wait(0.4);
        let mut right = state.switch.at_m < 0.5 * (ends[0] + ends[1]);
        for _ in 0..times {
            let end = switch.knob_in_world(ends[usize::from(right)]);
            let push = Vec2::new(if right { 1.0 } else { -1.0 }, 0.0);
            // Until the far stop holds the knob against the finger.
            let pushed = end + push * (0.5 * CLEARANCE_M + self.between(0.001, 0.002));
            self.reach(1.6, Goal { center_m: pushed, ..around });
            self.wait(0.3);
            self.reach(0.5, Goal { center_m: end, ..around });
            right = !right;
        }
        self.reach(0.8, Goal { center_m: self.at().center_m + Vec2::new(0.0, 0.020), ..around });
    }
}
