//! The live world and all that belongs to it.

use crate::recorder::{Recorder, Stopping};
use crate::ui::train::trainer::engine::Engine;
use crate::ui::train::trainer::force_test::Trial;
use crate::ui::train::trainer::hand::{HandDevice, HandSettings, Steering};
use crate::ui::train::trainer::history::History;
use crate::ui::train::trainer::impacts::Impacts;
use crate::ui::train::trainer::pause;
use crate::ui::train::trainer::pointer_grip::Pinch;
use crate::ui::train::trainer::script::Script;
use crate::ui::train::trainer::watch::Watch;
use crate::ui::train::trainer::world_choice::{Compare, WorldChoice};
use haptics::device::{Device, DeviceSpec};
use haptics::recording::Meta;
use haptics::servo::{Privileges, ServoConfig, Snapshot, Swap, TickRecord};
use haptics::teleop::{Delay, ViewSource};
use haptics::world::{State, World};
use std::path::PathBuf;
use std::sync::Arc;

/// Who moves the fingers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Operator {
    /// A person at a device, or a log.
    #[default]
    You,
    /// The scripted operator.
    Scripted,
}

/// Clock of the servo.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Clock {
    /// On its own thread, in real time.
    #[default]
    RealTime,
    /// Stepped on demand: tests and screenshots.
    Manual,
}

/// Sensor model of the virtual hand in recordings.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Sensors {
    /// Good encoders and strain gauges, to calibrate objects from.
    #[default]
    Usual,
    /// Exact values, to review an attempt.
    Ideal,
}

/// State and logic behind the trainer's panels.
#[derive(Default)]
pub struct Trainer {
    /// Clock of the servo.
    pub clock: Clock,
    /// World in the trainer.
    pub choice: WorldChoice,
    /// Who moves the fingers.
    pub operator: Operator,
    /// Device that moves the fingers, unless the script does.
    pub hand: HandDevice,
    /// Device settings beside the world.
    pub settings: HandSettings,
    /// Window side of the running device.
    pub steering: Steering,
    /// Skill and mistakes of the scripted operator.
    pub script: Script,
    /// The force test.
    pub trial: Trial,
    /// Control of the fingers by the mouse.
    pub pinch: Pinch,
    /// Recent impacts.
    pub impacts: Impacts,
    /// Speed of the fastest impact since the last frame, m/s; its sound plays once.
    pub struck_m_s: Option<f64>,
    /// Forces of the last seconds.
    pub history: History,
    /// Live estimates of the objects.
    pub watch: Watch,
    /// Calibrated world, if there is one.
    pub calibrated: Option<World>,
    /// Base and extended world of a diagnosis, while they are compared.
    pub compare: Option<Compare>,
    /// World from a file, if there is one.
    pub file: Option<World>,
    pub(crate) engine: Option<Engine>,
    /// Maximum damping of the passivity controller, N s/m; `None` if it is off.
    pub(crate) control_n_s_m: Option<f64>,
    pub(crate) spec: Option<DeviceSpec>,
    /// Worlds by generation of the running engine.
    pub(crate) worlds: Vec<Arc<World>>,
    pub(crate) newest: Option<Snapshot>,
    /// Sensor model of recordings.
    pub sensors: Sensors,
    /// Metadata for the sidecar of recordings.
    pub stated: Meta,
    /// Folder of recordings; `None` for the user's data folder.
    pub recordings_folder: Option<PathBuf>,
    pub(crate) recorder: Option<Recorder>,
    pub(crate) ended: Vec<Stopping>,
    pub(crate) scratch: Vec<TickRecord>,
    pub(crate) recordings_made: usize,
    pub(crate) performances: u64,
    /// Start time of each act of a scripted performance, s.
    pub acts_begin_s: Vec<f64>,
    pub(crate) delay: Delay,
    pub(crate) hold: pause::Hold,
    /// View of the operator over a link with latency.
    pub(crate) view: Option<ViewSource>,
    /// Number of the newest impact shown in that view.
    pub(crate) knocked: u64,
}

impl Trainer {
    /// Starts the servo unless it runs; continues from the paused state.
    pub fn ensure_running(&mut self) -> Result<(), String> {
        if self.engine.is_some() {
            return Ok(());
        }
        let resumed = self.newest.take().zip(self.worlds.last().cloned()).filter(|_| self.operator == Operator::You);
        let swap = match resumed {
            Some((snapshot, world)) if snapshot.state.bodies.len() == world.blocks.len() => {
                Swap::at((*world).clone(), snapshot.state)
            }
            _ => Swap::new(self.world_of(self.choice)),
        };
        self.start(swap)
    }

    /// Starts over: the chosen world in its starting state, the chosen operator.
    pub fn restart(&mut self) -> Result<(), String> {
        self.newest = None;
        let swap = Swap::new(self.world_of(self.choice));
        self.start(swap)
    }

    fn start(&mut self, mut swap: Box<Swap>) -> Result<(), String> {
        swap.world.check().map_err(|error| crate::text::sentence::sentence(&error.to_string()))?;
        self.end_recording();
        // The old device is closed first: a port can be open only once.
        self.engine = None;
        self.hold_nothing();
        self.steering = Steering::None;
        self.trial.abort();
        let Swap { world, state, .. } = &mut *swap;
        let (device, problem) = match self.device(world, state) {
            Ok(device) => (device, None),
            // The mouse always works; the problem with the other device is reported.
            Err(problem) => {
                self.hand = HandDevice::Mouse;
                (self.device(world, state)?, Some(problem))
            }
        };
        self.spec = Some(device.spec().clone());
        let device = self.connect(device, &swap)?;
        self.history = History::default();
        self.pinch.prepare_for(&swap.world, &swap.state);
        self.worlds = vec![Arc::new(swap.world.clone())];
        let config = ServoConfig { passivity_control_n_s_m: self.control_n_s_m, ..ServoConfig::default() };
        let engine = match self.clock {
            Clock::RealTime => Engine::thread(swap, device, config)?,
            Clock::Manual => Engine::inline(swap, device, config),
        };
        self.engine = Some(engine);
        self.update(0.0);
        problem.map_or(Ok(()), Err)
    }

    fn device(&mut self, world: &World, state: &mut State) -> Result<Box<dyn Device>, String> {
        self.steering = Steering::None;
        match self.operator {
            Operator::You => {
                let (device, steering) = self.hand.make(world, state, &self.settings)?;
                self.steering = steering;
                Ok(device)
            }
            Operator::Scripted => {
                self.performances += 1;
                let operator = self.script.operator(world, state, self.performances);
                self.acts_begin_s = operator.acts_begin_s().to_vec();
                // With link latency people use a move-and-wait strategy.
                Ok(Box::new(if self.delay.is_none() { operator } else { operator.waiting() }))
            }
        }
    }

    /// Changes the device of the fingers; the world keeps its state. If that device cannot be used, the mouse takes
    /// over and the error gives the reason.
    pub fn take_up(&mut self, hand: HandDevice) -> Result<(), String> {
        (self.operator, self.hand) = (Operator::You, hand);
        self.pause();
        self.ensure_running()
    }

    /// Specification of the running device.
    pub fn spec(&self) -> Option<&DeviceSpec> {
        self.engine.as_ref().and(self.spec.as_ref())
    }

    /// Stops the servo; the world is kept for the next start.
    pub fn pause(&mut self) {
        self.end_recording();
        self.engine = None;
        self.hold_nothing();
        self.steering = Steering::None;
        self.trial.abort();
    }

    /// Changes the world while the servo runs, without a jump in force; the scripted operator starts over. Between two
    /// worlds that differ in their laws alone the state is kept, and the scripted operator continues.
    pub fn choose(&mut self, choice: WorldChoice) -> Result<(), String> {
        let goes_on = self.choice.goes_on_to(choice);
        self.choice = choice;
        let world = self.world_of(choice);
        let swap = if goes_on { Swap::going_on(world) } else { Swap::new(world) };
        // Both ends of a link need the same world.
        let running = self.engine.is_some() && self.view.is_none() && (goes_on || self.operator == Operator::You);
        if !running {
            return self.restart();
        }
        swap.world.check().map_err(|error| crate::text::sentence::sentence(&error.to_string()))?;
        self.end_recording();
        if !goes_on {
            self.pinch.prepare_for(&swap.world, &swap.state);
        }
        let world = Arc::new(swap.world.clone());
        match self.engine.as_mut().map(|engine| engine.swap(swap)) {
            Some(true) => {
                self.worlds.push(world);
                Ok(())
            }
            _ => self.restart(),
        }
    }

    /// Changes the operator; the world starts over.
    pub fn hand_to(&mut self, operator: Operator) -> Result<(), String> {
        self.operator = operator;
        self.restart()
    }

    /// Once a frame: fetches every tick, moves the mouse's goal.
    pub fn update(&mut self, frame_s: f64) {
        let Some(engine) = &mut self.engine else { return };
        self.scratch.clear();
        engine.drain(&mut self.scratch);
        let snapshot = engine.newest();
        match &mut self.newest {
            Some(kept) => {
                kept.state.copy_from(&snapshot.state);
                kept.generation = snapshot.generation;
                kept.tick = snapshot.tick;
                kept.timing = snapshot.timing;
                kept.coupling = snapshot.coupling;
                (kept.delay_s, kept.line_n_m) = (snapshot.delay_s, snapshot.line_n_m);
                kept.finished = snapshot.finished;
                kept.fault = snapshot.fault;
            }
            None => self.newest = Some(snapshot.clone()),
        }
        self.listen(frame_s);
        let Some(engine) = &mut self.engine else { return };
        let generation = self.newest.as_ref().map_or(0, |s| s.generation as usize);
        if let Some(world) = self.worlds.get(generation).or(self.worlds.last()) {
            self.watch.take(&self.scratch, world, self.clock == Clock::Manual);
        }
        engine.test_force(self.trial.advance(frame_s));
        self.look(frame_s);
        if let Some(tick) = self.seen_tick() {
            self.steering.follow(&mut self.pinch, &tick, frame_s);
        }
        self.follow_recording();
    }

    /// Advances a manual clock without processing the ticks: the next [`Self::update`] does.
    pub fn run_unseen(&mut self, seconds: f64) {
        if let Some(engine) = &mut self.engine {
            engine.advance(seconds);
        }
    }

    /// Advances a manual clock; the mouse's goal follows in steps of a frame.
    pub fn advance(&mut self, seconds: f64) {
        const FRAME_S: f64 = 1.0 / 60.0;
        let mut left = seconds;
        while left > 1e-9 {
            let part = left.min(FRAME_S);
            if let Some(engine) = &mut self.engine {
                engine.advance(part);
            }
            self.update(part);
            left -= part;
        }
    }

    /// Newest state and its world.
    pub fn scene(&self) -> Option<(&Snapshot, &Arc<World>)> {
        let snapshot = self.newest.as_ref()?;
        let world = self.worlds.get(snapshot.generation as usize).or(self.worlds.last())?;
        (snapshot.state.bodies.len() == world.blocks.len()).then_some((snapshot, world))
    }

    /// Privileges that the system granted to the servo thread.
    pub fn privileges(&self) -> Option<Privileges> {
        self.engine.as_ref()?.privileges()
    }

    /// The servo's settings.
    pub fn config(&self) -> ServoConfig {
        self.engine.as_ref().map_or_else(ServoConfig::default, Engine::config)
    }

    /// True once a script or a replay has ended.
    pub fn performance_over(&self) -> bool {
        self.engine.is_some() && self.newest.as_ref().is_some_and(|newest| newest.finished)
    }

    /// True while frames must follow each other quickly.
    pub fn is_moving(&self) -> bool {
        let Some(snapshot) = &self.newest else { return false };
        let fast = |v: &haptics::Vec2| v.norm() > 2e-4;
        self.recorder.is_some()
            || self.impacts.any()
            || snapshot.state.input.tip_velocity.iter().any(fast)
            || snapshot.state.bodies.iter().any(|b| fast(&b.velocity_m_s))
            || snapshot.state.crank.rate_rad_s.abs() > 1e-2
    }
}
