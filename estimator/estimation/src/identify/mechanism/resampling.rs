//! Uneven samples onto an even grid: one linear operation for every channel, so that it cancels in the regression.
//!
//! Interpolation must do the same to every regressor as to a signal: position, force and the direction of motion are
//! all taken at the recorded times and then brought onto the grid together. A direction made on the grid instead would
//! be sharper than the force that it explains, and the estimate of Coulomb friction would be too small.

use foundation::signal::derive::{even_period, interpolate, interpolate_cubic};
use foundation::signal::noise::{white_noise_under_fast_motion, white_noise_uneven};

/// Share of the grid's period within which samples are taken as one: a slope between them is noise.
/// Choice: halved or doubled, none of 3 answers changes.
const TOGETHER: f64 = 0.3;

/// Recorded times and the even grid of one segment.
#[derive(Clone, Debug)]
pub struct Resampled {
    /// The grid, s; the recorded times themselves where they are even.
    pub grid: Vec<f64>,
    /// Spacing of the grid, s.
    pub period_s: f64,
    /// Groups of samples read as one, if the recording is uneven.
    uneven: Option<Groups>,
}

/// Runs of samples taken as one (first, end), and their mean times, s.
type Groups = (Vec<(usize, usize)>, Vec<f64>);

impl Resampled {
    /// A grid for samples at `time`, of spacing `period` where they are uneven.
    pub fn new(time: &[f64], period: f64) -> Self {
        if let Some(period_s) = even_period(time) {
            return Self { grid: time.to_vec(), period_s, uneven: None };
        }
        let mut groups: Vec<(usize, usize)> = Vec::new();
        for (i, t) in time.iter().enumerate() {
            match groups.last_mut() {
                Some((first, end)) if t - time[*first] < TOGETHER * period => *end = i + 1,
                _ => groups.push((i, i + 1)),
            }
        }
        let times = means(&groups, time);
        let (start, stop) = (times[0], times[times.len() - 1]);
        let count = ((stop - start) / period).floor() as usize + 1;
        let grid = (0..count).map(|i| start + i as f64 * period).collect();
        Self { grid, period_s: period, uneven: Some((groups, times)) }
    }

    /// A recorded channel on the grid.
    pub fn onto(&self, values: &[f64]) -> Vec<f64> {
        match &self.uneven {
            None => values.to_vec(),
            Some((groups, times)) => interpolate_cubic(times, &means(groups, values), &self.grid),
        }
    }

    /// A flag on the grid: set where either neighbouring sample has it.
    pub fn flags(&self, time: &[f64], flags: &[bool]) -> Vec<bool> {
        if self.uneven.is_none() {
            return flags.to_vec();
        }
        let levels: Vec<f64> = flags.iter().map(|&f| f64::from(u8::from(f))).collect();
        interpolate(time, &levels, &self.grid).into_iter().map(|level| level > 0.0).collect()
    }

    /// A function of a smooth signal on the grid, as if it had been recorded: taken at the recorded times, then brought back.
    pub fn through(&self, smooth: &[f64], of: impl Fn(f64) -> f64) -> Vec<f64> {
        match &self.uneven {
            None => smooth.iter().map(|&v| of(v)).collect(),
            Some((_, times)) => {
                let sampled: Vec<f64> = interpolate_cubic(&self.grid, smooth, times).into_iter().map(of).collect();
                interpolate_cubic(times, &sampled, &self.grid)
            }
        }
    }

    /// Standard deviation of a recorded channel's white noise.
    pub fn noise(&self, values: &[f64]) -> f64 {
        match &self.uneven {
            None => white_noise_under_fast_motion(values),
            Some((groups, times)) => white_noise_uneven(times, &means(groups, values)),
        }
    }
}

fn means(groups: &[(usize, usize)], values: &[f64]) -> Vec<f64> {
    let mean = |&(first, end): &(usize, usize)| values[first..end].iter().sum::<f64>() / (end - first) as f64;
    groups.iter().map(mean).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn even_times_pass_untouched() {
        let time: Vec<f64> = (0..50).map(|i| f64::from(i) * 0.1).collect();
        let even = Resampled::new(&time, 0.1);
        assert_eq!(even.onto(&time), time);
        assert_eq!(even.through(&[-2.0, 3.0], f64::signum), [-1.0, 1.0]);
    }

    #[test]
    fn a_made_direction_is_smeared_exactly_like_a_recorded_force() {
        let time: Vec<f64> = (0..400).map(|i| f64::from(i) * 0.01 + 0.004 * (f64::from(i) * 2.3).sin()).collect();
        let even = Resampled::new(&time, 0.01);
        let friction: Vec<f64> = time.iter().map(|t| (9.0 * t).sin().signum()).collect();
        let velocity: Vec<f64> = even.grid.iter().map(|t| (9.0 * t).sin()).collect();
        let (recorded, made) = (even.onto(&friction), even.through(&velocity, f64::signum));
        let apart = |a: &[f64], b: &[f64]| a.iter().zip(b).skip(2).map(|(x, y)| (x - y).abs()).fold(0.0, f64::max);
        assert!(apart(&recorded, &made) < 1e-12, "{}", apart(&recorded, &made));
        let on_the_grid: Vec<f64> = velocity.iter().map(|v| v.signum()).collect();
        assert!(apart(&recorded, &on_the_grid) > 0.2);
    }

    #[test]
    fn twins_count_as_one_sample() {
        let mut time: Vec<f64> = (0..50).map(|i| f64::from(i) * 0.1 + 0.02 * f64::from(i % 3)).collect();
        time[20] = time[19] + 1e-9;
        let noisy: Vec<f64> = (0..50).map(|i| f64::from(i % 2) * 1e-3).collect();
        let even = Resampled::new(&time, 0.1);
        assert!(even.onto(&noisy).iter().all(|v| v.abs() < 0.01), "a slope between twins must not run away");
    }
}
