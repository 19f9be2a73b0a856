//! The servo thread and the handle that the window keeps.

use super::clock::Deadlines;
use super::r#loop::{Loop, Snapshot, Swap, TickRecord};
use super::realtime::{Privileges, acquire};
use super::safety::Limits;
use super::timing::{Timing, TimingCollector};
use crate::device::Device;
use rtrb::{Consumer, Producer, RingBuffer};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU8, Ordering};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};
use triple_buffer::{Input, Output, triple_buffer};

/// Seconds of ticks that the ring holds before the reader must have fetched them.
const RING_SECONDS: f64 = 8.0;

/// How the servo runs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ServoConfig {
    /// Ticks a second, 50 … 8000.
    pub rate_hz: f64,
    /// Safety limits.
    pub limits: Limits,
    /// Ask the system for real-time scheduling.
    pub real_time: bool,
    /// Largest damping that the passivity controller may add, N s/m; `None`: it only observes.
    pub passivity_control_n_s_m: Option<f64>,
}

impl Default for ServoConfig {
    fn default() -> Self {
        Self { rate_hz: 1000.0, limits: Limits::default(), real_time: true, passivity_control_n_s_m: None }
    }
}

/// Why a servo could not be started.
#[derive(Debug, thiserror::Error)]
pub enum ServoError {
    /// Rate out of range.
    #[error("a servo rate of {0} Hz is not possible; choose 50 to 8000 Hz")]
    Rate(f64),
    /// The system gave no thread.
    #[error("the servo thread could not be started ({0})")]
    Thread(#[from] std::io::Error),
}

/// A running servo. Dropping it stops the thread and leaves the device at zero force.
pub struct Servo {
    newest: Output<Snapshot>,
    ticks: Consumer<TickRecord>,
    swaps: Producer<Box<Swap>>,
    retired: Consumer<Box<Swap>>,
    stop: Arc<AtomicBool>,
    granted: Arc<AtomicU8>,
    config: ServoConfig,
    thread: Option<JoinHandle<()>>,
}

impl Servo {
    /// Starts the thread on a checked world with a device.
    pub fn start(swap: Box<Swap>, device: Box<dyn Device>, config: ServoConfig) -> Result<Self, ServoError> {
        if !(50.0..=8000.0).contains(&config.rate_hz) {
            return Err(ServoError::Rate(config.rate_hz));
        }
        let first = Snapshot {
            state: swap.state.clone(),
            generation: 0,
            tick: TickRecord { input: swap.state.input, label: "free-motion", ..TickRecord::default() },
            timing: Timing { period_s: 1.0 / config.rate_hz, ..Timing::default() },
            fault: None,
        };
        let (snapshot_in, newest) = triple_buffer(&first);
        let (tick_in, ticks) = RingBuffer::new((config.rate_hz * RING_SECONDS) as usize);
        let (swaps, swap_out) = RingBuffer::new(4);
        let (retired_in, retired) = RingBuffer::new(8);
        let stop = Arc::new(AtomicBool::new(false));
        let granted = Arc::new(AtomicU8::new(0));
        let limits = Limits { max_force_n: config.limits.max_force_n.min(device.spec().max_force_n), ..config.limits };
        let runner = Runner {
            body: Loop::new(swap, device, limits).with_passivity_control(config.passivity_control_n_s_m),
            snapshot: snapshot_in,
            ticks: tick_in,
            swaps: swap_out,
            retired: retired_in,
            stop: Arc::clone(&stop),
            granted: Arc::clone(&granted),
            config,
            timing: TimingCollector::default(),
            summary: first.timing,
        };
        let thread = std::thread::Builder::new().name("servo".to_owned()).spawn(move || runner.run())?;
        Ok(Self { newest, ticks, swaps, retired, stop, granted, config, thread: Some(thread) })
    }

    /// The newest snapshot; never waits.
    pub fn newest(&mut self) -> &Snapshot {
        self.newest.read()
    }

    /// All ticks since the last call, oldest first, into `into`. Call it at least every few seconds while recording.
    pub fn drain(&mut self, into: &mut Vec<TickRecord>) {
        while let Ok(tick) = self.ticks.pop() {
            into.push(tick);
        }
        // Worlds that were swapped out die here, not on the servo thread.
        while self.retired.pop().is_ok() {}
    }

    /// Puts a new world in at the next tick. Returns it when four are already waiting.
    pub fn swap(&mut self, next: Box<Swap>) -> Result<(), Box<Swap>> {
        self.swaps.push(next).map_err(|rtrb::PushError::Full(back)| back)
    }

    /// What the system granted.
    pub fn privileges(&self) -> Privileges {
        let bits = self.granted.load(Ordering::Relaxed);
        Privileges { fifo: bits & 1 != 0, memory_locked: bits & 2 != 0 }
    }

    /// How it was started.
    pub fn config(&self) -> ServoConfig {
        self.config
    }

    /// True while the thread runs.
    pub fn is_running(&self) -> bool {
        self.thread.as_ref().is_some_and(|t| !t.is_finished())
    }
}

impl Drop for Servo {
    fn drop(&mut self) {
        self.stop.store(true, Ordering::Relaxed);
        if let Some(thread) = self.thread.take() {
            // The thread catches its own panics; joining cannot bring one here.
            let _ = thread.join();
        }
    }
}

struct Runner {
    body: Loop,
    snapshot: Input<Snapshot>,
    ticks: Producer<TickRecord>,
    swaps: Consumer<Box<Swap>>,
    retired: Producer<Box<Swap>>,
    stop: Arc<AtomicBool>,
    granted: Arc<AtomicU8>,
    config: ServoConfig,
    timing: TimingCollector,
    summary: Timing,
}

impl Runner {
    fn run(mut self) {
        if self.config.real_time {
            let granted = acquire();
            let bits = u8::from(granted.fifo) | (u8::from(granted.memory_locked) << 1);
            self.granted.store(bits, Ordering::Relaxed);
        }
        // A panic in the tick would be a bug; it must still end in zero force and be said.
        let ended = catch_unwind(AssertUnwindSafe(|| self.tick_until_stopped()));
        self.body.make_safe();
        if ended.is_err() {
            self.publish(
                TickRecord::default(),
                Some("The servo met an internal fault and stopped; the force is zero."),
            );
        }
    }

    fn tick_until_stopped(&mut self) {
        let period_s = 1.0 / self.config.rate_hz;
        let mut deadlines = Deadlines::new(Duration::from_secs_f64(period_s));
        let mut count = 0_u64;
        while !self.stop.load(Ordering::Relaxed) {
            let (late_s, missed) = deadlines.wait();
            let started = Instant::now();
            self.take_swap();
            let tick = self.body.tick(period_s);
            // A full ring means that nobody records: the newest ticks are dropped, the servo goes on.
            let _ = self.ticks.push(tick);
            self.timing.add(late_s, started.elapsed().as_secs_f64(), missed);
            count += 1;
            if count.is_multiple_of((0.25 * self.config.rate_hz) as u64) {
                self.summary = self.timing.summary(period_s, self.body.sample_age_s());
            }
            self.publish(tick, None);
        }
    }

    fn take_swap(&mut self) {
        // Only when the old world can be handed back for dropping elsewhere.
        if self.retired.slots() == 0 {
            return;
        }
        if let Ok(next) = self.swaps.pop() {
            let old = self.body.swap(next);
            let _ = self.retired.push(old);
        }
    }

    fn publish(&mut self, tick: TickRecord, fault: Option<&'static str>) {
        let buffer = self.snapshot.input_buffer_mut();
        buffer.state.copy_from(self.body.state());
        buffer.generation = self.body.generation();
        buffer.tick = tick;
        buffer.timing = self.summary;
        buffer.fault = fault;
        self.snapshot.publish();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::device::{ScriptedOperator, Skill};
    use crate::world::{State, presets};

    fn start(rate_hz: f64) -> Servo {
        let world = presets::stacking();
        let state = State::resting(&world);
        let device = ScriptedOperator::new(&world, &state, Skill::default(), 1);
        let config = ServoConfig { rate_hz, ..ServoConfig::default() };
        Servo::start(Swap::new(world), Box::new(device), config).expect("a thread")
    }

    /// Waits until `done` or ten seconds have passed; the condition decides, not the time.
    fn wait_for(servo: &mut Servo, done: impl Fn(&Snapshot) -> bool) -> bool {
        let begun = Instant::now();
        while begun.elapsed() < Duration::from_secs(10) {
            if done(servo.newest()) {
                return true;
            }
            std::thread::yield_now();
        }
        false
    }

    #[test]
    fn ticks_arrive_in_order_without_a_hole() {
        let mut servo = start(1000.0);
        let mut ticks = Vec::new();
        assert!(wait_for(&mut servo, |s| s.state.tick > 300));
        servo.drain(&mut ticks);
        assert!(ticks.len() >= 300);
        assert!(ticks.windows(2).all(|w| ((w[1].time_s - w[0].time_s) - 1e-3).abs() < 1e-9));
        assert!(wait_for(&mut servo, |s| s.timing.ticks > 0 && s.timing.compute.p50_s > 0.0));
    }

    #[test]
    fn a_world_is_swapped_in_and_the_fingers_stay() {
        let mut servo = start(1000.0);
        assert!(wait_for(&mut servo, |s| s.state.tick > 50));
        assert!(servo.swap(Swap::new(presets::crank())).is_ok());
        assert!(wait_for(&mut servo, |s| s.generation == 1 && s.state.bodies.is_empty()));
        let mut ticks = Vec::new();
        servo.drain(&mut ticks);
        let jump = ticks
            .windows(2)
            .map(|w| (w[1].input.tip_in_world[0] - w[0].input.tip_in_world[0]).norm())
            .fold(0.0, f64::max);
        assert!(jump < 1e-3, "a finger jumped by {jump} m");
    }

    #[test]
    fn a_panicking_device_ends_in_a_fault_that_is_said() {
        struct Broken(crate::device::DeviceSpec, Arc<AtomicBool>);
        impl Device for Broken {
            fn spec(&self) -> &crate::device::DeviceSpec {
                &self.0
            }
            fn exchange(&mut self, _: &crate::device::Command, _: f64) -> crate::device::Sample {
                panic!("a device driver's bug");
            }
            fn make_safe(&mut self) {
                self.1.store(true, Ordering::Relaxed);
            }
        }
        let world = presets::table();
        let probe = ScriptedOperator::new(&world, &State::resting(&world), Skill::default(), 0);
        let safe = Arc::new(AtomicBool::new(false));
        let device = Broken(probe.spec().clone(), Arc::clone(&safe));
        let mut servo = Servo::start(Swap::new(world), Box::new(device), ServoConfig::default()).expect("a thread");
        assert!(wait_for(&mut servo, |s| s.fault.is_some()));
        assert!(safe.load(Ordering::Relaxed), "the device was told to be safe");
    }

    #[test]
    fn impossible_rates_are_refused() {
        let world = presets::table();
        let device = ScriptedOperator::new(&world, &State::resting(&world), Skill::default(), 0);
        let config = ServoConfig { rate_hz: 0.0, ..ServoConfig::default() };
        assert!(matches!(Servo::start(Swap::new(world), Box::new(device), config), Err(ServoError::Rate(_))));
    }
}
