//! Rates that a file states beside its rows: `Fs = 200`, `Sampling interval: 5 ms`. They are suggested, for other rates may be meant.

use crate::units::Dimension;
use crate::written_units::{Written, parse};
use haptics::recording::Warning;
use serde_json::json;

/// Kind of the warning.
pub const STATED_RATE: &str = "stated-rate";
/// Words for a rate, and words for a period.
const RATES: [&str; 11] = [
    "fs",
    "sample rate",
    "samplerate",
    "sample_rate",
    "sampling rate",
    "sampling frequency",
    "sample frequency",
    "frame rate",
    "data rate",
    "scan rate",
    "rate_hz",
];
const PERIODS: [&str; 13] = [
    "sampling interval",
    "sample interval",
    "sampling period",
    "sample period",
    "sample time",
    "time step",
    "timestep",
    "delta_t",
    "delta t",
    "dt",
    "wf_increment",
    "isi",
    "interval",
];
/// Rates that are meant, Hz.
const HZ: std::ops::RangeInclusive<f64> = 0.1..=1e6;

/// The rate that a line states, Hz: a word for a rate or a period, a number, and a unit behind the number or the word.
pub fn of_line(line: &str) -> Option<f64> {
    let lower = line.to_lowercase();
    let behind = |word: &&str| {
        let at = lower.find(*word)?;
        let is_apart = |c: Option<char>| c.is_none_or(|c| !c.is_alphanumeric());
        let rest = &lower[at + word.len()..];
        (is_apart(lower[..at].chars().next_back()) && is_apart(rest.chars().next())).then_some(rest)
    };
    let (rest, is_period) = match RATES.iter().find_map(behind) {
        Some(rest) => (rest, false),
        None => (PERIODS.iter().find_map(behind)?, true),
    };
    let first = rest.find(|c: char| c.is_ascii_digit())?;
    let between = rest[..first].trim_matches(|c: char| !c.is_alphanumeric());
    let length =
        rest[first..].find(|c: char| !(c.is_ascii_digit() || "+-.e".contains(c))).unwrap_or(rest.len() - first);
    let (number, behind) = rest[first..].split_at(length);
    // `5e` of `5 E`, and the point of a sentence.
    let number: f64 = number.trim_end_matches(['e', '.', '-', '+']).parse().ok()?;
    let unit =
        behind.trim_matches(|c: char| !c.is_alphanumeric()).split([' ', ',', ';', '\t']).next().unwrap_or_default();
    let unit = if between.is_empty() { unit } else { between };
    let rate_hz = if is_period { 1.0 / (number * seconds(unit)?) } else { number * hertz(unit)? };
    HZ.contains(&rate_hz).then_some(rate_hz)
}

/// Length of a unit of time, s; seconds without one.
fn seconds(unit: &str) -> Option<f64> {
    match parse(unit, &[Dimension::Time]) {
        _ if unit.is_empty() => Some(1.0),
        Written::Known(Dimension::Time, factor) => Some(factor),
        _ => None,
    }
}

fn hertz(unit: &str) -> Option<f64> {
    match unit {
        "" | "hz" | "fps" | "sps" | "s/s" | "samples/s" | "1/s" => Some(1.0),
        "khz" => Some(1e3),
        _ => None,
    }
}

/// Doubt about a log without a clock whose file states a rate.
pub fn doubt(text: &str, rate_hz: f64) -> Warning {
    let text = format!(
        "the file states `{}`: if its rows come at {rate_hz} Hz, state \"rate_hz\": {rate_hz} in the sidecar",
        text.trim()
    );
    let suggested = json!({ "rate_hz": rate_hz }).as_object().cloned();
    Warning { kind: STATED_RATE.to_owned(), text, suggested, ..Warning::default() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rates_and_periods_are_read_with_their_units() {
        for (line, rate_hz) in [
            ("Fs = 200", Some(200.0)),
            ("\"Sampling interval\",\"5ms\"", Some(200.0)),
            ("Sample Rate (Hz): 1000.0", Some(1000.0)),
            ("# Sampling rate;2,kHz", Some(2000.0)),
            ("# sampling rate: 2 kHz", Some(2000.0)),
            ("wf_increment\t0.005", Some(200.0)),
            ("Export Frame Rate,120.000000", Some(120.0)),
            ("isi_ms = 5", Some(200.0)),
            ("dt [ms] 5", Some(200.0)),
            ("Delta_X 0.001", None),
            ("width 5, 12", None),
            ("interval 20 mm", None),
        ] {
            let found = of_line(line);
            assert!(
                found.zip(rate_hz).map_or(found == rate_hz, |(a, b)| (a / b - 1.0).abs() < 1e-9),
                "{line}: {found:?}"
            );
        }
    }
}
