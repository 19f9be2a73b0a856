//! The handle of a running servo, for the window.

use super::config::ServoConfig;
use super::control_loop::{Loop, Snapshot, TickRecord};
use super::force_test::Request;
use super::guard::{Beat, FAULT_AFTER_S, watch};
use super::rate::RateReport;
use super::realtime::Privileges;
use super::runner::Runner;
use super::safety::Limits;
use super::swap::Swap;
use super::tap::{TapSource, tap};
use crate::Vec2;
use crate::device::Device;
use rtrb::{Consumer, Producer, RingBuffer};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU8, Ordering};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};
use triple_buffer::{Output, triple_buffer};

/// Seconds of ticks that each ring holds before its reader must have fetched them.
const RING_SECONDS: f64 = 8.0;
/// A servo that is told to stop gets this long; a device that has not come back by then is left to its guard.
const FAREWELL: Duration = Duration::from_millis(500);

/// Shown while the servo stands still.
const STANDSTILL: &str = "The servo stands still: the device does not answer or the machine is overloaded. The force was set \
                          to zero; check the cable, or choose the device again.";

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
    tap: TapSource,
    swaps: Producer<Box<Swap>>,
    retired: Consumer<Box<Swap>>,
    stop: Arc<AtomicBool>,
    granted: Arc<AtomicU8>,
    beat: Arc<Beat>,
    test: Arc<Request>,
    hold: Arc<AtomicBool>,
    config: ServoConfig,
    threads: Vec<JoinHandle<()>>,
}

impl Servo {
    /// Starts the thread on a checked world with a device, and a second one that watches it.
    pub fn start(swap: Box<Swap>, mut device: Box<dyn Device>, config: ServoConfig) -> Result<Self, ServoError> {
        let most_hz = config.rate.most_hz();
        if !(50.0..=8000.0).contains(&most_hz) {
            return Err(ServoError::Rate(most_hz));
        }
        let nominal = RateReport { rate_hz: config.rate.nominal_hz(), ..RateReport::default() };
        let first = Snapshot::starting(&swap, nominal);
        let (snapshot_in, newest) = triple_buffer(&first);
        let (tick_in, ticks) = RingBuffer::new((most_hz * RING_SECONDS) as usize);
        let (tap_in, tap) = tap((most_hz * RING_SECONDS) as usize);
        let (swaps, swap_out) = RingBuffer::new(4);
        let (retired_in, retired) = RingBuffer::new(8);
        let stop = Arc::new(AtomicBool::new(false));
        let granted = Arc::new(AtomicU8::new(0));
        let beat = Arc::new(Beat::default());
        let test = Arc::new(Request::default());
        let hold = Arc::new(AtomicBool::new(false));
        let limits = Limits { max_force_n: config.limits.max_force_n.min(device.spec().max_force_n), ..config.limits };
        let guard = device.guard();
        let scratch = swap.state.clone();
        let runner = Runner {
            body: Loop::new(swap, device, limits).with_passivity_control(config.passivity_control_n_s_m),
            snapshot: snapshot_in,
            ticks: tick_in,
            tap: tap_in,
            swaps: swap_out,
            retired: retired_in,
            stop: Arc::clone(&stop),
            granted: Arc::clone(&granted),
            beat: Arc::clone(&beat),
            test: Arc::clone(&test),
            hold: Arc::clone(&hold),
            config,
            summary: first.timing,
            rate: nominal,
        };
        let (watched, watchdog_s, real_time) = (Arc::clone(&beat), config.limits.watchdog_s, config.real_time);
        // The guard first: a device is never driven without a guard.
        let threads = vec![
            std::thread::Builder::new()
                .name("servo-guard".to_owned())
                .spawn(move || watch(&watched, guard, watchdog_s, real_time))?,
            std::thread::Builder::new().name("servo".to_owned()).spawn(move || runner.run(scratch)).inspect_err(
                // Nothing else would tell the guard.
                |_| beat.finish(),
            )?,
        ];
        Ok(Self { newest, ticks, tap, swaps, retired, stop, granted, beat, test, hold, config, threads })
    }

    /// The newest snapshot; never waits. It has a fault while the servo stands still.
    pub fn newest(&mut self) -> &Snapshot {
        self.newest.update();
        if self.beat.standing_still_s() > FAULT_AFTER_S {
            self.newest.output_buffer_mut().fault = Some(STANDSTILL);
        }
        self.newest.output_buffer()
    }

    /// All ticks since the last call, oldest first, into `into`. After more than eight seconds without a call ticks are missing.
    pub fn drain(&mut self, into: &mut Vec<TickRecord>) {
        while let Ok(tick) = self.ticks.pop() {
            into.push(tick);
        }
        // Worlds that were swapped out die here, not on the servo thread.
        while self.retired.pop().is_ok() {}
    }

    /// Source of every tick for a recorder on a thread of its own, however rarely [`Self::drain`] is called.
    pub fn tap(&self) -> &TapSource {
        &self.tap
    }

    /// Puts a new world in at the next tick. Returns it when four are already waiting.
    pub fn swap(&mut self, next: Box<Swap>) -> Result<(), Box<Swap>> {
        self.swaps.push(next).map_err(|rtrb::PushError::Full(back)| back)
    }

    /// Pushes with a small force instead of the world's, N on the operator's fingers, to try the device; `None` ends it.
    pub fn test_force(&self, wanted_n: Option<[Vec2; 2]>) {
        self.test.set(wanted_n);
    }

    /// Holds the world still, or lets it go on; see [`Loop::hold`].
    pub fn hold(&self, held: bool) {
        self.hold.store(held, Ordering::Relaxed);
    }

    /// Privileges that the system granted.
    pub fn privileges(&self) -> Privileges {
        let bits = self.granted.load(Ordering::Relaxed);
        Privileges { asked: bits & 4 != 0, fifo: bits & 1 != 0, memory_locked: bits & 2 != 0 }
    }

    /// Settings with which it was started.
    pub fn config(&self) -> ServoConfig {
        self.config
    }

    /// Number of times that the guard made the device safe because the servo stood still.
    pub fn guarded(&self) -> u64 {
        self.beat.guarded()
    }

    /// True while the thread runs.
    pub fn is_running(&self) -> bool {
        self.threads.last().is_some_and(|t| !t.is_finished())
    }
}

impl Drop for Servo {
    fn drop(&mut self) {
        self.stop.store(true, Ordering::Relaxed);
        let asked = Instant::now();
        for thread in self.threads.drain(..).rev() {
            while !thread.is_finished() && asked.elapsed() < FAREWELL {
                // A stop is rare and waits for another thread's last tick.
                std::thread::sleep(Duration::from_millis(1));
            }
            if thread.is_finished() {
                // The threads catch their own panics; joining cannot bring one here.
                let _ = thread.join();
            }
            // Else the device's driver hangs: the guard has made it safe and stays until the driver comes back.
        }
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
        let config = ServoConfig::at(rate_hz);
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
        // While the panic is still being printed the watch has already said that the servo stands still.
        assert!(wait_for(&mut servo, |_| safe.load(Ordering::Relaxed)), "the device was told to be safe");
        assert!(wait_for(&mut servo, |s| s.fault.is_some()), "the fault is still said");
    }

    #[test]
    fn impossible_rates_are_refused() {
        let world = presets::table();
        let device = ScriptedOperator::new(&world, &State::resting(&world), Skill::default(), 0);
        let config = ServoConfig::at(0.0);
        assert!(matches!(Servo::start(Swap::new(world), Box::new(device), config), Err(ServoError::Rate(_))));
    }
}
