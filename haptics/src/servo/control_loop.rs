//! One tick of the servo as a plain function.

use super::coupling::{Coupling, Proxy};
use super::force_test::{Change, ForceTest};
use super::passivity::{Observer, control};
use super::rate::RateReport;
use super::safety::{Limits, Safety, SafetyFlags};
use super::swap::Swap;
use super::timing::Timing;
use crate::Vec2;
use crate::device::{Command, Device, Sample};
use crate::world::{Input, State, Stored, World, step};

/// Record of one tick for the recorder.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TickRecord {
    /// Simulated time, s.
    pub time_s: f64,
    /// Positions of the fingertips in the world. On a virtual coupling they are the proxies.
    pub input: Input,
    /// Positions of the fingers at the device, m in the world; the same as the tips without a virtual coupling.
    pub device_in_world: [Vec2; 2],
    /// Force of the tips on the environment, N.
    pub tip_force_n: [Vec2; 2],
    /// Force sent to the device, N on the operator's fingers.
    pub sent_force_n: [Vec2; 2],
    /// Actions of the safety stage.
    pub flags: SafetyFlags,
    /// Energy that the virtual environment has taken from the hand since the start, J; below zero it has given some out.
    pub energy_j: f64,
    /// Largest speed at which something struck something during this tick, m/s; zero without an impact.
    pub impact_m_s: f64,
    /// Position of that impact, m in the world.
    pub impact_in_world: Vec2,
    /// The true contact state (generators write it as the label).
    pub label: &'static str,
}

/// The newest state, for pictures and panels.
#[derive(Clone, Debug)]
pub struct Snapshot {
    /// The world's state.
    pub state: State,
    /// Generation of the world it belongs to: counts the swaps.
    pub generation: u64,
    /// The last tick.
    pub tick: TickRecord,
    /// Timing so far (a few times a second).
    pub timing: Timing,
    /// The virtual coupling that the device needs in this world at this rate; `None`: it renders the world directly.
    pub coupling: Option<Coupling>,
    /// Delay that the device states of itself, s ([`Device::delay_s`]): the passive rendering limits count with it.
    pub delay_s: f64,
    /// Stiffness of a line with waves between device and world, N/m ([`Device::line_stiffness_n_m`]); `None` without one.
    pub line_n_m: Option<f64>,
    /// True once a performing device (a script, a replay) is done.
    pub finished: bool,
    /// Why the servo stopped, if it did.
    pub fault: Option<&'static str>,
}

impl Snapshot {
    /// Before the first tick.
    pub fn starting(swap: &Swap, rate: RateReport) -> Self {
        let input = swap.state.input;
        let tick =
            TickRecord { input, device_in_world: input.tip_in_world, label: "free-motion", ..TickRecord::default() };
        Self {
            state: swap.state.clone(),
            generation: 0,
            tick,
            timing: Timing::starting(rate),
            coupling: None,
            delay_s: 0.0,
            line_n_m: None,
            finished: false,
            fault: None,
        }
    }
}

/// Device, world and safety: everything that a tick touches.
pub struct Loop {
    current: Box<Swap>,
    device: Box<dyn Device>,
    safety: Safety,
    proxy: Option<Proxy>,
    /// The period that the coupling was computed for, s.
    coupled_for_s: f64,
    last: TickRecord,
    sent_force_n: [Vec2; 2],
    observer: Observer,
    stored: Stored,
    passivity_control_n_s_m: Option<f64>,
    test: ForceTest,
    held: bool,
    generation: u64,
}

impl Loop {
    /// Ready to tick; the fingers start where the state has them.
    pub fn new(current: Box<Swap>, device: Box<dyn Device>, limits: Limits) -> Self {
        let tips = current.state.input;
        let safety = Safety::new(limits, tips.tip_in_world);
        let last = TickRecord {
            input: tips,
            device_in_world: tips.tip_in_world,
            label: "free-motion",
            ..TickRecord::default()
        };
        Self {
            current,
            device,
            safety,
            proxy: None,
            coupled_for_s: 0.0,
            last,
            sent_force_n: [Vec2::zeros(); 2],
            observer: Observer::default(),
            stored: Stored::default(),
            passivity_control_n_s_m: None,
            test: ForceTest::default(),
            held: false,
            generation: 0,
        }
    }

    /// Lets the passivity controller add up to this damping (N s/m) while energy has been generated; off by default.
    #[must_use]
    pub fn with_passivity_control(mut self, most_n_s_m: Option<f64>) -> Self {
        self.passivity_control_n_s_m = most_n_s_m;
        self
    }

    /// Device, world, force: one tick of `dt_s`. Allocates, locks, prints and waits for nothing.
    ///
    /// A clock that stands still, runs backwards or is not a number moves nothing and ends in zero force.
    pub fn tick(&mut self, dt_s: f64) -> TickRecord {
        if !(dt_s > 0.0 && dt_s.is_finite()) {
            return self.tick_without_time();
        }
        if self.held {
            return self.tick_held(dt_s);
        }
        if dt_s != self.coupled_for_s {
            self.couple(dt_s);
        }
        let Swap { world, state, .. } = &mut *self.current;
        let mut flags = SafetyFlags::default();
        self.device.see(world, state);
        let raw = self.device.exchange(&Command { force_n: self.sent_force_n }, dt_s);
        let sample = self.safety.admit(&raw, dt_s, &mut flags);
        let input = match &mut self.proxy {
            Some(proxy) => proxy.follow(&sample, world, state, dt_s),
            None => Input { tip_in_world: sample.tip_in_world, tip_velocity: sample.tip_velocity },
        };
        step(world, state, &input, dt_s);
        let wanted = self.wanted_force_n(&sample, dt_s);
        self.sent_force_n = self.safety.limit(wanted, dt_s, &mut flags);
        let Swap { world, state, .. } = &mut *self.current;
        // Cleared with every tick: each impact is told once.
        let impact_m_s = std::mem::take(&mut state.impact_m_s);
        if impact_m_s > 0.0 {
            self.device.strike(impact_m_s);
        }
        let stored_j = self.stored.update(world, state);
        self.observer.add(sample.tip_in_world, self.sent_force_n.map(|f| -f), stored_j);
        self.last = TickRecord {
            time_s: state.time_s,
            input,
            device_in_world: sample.tip_in_world,
            tip_force_n: state.tip_force_n,
            sent_force_n: self.sent_force_n,
            flags,
            energy_j: self.observer.energy_j(),
            impact_m_s,
            impact_in_world: state.impact_in_world,
            label: crate::world::true_label(world, state),
        };
        self.last
    }

    /// Force on the operator's fingers before the safety stage, N: of the world or of a test, and of the passivity controller.
    fn wanted_force_n(&mut self, sample: &Sample, dt_s: f64) -> [Vec2; 2] {
        // The operator feels the reaction to the tips' force, or the coupling that they hang on.
        let mut wanted = match &self.proxy {
            Some(proxy) => proxy.force_n(sample),
            None => self.current.state.tip_force_n.map(|f| -f),
        };
        match self.test.advance(dt_s) {
            Change::Off => {}
            Change::On(test_n, first) => {
                wanted = test_n;
                if first {
                    self.safety.swapped();
                }
            }
            Change::Ended => self.safety.swapped(),
        }
        if let Some(most) = self.passivity_control_n_s_m {
            let extra = control(&self.observer, sample.tip_velocity, dt_s, most);
            for (force, extra) in wanted.iter_mut().zip(extra) {
                *force += extra;
            }
        }
        wanted
    }

    /// The world stands still, its clock too, and the force goes.
    fn tick_held(&mut self, dt_s: f64) -> TickRecord {
        let mut flags = SafetyFlags::default();
        // A hand that a program thinks out stays where it is; a real one moves on, and is still listened to.
        if self.device.spec().force_feedback {
            let raw = self.device.exchange(&Command { force_n: self.sent_force_n }, dt_s);
            self.last.device_in_world = self.safety.admit(&raw, dt_s, &mut flags).tip_in_world;
        }
        self.sent_force_n = self.safety.release(dt_s, &mut flags);
        self.last = TickRecord { flags, sent_force_n: self.sent_force_n, impact_m_s: 0.0, ..self.last };
        self.last
    }

    fn tick_without_time(&mut self) -> TickRecord {
        self.make_safe();
        self.safety.interrupted();
        let flags = SafetyFlags { stale: true, ..SafetyFlags::default() };
        self.last = TickRecord { flags, sent_force_n: self.sent_force_n, impact_m_s: 0.0, ..self.last };
        self.last
    }

    /// The coupling that device, world and period ask for; the tips stay where they are.
    fn couple(&mut self, period_s: f64) {
        self.coupled_for_s = period_s;
        let delay_s = self.device.delay_s();
        let needed = Coupling::needed(self.device.spec(), &self.current.world, period_s, delay_s);
        let tips = self.current.state.input;
        self.proxy = needed.map(|coupling| match self.proxy {
            Some(proxy) => proxy.with_coupling(coupling),
            None => Proxy::new(coupling, tips),
        });
    }

    /// Puts a new world in; returns the old one, to be dropped on another thread. The fingers stay where they are, and
    /// so does everything else in a world that continues the old one ([`Swap::going_on`]). The old force fades, and a
    /// new one that presses much harder rises with the start ramp.
    pub fn swap(&mut self, mut next: Box<Swap>) -> Box<Swap> {
        next.follow(&self.current);
        self.generation += 1;
        let old = std::mem::replace(&mut self.current, next);
        self.safety.swapped();
        // Another environment, another account.
        self.observer = Observer::default();
        self.stored = Stored::default();
        if self.coupled_for_s > 0.0 {
            self.couple(self.coupled_for_s);
        }
        old
    }

    /// Says that the loop stood still for longer than the watchdog allows: zero force, then up again softly.
    pub fn interrupted(&mut self) {
        self.safety.interrupted();
        self.device.interrupted();
    }

    /// Pushes with a small force instead of the world's, N on the operator's fingers, to try the device; `None` ends it. It
    /// comes up slowly and passes the safety stage like any force.
    pub fn test_force(&mut self, wanted_n: Option<[Vec2; 2]>) {
        self.test.ask(wanted_n);
    }

    /// Holds the world still, or lets it go on. Held, its clock stands and the force on the operator goes; afterwards the force comes up
    /// with the start ramp.
    pub fn hold(&mut self, held: bool) {
        self.held = held;
    }

    /// True while the world is held still.
    pub fn is_held(&self) -> bool {
        self.held
    }

    /// The virtual coupling in use; `None`: the device renders the world directly.
    pub fn coupling(&self) -> Option<Coupling> {
        self.proxy.map(|proxy| proxy.coupling())
    }

    /// Delay that the device states of itself, s.
    pub fn delay_s(&self) -> f64 {
        self.device.delay_s()
    }

    /// Stiffness of the line with waves that the device is behind, N/m.
    pub fn line_stiffness_n_m(&self) -> Option<f64> {
        self.device.line_stiffness_n_m()
    }

    /// Zero force on the device.
    pub fn make_safe(&mut self) {
        self.device.make_safe();
        self.sent_force_n = [Vec2::zeros(); 2];
    }

    /// World and state, for the corrections of a model.
    pub(crate) fn model_mut(&mut self) -> (&mut World, &mut State) {
        let Swap { world, state, .. } = &mut *self.current;
        (world, state)
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

    /// Age of the newest good sample of the finger that was not seen for longer, s.
    pub fn sample_age_s(&self) -> f64 {
        self.safety.sample_age_s()
    }

    /// Whether both fingers were ever seen.
    pub fn has_met_both(&self) -> bool {
        self.safety.has_met_both()
    }
}

#[cfg(test)]
mod tests;
