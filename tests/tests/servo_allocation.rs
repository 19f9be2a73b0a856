//! The whole servo thread allocates and frees nothing: waiting, timing, rate, snapshots, recorder, swaps, stalls, and the end.
//!
//! `allocation.rs` guards one tick, called from a test's own thread. Here the real thread runs. The device, which is called on it,
//! puts the thread under watch in its first exchange and takes it from it when it is dropped at the very end.

#![allow(unsafe_code)] // an allocator that counts is an `unsafe impl`; all that it does is count and pass on

use haptics::Vec2;
use haptics::device::{Command, Device, DeviceSpec, Sample, ScriptedOperator, Skill};
use haptics::servo::rate::{RateChoice, RateReason};
use haptics::servo::{Servo, ServoConfig, Swap};
use haptics::teleop::{self, Delay, Ends, ViewSource};
use haptics::world::{State, World, presets};
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU32, AtomicU64, Ordering};
use std::time::{Duration, Instant};

/// What was counted on one watched thread.
#[derive(Default)]
struct Count {
    allocated: AtomicU64,
    freed: AtomicU64,
}

/// One entry a test: tests run side by side.
static COUNTS: [Count; 8] = [const { Count { allocated: AtomicU64::new(0), freed: AtomicU64::new(0) } }; 8];

thread_local! {
    /// The entry that counts for this thread.
    static WATCHED: Cell<Option<usize>> = const { Cell::new(None) };
}

fn count(which: impl Fn(&Count) -> &AtomicU64) {
    // A thread that is ending has no cell any more.
    if let Ok(Some(entry)) = WATCHED.try_with(Cell::get) {
        which(&COUNTS[entry]).fetch_add(1, Ordering::Relaxed);
    }
}

struct Counting;

// SAFETY: every call goes to the system's allocator as it came; counting touches no memory of the caller and allocates nothing.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count(|c| &c.allocated);
        // SAFETY: the caller's promises are passed on.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, memory: *mut u8, layout: Layout) {
        count(|c| &c.freed);
        // SAFETY: the caller's promises are passed on.
        unsafe { System.dealloc(memory, layout) }
    }

    unsafe fn realloc(&self, memory: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        count(|c| &c.allocated);
        // SAFETY: the caller's promises are passed on.
        unsafe { System.realloc(memory, layout, size) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// What a test tells its device.
#[derive(Default)]
struct Orders {
    /// The next exchange takes so long, ms.
    stall_ms: AtomicU32,
    /// Every exchange takes so long, µs.
    slow_us: AtomicU32,
    /// Every exchange allocates: what the test must see.
    allocates: AtomicBool,
}

/// A scripted operator whose thread is watched.
struct Watched {
    inner: ScriptedOperator,
    entry: usize,
    orders: Arc<Orders>,
    /// The freed memory of the running servo; what the end frees is its own.
    freed: Arc<AtomicU64>,
}

impl Device for Watched {
    fn spec(&self) -> &DeviceSpec {
        self.inner.spec()
    }

    fn exchange(&mut self, command: &Command, dt_s: f64) -> Sample {
        WATCHED.set(Some(self.entry));
        let busy = Instant::now();
        let slow = Duration::from_micros(self.orders.slow_us.load(Ordering::Relaxed).into());
        let stall = Duration::from_millis(self.orders.stall_ms.swap(0, Ordering::Relaxed).into());
        while busy.elapsed() < slow + stall {
            std::hint::spin_loop();
        }
        if self.orders.allocates.load(Ordering::Relaxed) {
            drop(std::hint::black_box(Box::new(dt_s)));
        }
        self.inner.exchange(command, dt_s)
    }

    fn make_safe(&mut self) {
        self.freed.store(COUNTS[self.entry].freed.load(Ordering::Relaxed), Ordering::Relaxed);
        self.inner.make_safe();
    }

    fn see(&mut self, world: &World, state: &State) {
        self.inner.see(world, state);
    }
}

impl Drop for Watched {
    fn drop(&mut self) {
        WATCHED.set(None);
    }
}

struct Run {
    servo: Servo,
    orders: Arc<Orders>,
    freed: Arc<AtomicU64>,
    entry: usize,
}

fn start(entry: usize, rate: RateChoice) -> Run {
    start_behind(entry, rate, |device, _| device)
}

/// The same with something between the operator and the servo.
fn start_behind(
    entry: usize,
    rate: RateChoice,
    put_before: impl FnOnce(Box<dyn Device>, &Swap) -> Box<dyn Device>,
) -> Run {
    let world = presets::stacking();
    let inner = ScriptedOperator::new(&world, &State::resting(&world), Skill::default(), 1);
    let (orders, freed) = (Arc::new(Orders::default()), Arc::new(AtomicU64::new(u64::MAX)));
    let device = Watched { inner, entry, orders: Arc::clone(&orders), freed: Arc::clone(&freed) };
    let config = ServoConfig { rate, ..ServoConfig::default() };
    let swap = Swap::new(world);
    let device = put_before(Box::new(device), &swap);
    let servo = Servo::start(swap, device, config).expect("a thread");
    Run { servo, orders, freed, entry }
}

/// A slow, unsteady line before the device, and what is seen over it.
fn over_a_line(entry: usize, round_trip_s: f64, predicted: bool) -> (Run, ViewSource) {
    let mut seen = None;
    let run = start_behind(entry, RateChoice::Fixed(1000.0), |device, swap| {
        let guess = teleop::guess(&swap.world, 3);
        let limits = ServoConfig::default().limits;
        let (world, state) = (&swap.world, &swap.state);
        let ends = Ends { world, state, guess: Some(&guess), limits, period_s: 1e-3, seed: 3 };
        let delay = Delay { jitter_s: 0.02, loss: 0.05, ..Delay::of(round_trip_s, predicted) };
        let (device, view) = teleop::connect(device, &ends, &delay).expect("a line");
        seen = Some(view);
        device
    });
    (run, seen.expect("connected"))
}

impl Run {
    /// Looks at the snapshots until the condition holds; the condition decides, the limit only ends a broken test.
    fn until(&mut self, mut done: impl FnMut(&mut Servo) -> bool) -> bool {
        let begun = Instant::now();
        while begun.elapsed() < Duration::from_mins(2) {
            if done(&mut self.servo) {
                return true;
            }
            std::thread::sleep(Duration::from_millis(2));
        }
        false
    }

    /// Ends the servo; how often its thread allocated until the device was dropped, and freed until it was made safe.
    fn end(self) -> (u64, u64) {
        drop(self.servo);
        (COUNTS[self.entry].allocated.load(Ordering::Relaxed), self.freed.load(Ordering::Relaxed))
    }
}

/// Stacked blocks, and many more of them: every buffer has to have been large enough before.
fn larger() -> World {
    let mut world = presets::stacking();
    for number in 3..30_u32 {
        let mut block = world.blocks[1].clone();
        block.name = format!("block-{number}");
        block.start.center_m.x += 0.03 * f64::from(number);
        world.blocks.push(block);
    }
    world
}

#[test]
fn a_running_servo_with_swaps_pushes_and_stalls_allocates_and_frees_nothing() {
    let mut run = start(0, RateChoice::Fixed(1000.0));
    let mut ticks = Vec::with_capacity(100_000);
    assert!(run.until(|servo| servo.newest().state.tick > 300));
    for (number, world) in [presets::crank(), larger(), presets::table(), presets::stacking()].into_iter().enumerate() {
        assert!(run.servo.swap(Swap::new(world)).is_ok());
        assert!(run.until(|servo| servo.newest().generation == number as u64 + 1));
        run.servo.test_force((number % 2 == 0).then_some([Vec2::new(0.0, 0.5); 2]));
        // Longer than the watchdog and the guard wait: an interruption, a missed deadline, a new schedule.
        run.orders.stall_ms.store(40, Ordering::Relaxed);
        let stalls = run.servo.newest().timing.stalls;
        assert!(run.until(|servo| servo.newest().timing.stalls > stalls), "a stall is counted");
        run.servo.drain(&mut ticks);
    }
    // More than one part of the recent timing and a dozen summaries.
    assert!(run.until(|servo| servo.newest().timing.ticks > 2_500));
    let timing = run.servo.newest().timing;
    assert!(timing.missed > 0 && timing.recent.ticks > 1_000, "{timing:?}");
    run.servo.drain(&mut ticks);
    assert!(ticks.len() > 2_000 && ticks.iter().any(|tick| tick.flags.stale));
    assert_eq!(run.end(), (0, 0), "allocated until the end, freed while it ran");
}

#[test]
fn a_servo_that_is_recorded_from_allocates_and_frees_nothing_also_when_nobody_reads() {
    let mut run = start(3, RateChoice::Fixed(2000.0));
    assert!(run.until(|servo| servo.newest().state.tick > 200));
    let mut tap = run.servo.tap().open().expect("nobody else records");
    let mut times = Vec::with_capacity(100_000);
    assert!(run.until(|_| {
        times.extend(std::iter::from_fn(|| tap.pop()).map(|tick| tick.time_s));
        times.len() > 2_000
    }));
    assert!(times.windows(2).all(|w| (w[1] - w[0] - 0.5e-3).abs() < 1e-9), "no tick is missing");
    assert_eq!(tap.dropped(), 0);
    // Nobody reads any more: full after eight seconds, then ticks are counted and dropped, and the servo goes on.
    assert!(run.until(|_| tap.dropped() > 100));
    let before = run.servo.newest().state.tick;
    assert!(run.until(|servo| servo.newest().state.tick > before + 200));
    drop(tap);
    let again = run.servo.tap().open().expect("given back");
    assert_eq!(again.dropped(), 0);
    drop(again);
    assert_eq!(run.end(), (0, 0), "allocated until the end, freed while it ran");
}

#[test]
fn a_servo_that_falls_back_to_a_lower_rate_allocates_and_frees_nothing() {
    let mut run = start(1, RateChoice::Auto);
    assert!(run.until(|servo| servo.newest().timing.ticks > 100));
    // Too long for 4 kHz, not for 1 kHz.
    run.orders.slow_us.store(700, Ordering::Relaxed);
    let begun_at = run.servo.newest().timing.rate.rate_hz;
    assert!(run.until(|servo| {
        let rate = servo.newest().timing.rate;
        // A machine that does not hold 4 kHz has nothing to fall from.
        begun_at < 4000.0 || matches!(rate.reason, RateReason::FellBack { .. })
    }));
    let before = run.servo.newest().state.tick;
    assert!(run.until(|servo| servo.newest().state.tick > before + 500));
    assert_eq!(run.end(), (0, 0), "allocated until the end, freed while it ran");
}

#[test]
fn a_hand_over_a_slow_line_lifts_a_block_on_the_real_thread_and_allocates_and_frees_nothing() {
    const LIFTED_M: f64 = 5e-3;
    let lines = [(4, 0.15, false), (5, 0.5, false), (6, 0.15, true), (7, 0.5, true)];
    let lift = |(entry, round_trip_s, predicted): (usize, f64, bool)| {
        let what = format!("{round_trip_s} s, model: {predicted}");
        let (mut run, mut view) = over_a_line(entry, round_trip_s, predicted);
        let starts = presets::stacking().blocks.iter().map(|block| block.start.center_m.y).collect::<Vec<_>>();
        let rises = |state: &State| state.bodies.iter().zip(&starts).any(|(body, y)| body.center_m.y - y > LIFTED_M);
        assert!(run.until(|servo| rises(&servo.newest().state)), "{what}: nothing is lifted at the far end");
        // What is seen there is as late as the line is.
        assert!(run.until(|_| rises(&view.newest().there)), "{what}: nobody sees it");
        let age_s = view.newest().age_s;
        assert!(age_s > 0.5 * round_trip_s && view.newest().predicted == predicted, "{what}: {age_s} s");
        // An interruption at the far end leaves the hand without force, and the line goes on.
        let stalls = run.servo.newest().timing.stalls;
        run.orders.stall_ms.store(40, Ordering::Relaxed);
        assert!(run.until(|servo| servo.newest().timing.stalls > stalls), "{what}: a stall is counted");
        let before = run.servo.newest().state.tick;
        assert!(run.until(|servo| servo.newest().state.tick > before + 500), "{what}: it goes on");
        assert_eq!(run.end(), (0, 0), "{what}: allocated until the end, freed while it ran");
    };
    std::thread::scope(|threads| {
        for line in lines {
            threads.spawn(move || lift(line));
        }
    });
}

#[test]
fn an_allocation_on_the_servo_thread_is_seen() {
    let mut run = start(2, RateChoice::Fixed(1000.0));
    run.orders.allocates.store(true, Ordering::Relaxed);
    assert!(run.until(|servo| servo.newest().state.tick > 50));
    let (allocated, freed) = run.end();
    assert!(allocated >= 40 && freed >= 40, "{allocated} allocations, {freed} frees");
}
