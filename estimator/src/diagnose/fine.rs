//! Motion between the rows: calmed a little, thinned out or filled in.

use super::track::Fine;
use haptics::Vec2;

/// Points come at about this rate, Hz: a hand's motion is a straight line between them.
pub const FINE_HZ: f64 = 400.0;
/// Velocities are means over about this long, s.
const CALM_S: f64 = 0.012;

/// Weights of the calming, from the middle outwards; their sum over both sides is one.
fn weights(period_s: f64) -> Vec<f64> {
    let half = (0.5 * CALM_S / period_s).floor() as usize;
    let sum: f64 = (half + 1) as f64 + (1..=half).map(|k| (half + 1 - k) as f64).sum::<f64>() * 2.0;
    (0..=half).map(|k| (half + 1 - k) as f64 / sum).collect()
}

/// Short weighted means (a hat), and what is left of the noise of one sample, as a factor.
pub fn calmed(values: &[Vec2], period_s: f64) -> (Vec<Vec2>, f64) {
    let weights = weights(period_s);
    let n = values.len();
    let at = |i: usize| {
        // The same on both sides, also near an end.
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

/// A point between two others: time and velocity on a line, the position on the cubic that has both slopes.
pub fn between(a: &Fine, b: &Fine, part: f64) -> Fine {
    let step_s = b.time_s - a.time_s;
    let (p, q) = (part, 1.0 - part);
    let bend = p * q * step_s * (q * a.velocity - p * b.velocity);
    let ease = p * p * (3.0 - 2.0 * p);
    Fine {
        stretch: b.stretch,
        time_s: a.time_s + p * step_s,
        position: a.position + ease * (b.position - a.position) + bend,
        velocity: q * a.velocity + p * b.velocity,
        direction: 0.0,
        open: 0.0,
    }
}
