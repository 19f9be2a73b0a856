//! Rate of the servo: measured at the start, watched while it runs, said in one sentence.
//!
//! Before the first tick the servo keeps the deadlines of the fast rate for [`TEST_S`], with the world's own step as the load
//! and no device. The machine holds the rate when 99 of 100 ticks start within [`LATE_SHARE`] of a period after their
//! deadline, the step takes no more than [`COMPUTE_SHARE`] of a period in 99 of 100 ticks, and no more than [`MISSED_SHARE`]
//! of the deadlines are missed altogether. Single long stalls do not decide: they hurt a slow servo just as much.

use super::clock::Deadlines;
use super::histogram::Histogram;
use crate::world::{State, World, step};
use std::time::{Duration, Instant};

/// The rate wanted where the machine holds it, Hz.
pub const FAST_HZ: f64 = 4000.0;
/// The rate that is run anywhere, Hz.
pub const SAFE_HZ: f64 = 1000.0;
/// Length of the self-test, s.
pub const TEST_S: f64 = 0.4;
/// Share of a period that 99 of 100 ticks may be late by.
pub const LATE_SHARE: f64 = 0.4;
/// Share of a period that 99 of 100 steps may take.
pub const COMPUTE_SHARE: f64 = 0.5;
/// Share of the deadlines that may be missed.
pub const MISSED_SHARE: f64 = 0.005;

/// Length of a window of the watch at run time, s.
const WINDOW_S: f64 = 1.0;
/// Share of missed deadlines that makes a window bad.
const BAD_SHARE: f64 = 0.05;
/// Bad windows in a row that are believed.
const BAD_WINDOWS: u32 = 3;
/// Good windows in a row after which an overload is over.
const GOOD_WINDOWS: u32 = 10;

/// Choice of the rate.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum RateChoice {
    /// [`FAST_HZ`] where a self-test at the start shows that the machine holds it, else [`SAFE_HZ`].
    #[default]
    Auto,
    /// This rate, Hz, 50 … 8000.
    Fixed(f64),
}

impl RateChoice {
    /// The rate before anything was measured, Hz: loops that run without a clock of their own stay at it.
    pub fn nominal_hz(self) -> f64 {
        match self {
            Self::Auto => SAFE_HZ,
            Self::Fixed(hz) => hz,
        }
    }

    /// The highest rate that may come of it, Hz.
    pub fn most_hz(self) -> f64 {
        match self {
            Self::Auto => FAST_HZ,
            Self::Fixed(hz) => hz,
        }
    }
}

/// What the self-test found.
#[derive(Clone, Copy, Debug, Default, PartialEq, schemars::JsonSchema, serde::Serialize)]
pub struct Trial {
    /// Rate that was tried, Hz.
    pub rate_hz: f64,
    /// 99 of 100 ticks started within this time after their deadline, s.
    pub late_p99_s: f64,
    /// 99 of 100 steps took no longer, s.
    pub compute_p99_s: f64,
    /// Share of the deadlines that were missed by more than a period.
    pub missed_share: f64,
}

impl Trial {
    /// True if the machine holds the rate.
    pub fn holds(&self) -> bool {
        self.late_p99_s <= LATE_SHARE / self.rate_hz
            && self.compute_p99_s <= COMPUTE_SHARE / self.rate_hz
            && self.missed_share <= MISSED_SHARE
    }
}

/// Why the servo runs at its rate.
#[derive(Clone, Copy, Debug, Default, PartialEq, schemars::JsonSchema, serde::Serialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum RateReason {
    /// It was asked for.
    #[default]
    Fixed,
    /// The self-test decided.
    Measured(Trial),
    /// Too many deadlines were missed while it ran at a higher rate.
    FellBack {
        /// Rate before, Hz.
        from_hz: f64,
        /// Share of the deadlines that were missed in the last window.
        missed_share: f64,
    },
}

/// The rate and how it came about.
#[derive(Clone, Copy, Debug, Default, PartialEq, schemars::JsonSchema, serde::Serialize)]
pub struct RateReport {
    /// Ticks a second.
    pub rate_hz: f64,
    /// Why.
    pub reason: RateReason,
    /// True when the machine does not hold even this rate.
    pub overloaded: bool,
}

impl RateReport {
    /// The choice and its reason in one sentence for people, and a second one when the machine does not keep up.
    pub fn sentence(&self) -> String {
        // Rounded up: "less than" must be true.
        let micro = |seconds: f64| (seconds * 1e6).ceil().max(1.0);
        let hz = self.rate_hz;
        let mut text = match self.reason {
            RateReason::Fixed => format!("{hz:.0} Hz, as asked for."),
            RateReason::Measured(t) => format!(
                "{hz:.0} Hz: in a self-test at {:.0} Hz 99 of 100 ticks were late by less than {:.0}\u{a0}µs, worked for less than \
                 {:.0}\u{a0}µs, and {:.1}\u{a0}% of the deadlines were missed.",
                t.rate_hz,
                micro(t.late_p99_s),
                micro(t.compute_p99_s),
                100.0 * t.missed_share
            ),
            RateReason::FellBack { from_hz, missed_share } => format!(
                "{hz:.0} Hz: it had begun at {from_hz:.0} Hz and missed {:.0} % of the deadlines there.",
                100.0 * missed_share
            ),
        };
        if self.overloaded {
            text.push_str(" The machine does not hold this rate; close other programs or choose a lower one.");
        }
        text
    }
}

/// Tries the fast rate with the world's step as the load. Runs on the servo's thread before its first tick; allocates nothing.
pub(super) fn choose(choice: RateChoice, world: &World, scratch: &mut State) -> RateReport {
    match choice {
        RateChoice::Fixed(rate_hz) => RateReport { rate_hz, ..RateReport::default() },
        RateChoice::Auto => {
            let trial = measure(FAST_HZ, world, scratch);
            let rate_hz = if trial.holds() { FAST_HZ } else { SAFE_HZ };
            RateReport { rate_hz, reason: RateReason::Measured(trial), overloaded: false }
        }
    }
}

fn measure(rate_hz: f64, world: &World, scratch: &mut State) -> Trial {
    let period_s = 1.0 / rate_hz;
    let mut deadlines = Deadlines::new(Duration::from_secs_f64(period_s));
    let (mut lateness, mut compute) = (Histogram::default(), Histogram::default());
    let ticks = (TEST_S * rate_hz) as u32;
    let mut missed = 0_u32;
    let begun = Instant::now();
    let mut done = 0_u32;
    // On a machine that misses everything the test still ends in time.
    while done < ticks && begun.elapsed().as_secs_f64() < 2.0 * TEST_S {
        let (late_s, overrun) = deadlines.wait();
        let started = Instant::now();
        let input = scratch.input;
        step(world, scratch, &input, period_s);
        lateness.add(late_s);
        compute.add(started.elapsed().as_secs_f64());
        missed += u32::from(overrun);
        done += 1;
    }
    Trial {
        rate_hz,
        late_p99_s: lateness.percentile_s(0.99),
        compute_p99_s: compute.percentile_s(0.99),
        missed_share: f64::from(missed) / f64::from(done.max(1)),
    }
}

/// Watches the missed deadlines of a running servo.
#[derive(Clone, Copy, Debug, Default)]
pub struct Watch {
    passed_s: f64,
    ticks: u32,
    missed: u32,
    bad: u32,
    good: u32,
}

/// Verdict of the watch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Verdict {
    /// Too many deadlines were missed for three windows of a second in a row; the share in the last one.
    Overloaded(f64),
    /// None of the last ten windows was bad.
    Recovered,
}

impl Watch {
    /// Counts one tick that began `interval_s` after the one before; a verdict when the time has come for one.
    pub fn add(&mut self, missed: bool, interval_s: f64) -> Option<Verdict> {
        self.passed_s += interval_s;
        self.ticks += 1;
        self.missed += u32::from(missed);
        if self.passed_s < WINDOW_S {
            return None;
        }
        let share = f64::from(self.missed) / f64::from(self.ticks);
        (self.bad, self.good) = if share > BAD_SHARE { (self.bad + 1, 0) } else { (0, self.good + 1) };
        (self.passed_s, self.ticks, self.missed) = (0.0, 0, 0);
        if self.bad >= BAD_WINDOWS {
            self.bad = 0;
            return Some(Verdict::Overloaded(share));
        }
        if self.good >= GOOD_WINDOWS {
            self.good = 0;
            return Some(Verdict::Recovered);
        }
        None
    }
}

/// The report after a verdict. A rate that was lowered stays low: up and down again would be felt.
pub(super) fn judge(choice: RateChoice, report: RateReport, verdict: Verdict) -> RateReport {
    match verdict {
        Verdict::Overloaded(share) => degrade(choice, report, share),
        Verdict::Recovered => RateReport { overloaded: false, ..report },
    }
}

/// Report after too many missed deadlines: down to [`SAFE_HZ`] if the rate was the servo's own choice, else only marked
/// as overloaded.
fn degrade(choice: RateChoice, report: RateReport, missed_share: f64) -> RateReport {
    if choice == RateChoice::Auto && report.rate_hz > SAFE_HZ {
        let reason = RateReason::FellBack { from_hz: report.rate_hz, missed_share };
        return RateReport { rate_hz: SAFE_HZ, reason, overloaded: false };
    }
    RateReport { overloaded: true, ..report }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::presets;

    #[test]
    fn the_criterion_is_what_it_says() {
        let good = Trial { rate_hz: 4000.0, late_p99_s: 90e-6, compute_p99_s: 20e-6, missed_share: 0.004 };
        assert!(good.holds());
        assert!(!Trial { late_p99_s: 110e-6, ..good }.holds());
        assert!(!Trial { compute_p99_s: 130e-6, ..good }.holds());
        assert!(!Trial { missed_share: 0.01, ..good }.holds());
    }

    #[test]
    fn a_self_test_measures_and_a_fixed_rate_is_not_tested() {
        let world = presets::stacking();
        let mut state = State::resting(&world);
        let report = choose(RateChoice::Auto, &world, &mut state);
        let RateReason::Measured(trial) = report.reason else { panic!("not measured: {report:?}") };
        assert_eq!(report.rate_hz == FAST_HZ, trial.holds());
        assert!(trial.late_p99_s > 0.0 && trial.compute_p99_s > 0.0 && state.tick > 100);
        assert!(report.sentence().contains("self-test at 4000 Hz"), "{}", report.sentence());
        let fixed = choose(RateChoice::Fixed(500.0), &world, &mut state);
        assert_eq!(fixed.sentence(), "500 Hz, as asked for.");
    }

    #[test]
    fn many_misses_over_seconds_lower_a_chosen_rate_and_only_blame_a_fixed_one() {
        let mut watch = Watch::default();
        let mut verdicts = Vec::new();
        // A bad second, a good one, then four bad ones.
        for tick in 0..6 * 4096_u32 {
            let bad = !(4096..8192).contains(&tick);
            verdicts.extend(watch.add(bad && tick.is_multiple_of(10), 1.0 / 4096.0).map(|verdict| (tick, verdict)));
        }
        let [(tick, Verdict::Overloaded(share))] = verdicts[..] else { panic!("{verdicts:?}") };
        assert!(tick == 5 * 4096 - 1 && (share - 0.1).abs() < 1e-3, "{verdicts:?}");
        let fast = RateReport { rate_hz: FAST_HZ, ..RateReport::default() };
        let slower = degrade(RateChoice::Auto, fast, share);
        assert_eq!(slower.rate_hz, SAFE_HZ);
        assert!(slower.sentence().contains("begun at 4000 Hz and missed 10 %"), "{}", slower.sentence());
        assert!(degrade(RateChoice::Auto, slower, share).overloaded, "there is nothing below");
        let fixed = degrade(RateChoice::Fixed(4000.0), fast, share);
        assert!(fixed.rate_hz == FAST_HZ && fixed.sentence().contains("does not hold"), "{}", fixed.sentence());
    }

    #[test]
    fn an_overload_that_is_over_is_no_longer_blamed_and_a_lowered_rate_stays() {
        let (mut watch, mut report) = (Watch::default(), RateReport { rate_hz: 4096.0, ..RateReport::default() });
        let mut second = |bad: bool, report: &mut RateReport| {
            for tick in 0..4096_u32 {
                if let Some(verdict) = watch.add(bad && tick.is_multiple_of(10), 1.0 / 4096.0) {
                    *report = judge(RateChoice::Fixed(4096.0), *report, verdict);
                }
            }
        };
        (0..3).for_each(|_| second(true, &mut report));
        assert!(report.overloaded && report.sentence().contains("close other programs"));
        (0..9).for_each(|_| second(false, &mut report));
        assert!(report.overloaded, "nine good seconds are not yet believed");
        second(false, &mut report);
        assert!(!report.overloaded && report.rate_hz == 4096.0);
        let fast = RateReport { rate_hz: FAST_HZ, ..RateReport::default() };
        let lowered = judge(RateChoice::Auto, fast, Verdict::Overloaded(0.2));
        assert_eq!(judge(RateChoice::Auto, lowered, Verdict::Recovered), lowered);
    }
}
