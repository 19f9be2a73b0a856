//! A second thread that watches the servo: when a tick does not come back, it makes the device safe.
//!
//! A driver that blocks inside `exchange`, or a machine that takes the processor away, leaves the device with the last
//! force. The servo cannot help itself then. The guard can, through [`crate::device::Device::guard`]: within half of
//! the watchdog's time it orders zero force by a way of its own, as long as the servo stands still. Devices that run a
//! thread of their own (the Haply boards) guard themselves and provide none.

use super::realtime::raise_guard;
use crate::device::ForceGuard;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::{Duration, Instant};

/// A standstill as long as this is told to the user, s; shorter ones are counted as stalls.
pub const FAULT_AFTER_S: f64 = 0.1;

/// The servo's pulse, between its thread, the guard and the handle.
#[derive(Debug, Default)]
pub(super) struct Beat {
    ticks: AtomicU64,
    fired: AtomicBool,
    finished: AtomicBool,
    /// Time for which the servo has stood still, ns; zero while it runs.
    still_ns: AtomicU64,
    guarded: AtomicU64,
}

impl Beat {
    /// The servo: another tick begins. True when the guard has acted since the last one.
    pub fn tick(&self) -> bool {
        self.ticks.fetch_add(1, Ordering::Relaxed);
        self.fired.swap(false, Ordering::Relaxed)
    }

    /// The servo: no tick will follow.
    pub fn finish(&self) {
        self.finished.store(true, Ordering::Release);
    }

    /// Time for which the servo has stood still, s.
    pub fn standing_still_s(&self) -> f64 {
        self.still_ns.load(Ordering::Relaxed) as f64 * 1e-9
    }

    /// Number of times that the guard acted.
    pub fn guarded(&self) -> u64 {
        self.guarded.load(Ordering::Relaxed)
    }
}

/// The guard's thread: until the servo has finished.
pub(super) fn watch(beat: &Beat, mut guard: Option<ForceGuard>, watchdog_s: f64, real_time: bool) {
    if real_time {
        raise_guard();
    }
    let watchdog_s = watchdog_s.clamp(1e-3, 10.0);
    let (patience, pause) = (Duration::from_secs_f64(0.5 * watchdog_s), Duration::from_secs_f64(0.125 * watchdog_s));
    let (mut seen, mut seen_at) = (0, Instant::now());
    while !beat.finished.load(Ordering::Acquire) {
        // A watch looks at intervals; there is nothing to be woken by.
        std::thread::sleep(pause);
        let ticks = beat.ticks.load(Ordering::Relaxed);
        if ticks != seen {
            (seen, seen_at) = (ticks, Instant::now());
            beat.still_ns.store(0, Ordering::Relaxed);
        } else if ticks > 0 && seen_at.elapsed() > patience {
            let first = beat.still_ns.swap(seen_at.elapsed().as_nanos() as u64, Ordering::Relaxed) == 0;
            beat.guarded.fetch_add(u64::from(first), Ordering::Relaxed);
            beat.fired.store(true, Ordering::Relaxed);
            make_safe(&mut guard);
        }
    }
    beat.still_ns.store(0, Ordering::Relaxed);
    // The servo has said zero; should its last word have been lost in a panic, this one is not.
    make_safe(&mut guard);
}

fn make_safe(guard: &mut Option<ForceGuard>) {
    if let Some(zero_force) = guard {
        // A guard that panics is not asked again; the servo's own thread still makes the device safe.
        if catch_unwind(AssertUnwindSafe(zero_force)).is_err() {
            *guard = None;
        }
    }
}
