//! Whatever fails, the device ends at zero force within one watchdog time, and the servo says so.

use haptics::Vec2;
use haptics::device::{Command, Device, DeviceSpec, ForceGuard, Sample};
use haptics::servo::rate::{FAST_HZ, SAFE_HZ};
use haptics::servo::safety::Limits;
use haptics::servo::{Loop, Servo, ServoConfig, Snapshot, Swap, TickRecord};
use haptics::world::presets;
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

const DT: f64 = 1e-3;

/// What goes wrong.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Fault {
    None,
    /// No fresh sample any more.
    Stalled,
    /// Nine of ten samples are lost.
    Loss,
    /// Positions that are not a number, and called fresh.
    NotANumber,
    /// Velocities without bound.
    Infinite,
    /// A place that no hand reaches.
    FarAway,
    /// A bug in the driver.
    Panics,
    /// A driver that waits for hardware that does not answer.
    Blocks,
    /// One exchange that comes back only when the guard has acted.
    LongExchange,
    /// Every exchange takes 0.7 ms: too long for 4 kHz, not for 1 kHz.
    Slow,
}

/// The force on the motor, and the time since which it is zero. One lock holds both, so that no reader sees one without the other.
#[derive(Clone, Copy, Default)]
struct Held {
    newtons: f64,
    zero_at: Option<Instant>,
}

/// The hardware as seen from outside: it holds a force, as a motor would, until it is told otherwise.
#[derive(Default)]
struct Hardware {
    held: Mutex<Held>,
    fault: Mutex<Option<(Fault, Instant)>>,
    exchanges: AtomicU64,
    unblock: AtomicBool,
}

impl Hardware {
    fn hold(&self, newtons: f64) {
        let mut held = self.held.lock().expect("no panic while held");
        let zero_at = (newtons == 0.0).then(|| held.zero_at.unwrap_or_else(Instant::now));
        *held = Held { newtons, zero_at };
    }

    fn held_n(&self) -> f64 {
        self.held.lock().expect("no panic while held").newtons
    }

    fn begin(&self, fault: Fault) {
        *self.fault.lock().expect("no panic while held") = Some((fault, Instant::now()));
    }

    fn fault(&self) -> Fault {
        self.fault.lock().expect("no panic while held").map_or(Fault::None, |(fault, _)| fault)
    }

    /// Time from the fault to zero force, s.
    fn took_s(&self) -> Option<f64> {
        let begun = self.fault.lock().expect("no panic while held").map(|(_, at)| at)?;
        let zero = self.held.lock().expect("no panic while held").zero_at?;
        Some(zero.saturating_duration_since(begun).as_secs_f64())
    }
}

/// Two fingers that lean on the table, behind hardware that can fail.
struct FaultyDevice {
    spec: DeviceSpec,
    hardware: Arc<Hardware>,
    rng: StdRng,
    guarded: bool,
}

impl FaultyDevice {
    fn new(force_feedback: bool, guarded: bool) -> (Self, Arc<Hardware>) {
        let hardware = Arc::new(Hardware::default());
        let spec = DeviceSpec {
            name: "faulty".to_owned(),
            force_feedback,
            max_force_n: 4.0,
            damping_n_s_m: 1.0,
            coulomb_n: 0.0,
            resolution_m: 0.0,
        };
        (Self { spec, hardware: Arc::clone(&hardware), rng: StdRng::seed_from_u64(1), guarded }, hardware)
    }
}

impl Device for FaultyDevice {
    fn spec(&self) -> &DeviceSpec {
        &self.spec
    }

    fn exchange(&mut self, command: &Command, _: f64) -> Sample {
        self.hardware.exchanges.fetch_add(1, Ordering::Relaxed);
        let force = command.force_n[0].norm().max(command.force_n[1].norm());
        let fault = self.hardware.fault();
        self.hardware.hold(force);
        let mut sample = Sample {
            tip_in_world: [Vec2::new(-0.02, -0.1258), Vec2::new(0.02, -0.1258)],
            tip_velocity: [Vec2::zeros(); 2],
            fresh: [true; 2],
        };
        match fault {
            Fault::None => {}
            Fault::Stalled => sample.fresh = [false; 2],
            Fault::Loss => sample.fresh = [self.rng.random_bool(0.1); 2],
            Fault::NotANumber => sample.tip_in_world[1].y = f64::NAN,
            Fault::Infinite => sample.tip_velocity[0].x = f64::INFINITY,
            Fault::FarAway => sample.tip_in_world[0].x = 1e300,
            Fault::Panics => panic!("a driver's bug"),
            Fault::Blocks => {
                while !self.hardware.unblock.load(Ordering::Relaxed) {
                    std::thread::sleep(Duration::from_millis(1));
                }
            }
            Fault::Slow => {
                let begun = Instant::now();
                while begun.elapsed() < Duration::from_micros(700) {
                    std::hint::spin_loop();
                }
            }
            Fault::LongExchange => {
                *self.hardware.fault.lock().expect("no panic while held") = None;
                // The guard's word decides, not a time: on a busy machine it comes late.
                assert!(until(|| self.hardware.held_n() == 0.0), "the guard ends it");
            }
        }
        sample
    }

    fn make_safe(&mut self) {
        self.hardware.hold(0.0);
    }

    fn guard(&mut self) -> Option<ForceGuard> {
        let hardware = Arc::clone(&self.hardware);
        self.guarded.then(|| -> ForceGuard { Box::new(move || hardware.hold(0.0)) })
    }
}

fn limits() -> Limits {
    Limits { ramp_s: 0.1, ..Limits::default() }
}

/// A loop whose fingers press, after its ramp.
fn pressing(force_feedback: bool) -> (Loop, Arc<Hardware>) {
    let (device, hardware) = FaultyDevice::new(force_feedback, false);
    let mut body = Loop::new(Swap::new(presets::table()), Box::new(device), limits());
    for _ in 0..500 {
        body.tick(DT);
    }
    assert!(body.tick(DT).sent_force_n[0].norm() > 0.5, "there is a force to lose");
    (body, hardware)
}

fn is_zero(tick: &TickRecord) -> bool {
    tick.sent_force_n == [Vec2::zeros(); 2]
}

#[test]
fn bad_samples_end_in_zero_force_and_a_light_and_come_back_softly() {
    let within = (limits().watchdog_s / DT) as usize + 1;
    for force_feedback in [false, true] {
        for fault in [Fault::Stalled, Fault::NotANumber, Fault::Infinite, Fault::FarAway] {
            let (mut body, hardware) = pressing(force_feedback);
            hardware.begin(fault);
            let ticks: Vec<TickRecord> = (0..500).map(|_| body.tick(DT)).collect();
            let zero = ticks.iter().position(is_zero).expect("zero in the end");
            assert!(zero <= within, "{fault:?}: zero after {zero} ticks");
            assert!(ticks[zero..].iter().all(|t| is_zero(t) && t.flags.stale), "{fault:?}: and it stays so");
            let refused = ticks.iter().all(|t| t.flags.not_finite);
            assert_eq!(refused, fault != Fault::Stalled, "{fault:?}: what was refused is said");
            assert!(ticks.iter().all(|t| t.input.tip_in_world.iter().all(|v| v.norm() < 1.0)));

            hardware.begin(Fault::None);
            let first = body.tick(DT);
            assert!(!first.flags.stale && first.sent_force_n[0].norm() < 0.1, "{fault:?}: no kick at the return");
            let last = (0..500).map(|_| body.tick(DT)).last().expect("ticks");
            assert!(last.sent_force_n[0].norm() > 0.5, "{fault:?}: the force is back");
        }
    }
}

#[test]
fn jitter_and_loss_never_leave_a_force_on_an_old_sample() {
    let (mut body, hardware) = pressing(true);
    let mut rng = StdRng::seed_from_u64(7);
    let (mut age_s, mut seen_zero, mut seen_force) = (0.0, 0, 0);
    let mut before = body.tick(DT);
    for _ in 0..400 {
        // Gaps of up to three watchdog times, then a while of good or lossy samples.
        let gap = rng.random_range(1..60);
        hardware.begin(Fault::Stalled);
        for tick in 0..gap + 100 {
            if tick == gap {
                hardware.begin(if rng.random_bool(0.5) { Fault::Loss } else { Fault::None });
            }
            let now = body.tick(DT);
            age_s = body.sample_age_s();
            if age_s > limits().watchdog_s {
                assert!(is_zero(&now) && now.flags.stale, "a force on a sample of {age_s} s");
                seen_zero += 1;
            } else {
                let change = (now.sent_force_n[0] - before.sent_force_n[0]).norm();
                assert!(change <= limits().max_slew_n_s * DT + 1e-12, "a jump of {change} N");
                seen_force += usize::from(now.sent_force_n[0].norm() > 0.1);
            }
            before = now;
        }
    }
    assert!(age_s < 1.0 && seen_zero > 1_000 && seen_force > 1_000, "{seen_zero} zero, {seen_force} with force");
}

#[test]
fn a_clock_that_stands_still_or_is_no_number_ends_in_zero_force() {
    for dt in [0.0, -1e-3, f64::NAN, f64::INFINITY] {
        let (mut body, hardware) = pressing(true);
        let before = body.state().clone();
        let frozen = body.tick(dt);
        assert!(is_zero(&frozen) && frozen.flags.stale, "dt {dt}");
        assert_eq!(hardware.held_n(), 0.0, "dt {dt}: the device was told at once");
        let now = body.state();
        assert_eq!(
            (now.tick, now.time_s, now.input),
            (before.tick, before.time_s, before.input),
            "dt {dt}: nothing moved"
        );
        let next = body.tick(DT);
        assert!(is_zero(&next) && next.flags.stale);
        assert!(body.tick(DT).sent_force_n[0].norm() < 0.1, "and softly up again");
    }
}

/// A thread whose fingers press. Its watchdog is slow, so that a busy machine is no fault.
fn running(guarded: bool) -> (Servo, Arc<Hardware>) {
    let (device, hardware) = FaultyDevice::new(false, guarded);
    let limits = Limits { watchdog_s: WATCHDOG_S, ..limits() };
    let config = ServoConfig { limits, ..ServoConfig::at(1000.0) };
    let servo = Servo::start(Swap::new(presets::table()), Box::new(device), config).expect("a thread");
    assert!(until(|| hardware.held_n() > 0.5), "there is a force to lose");
    (servo, hardware)
}

const WATCHDOG_S: f64 = 0.4;

/// Waits until `done` or ten seconds have passed; the condition decides, not the time.
fn until(mut done: impl FnMut() -> bool) -> bool {
    let begun = Instant::now();
    while begun.elapsed() < Duration::from_secs(10) {
        if done() {
            return true;
        }
        std::thread::yield_now();
    }
    false
}

/// Runs a fault on a thread; the device's force must be zero within one watchdog time. A machine that takes the processor away
/// for that long gets two more chances.
fn ends_in_zero(fault: Fault, guarded: bool, said: impl Fn(&Snapshot) -> bool) -> (Servo, Arc<Hardware>) {
    let mut slow = Vec::new();
    for _ in 0..3 {
        let (mut servo, hardware) = running(guarded);
        hardware.begin(fault);
        assert!(until(|| hardware.held_n() == 0.0), "{fault:?}: the force is never zero");
        assert!(until(|| said(servo.newest())), "{fault:?}: nothing was said");
        // A late guard can set zero before the fault begins; the fault's own zero is the one that lasts.
        let mut took_s = None;
        assert!(until(|| hardware.took_s().inspect(|t| took_s = Some(*t)).is_some()), "{fault:?}: zero does not last");
        let took_s = took_s.expect("a time");
        if took_s <= WATCHDOG_S {
            return (servo, hardware);
        }
        slow.push(took_s);
        hardware.unblock.store(true, Ordering::Relaxed);
    }
    panic!("{fault:?}: zero only after {slow:?} s");
}

#[test]
fn a_panic_in_the_device_ends_in_zero_force_and_a_sentence() {
    // A processor that was taken away may be said first.
    let is_said = |s: &Snapshot| s.fault.is_some_and(|f| f.contains("internal fault"));
    let (servo, hardware) = ends_in_zero(Fault::Panics, false, is_said);
    assert!(until(|| !servo.is_running()));
    drop(servo);
    assert_eq!(hardware.held_n(), 0.0);
}

#[test]
fn a_driver_that_blocks_is_overruled_by_the_guard_and_can_be_left() {
    let (servo, hardware) = ends_in_zero(Fault::Blocks, true, |s| s.fault.is_some_and(|f| f.contains("stands still")));
    assert!(servo.guarded() >= 1);
    // The window can be closed while the driver hangs, and the last word is zero when it comes back.
    let left = Instant::now();
    drop(servo);
    assert!(left.elapsed() < Duration::from_secs(5), "closing waits for the driver");
    let exchanges = hardware.exchanges.load(Ordering::Relaxed);
    hardware.unblock.store(true, Ordering::Relaxed);
    assert!(until(|| Arc::strong_count(&hardware) == 1), "the threads end");
    assert_eq!(hardware.held_n(), 0.0);
    assert_eq!(hardware.exchanges.load(Ordering::Relaxed), exchanges, "nothing was sent after the stop");
}

#[test]
fn after_a_long_exchange_the_force_starts_from_zero_again() {
    let (mut servo, hardware) = running(true);
    let mut ticks = Vec::new();
    servo.drain(&mut ticks);
    ticks.clear();
    // The servo starts from zero because the guard says so, half a watchdog time after the last tick.
    hardware.begin(Fault::LongExchange);
    let mut stale = || {
        servo.drain(&mut ticks);
        ticks.iter().find(|t| t.flags.stale).copied()
    };
    assert!(until(|| stale().is_some()), "it is said");
    assert!(stale().is_some_and(|tick| is_zero(&tick)));
    assert!(servo.guarded() >= 1);
    assert!(until(|| hardware.held_n() > 0.5), "and the force comes back");
    assert!(until(|| servo.newest().timing.missed > 0), "the stall is counted");
    assert!(servo.newest().timing.stall_sentence().is_some());
}

#[test]
fn a_window_that_panics_takes_the_force_with_it() {
    let (servo, hardware) = running(false);
    let window = std::thread::spawn(move || {
        let _kept = servo;
        panic!("a bug in the window");
    });
    assert!(window.join().is_err());
    assert_eq!(hardware.held_n(), 0.0, "the handle was dropped: zero force");
    assert!(until(|| Arc::strong_count(&hardware) == 1), "and the threads ended");
}

#[test]
fn a_rate_that_is_no_longer_held_is_lowered_without_a_jump_and_said() {
    let (device, hardware) = FaultyDevice::new(false, false);
    // Nothing but the rate is to be seen here.
    let limits = Limits { watchdog_s: WATCHDOG_S, ..limits() };
    let config = ServoConfig { limits, ..ServoConfig::default() };
    let mut servo = Servo::start(Swap::new(presets::table()), Box::new(device), config).expect("a thread");
    assert!(until(|| hardware.held_n() > 0.5), "there is a force");
    let chosen = servo.newest().timing.rate;
    assert!(chosen.sentence().contains("self-test"), "{}", chosen.sentence());
    if chosen.rate_hz < FAST_HZ {
        // This machine does not hold the fast rate to begin with: that was said, and there is nothing to fall from.
        assert_eq!(chosen.rate_hz, SAFE_HZ);
        return;
    }
    hardware.begin(Fault::Slow);
    let mut ticks = Vec::new();
    assert!(until(|| {
        servo.drain(&mut ticks);
        servo.newest().timing.rate.rate_hz == SAFE_HZ
    }));
    assert!(servo.newest().timing.rate.sentence().contains("begun at 4000 Hz"));
    let lowered = ticks.len();
    assert!(until(|| {
        servo.drain(&mut ticks);
        ticks.len() > lowered + 300
    }));
    let step = |w: &[TickRecord]| w[1].time_s - w[0].time_s;
    assert!(ticks.windows(2).any(|w| (step(w) - 1.0 / SAFE_HZ).abs() < 1e-9), "the ticks are longer now");
    for w in ticks.windows(2).filter(|w| !w[1].flags.stale) {
        let change = (w[1].sent_force_n[0] - w[0].sent_force_n[0]).norm();
        assert!(change < 0.05, "a jump of {change} N");
    }
}
