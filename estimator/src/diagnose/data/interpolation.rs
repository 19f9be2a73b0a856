//! Motion between the rows: slightly smoothed, thinned out or interpolated.

use super::regression_data::Fine;
use foundation::signal::derive::savitzky_golay;
use foundation::signal::noise::white_noise;
use haptics::Vec2;

/// Approximate rate of the points, Hz: a hand's motion is nearly linear between them.
/// Choice: halved, 3 of 63 answers change; doubled, 1 of 63 answers change.
pub const FINE_HZ: f64 = 400.0;
/// Averaging time of velocities, s.
/// Choice: halved, 1 of 48 answers change; doubled, 1 of 48 answers change.
const CALM_S: f64 = 0.012;
/// Windows of the acceleration: rows on either side, order, and power of the slope's noise in the noise of one row's
/// speed over a row's time. Over the first, a parabola of the speed halves a tremor of 9 Hz. The first is taken whose
/// noise makes no more than [`NOISE_OF_ACCELERATION`].
/// Source: Savitzky & Golay 1964; the noise powers are the sums of the squared slope coefficients.
const FINER: [(usize, usize, f64); 3] = [(2, 4, 0.903), (3, 4, 0.263), (4, 4, 0.114)];
/// Largest share of the acceleration's power that noise of its slope may make.
/// Choice: halved or doubled, none of 43 answers changes.
const NOISE_OF_ACCELERATION: f64 = 0.02;

/// Mean time between samples, s.
pub fn mean_step_s(time_s: &[f64]) -> f64 {
    match time_s {
        [first, .., last] => (last - first) / (time_s.len() - 1) as f64,
        _ => 1.0,
    }
}

/// Noise of the slope of a line through a window of `half` samples to either side, a second.
pub fn slope_noise(values: &[f64], half: usize, step_s: f64) -> f64 {
    let half = half as f64;
    let spread = half * (half + 1.0) * (2.0 * half + 1.0) / 3.0;
    white_noise(values) / (spread.sqrt() * step_s.max(1e-9))
}

/// Weights of the smoothing, from the middle outwards; their sum over both sides is one.
fn weights(period_s: f64) -> Vec<f64> {
    let half = (0.5 * CALM_S / period_s).floor() as usize;
    let sum: f64 = (half + 1) as f64 + (1..=half).map(|k| (half + 1 - k) as f64).sum::<f64>() * 2.0;
    (0..=half).map(|k| (half + 1 - k) as f64 / sum).collect()
}

/// Short weighted means (triangular), and the remaining noise of one sample, as a factor.
pub fn calmed(values: &[Vec2], period_s: f64) -> (Vec<Vec2>, f64) {
    let weights = weights(period_s);
    let n = values.len();
    let at = |i: usize| {
        // The window is symmetric, also near an end.
        let reach = (weights.len() - 1).min(i).min(n - 1 - i);
        let (mut sum, mut total) = (values[i] * weights[0], weights[0]);
        for (k, w) in weights.iter().enumerate().take(reach + 1).skip(1) {
            sum += (values[i - k] + values[i + k]) * *w;
            total += 2.0 * w;
        }
        sum / total
    };
    let left = weights[0].powi(2) + 2.0 * weights[1..].iter().map(|w| w * w).sum::<f64>();
    ((0..n).map(at).collect(), left.sqrt())
}

/// The same of one coordinate.
pub fn calmed_line(values: &[f64], period_s: f64) -> (Vec<f64>, f64) {
    let (calm, left) = calmed(&values.iter().map(|v| Vec2::new(*v, 0.0)).collect::<Vec<_>>(), period_s);
    (calm.into_iter().map(|v| v.x).collect(), left)
}

/// Number of points for one sample, and number of samples for one point, at this time step. One of them is 1.
pub fn points_and_samples(period_s: f64) -> (usize, usize) {
    // With more than 64 points for a sample, a clock with a wrong unit would ask for memory by its seconds.
    let fill = (FINE_HZ * period_s).round().clamp(1.0, 64.0) as usize;
    (fill, (1.0 / (FINE_HZ * period_s)).round().max(1.0) as usize)
}

/// Adds a sample's point, preceded by interpolated ones within its segment: `fill` points for one sample.
pub fn add_point(points: &mut Vec<Fine>, point: Fine, fill: usize) {
    if let Some(before) = points.last().copied().filter(|f| f.segment == point.segment) {
        points.extend((1..fill).map(|part| between(&before, &point, part as f64 / fill as f64)));
    }
    points.push(point);
}

/// A point between two others: time and velocity by linear interpolation, position by the cubic with both slopes.
fn between(a: &Fine, b: &Fine, part: f64) -> Fine {
    let step_s = b.time_s - a.time_s;
    let (p, q) = (part, 1.0 - part);
    let bend = p * q * step_s * (q * a.velocity - p * b.velocity);
    let ease = p * p * (3.0 - 2.0 * p);
    Fine {
        segment: b.segment,
        time_s: a.time_s + p * step_s,
        position: a.position + ease * (b.position - a.position) + bend,
        velocity: q * a.velocity + p * b.velocity,
        ..Fine::default()
    }
}

/// Acceleration of each row, with the shortest window that the noise of the speed permits, its window and order.
pub fn acceleration(time_s: &[f64], speed: &[f64], half: usize, period_s: f64) -> (Vec<f64>, (usize, usize)) {
    let noise = (white_noise(speed) / period_s).powi(2);
    for (finer, order, slope_noise) in FINER.into_iter().filter(|(finer, ..)| *finer <= half) {
        let found = savitzky_golay(time_s, speed, finer, order).first;
        let power = found.iter().map(|a| a * a).sum::<f64>() / found.len().max(1) as f64;
        if slope_noise * noise < NOISE_OF_ACCELERATION * power {
            return (found, (finer, order));
        }
    }
    (savitzky_golay(time_s, speed, half, 2).first, (half, 2))
}

/// Positions of the finer points in a row of `every` samples, in samples after the first. They are symmetric about the
/// middle, as the row's force is. If the points were early on average, the force would look late.
pub fn offsets(every: usize, period_s: f64) -> impl Iterator<Item = f64> {
    let samples = every as f64;
    let points = (samples * FINE_HZ * period_s).round().clamp(1.0, samples);
    (0..points as usize).map(move |k| (k as f64 + 0.5) * samples / points - 0.5)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slow_clock_has_a_bounded_number_of_points_for_a_sample() {
        assert_eq!(points_and_samples(0.01), (4, 1));
        assert_eq!(points_and_samples(0.16), (64, 1));
        for period_s in [10.0, 1e6, 1e300, f64::INFINITY] {
            assert_eq!(points_and_samples(period_s), (64, 1), "{period_s}");
        }
    }

    #[test]
    fn points_lie_evenly_about_the_middle_of_their_row() {
        for (every, rate_hz) in
            [(1, 50.0), (1, 100.0), (3, 250.0), (5, 500.0), (10, 1000.0), (20, 2000.0), (40, 4000.0)]
        {
            let found: Vec<f64> = offsets(every, 1.0 / rate_hz).collect();
            let mean = found.iter().sum::<f64>() / found.len() as f64;
            let middle = 0.5 * (every as f64 - 1.0);
            assert!((mean - middle).abs() < 1e-9, "{rate_hz} Hz: {found:?}");
            assert!(found.iter().all(|o| (0.0..every as f64).contains(o)), "{rate_hz} Hz: {found:?}");
        }
    }

    #[test]
    fn a_trembling_hand_keeps_its_acceleration_where_noise_lets_it() {
        let time_s: Vec<f64> = (0..400).map(|k| 0.01 * f64::from(k)).collect();
        let turns = std::f64::consts::TAU * 9.0;
        let speed: Vec<f64> = time_s.iter().map(|t| (turns * t).sin() / turns).collect();
        let (found, _) = acceleration(&time_s, &speed, 4, 0.01);
        let power = |values: &[f64]| values[20..380].iter().map(|v| v * v).sum::<f64>() / 360.0;
        assert!((power(&found) - 0.5).abs() < 0.04, "{}", power(&found));
    }
}
