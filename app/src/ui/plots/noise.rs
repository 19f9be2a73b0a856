//! Noise of a curve: the band around the prediction of a model.

use super::levels::Levels;
use crate::ui::document::prepared::Prepared;
use estimator::segment::{Segmentation, SystemState};
use estimator::signal::derive::even_period;
use estimator::signal::filter::white_noise_gain;
use estimator::signal::noise::white_noise_under_fast_motion;
use estimator::signal::transform::Transform;
use std::ops::Range;

/// Maximum number of samples: the standard error of a standard deviation from so many is below half a percent.
const MOST_SAMPLES: usize = 60_000;
/// Share of a free phase that is discarded at either end: the hand has just let go, or is about to touch.
const EDGE_SHARE: f64 = 0.15;
/// Minimum number of samples of a usable free phase.
const LEAST_SAMPLES: usize = 24;

/// Standard deviation of a force curve's noise, in its unit. It is the spread in the contact-free phases, or that of
/// the fastest part of the signal where there are none. `raw` is the curve before the `transform`, `drawn` the one
/// after it. `None` where neither applies: the noise of an integral grows with time.
pub fn sigma(
    raw: &Levels,
    drawn: &Levels,
    prepared: &Prepared,
    segmentation: Option<&Segmentation>,
    transform: Transform,
) -> Option<f64> {
    if transform == Transform::Integral {
        return None;
    }
    let free = segmentation.map(|s| free_phases(prepared, s)).unwrap_or_default();
    in_phases(drawn, prepared, &free).or_else(|| of_fastest_part(raw, prepared, transform)).filter(|s| *s > 0.0)
}

fn free_phases(prepared: &Prepared, segmentation: &Segmentation) -> Vec<Range<usize>> {
    let at = |time: f64| prepared.times.partition_point(|t| *t < time);
    let free = segmentation.states.iter().filter(|i| i.state == SystemState::FreeMotion);
    free.map(|interval| {
        let edge = EDGE_SHARE * (interval.t1 - interval.t0);
        at(interval.t0 + edge)..at(interval.t1 - edge)
    })
    .filter(|range| range.len() >= LEAST_SAMPLES)
    .collect()
}

/// Spread about each phase's own mean: a zero that drifts from one phase to the next is not noise.
fn in_phases(curve: &Levels, prepared: &Prepared, phases: &[Range<usize>]) -> Option<f64> {
    let samples = curve.samples(&prepared.recording);
    let share = MOST_SAMPLES / phases.len().max(1);
    let (mut squares, mut freedom) = (0.0, 0_usize);
    for phase in phases {
        let values: Vec<f64> =
            phase.clone().take(share.max(LEAST_SAMPLES)).map(|i| samples.value(i)).filter(|v| v.is_finite()).collect();
        if values.len() < LEAST_SAMPLES {
            continue;
        }
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        squares += values.iter().map(|v| (v - mean).powi(2)).sum::<f64>();
        freedom += values.len() - 1;
    }
    (freedom > 0).then(|| (squares / freedom as f64).sqrt())
}

fn of_fastest_part(raw: &Levels, prepared: &Prepared, transform: Transform) -> Option<f64> {
    let samples = raw.samples(&prepared.recording);
    let first = samples.len().saturating_sub(MOST_SAMPLES) / 2;
    let range = first..samples.len().min(first + MOST_SAMPLES);
    let period_s = even_period(prepared.times.get(range.clone())?)?;
    let gain = match transform {
        Transform::None | Transform::MinusMean => 1.0,
        Transform::LowPass(cutoff_hz) => white_noise_gain(1.0 / period_s, cutoff_hz),
        Transform::Derivative | Transform::SecondDerivative | Transform::Integral => return None,
    };
    let values: Vec<f64> = range.map(|i| samples.value(i)).filter(|v| v.is_finite()).collect();
    Some(white_noise_under_fast_motion(&values) * gain.sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;
    use estimator::segment::{Interval, Thresholds};
    use haptics::recording::{Channel, Recording};
    use std::collections::BTreeMap;

    /// Uniform-sum noise of standard deviation 1 without a library: twelve uniform numbers minus six.
    fn noise(n: usize) -> Vec<f64> {
        let mut state = 88_172_645_463_325_252_u64;
        let mut uniform = || {
            state ^= state << 13;
            state ^= state >> 7;
            state ^= state << 17;
            (state >> 11) as f64 / (1_u64 << 53) as f64
        };
        (0..n).map(|_| (0..12).map(|_| uniform()).sum::<f64>() - 6.0).collect()
    }

    #[test]
    fn free_phases_say_how_noisy_a_force_is_and_its_fastest_part_where_there_are_none() {
        let n = 20_000;
        let values: Vec<f64> = noise(n)
            .iter()
            .enumerate()
            .map(|(i, e)| 0.02 * e + if i > 8_000 { (i as f64 * 0.004).sin() } else { 0.1 })
            .collect();
        let channel = Channel { name: "f_N".into(), unit: "N".into(), values };
        let time_s = Some((0..n).map(|i| i as f64 * 1e-3).collect());
        let prepared = Prepared::new(Recording { time_s, channels: vec![channel], ..Recording::default() });
        let raw = &prepared.groups[0].traces[0].levels;
        let interval = |state, t0: f64, t1: f64| {
            let (first, end) = ((1e3 * t0) as usize, (1e3 * t1) as usize);
            Interval { t0, t1, state, subtask: None, probability: 1.0, first, end }
        };
        let segmentation = Segmentation {
            method: String::new(),
            task: String::new(),
            states: vec![interval(SystemState::FreeMotion, 0.0, 8.0), interval(SystemState::Holding, 8.0, 20.0)],
            thresholds: Thresholds { velocity_m_s: 0.05, force_n: 0.05 },
            shows: BTreeMap::new(),
            warnings: Vec::new(),
            score: None,
            by_hand: false,
            posterior: None,
            definition: None,
        };
        let of = |segmentation, transform| sigma(raw, raw, &prepared, segmentation, transform);
        for found in [of(Some(&segmentation), Transform::None), of(None, Transform::None)] {
            let sigma = found.expect("known");
            assert!((sigma / 0.02 - 1.0).abs() < 0.05, "{sigma}");
        }
        let calm = of(None, Transform::LowPass(20.0)).expect("known");
        assert!(calm < 0.3 * 0.02, "{calm}: a low-pass takes most of it away");
        assert_eq!(of(Some(&segmentation), Transform::Integral), None);
        assert_eq!(of(None, Transform::Derivative), None);
    }
}
