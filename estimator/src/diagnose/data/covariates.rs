//! Covariates: slowly changing channels beside motion and force (a temperature, a voltage) that may affect friction or
//! the force sensor.

use foundation::signal::interpolation::cubic;
use haptics::recording::Recording;
use logs::units::{is_program_name, split};

/// Time over which the changes of a slow channel are measured, s.
/// Choice: halved or doubled, none of 48 answers changes.
const SLOW_S: f64 = 1.0;
/// Largest ratio of the change over that time to the total spread (both RMS) of a slow channel. A faster channel
/// follows the motion itself and is no candidate.
/// Choice: no case of the ablation reads it.
const SLOW_SHARE: f64 = 0.6;
/// Names of channels for user annotations.
const MARKS: [&str; 3] = ["trial", "label", "state"];
/// Quantities of motion, force and time.
const FURTHER: [&str; 19] =
    ["f", "fx", "fy", "fz", "tau", "q", "qb", "qt", "dq", "dqb", "dqt", "x", "y", "z", "v", "vx", "vy", "vz", "t"];

/// A slow channel of one recording.
#[derive(Clone, Debug, PartialEq)]
pub struct Extra {
    /// Name in the recording, for example `temperature_degC`.
    pub name: String,
    /// Unit by its name.
    pub unit: String,
    time_s: Vec<f64>,
    values: Vec<f64>,
}

impl Extra {
    /// Value at this time after the recording's start, s.
    pub fn at(&self, time_s: f64) -> f64 {
        let last_s = self.time_s[self.time_s.len() - 1];
        cubic(&self.time_s, &self.values, time_s.clamp(self.time_s[0], last_s))
    }
}

/// The slow channels of a recording, without their noise.
pub fn of(recording: &Recording) -> Vec<Extra> {
    let Some(time_s) = recording.time_s.as_ref().filter(|t| t.len() > 2) else { return Vec::new() };
    let start_s = time_s[0];
    let span_s = time_s[time_s.len() - 1] - start_s;
    // No more than samples, however far the clock runs.
    let bins = ((span_s / (0.5 * SLOW_S)).floor() as usize).min(time_s.len());
    if bins < 8 {
        return Vec::new();
    }
    let bin_s = span_s / bins as f64;
    let extra = |channel: &haptics::recording::Channel| {
        let is_whole = channel.values.iter().filter(|v| v.is_finite()).all(|v| v.fract() == 0.0);
        let unit = split(&channel.name).map_or_else(|| channel.unit.clone(), |(_, unit)| unit.symbol.to_owned());
        // Whole numbers without a unit count or name something.
        let mark = MARKS.iter().any(|mark| channel.name.starts_with(mark)) || is_whole && unit.is_empty();
        // `fx_human_N`, `q_out_rad` are further forces and motions.
        let quantity = channel.name.split('_').next()?.trim_end_matches(|c: char| c.is_ascii_digit());
        let further = FURTHER.contains(&quantity);
        if mark || further || is_program_name(&channel.name) || channel.values.len() != time_s.len() {
            return None;
        }
        let (mut sums, mut counts) = (vec![0.0; bins], vec![0.0_f64; bins]);
        for (value, time) in channel.values.iter().zip(time_s).filter(|(v, _)| v.is_finite()) {
            let bin = (((time - start_s) / bin_s) as usize).min(bins - 1);
            sums[bin] += value;
            counts[bin] += 1.0;
        }
        let seen: Vec<usize> = (0..bins).filter(|b| counts[*b] > 0.0).collect();
        let values: Vec<f64> = seen.iter().map(|b| sums[*b] / counts[*b]).collect();
        let time_s: Vec<f64> = seen.iter().map(|b| (*b as f64 + 0.5) * bin_s).collect();
        is_slow(&values).then(|| {
            let values = at_centres(&time_s, &values, bin_s);
            Extra { name: channel.name.clone(), unit, time_s, values }
        })
    };
    recording.channels.iter().filter_map(extra).collect()
}

/// Values at the centres of bins from the means over bins of `bin_s`: a mean lies above its centre by `f″ bin_s²/24`.
/// Without it, a wave of 6 s lost 1.3 % of its amplitude, and the force that follows it came out as much too large.
fn at_centres(time_s: &[f64], means: &[f64], bin_s: f64) -> Vec<f64> {
    let mut values = means.to_vec();
    for k in 1..means.len().saturating_sub(1) {
        if time_s[k + 1] - time_s[k - 1] < 2.5 * bin_s {
            values[k] -= (means[k + 1] - 2.0 * means[k] + means[k - 1]) / 24.0;
        }
    }
    values
}

/// True if the RMS change between neighbours is small relative to the spread.
fn is_slow(values: &[f64]) -> bool {
    let n = values.len() as f64;
    if values.len() < 8 {
        return false;
    }
    let mean = values.iter().sum::<f64>() / n;
    let spread = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / n;
    let steps = values.windows(2).map(|w| (w[1] - w[0]).powi(2)).sum::<f64>() / (n - 1.0);
    spread > 1e-18 * (1.0 + mean * mean) && steps < (SLOW_SHARE * SLOW_SHARE) * spread
}

#[cfg(test)]
mod tests {
    use super::*;
    use haptics::recording::Channel;

    fn recording(channels: &[(&str, &dyn Fn(f64) -> f64)]) -> Recording {
        let time_s: Vec<f64> = (0..4000).map(|k| 100.0 + 0.01 * f64::from(k)).collect();
        let channel = |(name, of): &(&str, &dyn Fn(f64) -> f64)| Channel {
            name: (*name).to_owned(),
            unit: String::new(),
            values: time_s.iter().map(|t| of(*t)).collect(),
        };
        Recording { channels: channels.iter().map(channel).collect(), time_s: Some(time_s), ..Recording::default() }
    }

    #[test]
    fn a_slow_wave_keeps_its_amplitude() {
        let wave = |t: f64| 24.0 + 2.0 * (1.1 * t).sin();
        let found = of(&recording(&[("temperature_degC", &wave)]));
        for t in [3.0, 11.3, 29.9] {
            let error = found[0].at(t) - wave(100.0 + t);
            assert!(error.abs() < 0.01, "{error} at {t} s");
        }
    }

    #[test]
    fn a_clock_that_leaps_asks_for_no_memory_by_its_seconds() {
        let mut made = recording(&[("temperature_degC", &|t: f64| 20.0 + 2.0 * (0.3 * t).sin())]);
        for time in made.time_s.iter_mut().flatten().skip(2000) {
            *time += 1e15;
        }
        // One bin for each half of the recording is too little for a slow channel.
        assert_eq!(of(&made), []);
    }

    #[test]
    fn a_slow_channel_is_a_suspect_and_what_moves_with_the_hand_or_is_noise_is_none() {
        let noise = |t: f64| (t * 9_731.77).sin();
        let slow = move |t: f64| 20.0 + 2.0 * (0.3 * t).sin() + 0.05 * noise(t);
        let fast = |t: f64| (4.0 * t).sin();
        let made = recording(&[
            ("temperature_degC", &slow),
            ("current_A", &fast),
            ("volts_V", &noise),
            ("fx_other_N", &slow),
            ("label", &slow),
            ("segment", &|t| (0.25 * (t - 100.0)).floor()),
            ("level_V", &|_| 3.0),
        ]);
        let found = of(&made);
        assert_eq!(found.iter().map(|e| e.name.as_str()).collect::<Vec<_>>(), ["temperature_degC"]);
        assert_eq!(found[0].unit, "degC");
        for t in [3.0, 11.3, 29.9] {
            assert!((found[0].at(t) - 20.0 - 2.0 * (0.3 * (100.0 + t)).sin()).abs() < 0.06, "at {t} s");
        }
    }
}
