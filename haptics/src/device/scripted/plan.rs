//! Plan of the scripted operator: a list of minimum-jerk movements (Flash & Hogan 1985). It is made ahead, and made
//! again from the position of the hand when the operator sees that a block was lost.

use super::acts::{Act, Places};
use super::builder::Builder;
use super::eye::Frame;
use super::movement::{Goal, Job, Move, Phase};
use super::skill::{Mistake, Skill};
use crate::Vec2;
use crate::world::{Block, Shape, State, World};
use rand::rngs::StdRng;

/// A block that is farther from the fingers than this is not held any more, m.
const LOST_M: f64 = 0.005;
/// A block that stands farther from its place than this is put there again, m.
const MISPLACED_M: f64 = 0.0025;
/// Number of failures with one block after which the operator continues with the next.
const MOST_ATTEMPTS: u8 = 4;
/// Largest number of movements in one carry, with its corrections.
const PER_CARRY: usize = 32;

/// The whole performance.
pub struct Plan {
    phases: Vec<Phase>,
    current: usize,
    jobs: Vec<Job>,
    retry: Option<usize>,
    skill: Skill,
    habits: [StdRng; 2],
}

impl Plan {
    /// Turn the crank if there is one, pierce the membrane, throw the switch, examine the barrel, else unstack and
    /// restack the blocks, else look around. `rng` draws the variations of every operator, `habits` those of some
    /// levels of skill only.
    pub fn for_world(
        world: &World,
        state: &State,
        start: Goal,
        skill: Skill,
        mistakes: &[Mistake],
        rng: &mut StdRng,
        habits: [StdRng; 2],
    ) -> Self {
        let mut plan = Self { phases: Vec::new(), current: 0, jobs: Vec::new(), retry: None, skill, habits };
        let mut builder = Builder::new(&mut plan.phases, 0.0, start, skill, rng, &mut plan.habits[0]);
        builder.growing = true;
        builder.wait(1.0);
        if world.crank.is_some() {
            builder.turn_crank(world, state, mistakes);
        } else if world.membrane.is_some() {
            builder.pierce_sheet(world, state, mistakes);
        } else if world.switch.is_some() {
            builder.throw_switch(world, state, 6);
        } else if world.blocks.iter().any(|b| b.shape == Shape::Barrel) {
            builder.examine_barrel(world, state, mistakes);
        } else if world.blocks.is_empty() {
            builder.look_around(world);
        } else {
            plan.jobs = builder.plan_restack(world, state);
            builder.spoil(&mut plan.jobs, mistakes);
            for (index, job) in plan.jobs.iter().enumerate() {
                builder.carry(index, job, state.bodies[job.block].center_m, job.width_m);
            }
        }
        builder.wait(1.0);
        plan.with_room()
    }

    /// Does a list of acts, one by one; acts that are impossible in the world are left out.
    pub fn of_acts(
        world: &World,
        state: &State,
        start: Goal,
        skill: Skill,
        acts: &[Act],
        rng: &mut StdRng,
        habits: [StdRng; 2],
    ) -> (Self, Vec<f64>) {
        let mut plan = Self { phases: Vec::new(), current: 0, jobs: Vec::new(), retry: None, skill, habits };
        let mut builder = Builder::new(&mut plan.phases, 0.0, start, skill, rng, &mut plan.habits[0]);
        builder.growing = true;
        builder.wait(0.5);
        let mut places = Places::new(world, state);
        let mut begin_s = Vec::with_capacity(acts.len());
        for act in acts {
            begin_s.push(builder.now_s());
            if act.lacks(world).is_none() && act.wrong().is_none() {
                builder.act(act, &mut places, &mut plan.jobs);
            }
        }
        builder.wait(1.0);
        (plan.with_room(), begin_s)
    }

    /// Room for every attempt that may follow: nothing grows in the tick.
    fn with_room(mut self) -> Self {
        self.phases.reserve(self.jobs.len() * usize::from(MOST_ATTEMPTS) * PER_CARRY);
        self
    }

    /// Acts on the sight of the world (that the jobs are about) one reaction time ago: lost blocks are fetched again.
    pub fn notice(&mut self, blocks: &[Block], seen: &Frame, now_s: f64) {
        if let Some(job) = self.retry {
            if now_s >= self.duration_s() {
                self.try_again(job, blocks, seen, now_s);
            }
        } else if let (Some(job), Some(then)) = (self.holding(now_s), self.holding(seen.plan_s))
            && job == then
            && let Some((center_m, _)) = seen.bodies.get(self.jobs[job].block)
            && (center_m - seen.hand_m).norm() > LOST_M
        {
            self.stop_and_open(job, now_s);
        } else if let Some(job) = self.phase_at(seen.time_s).and_then(|phase| phase.placed)
            && self.misses(job, seen)
        {
            self.stop_and_open(job, now_s);
        }
    }

    /// True when a block that was told to go somewhere is seen to stand elsewhere, and has not moved since the last attempt began.
    fn misses(&self, job: usize, seen: &Frame) -> bool {
        let Job { block, to_m, hold_s, attempts, .. } = self.jobs[job];
        let begun_again = self.phases[..=self.current].iter().any(|phase| phase.holds.is_some_and(|held| held > job));
        hold_s.is_some()
            && attempts + 1 < MOST_ATTEMPTS
            && !begun_again
            && seen
                .bodies
                .get(block)
                .is_some_and(|(at, _)| (at.x - to_m.x).abs() > MISPLACED_M || (at.y - to_m.y).abs() > 2.0 * MISPLACED_M)
    }

    /// True while a lost block has not been fetched yet: there is more to come than the list says.
    pub fn is_recovering(&self) -> bool {
        self.retry.is_some()
    }

    fn holding(&self, time_s: f64) -> Option<usize> {
        self.phase_at(time_s)?.holds
    }

    fn phase_at(&self, time_s: f64) -> Option<&Phase> {
        self.phases[..=self.current].iter().rev().find(|phase| phase.start_s <= time_s)
    }

    /// Breaks off, opens the fingers, goes up out of the way and waits for things to come to rest.
    fn stop_and_open(&mut self, job: usize, now_s: f64) {
        let (here, _) = self.at(now_s);
        self.phases.truncate(self.current + 1);
        self.phases[self.current].end_s = now_s;
        self.jobs[job].attempts += 1;
        self.jobs[job].mistake = None;
        let given_up = self.jobs[job].attempts >= MOST_ATTEMPTS;
        self.retry = Some(job + usize::from(given_up));
        let Job { width_m, clear_y_m, .. } = self.jobs[job];
        let [usual, habits] = &mut self.habits;
        let mut builder = Builder::new(&mut self.phases, now_s, here, self.skill, usual, habits);
        builder.back_off(width_m, clear_y_m);
    }

    /// Carries this block and all that follow from where they are seen to lie.
    fn try_again(&mut self, first: usize, blocks: &[Block], seen: &Frame, now_s: f64) {
        let (here, _) = self.at(now_s);
        self.retry = None;
        let [usual, habits] = &mut self.habits;
        let mut builder = Builder::new(&mut self.phases, now_s, here, self.skill, usual, habits);
        for (index, job) in self.jobs.iter().enumerate().skip(first) {
            if let (Some((center_m, angle_rad)), Some(block)) = (seen.bodies.get(job.block), blocks.get(job.block)) {
                let (sin, cos) = angle_rad.sin_cos();
                // A block that lies on its side is taken by its present width.
                let width_m = block.width_m * cos.abs() + block.height_m * sin.abs();
                builder.carry(index, job, *center_m, width_m);
            }
        }
        builder.wait(1.0);
    }

    /// Final goal of the movement that ends within the next `dt_s`, if another one that moves follows it.
    pub fn ends(&self, now_s: f64, dt_s: f64) -> Option<Goal> {
        let (phase, next) = (self.phases.get(self.current)?, self.phases.get(self.current + 1)?);
        (now_s + dt_s >= phase.end_s && next.movement.moves()).then(|| phase.movement.end())
    }

    /// Length, s.
    pub fn duration_s(&self) -> f64 {
        self.phases.last().map_or(0.0, |p| p.end_s)
    }

    /// Goal and its rate (per second; the rate's pinch is unused) at `now_s`, which must not go back.
    pub fn at(&mut self, now_s: f64) -> (Goal, Goal) {
        while self.current + 1 < self.phases.len() && now_s >= self.phases[self.current].end_s {
            self.current += 1;
        }
        let phase = &self.phases[self.current];
        let span_s = (phase.end_s - phase.start_s).max(1e-9);
        let u = ((now_s - phase.start_s) / span_s).clamp(0.0, 1.0);
        let share = u * u * u * (10.0 - 15.0 * u + 6.0 * u * u);
        let rate = 30.0 * u * u * (1.0 - u) * (1.0 - u) / span_s;
        match phase.movement {
            Move::Reach { from, to } => {
                let rates = Goal {
                    center_m: (to.center_m - from.center_m) * rate,
                    aperture_m: (to.aperture_m - from.aperture_m) * rate,
                    pinch_n: 0.0,
                };
                (from.lerp(&to, share), rates)
            }
            Move::Turn { center_m, radius_m, from_rad, to_rad, pull_m, grasp } => {
                // A turn is steadier than a reach: blend minimum jerk with constant speed in the middle.
                let angle = from_rad + (to_rad - from_rad) * share;
                let (sin, cos) = angle.sin_cos();
                // The pull comes and goes over the turn: pushed as well as pulled, as exploration asks.
                let pull = pull_m * (0.35 + (std::f64::consts::PI * 3.0 * u).sin());
                let center = center_m + Vec2::new(cos, sin) * (radius_m + pull * (1.0 - (2.0 * u - 1.0).powi(8)));
                let speed = radius_m * (to_rad - from_rad) * rate;
                let rates = Goal { center_m: Vec2::new(-sin, cos) * speed, aperture_m: 0.0, pinch_n: 0.0 };
                (Goal { center_m: center, ..grasp }, rates)
            }
            Move::Spin(spin) => spin.goal(now_s - phase.start_s, span_s),
        }
    }
}
