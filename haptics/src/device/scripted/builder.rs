//! Makes the movements of a performance: reaches with their misses and corrections, carries, turns.

use super::movement::{Goal, Job, Move, Phase, Spin};
use super::skill::{Mistake, Skill};
use crate::Vec2;
use crate::world::{State, World};
use rand::RngExt;
use rand::rngs::StdRng;
use rand_distr::{Distribution, StandardNormal};

/// Spare opening of the fingers around an object, m on both sides together.
const CLEARANCE_M: f64 = 0.006;
/// Height that objects are carried above any obstacle, m.
const CARRY_HEIGHT_M: f64 = 0.012;
/// Share of the reaction time that passes between a miss and its correction: the eye leads the hand.
const CORRECTION_LAG: f64 = 0.6;
/// Pinch on something heavy, relative to the least that holds it: no pinch is steady.
pub(super) const SPARE_PINCH: f64 = 2.2;
/// A crushing pinch, relative to the usual one.
const CRUSH: f64 = 3.5;
/// A pinch that loosens: relative to the least that holds, at the beginning and at the end of the lift.
const LOOSENING: [f64; 2] = [1.9, 0.35];

pub(super) struct Builder<'a> {
    phases: &'a mut Vec<Phase>,
    now_s: f64,
    at: Goal,
    skill: Skill,
    rng: &'a mut StdRng,
    habits: &'a mut StdRng,
    holds: Option<usize>,
    placed: Option<usize>,
    /// True while the list may grow: only before the servo runs.
    pub growing: bool,
}

impl<'a> Builder<'a> {
    /// Continues from `at` at `now_s`.
    pub fn new(
        phases: &'a mut Vec<Phase>,
        now_s: f64,
        at: Goal,
        skill: Skill,
        rng: &'a mut StdRng,
        habits: &'a mut StdRng,
    ) -> Self {
        Self { phases, now_s, at, skill, rng, habits, holds: None, placed: None, growing: false }
    }

    /// Goal of the hand at the end of the movements so far.
    pub(super) fn at(&self) -> Goal {
        self.at
    }

    /// Skill of the operator.
    pub(super) fn skill(&self) -> Skill {
        self.skill
    }

    /// Random number, different for every operator.
    pub(super) fn between(&mut self, least: f64, most: f64) -> f64 {
        self.rng.random_range(least..most)
    }

    fn vary(&mut self, usual: f64, share: f64) -> f64 {
        usual * self.rng.random_range(1.0 - share..1.0 + share)
    }

    fn push(&mut self, usual_s: f64, movement: Move) {
        let span_s = self.vary(usual_s * self.skill.pace, 0.2);
        self.push_for(span_s, movement);
    }

    fn push_for(&mut self, span_s: f64, movement: Move) {
        // In the servo the list has the room it was made with; beyond it the performance ends early.
        if self.growing || self.phases.len() < self.phases.capacity() {
            let end_s = self.now_s + span_s;
            self.phases.push(Phase { start_s: self.now_s, end_s, movement, holds: self.holds, placed: self.placed });
            self.now_s = end_s;
        }
    }

    pub(super) fn reach(&mut self, usual_s: f64, to: Goal) {
        self.push(usual_s, Move::Reach { from: self.at, to });
        self.at = to;
    }

    pub fn wait(&mut self, usual_s: f64) {
        self.reach(usual_s, self.at);
    }

    /// End time of the movements so far, s.
    pub(super) fn now_s(&self) -> f64 {
        self.now_s
    }

    /// Stays as it is for a time that everybody keeps to, because it was asked for, and a little longer.
    pub(super) fn hold(&mut self, seconds: f64) {
        let extra_s = self.vary(0.3 * self.skill.pace, 0.2);
        self.push_for(seconds + extra_s, Move::Reach { from: self.at, to: self.at });
    }

    /// Random miss of this operator beside its goal, m, as its skill has it; zero for a steady hand.
    pub(super) fn scatter_m(&mut self) -> f64 {
        if self.skill.aim_error_m == 0.0 {
            return 0.0;
        }
        let normal: f64 = StandardNormal.sample(self.habits);
        0.4 * self.skill.aim_error_m * normal
    }

    /// Turns at an even speed; the hand ends at `end`.
    pub(super) fn turn_evenly(&mut self, spin: Spin, span_s: f64, end: Vec2) {
        self.push_for(span_s, Move::Spin(spin));
        self.at = Goal { center_m: end, ..spin.grasp };
    }

    /// A reach through the air: it ends beside its goal, mostly beyond it, and is corrected once that has been seen.
    pub(super) fn aim(&mut self, usual_s: f64, to: Goal) {
        if self.skill.aim_error_m == 0.0 && self.skill.overshoot == 0.0 {
            return self.reach(usual_s, to);
        }
        let mut normal = || -> f64 { StandardNormal.sample(self.habits) };
        let scatter = Vec2::new(normal(), normal()) * self.skill.aim_error_m;
        let beyond = (to.center_m - self.at.center_m) * (self.skill.overshoot * (1.0 + 0.3 * normal()).max(0.0));
        // Things to run into are below: the miss is to the sides and upwards.
        let miss = scatter + beyond;
        let missed = Goal { center_m: to.center_m + Vec2::new(miss.x, miss.y.abs()), ..to };
        self.reach(usual_s, missed);
        self.wait(self.skill.reaction_s.unwrap_or(0.0) * CORRECTION_LAG);
        self.reach(0.35, to);
    }

    /// A pinch as this operator chooses it, N per finger.
    pub(super) fn choose_pinch(&mut self, usual_n: f64, share: f64) -> f64 {
        let pinch_n = self.vary(usual_n, share);
        if self.skill.pinch_spread == 0.0 {
            return pinch_n;
        }
        let normal: f64 = StandardNormal.sample(self.habits);
        pinch_n * (1.0 + self.skill.pinch_spread * normal).max(0.5)
    }

    pub fn look_around(&mut self, world: &World) {
        let workspace = world.hand.workspace;
        for corner in [(-0.5, 0.4), (0.5, 0.4), (0.5, -0.2), (-0.5, -0.2), (0.0, 0.0)] {
            let center_m = workspace.center_m + Vec2::new(corner.0, corner.1) * workspace.radius_m;
            self.aim(0.8, Goal { center_m, ..self.at });
        }
    }

    /// A tower goes block by block to the other side of the middle, top first, so that it ends upside down.
    pub fn plan_restack(&mut self, world: &World, state: &State) -> Vec<Job> {
        let floor_m = world.floor.as_ref().map_or(state.bodies[0].center_m.y, |f| f.height_m);
        let mut order: Vec<usize> = (0..world.blocks.len()).collect();
        order.sort_by(|a, b| state.bodies[*b].center_m.y.total_cmp(&state.bodies[*a].center_m.y));
        let middle = world.hand.workspace.center_m.x;
        let from_x = state.bodies[order[0]].center_m.x;
        let to_x = middle + (middle - from_x) + self.rng.random_range(-0.001..0.001);
        let tower: f64 = world.blocks.iter().map(|b| b.height_m).sum();
        let clear_y = floor_m + tower + CARRY_HEIGHT_M;
        let mut base_y = floor_m;
        order
            .into_iter()
            .map(|index| {
                let height_m = world.blocks[index].height_m;
                let to = Vec2::new(to_x, base_y + 0.5 * height_m);
                base_y += height_m;
                Job::new(world, index, to, clear_y)
            })
            .collect()
    }

    /// Deals the mistakes out, one a carry. A misaligned stack needs a block below, so it goes to the last one.
    pub fn spoil(&mut self, jobs: &mut [Job], mistakes: &[Mistake]) {
        let count = jobs.len();
        for mistake in mistakes.iter().filter(|m| m.is_of_blocks()) {
            let first = match mistake {
                Mistake::MisalignedStack => count - 1,
                _ => self.habits.random_range(0..count),
            };
            if let Some(free) = (0..count).map(|i| (first + i) % count).find(|i| jobs[*i].mistake.is_none()) {
                jobs[free].mistake = Some(*mistake);
            }
        }
    }

    /// Opens the fingers where they are, goes up and waits until a fallen object has come to rest.
    pub fn back_off(&mut self, width_m: f64, clear_y_m: f64) {
        self.reach(0.3, Goal { aperture_m: width_m + 2.0 * CLEARANCE_M, pinch_n: 0.0, ..self.at });
        let above = Vec2::new(self.at.center_m.x, self.at.center_m.y.max(clear_y_m));
        self.reach(0.4, Goal { center_m: above, ..self.at });
        self.wait(0.8);
    }

    /// Takes a block that stands at `from` and is `width_m` wide, and puts it where the job says.
    pub fn carry(&mut self, index: usize, job: &Job, from: Vec2, width_m: f64) {
        let clear_y = job.clear_y_m;
        let open = Goal { center_m: from, aperture_m: width_m + CLEARANCE_M, pinch_n: 0.0 };
        let grasp_dy = self.rng.random_range(-0.001..0.001);
        let up = |y: f64, goal: &Goal| Goal { center_m: Vec2::new(goal.center_m.x, y), ..*goal };
        self.aim(0.9, up(job.above_y_m, &open));
        let around = Goal { center_m: from + Vec2::new(0.0, grasp_dy), ..open };
        self.reach(0.7, around);
        self.wait(0.2);
        let least_n = if job.hold_s.is_some() { SPARE_PINCH * job.least_pinch_n } else { 0.0 };
        let usual_n = self.choose_pinch(self.skill.pinch_n.max(least_n), 0.25);
        let (pinch_n, lifted_n) = match job.mistake {
            Some(Mistake::Crush) => (CRUSH * usual_n, CRUSH * usual_n),
            Some(Mistake::WeakPinch) => (LOOSENING[0] * job.least_pinch_n, LOOSENING[1] * job.least_pinch_n),
            _ => (usual_n, usual_n),
        };
        let held = Goal { aperture_m: width_m, pinch_n, ..around };
        self.reach(0.5, held);
        // People lean on it a little before lifting; it also separates holding from lifting.
        let lean_m = self.rng.random_range(0.0002..0.0006);
        let leaning = Goal { center_m: held.center_m - Vec2::new(0.0, lean_m), ..held };
        self.reach(0.25, leaning);
        self.wait(0.5);
        self.holds = Some(index);
        let carried = Goal { pinch_n: lifted_n, ..up(clear_y, &held) };
        self.reach(0.8, carried);
        self.wait(0.3);
        if let Some(hold_s) = job.hold_s.filter(|hold_s| *hold_s > 0.0) {
            self.hold(hold_s);
        }
        let above = Goal { center_m: Vec2::new(job.to_m.x, clear_y), ..carried };
        if job.mistake == Some(Mistake::EarlyRelease) {
            self.let_go_on_the_way(above, width_m);
        } else {
            self.aim(1.0, above);
        }
        self.wait(0.3);
        let press_m = self.rng.random_range(0.0006..0.0012);
        let beside_m = self.beside_m(job);
        let placed = Goal { center_m: job.to_m + Vec2::new(beside_m, grasp_dy - press_m), ..self.at };
        self.reach(0.9, placed);
        self.holds = None;
        self.wait(0.6);
        let released = Goal { aperture_m: width_m + CLEARANCE_M, pinch_n: 0.0, ..placed };
        self.reach(0.5, released);
        self.wait(0.2);
        self.placed = Some(index);
        self.reach(0.7, up(job.above_y_m, &released));
        self.placed = None;
    }

    /// Distance of a block beside its place, m: enough to be seen, not enough to fall.
    fn beside_m(&mut self, job: &Job) -> f64 {
        if job.mistake != Some(Mistake::MisalignedStack) {
            return 0.0;
        }
        let side = if self.habits.random_bool(0.5) { 1.0 } else { -1.0 };
        side * self.habits.random_range(0.16..0.24) * job.width_m
    }

    fn let_go_on_the_way(&mut self, above: Goal, width_m: f64) {
        let start = self.at;
        let part = self.habits.random_range(0.4..0.7);
        let middle = Goal { center_m: start.center_m + (above.center_m - start.center_m) * part, ..start };
        self.reach(0.6, middle);
        let open = |goal: Goal| Goal { aperture_m: width_m + CLEARANCE_M, pinch_n: 0.0, ..goal };
        self.reach(0.3, open(middle));
        self.reach(0.6, open(above));
    }

    pub fn turn_crank(&mut self, world: &World, state: &State, mistakes: &[Mistake]) {
        let (Some(crank), Some(handle)) = (&world.crank, state.handle_in_world(world)) else { return };
        let open = Goal { center_m: handle, aperture_m: crank.handle_width_m + CLEARANCE_M, pinch_n: 0.0 };
        self.aim(1.0, open);
        self.wait(0.3);
        let mut pinch_n = self.choose_pinch(2.0 * self.skill.pinch_n, 0.2);
        if mistakes.contains(&Mistake::Crush) {
            pinch_n *= CRUSH;
        }
        let held = Goal { aperture_m: crank.handle_width_m, pinch_n, ..open };
        self.reach(0.5, held);
        self.wait(0.4);
        let mut angle = state.crank.angle_rad;
        if mistakes.contains(&Mistake::WrongDirection) {
            // Noticed after a part of a turn; the right turn then starts from there.
            let turns = -self.habits.random_range(0.2..0.4);
            angle = self.turn(world, angle, turns, held);
            self.wait(self.skill.reaction_s.unwrap_or(0.3));
        }
        for turns in [2.0, 1.25, -1.5, 0.25] {
            angle = self.turn(world, angle, turns, held);
            self.wait(0.3);
        }
        self.reach(0.5, Goal { aperture_m: crank.handle_width_m + 2.0 * CLEARANCE_M, pinch_n: 0.0, ..self.at });
    }

    /// Turns the crank from `from_rad` by some turns; returns the new angle, rad.
    fn turn(&mut self, world: &World, from_rad: f64, turns: f64, grasp: Goal) -> f64 {
        let Some(crank) = &world.crank else { return from_rad };
        let to_rad = from_rad + turns * std::f64::consts::TAU;
        // A badly aimed hand also pulls off the circle.
        let pull_m = self.rng.random_range(0.0008..0.0016) + 0.3 * self.skill.aim_error_m;
        let (center_m, radius_m) = (crank.center_m, crank.radius_m);
        self.push(1.1 + 1.6 * turns.abs(), Move::Turn { center_m, radius_m, from_rad, to_rad, pull_m, grasp });
        let (sin, cos) = to_rad.sin_cos();
        self.at = Goal { center_m: center_m + Vec2::new(cos, sin) * radius_m, ..grasp };
        to_rad
    }
}
