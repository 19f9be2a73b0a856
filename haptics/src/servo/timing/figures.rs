//! The figures of the servo's timing: what one tick took, and the summary since the start and of the last seconds.

use crate::servo::histogram::Percentiles;
use crate::servo::rate::RateReport;

/// Length of the recent past, s.
pub const RECENT_S: f64 = 10.0;
/// A tick that starts so late, or works so long, is a stall of its own and named, s.
pub const STALL_S: f64 = 1e-3;

/// How punctual the servo was in a stretch of time.
#[derive(Clone, Copy, Debug, Default, PartialEq, schemars::JsonSchema, serde::Serialize)]
pub struct Figures {
    /// Length of the stretch, s: what has passed, up to [`RECENT_S`].
    pub seconds: f64,
    /// Ticks in it.
    pub ticks: u64,
    /// Time from the start of one tick to the start of the next.
    pub period: Percentiles,
    /// How late the ticks started after their deadline.
    pub lateness: Percentiles,
    /// How long reading, stepping and writing took.
    pub compute: Percentiles,
    /// How old the sample was that a force was computed from; see [`Timing::force_age`].
    pub force_age: Percentiles,
    /// Deadlines missed by more than a period.
    pub missed: u64,
    /// Single ticks that came or took longer than [`STALL_S`].
    pub stalls: u64,
    /// The longest of them, s.
    pub longest_stall_s: f64,
}

/// What the servo knows about its own timing, since the start unless it says otherwise.
#[derive(Clone, Copy, Debug, Default, PartialEq, schemars::JsonSchema, serde::Serialize)]
pub struct Timing {
    /// Ticks since the start, or since the rate changed.
    pub ticks: u64,
    /// Wanted period, s.
    pub period_s: f64,
    /// The rate and why it is that.
    pub rate: RateReport,
    /// Time from the start of one tick to the start of the next.
    pub period: Percentiles,
    /// How late the ticks start after their deadline.
    pub lateness: Percentiles,
    /// How long reading, stepping and writing take.
    pub compute: Percentiles,
    /// How old the sample is that a force was computed from, at the moment when the device gets the force. While the force is
    /// zero because no fresh sample came there is none.
    pub force_age: Percentiles,
    /// Deadlines missed by more than a period: the schedule was re-anchored, no tick was made up for.
    pub missed: u64,
    /// Single ticks that came or took longer than [`STALL_S`].
    pub stalls: u64,
    /// The longest of them, s.
    pub longest_stall_s: f64,
    /// Age of the newest device sample, s.
    pub sample_age_s: f64,
    /// The same figures for the last [`RECENT_S`].
    pub recent: Figures,
}

impl Timing {
    /// Before the first tick at a rate.
    pub fn starting(rate: RateReport) -> Self {
        Self { period_s: 1.0 / rate.rate_hz, rate, ..Self::default() }
    }

    /// One sentence about the stalls; `None` without any.
    pub fn stall_sentence(&self) -> Option<String> {
        if self.stalls == 0 {
            return None;
        }
        let longest_ms = 1e3 * self.longest_stall_s;
        // One in a thousand is a habit.
        let often = self.stalls * 1000 > self.ticks;
        let which = if often {
            format!("{} stalls of up to {longest_ms:.1} ms", self.stalls)
        } else if self.stalls == 1 {
            format!("A single stall of {longest_ms:.1} ms")
        } else {
            format!("{} single stalls of up to {longest_ms:.1} ms", self.stalls)
        };
        let why = if self.compute.p50_s > 0.5 * self.period_s {
            "this world needs more than half of every period"
        } else if often {
            "the machine is busy with other work"
        } else {
            "the machine took the processor away"
        };
        Some(format!("{which}: {why}."))
    }
}

/// Timing of one tick.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TickTiming {
    /// Start after the deadline, s.
    pub lateness_s: f64,
    /// Time since the start of the tick before, s; absent for the first.
    pub interval_s: Option<f64>,
    /// Reading, stepping, writing, s.
    pub compute_s: f64,
    /// True if the deadline was missed by more than a period.
    pub missed: bool,
    /// Age of the newest sample when the force was computed, s; before the first the time since the start.
    pub sample_age_s: f64,
    /// True if a force was computed from that sample. False before the first sample, and while the force is zero
    /// because the samples are stale: an operator who waits for a device has no old force.
    pub has_force: bool,
}
