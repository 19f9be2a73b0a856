//! A scripted operator that does the tasks like a person: reaches in minimum jerk, pinches with a spare margin, trembles,
//! lets go. It sees the world as a person sees the screen, and drives the fingers through the arm's impedance.

mod acts;
mod builder;
mod captured;
mod direct;
mod eye;
mod movement;
mod noise;
mod patience;
mod plan;
mod route;
mod skill;
#[cfg(test)]
mod tests;

pub use acts::Act;
pub use direct::{Pull, PullSensor, Pulled};
pub use movement::Goal as HandGoal;
pub use route::Route;
pub use skill::{Mistake, Skill};

use super::impedance::HandImpedance;
use super::interface::{Command, Device, DeviceSpec, Sample};
use crate::Vec2;
use crate::world::{State, World};
use eye::Eye;
use movement::Goal;
use noise::{Tremor, Wander};
use patience::Patience;
use plan::Plan;
use rand::SeedableRng;
use rand::rngs::StdRng;

/// Source of a performance.
enum Way {
    /// Made for the objects in the world, and made again after something is lost.
    Planned(Box<Plan>),
    /// Told from outside.
    Told(Route),
}

impl Way {
    fn duration_s(&self) -> f64 {
        match self {
            Self::Planned(plan) => plan.duration_s(),
            Self::Told(route) => route.duration_s(),
        }
    }
}

/// A device that performs a task by itself.
pub struct ScriptedOperator {
    spec: DeviceSpec,
    impedance: HandImpedance,
    way: Way,
    tremor: [Tremor; 2],
    pinch_wander: Wander,
    eye: Option<Eye>,
    /// Present: each movement waits until the one before was seen to end.
    patience: Option<Patience>,
    acts_begin_s: Vec<f64>,
    position: [Vec2; 2],
    velocity: [Vec2; 2],
    now_s: f64,
    /// Time reached in the plan, s: behind the clock by the waiting time.
    plan_s: f64,
}

impl ScriptedOperator {
    /// An operator for the objects of `world` (a crank is turned, blocks are unstacked and restacked), whose hand
    /// starts as in `state`. The same seed makes the same motion to the bit.
    pub fn new(world: &World, state: &State, skill: Skill, seed: u64) -> Self {
        Self::with_mistakes(world, state, skill, &[], seed)
    }

    /// The same, with deliberate mistakes.
    pub fn with_mistakes(world: &World, state: &State, skill: Skill, mistakes: &[Mistake], seed: u64) -> Self {
        let mut rng = StdRng::seed_from_u64(seed);
        // Drawn apart, so that the steady operator's motion does not depend on the draws of the others.
        let habits = [0x0b5e_55ed, 0x51ee_b1e5].map(|salt: u64| StdRng::seed_from_u64(seed ^ salt));
        let start = Goal::from_tips(state.input.tip_in_world);
        let plan = Plan::for_world(world, state, start, skill, mistakes, &mut rng, habits);
        Self::going(Way::Planned(Box::new(plan)), state, skill, &mut rng)
    }

    /// An operator that does a list of acts, one by one; acts that are impossible in the world are left out.
    pub fn doing(world: &World, state: &State, acts: &[Act], skill: Skill, seed: u64) -> Self {
        let mut rng = StdRng::seed_from_u64(seed);
        let habits = [0x0b5e_55ed, 0x51ee_b1e5].map(|salt: u64| StdRng::seed_from_u64(seed ^ salt));
        let start = Goal::from_tips(state.input.tip_in_world);
        let (plan, begin_s) = Plan::of_acts(world, state, start, skill, acts, &mut rng, habits);
        Self { acts_begin_s: begin_s, ..Self::going(Way::Planned(Box::new(plan)), state, skill, &mut rng) }
    }

    /// Start times of the acts, s, as planned at first; empty for an operator without acts.
    pub fn acts_begin_s(&self) -> &[f64] {
        &self.acts_begin_s
    }

    /// An operator that follows a route, whatever stands there.
    pub fn on_route(state: &State, route: Route, skill: Skill, seed: u64) -> Self {
        Self::going(Way::Told(route), state, skill, &mut StdRng::seed_from_u64(seed))
    }

    fn going(way: Way, state: &State, skill: Skill, rng: &mut StdRng) -> Self {
        Self {
            spec: DeviceSpec {
                name: "Scripted operator".to_owned(),
                force_feedback: true,
                max_force_n: 12.0,
                damping_n_s_m: HandImpedance::default().damping_n_s_m,
                coulomb_n: 0.0,
                resolution_m: 0.0,
            },
            impedance: HandImpedance::default(),
            way,
            tremor: [Tremor::new(skill.tremor_m, rng), Tremor::new(skill.tremor_m, rng)],
            pinch_wander: Wander::new(skill.wander, rng),
            eye: skill.reaction_s.map(Eye::new),
            patience: None,
            acts_begin_s: Vec::new(),
            position: state.input.tip_in_world,
            velocity: [Vec2::zeros(); 2],
            now_s: 0.0,
            plan_s: 0.0,
        }
    }

    /// The same operator, who begins a movement when the one before was seen to have ended: move and wait (Ferrell 1965), as people
    /// do over a slow line. Operators that do not look ([`Skill::reaction_s`]) and those on a route go on as they are.
    #[must_use]
    pub fn waiting(mut self) -> Self {
        self.patience = self.eye.as_ref().map(|_| Patience::default());
        self
    }

    /// Length of the whole performance, s, as planned so far: dropping a block makes it longer.
    pub fn duration_s(&self) -> f64 {
        self.way.duration_s()
    }
}

impl Device for ScriptedOperator {
    fn spec(&self) -> &DeviceSpec {
        &self.spec
    }

    fn exchange(&mut self, command: &Command, dt_s: f64) -> Sample {
        self.now_s += dt_s;
        self.plan_s += match (&mut self.patience, &self.way) {
            (Some(patience), Way::Planned(plan)) => patience.allow(plan.ends(self.plan_s, dt_s), dt_s),
            _ => dt_s,
        };
        let (goal, rate) = match &mut self.way {
            Way::Planned(plan) => plan.at(self.plan_s),
            Way::Told(route) => route.at(self.plan_s),
        };
        // Squeezing harder than touching is done by wanting the tips closer: force over the arm's stiffness.
        let squeeze = goal.pinch_n * (1.0 + self.pinch_wander.at(self.now_s)) / self.impedance.stiffness_n_m;
        for (finger, side) in [(0, -1.0), (1, 1.0)] {
            let offset = Vec2::new(side * (0.5 * goal.aperture_m - squeeze), 0.0);
            let tremor = self.tremor[finger].at(self.now_s);
            let wanted = goal.center_m + offset + tremor;
            let wanted_rate = rate.center_m + Vec2::new(side * 0.5 * rate.aperture_m, 0.0);
            let (position, velocity) = (&mut self.position[finger], &mut self.velocity[finger]);
            self.impedance.advance(position, velocity, (wanted, wanted_rate), command.force_n[finger], dt_s);
        }
        Sample { tip_in_world: self.position, tip_velocity: self.velocity, fresh: [true; 2] }
    }

    fn make_safe(&mut self) {}

    fn see(&mut self, world: &World, state: &State) {
        let (Some(eye), Way::Planned(plan)) = (&mut self.eye, &mut self.way) else { return };
        if eye.look(self.now_s, self.plan_s, state)
            && let Some(seen) = eye.noticed(self.now_s)
        {
            plan.notice(&world.blocks, seen, self.plan_s);
            if let Some(patience) = &mut self.patience {
                patience.look(seen);
            }
        }
    }

    fn finished(&self) -> bool {
        let recovering = matches!(&self.way, Way::Planned(plan) if plan.is_recovering());
        self.plan_s > self.way.duration_s() && !recovering
    }
}
