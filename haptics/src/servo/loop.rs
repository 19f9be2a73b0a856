//! One tick of the servo as a plain function.

use super::safety::{Limits, Safety, SafetyFlags};
use super::timing::Timing;
use crate::Vec2;
use crate::device::{Command, Device};
use crate::world::{Input, State, World, step};

/// What the recorder keeps of every tick.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TickRecord {
    /// Simulated time, s.
    pub time_s: f64,
    /// Where the fingers are.
    pub input: Input,
    /// Force of the tips on the environment, N.
    pub tip_force_n: [Vec2; 2],
    /// Force sent to the device, N on the operator's fingers.
    pub sent_force_n: [Vec2; 2],
    /// What the safety stage did.
    pub flags: SafetyFlags,
    /// The true contact state (generators write it as the label).
    pub label: &'static str,
}

/// The newest state, for pictures and panels.
#[derive(Clone, Debug)]
pub struct Snapshot {
    /// The world's state.
    pub state: State,
    /// Which world it belongs to: counts the swaps.
    pub generation: u64,
    /// The last tick.
    pub tick: TickRecord,
    /// Timing so far (a few times a second).
    pub timing: Timing,
    /// Why the servo stopped, if it did.
    pub fault: Option<&'static str>,
}

/// A world and its state, built elsewhere, ready to be swapped in.
#[derive(Debug)]
pub struct Swap {
    /// The new world.
    pub world: World,
    /// Its state; the fingers are taken over from the running one.
    pub state: State,
}

impl Swap {
    /// A world in its starting state.
    pub fn new(world: World) -> Box<Self> {
        let state = State::resting(&world);
        Box::new(Self { world, state })
    }
}

/// Device, world and safety: everything that a tick touches.
pub struct Loop {
    current: Box<Swap>,
    device: Box<dyn Device>,
    safety: Safety,
    sent_force_n: [Vec2; 2],
    generation: u64,
}

impl Loop {
    /// Ready to tick; the fingers start where the state has them.
    pub fn new(current: Box<Swap>, device: Box<dyn Device>, limits: Limits) -> Self {
        let safety = Safety::new(limits, current.state.input.tip_in_world);
        Self { current, device, safety, sent_force_n: [Vec2::zeros(); 2], generation: 0 }
    }

    /// Device, world, force: one tick of `dt_s`. Allocates, locks, prints and waits for nothing.
    pub fn tick(&mut self, dt_s: f64) -> TickRecord {
        let Swap { world, state } = &mut *self.current;
        let mut flags = SafetyFlags::default();
        self.device.see(world, state);
        let raw = self.device.exchange(&Command { force_n: self.sent_force_n }, dt_s);
        let sample = self.safety.admit(&raw, dt_s, &mut flags);
        let input = Input { tip_in_world: sample.tip_in_world, tip_velocity: sample.tip_velocity };
        step(world, state, &input, dt_s);
        // The operator feels the reaction to what the tips exert.
        self.sent_force_n = self.safety.limit(state.tip_force_n.map(|f| -f), dt_s, &mut flags);
        TickRecord {
            time_s: state.time_s,
            input,
            tip_force_n: state.tip_force_n,
            sent_force_n: self.sent_force_n,
            flags,
            label: crate::world::true_label(world, state),
        }
    }

    /// Puts a new world in; returns the old one, to be dropped on another thread. The fingers stay where they are, and the
    /// safety stage keeps the force from jumping.
    pub fn swap(&mut self, mut next: Box<Swap>) -> Box<Swap> {
        next.state.input = self.current.state.input;
        self.generation += 1;
        std::mem::replace(&mut self.current, next)
    }

    /// Zero force on the device.
    pub fn make_safe(&mut self) {
        self.device.make_safe();
        self.sent_force_n = [Vec2::zeros(); 2];
    }

    /// The world that is running.
    pub fn world(&self) -> &World {
        &self.current.world
    }

    /// Its state.
    pub fn state(&self) -> &State {
        &self.current.state
    }

    /// Number of swaps so far.
    pub fn generation(&self) -> u64 {
        self.generation
    }

    /// True once a performing device is done.
    pub fn finished(&self) -> bool {
        self.device.finished()
    }

    /// Age of the newest good sample, s.
    pub fn sample_age_s(&self) -> f64 {
        self.safety.sample_age_s()
    }
}
