//! Timing limits of a servo rate, and the violations on this machine.
//!
//! At 4 kHz 99 of 100 ticks may start 50 µs late and 999 of 1000 may start 250 µs late, a fifth of a period and a whole
//! one. Other rates have the same shares of their period. In addition, a tick must leave half of its period free.

use crate::text::format::short_time;
use haptics::servo::rate::{COMPUTE_SHARE, MISSED_SHARE};
use haptics::servo::timing::Timing;
use schemars::JsonSchema;
use serde::Serialize;

/// Lateness limit for 99 of 100 ticks, as a share of the period: 50 µs at 4 kHz.
pub const LATE_P99: f64 = 0.2;
/// Lateness limit for 999 of 1000 ticks, as a share of the period: 250 µs at 4 kHz.
pub const LATE_P999: f64 = 1.0;

/// Limit with its measured value.
pub struct Limit {
    name: &'static str,
    what: &'static str,
    measured: f64,
    most: f64,
    is_time: bool,
}

/// The same for programs.
#[derive(JsonSchema, Serialize)]
pub struct Held {
    /// Its name.
    limit: &'static str,
    /// What may be: times in s, the missed deadlines as a share.
    most: f64,
    /// What was.
    measured: f64,
    /// Whether it is kept.
    holds: bool,
}

impl From<&Limit> for Held {
    fn from(limit: &Limit) -> Self {
        Self { limit: limit.name, most: limit.most, measured: limit.measured, holds: limit.is_kept() }
    }
}

/// All limits of a rate.
pub fn limits(t: &Timing) -> [Limit; 4] {
    let time = |name, what, measured, share: f64| {
        let most = share * t.period_s;
        Limit { name, what, measured, most, is_time: true }
    };
    let missed = t.missed as f64 / t.ticks.max(1) as f64;
    [
        time("lateness-p99", "lateness p99", t.lateness.p99_s, LATE_P99),
        time("lateness-p99.9", "lateness p99.9", t.lateness.p999_s, LATE_P999),
        time("compute-p99", "compute p99", t.compute.p99_s, COMPUTE_SHARE),
        Limit { name: "missed", what: "missed deadlines", measured: missed, most: MISSED_SHARE, is_time: false },
    ]
}

impl Limit {
    /// True if the limit is met.
    pub fn is_kept(&self) -> bool {
        self.measured <= self.most
    }

    /// `lateness p99 is 83 µs: 33 µs above the limit of 50 µs`.
    fn broken_words(&self) -> String {
        let over = self.measured - self.most;
        let words = |value: f64| if self.is_time { short_time(value) } else { format!("{:.2} %", 100.0 * value) };
        let verb = if self.is_time { "is" } else { "are" };
        format!(
            "{} {verb} {}: {} above the limit of {}",
            self.what,
            words(self.measured),
            words(over),
            words(self.most)
        )
    }

    fn kept_words(&self) -> String {
        format!("{} ≤ {}", self.what, short_time(self.most))
    }
}

/// One sentence: held, with the limits of the lateness, or not, with every violated limit.
pub fn sentence(limits: &[Limit]) -> String {
    let broken: Vec<String> = limits.iter().filter(|l| !l.is_kept()).map(Limit::broken_words).collect();
    if broken.is_empty() {
        let kept: Vec<String> =
            limits.iter().filter(|l| l.name.starts_with("lateness")).map(Limit::kept_words).collect();
        return format!("The machine holds this rate: {}.", kept.join(", "));
    }
    format!("The machine does not hold this rate: {}.", broken.join("; "))
}

#[cfg(test)]
mod tests {
    use super::*;
    use haptics::servo::Percentiles;

    fn timing(rate_hz: f64, p99_s: f64, p999_s: f64) -> Timing {
        let lateness = Percentiles { p99_s, p999_s, ..Percentiles::default() };
        Timing { period_s: 1.0 / rate_hz, ticks: 1000, lateness, ..Timing::default() }
    }

    fn holds(timing: &Timing) -> bool {
        limits(timing).iter().all(Limit::is_kept)
    }

    #[test]
    fn four_kilohertz_are_held_up_to_50_and_250_microseconds() {
        for (p99_us, p999_us, wanted) in
            [(49.0, 249.0, true), (51.0, 249.0, false), (49.0, 251.0, false), (99.0, 100.0, false)]
        {
            let timing = timing(4000.0, 1e-6 * p99_us, 1e-6 * p999_us);
            assert_eq!(holds(&timing), wanted, "{p99_us} and {p999_us} µs");
        }
        assert!(holds(&timing(1000.0, 190e-6, 900e-6)) && !holds(&timing(1000.0, 210e-6, 900e-6)));
    }

    #[test]
    fn a_broken_limit_is_named_with_how_much_it_is_broken_by() {
        let said = |timing: &Timing| sentence(&limits(timing));
        assert_eq!(
            said(&timing(4000.0, 40e-6, 90e-6)),
            "The machine holds this rate: lateness p99 ≤ 50.0 µs, lateness p99.9 ≤ 250 µs."
        );
        assert_eq!(
            said(&timing(4000.0, 83e-6, 90e-6)),
            "The machine does not hold this rate: lateness p99 is 83.0 µs: 33.0 µs above the limit of 50.0 µs."
        );
        let mut worse = timing(4000.0, 83e-6, 300e-6);
        (worse.compute.p99_s, worse.missed) = (200e-6, 20);
        let text = said(&worse);
        for part in ["lateness p99 ", "lateness p99.9", "compute p99 is", "missed deadlines are 2.00 %: 1.50 % above"] {
            assert!(text.contains(part), "{part}: {text}");
        }
    }
}
