//! Body of the servo's thread.

use super::clock::Deadlines;
use super::config::ServoConfig;
use super::control_loop::{Loop, Snapshot, TickRecord};
use super::force_test::Request;
use super::guard::Beat;
use super::rate::{self, RateReport, Watch};
use super::realtime::acquire;
use super::swap::Swap;
use super::tap::TapFiller;
use super::timing::{TickTiming, Timing, TimingCollector};
use crate::world::State;
use rtrb::{Consumer, Producer};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU8, Ordering};
use std::time::{Duration, Instant};
use triple_buffer::Input;

/// Percentiles are made this often, s.
const SUMMARY_S: f64 = 0.25;

/// Shown when the tick panicked.
const INTERNAL_FAULT: &str = "The servo met an internal fault and stopped; the force is zero.";

/// Everything that moves into the servo's thread.
pub(super) struct Runner {
    pub body: Loop,
    pub snapshot: Input<Snapshot>,
    pub ticks: Producer<TickRecord>,
    pub tap: TapFiller,
    pub swaps: Consumer<Box<Swap>>,
    pub retired: Producer<Box<Swap>>,
    pub stop: Arc<AtomicBool>,
    pub granted: Arc<AtomicU8>,
    pub beat: Arc<Beat>,
    pub test: Arc<Request>,
    pub hold: Arc<AtomicBool>,
    pub config: ServoConfig,
    pub summary: Timing,
    pub rate: RateReport,
}

impl Runner {
    /// Privileges, rate, ticks until told to stop; then zero force, whatever happened. `scratch` is a copy of the state for the
    /// self-test.
    pub fn run(mut self, mut scratch: State) {
        if self.config.real_time {
            let granted = acquire();
            let bits = u8::from(granted.fifo) | (u8::from(granted.memory_locked) << 1) | (u8::from(granted.asked) << 2);
            self.granted.store(bits, Ordering::Relaxed);
        }
        // A panic in the tick would be a bug; it must still end in zero force and be said.
        let ended = catch_unwind(AssertUnwindSafe(|| {
            self.rate = rate::choose(self.config.rate, self.body.world(), &mut scratch);
            self.tick_until_stopped();
        }));
        let safe = catch_unwind(AssertUnwindSafe(|| self.body.make_safe()));
        self.beat.finish();
        if ended.is_err() || safe.is_err() {
            self.publish(TickRecord::default(), Some(INTERNAL_FAULT));
        }
        // A device may panic in its destructor too; nothing is left to be told then.
        let body = self.body;
        let _ = catch_unwind(AssertUnwindSafe(move || drop(body)));
    }

    fn tick_until_stopped(&mut self) {
        let mut period_s = 1.0 / self.rate.rate_hz;
        let mut deadlines = Deadlines::new(Duration::from_secs_f64(period_s));
        let mut collector = TimingCollector::default();
        let mut watch = Watch::default();
        let mut before: Option<Instant> = None;
        let mut until_summary = 0_u32;
        self.summary = Timing::starting(self.rate);
        while !self.stop.load(Ordering::Relaxed) {
            let (lateness_s, missed) = deadlines.wait();
            let started = Instant::now();
            let interval_s = before.map(|b| (started - b).as_secs_f64());
            before = Some(started);
            let stood_still = interval_s.is_some_and(|s| s > self.config.limits.watchdog_s);
            if self.beat.tick() || stood_still {
                self.body.interrupted();
            }
            self.take_swap();
            self.body.test_force(self.test.get());
            self.body.hold(self.hold.load(Ordering::Relaxed));
            let tick = self.body.tick(period_s);
            // A world that is held still has no time to be recorded.
            if !self.body.is_held() {
                // A full ring means that no picture is drawn: the newest ticks are dropped, the servo continues.
                let _ = self.ticks.push(tick);
                self.tap.offer(tick);
            }
            let compute_s = started.elapsed().as_secs_f64();
            let sample_age_s = self.body.sample_age_s();
            let has_force = self.body.has_met_both() && !tick.flags.stale;
            collector.add(&TickTiming { lateness_s, interval_s, compute_s, missed, sample_age_s, has_force });
            if let Some(verdict) = watch.add(missed, interval_s.unwrap_or(period_s)) {
                self.rate = rate::judge(self.config.rate, self.rate, verdict);
                if period_s != 1.0 / self.rate.rate_hz {
                    period_s = 1.0 / self.rate.rate_hz;
                    deadlines = Deadlines::new(Duration::from_secs_f64(period_s));
                    collector = TimingCollector::default();
                    before = None;
                }
                until_summary = 0;
            }
            if until_summary == 0 {
                self.summary = collector.summary(self.rate);
                until_summary = (SUMMARY_S * self.rate.rate_hz) as u32;
            }
            until_summary -= 1;
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
        buffer.coupling = self.body.coupling();
        buffer.delay_s = self.body.delay_s();
        buffer.line_n_m = self.body.line_stiffness_n_m();
        buffer.finished = self.body.finished();
        buffer.fault = fault;
        self.snapshot.publish();
    }
}
