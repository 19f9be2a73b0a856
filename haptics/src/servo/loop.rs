//! One tick of the servo as a plain function.

use super::passivity::{Observer, control};
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
    /// Energy that the virtual environment has taken from the hand since the start, J; below zero it has given some out.
    pub energy_j: f64,
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
    observer: Observer,
    passivity_control_n_s_m: Option<f64>,
    generation: u64,
}

impl Loop {
    /// Ready to tick; the fingers start where the state has them.
    pub fn new(current: Box<Swap>, device: Box<dyn Device>, limits: Limits) -> Self {
        let safety = Safety::new(limits, current.state.input.tip_in_world);
        Self {
            current,
            device,
            safety,
            sent_force_n: [Vec2::zeros(); 2],
            observer: Observer::default(),
            passivity_control_n_s_m: None,
            generation: 0,
        }
    }

    /// Lets the passivity controller add up to so much damping (N s/m) while energy has been given out; off by default.
    #[must_use]
    pub fn with_passivity_control(mut self, most_n_s_m: Option<f64>) -> Self {
        self.passivity_control_n_s_m = most_n_s_m;
        self
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
        let mut wanted = state.tip_force_n.map(|f| -f);
        if let Some(most) = self.passivity_control_n_s_m {
            let extra = control(&self.observer, input.tip_velocity, dt_s, most);
            for (force, extra) in wanted.iter_mut().zip(extra) {
                *force += extra;
            }
        }
        self.sent_force_n = self.safety.limit(wanted, dt_s, &mut flags);
        self.observer.add(input.tip_in_world, self.sent_force_n.map(|f| -f));
        TickRecord {
            time_s: state.time_s,
            input,
            tip_force_n: state.tip_force_n,
            sent_force_n: self.sent_force_n,
            flags,
            energy_j: self.observer.energy_j(),
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::device::{DeviceSpec, ReplayDevice, Sample};
    use crate::world::presets;

    /// Fingers that press against the table along a sine, faster than a stiff pad sampled at 1 kHz can follow passively.
    struct Prodding(DeviceSpec, f64);

    impl Device for Prodding {
        fn spec(&self) -> &DeviceSpec {
            &self.0
        }

        fn exchange(&mut self, _: &Command, dt_s: f64) -> Sample {
            self.1 += dt_s;
            let omega = std::f64::consts::TAU * 25.0;
            let (sin, cos) = (omega * self.1).sin_cos();
            let tip = |x: f64| Vec2::new(x, -0.1262 + 0.001 * sin);
            let velocity = Vec2::new(0.0, 0.001 * omega * cos);
            Sample { tip_in_world: [tip(-0.03), tip(0.03)], tip_velocity: [velocity; 2], fresh: true }
        }

        fn make_safe(&mut self) {}
    }

    fn prodding(control: Option<f64>) -> TickRecord {
        let mut world = presets::table();
        // No damping at all: a sampled spring gives out K/2 Σ Δx².
        world.pad.damping_n_s_m = 0.0;
        let still = || vec![Vec2::zeros(); 2];
        let spec = ReplayDevice::new("spec", vec![0.0, 1.0], [still(), still()], [still(), still()])
            .expect("two samples")
            .spec()
            .clone();
        let limits = Limits { max_force_n: 50.0, max_slew_n_s: 1e6, ramp_s: 1e-3, ..Limits::default() };
        let mut servo =
            Loop::new(Swap::new(world), Box::new(Prodding(spec, 0.0)), limits).with_passivity_control(control);
        let mut last = TickRecord::default();
        for _ in 0..2_000 {
            last = servo.tick(1e-3);
        }
        last
    }

    #[test]
    fn the_observer_sees_a_sampled_spring_give_out_energy_and_the_controller_takes_it_back() {
        let watched = prodding(None).energy_j;
        assert!(watched < -1e-3, "a sampled spring is active: {watched}");
        let controlled = prodding(Some(50.0)).energy_j;
        assert!(controlled > 0.02 * watched, "{controlled} against {watched}");
    }
}
