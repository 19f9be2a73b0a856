//! The smoothing filters of the batch fit, delayed instead of looking ahead: the same weights over the same windows, told of the
//! window's middle once its end has come.

use foundation::signal::derive::savitzky_golay;
use foundation::signal::task::{CUBIC_HALF, DERIVATIVE_WINDOW_S};

/// Channels of a sample: x1 y1 x2 y2 (m), vx1 vy1 vx2 vy2 (m/s), fx1 fy1 fx2 fy2 (N), as in
/// [`haptics::servo::recorder::COLUMNS`].
pub const CHANNELS: usize = 12;
/// One sample of all channels.
pub type Sample = [f64; CHANNELS];

/// Samples are averaged over this time before anything else, s: all channels alike.
const COARSE_S: f64 = 0.002;
/// Half of the window in which forces and velocities are calmed before states are told, s (as in the segmentation).
const CALM_HALF_S: f64 = 0.04;

/// Weights over a window; the middle one belongs to the sample that is told.
#[derive(Clone, Debug)]
pub(super) struct Window {
    half: usize,
    weights: Vec<f64>,
}

impl Window {
    /// (h + ½)² − k², their sum 1.
    fn parabola(half: usize) -> Self {
        let reach = (half as f64 + 0.5).powi(2);
        let weights: Vec<f64> = (0..=2 * half).map(|k| reach - (k as f64 - half as f64).powi(2)).collect();
        let total: f64 = weights.iter().sum();
        Self { half, weights: weights.into_iter().map(|w| w / total).collect() }
    }

    /// Value, first and second derivative of a local polynomial.
    fn polynomial(half: usize, order: usize, period_s: f64) -> [Self; 3] {
        let n = 2 * half + 1;
        let time: Vec<f64> = (0..n).map(|k| k as f64 * period_s).collect();
        let mut parts = [(); 3].map(|()| Self { half, weights: vec![0.0; n] });
        for k in 0..n {
            // The answer to a single one at place k is the weight of that place.
            let mut one = vec![0.0; n];
            one[k] = 1.0;
            let answer = savitzky_golay(&time, &one, half, order);
            for (part, series) in parts.iter_mut().zip([&answer.value, &answer.first, &answer.second]) {
                part.weights[k] = series[half];
            }
        }
        parts
    }
}

/// The newest samples, with the filters that look at their middle.
#[derive(Clone, Debug)]
pub(super) struct Filters {
    period_s: f64,
    coarse: usize,
    sum: Sample,
    time_sum: f64,
    summed: usize,
    last_s: f64,
    /// A ring of coarse samples.
    times: Vec<f64>,
    samples: Vec<Sample>,
    next: usize,
    filled: usize,
    half: usize,
    calm: Window,
    level: Window,
    slope: Window,
    cubic: [Window; 3],
    /// Forgotten mean of the sizes of fourth differences of the velocities.
    velocity_bends: f64,
}

impl Filters {
    /// For samples `period_s` apart, s.
    pub(super) fn new(period_s: f64) -> Self {
        let coarse = (COARSE_S / period_s).round().max(1.0) as usize;
        let step_s = period_s * coarse as f64;
        let within = |s: f64| (s / step_s).round() as usize;
        let smooth = within(0.5 * DERIVATIVE_WINDOW_S).max(1);
        let wide = (2 * smooth).max(CUBIC_HALF);
        let order = if wide == CUBIC_HALF { 4 } else { 3 };
        let calm = Window::parabola(within(CALM_HALF_S));
        let half = calm.half.max(wide);
        let [_, slope, _] = Window::polynomial(smooth, 1, step_s);
        Self {
            period_s: step_s,
            coarse,
            sum: [0.0; CHANNELS],
            time_sum: 0.0,
            summed: 0,
            last_s: f64::NEG_INFINITY,
            times: vec![0.0; 2 * half + 1],
            samples: vec![[0.0; CHANNELS]; 2 * half + 1],
            next: 0,
            filled: 0,
            half,
            calm,
            level: Window::parabola(smooth),
            slope,
            cubic: Window::polynomial(wide, order, step_s),
            velocity_bends: 0.0,
        }
    }

    /// Period of the coarse samples, s.
    pub(super) fn period_s(&self) -> f64 {
        self.period_s
    }

    /// Samples in the window of a slope: closer ones share their noise.
    pub(super) fn smooth_samples(&self) -> usize {
        2 * self.level.half
    }

    /// Takes a sample; `true` when a new coarse one came in and the window is whole. `None` after a hole, with an empty window.
    pub(super) fn push(&mut self, time_s: f64, sample: &Sample) -> Option<bool> {
        let step = time_s - self.last_s;
        let fine_s = self.period_s / self.coarse as f64;
        let begun = self.last_s.is_finite();
        self.last_s = time_s;
        if begun && !(step > 0.0 && step < 4.0 * fine_s.max(0.5 * self.period_s)) {
            (self.filled, self.summed, self.time_sum, self.sum) = (0, 0, 0.0, [0.0; CHANNELS]);
            return None;
        }
        for (sum, value) in self.sum.iter_mut().zip(sample) {
            *sum += value;
        }
        (self.time_sum, self.summed) = (self.time_sum + time_s, self.summed + 1);
        if self.summed < self.coarse {
            return Some(false);
        }
        let share = 1.0 / self.summed as f64;
        self.times[self.next] = self.time_sum * share;
        self.samples[self.next] = self.sum.map(|v| v * share);
        (self.sum, self.time_sum, self.summed) = ([0.0; CHANNELS], 0.0, 0);
        self.next = (self.next + 1) % self.times.len();
        self.filled = (self.filled + 1).min(self.times.len());
        self.learn_noise();
        Some(self.filled == self.times.len())
    }

    fn learn_noise(&mut self) {
        const KEEP: f64 = 0.998;
        // Mean size of a normal variable with the variance of fourth differences of unit noise.
        const MEAN_SIZE: f64 = 6.675;
        if self.filled < 5 {
            return;
        }
        let n = self.times.len();
        let at = |back: usize| self.samples[(self.next + n - 1 - back) % n][5];
        let bend = at(0) - 4.0 * at(1) + 6.0 * at(2) - 4.0 * at(3) + at(4);
        self.velocity_bends = KEEP * self.velocity_bends + (1.0 - KEEP) * bend.abs() / MEAN_SIZE;
    }

    /// White noise of a coarse velocity, m/s.
    pub(super) fn velocity_noise(&self) -> f64 {
        self.velocity_bends
    }

    /// Share of a white noise's standard deviation that a cubic leaves.
    pub(super) fn cubic_leaves(&self) -> f64 {
        self.cubic[0].weights.iter().map(|w| w * w).sum::<f64>().sqrt()
    }

    /// Time of the middle, s.
    pub(super) fn time_s(&self) -> f64 {
        self.times[(self.next + self.half) % self.times.len()]
    }

    fn apply<const N: usize>(&self, window: &Window, pick: impl Fn(&Sample) -> [f64; N]) -> [f64; N] {
        let n = self.times.len();
        let first = self.next + self.half - window.half;
        let mut sums = [0.0; N];
        for (k, weight) in window.weights.iter().enumerate() {
            let values = pick(&self.samples[(first + k) % n]);
            for (sum, value) in sums.iter_mut().zip(values) {
                *sum += weight * value;
            }
        }
        sums
    }

    /// As the segmentation sees it.
    pub(super) fn calm<const N: usize>(&self, pick: impl Fn(&Sample) -> [f64; N]) -> [f64; N] {
        self.apply(&self.calm, pick)
    }

    /// Value and slope that have seen the same filter ([`foundation::signal::task::smooth`]).
    pub(super) fn smooth<const N: usize>(&self, pick: impl Fn(&Sample) -> [f64; N]) -> ([f64; N], [f64; N]) {
        (self.apply(&self.level, &pick), self.apply(&self.slope, &pick))
    }

    /// Value and two derivatives of a local cubic.
    pub(super) fn cubic<const N: usize>(&self, pick: impl Fn(&Sample) -> [f64; N]) -> [[f64; N]; 3] {
        [0, 1, 2].map(|order: usize| self.apply(&self.cubic[order], &pick))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use foundation::signal::task::smooth;

    #[test]
    fn delayed_filters_say_what_the_batch_filters_say() {
        let wave = |t: f64| (9.0 * t).sin() + 0.2 * t;
        let mut filters = Filters::new(0.002);
        let time: Vec<f64> = (0..400).map(|i| 0.002 * f64::from(i)).collect();
        let batch = smooth(&time, &time.iter().map(|t| wave(*t)).collect::<Vec<_>>());
        let mut compared = 0;
        for t in &time {
            if filters.push(*t, &[wave(*t); CHANNELS]) == Some(true) {
                let ([value], [slope]) = filters.smooth(|s| [s[3]]);
                let i = time.iter().position(|t| (t - filters.time_s()).abs() < 1e-9).expect("a sample's time");
                assert!((value - batch.value[i]).abs() < 1e-10 && (slope - batch.slope[i]).abs() < 1e-8);
                let [[v], [d], [b]] = filters.cubic(|s| [s[3]]);
                let t = time[i];
                assert!((v - wave(t)).abs() < 1e-3 && (d - 9.0 * (9.0 * t).cos() - 0.2).abs() < 0.02, "{v} {d}");
                assert!((b + 81.0 * (9.0 * t).sin()).abs() < 1.0, "{b}");
                compared += 1;
            }
        }
        assert!(compared > 300);
    }

    #[test]
    fn a_hole_empties_the_window() {
        let mut filters = Filters::new(0.001);
        for i in 0..200 {
            assert!(filters.push(1e-3 * f64::from(i), &[0.0; CHANNELS]).is_some());
        }
        assert!(filters.push(5.0, &[0.0; CHANNELS]).is_none());
        assert_eq!(filters.push(5.001, &[0.0; CHANNELS]), Some(false));
        assert!(filters.push(4.0, &[0.0; CHANNELS]).is_none(), "a clock that runs backwards");
    }
}
