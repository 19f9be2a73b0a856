//! Signals of a recording of a switch: force along the knob's way against its displacement, one direction of travel at
//! a time.
//!
//! Fingers push and cannot pull. The one behind the knob presses it up to the top of the curve and follows it down until the force
//! is gone; then the knob snaps over by itself, and is met again on its stop.

use super::assumptions::Assumptions;
use crate::identify::limits::{CERTAIN, SETTLED, TOUCH_SHARE};
use crate::segment::threshold::percentile;
use foundation::estimate::EstimateError;
use foundation::signal::derive::savitzky_golay;
use foundation::signal::noise::white_noise;
use foundation::signal::task::{TipSeries, is_two_fingered, times, tip_series};
use haptics::Vec2;
use haptics::recording::Recording;
use std::ops::Range;

/// Half of the window over which samples are averaged, s.
/// Choice: halved, 6 of 21 answers change; doubled, 13 of 21 answers change.
const CALM_HALF_S: f64 = 0.004;
/// Half of the window of the parabolas for speed and acceleration, s. A knob that falls over runs away within 20 ms.
/// Choice: halved, 1 of 21 answers change; doubled, 12 of 21 answers change.
const MOVING_HALF_S: f64 = 0.010;
/// Least share of its speed along the arc with which a knob moves across.
/// Derived: √(1 − 0.95²), the cosine at the farthest sine.
const LEAST_COSINE: f64 = 0.31;
/// Least force on a stop, as a share of its largest value there: the knob lies there, and no friction carries it.
/// Choice: halved, 3 of 21 answers change; doubled, 5 of 21 answers change.
const STOP_SHARE: f64 = 0.3;
/// Force on a pressed stop, in multiples of the least force of a touch.
/// Choice: halved, 1 of 21 answers change; doubled, 0 of 21 answers change.
const STOP_TOUCHES: f64 = 2.0;
/// Least size of a turn of the motion, as a share of its range.
/// Choice: halved or doubled, none of 21 answers changes.
const THROW_TURN_SHARE: f64 = 0.1;
/// Share of the samples that are slower than a fast hand.
/// Choice: halved, 0 of 21 answers change; doubled, 9 of 9 answers change.
const FAST_SHARE: f64 = 0.9;
/// Share of the samples among which a finger at rest is looked for.
/// Choice: halved, 3 of 21 answers change; doubled, 3 of 21 answers change.
const QUIET_SHARE: f64 = 0.25;

/// One finger, without its sensor's offset, averaged.
#[derive(Clone, Debug)]
struct Finger {
    x_m: Vec<f64>,
    force: Vec<Vec2>,
    /// Rate and its own rate, of the place and of the force along x: m/s, m/s², N/s, N/s².
    rates: [[Vec<f64>; 2]; 2],
    /// Samples on each side that these rates look at.
    reach: usize,
    /// Noise of rate, m/s, and acceleration, m/s².
    rate_noise: [f64; 2],
    touches: Vec<bool>,
    /// Force from which it touches, N.
    touch_n: f64,
}

/// The recording of a switch.
#[derive(Clone, Debug)]
pub struct Signals {
    fingers: [Finger; 2],
    strokes: Vec<(f64, Range<usize>)>,
    /// Error of the forces' zero, N.
    pub zero_error_n: f64,
    /// Mean height of the tips while they touch, m.
    pub height_m: f64,
    /// Middle of the seen range, m.
    pub middle_m: f64,
    /// Travel of the hand in touch, m.
    pub range_m: f64,
    /// Longest way of one finger in one touch, m: the same if the knob is thrown in one direction only.
    pub push_m: f64,
    /// Force from which a touch is seen, N.
    pub touch_n: f64,
    /// Way from one sample to the next where the hand is fast, m: so late may a touch be seen.
    pub step_m: f64,
}

/// One sample of a direction of travel, turned so that the knob moves towards larger places.
#[derive(Clone, Copy, Debug)]
pub struct Sample {
    /// Place of the knob along its arc, m from the middle of the seen range.
    pub at_m: f64,
    /// Force that moves the knob on, N.
    pub force_n: f64,
    /// Speed of that place, m/s, and its acceleration, m/s².
    pub rate_m_s: f64,
    /// m/s².
    pub acceleration: f64,
}

/// Samples of the finger behind the knob in one direction, in order of time.
#[derive(Clone, Debug, Default)]
pub struct Seen {
    /// Noise of the samples' rate, m/s, and acceleration, m/s² (one standard deviation).
    pub rate_noise: [f64; 2],
    /// From the settled push up to where the knob leaves the finger.
    pub way: Vec<Sample>,
    /// Pressed against the stop at the end.
    pub stop: Vec<Sample>,
    /// Throws.
    pub throws: usize,
}

impl Signals {
    /// Reads two fingers around the knob or one tool on it.
    pub fn of(recording: &Recording) -> Result<Self, EstimateError> {
        let time_s = recording.time_s.as_ref().ok_or_else(|| EstimateError::Clockless {
            what: "the fit of a switch".to_owned(),
            recording: recording.name.clone(),
        })?;
        if !is_two_fingered(recording) {
            return Err(EstimateError::Other(format!(
                "{} has a single tool; a switch is fitted from two fingers around its knob (x1_m … fy2_N)",
                recording.name
            )));
        }
        let n = time_s.len();
        let period_s = if n > 1 { (time_s[n - 1] - time_s[0]) / (n - 1) as f64 } else { 1.0 };
        let (left, left_zero_n, left_height_m) = Finger::read(recording, "1", period_s)?;
        let (right, right_zero_n, right_height_m) = Finger::read(recording, "2", period_s)?;
        let fingers = [left, right];
        let mean: Vec<f64> = (0..n).map(|i| 0.5 * (fingers[0].x_m[i] + fingers[1].x_m[i])).collect();
        let touched = |i: &usize| fingers.iter().any(|f| f.touches[*i]);
        let (low, high) = (0..n)
            .filter(touched)
            .map(|i| mean[i])
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(x), h.max(x)));
        if !low.is_finite() || high <= low {
            return Err(EstimateError::Other(format!(
                "{} shows no push against a switch: no force stands out of the noise",
                recording.name
            )));
        }
        let strokes = strokes(&mean, THROW_TURN_SHARE * (high - low));
        let height_m = [left_height_m, right_height_m].iter().flatten().sum::<f64>()
            / [left_height_m, right_height_m].iter().flatten().count().max(1) as f64;
        let zero_error_n = left_zero_n.max(right_zero_n);
        let push_m = fingers.iter().map(|f| longest_push_m(&f.x_m, &f.touches)).fold(0.0, f64::max);
        let touch_n = fingers[0].touch_n.max(fingers[1].touch_n);
        let step_m = percentile(&mut mean.windows(2).map(|w| (w[1] - w[0]).abs()).collect::<Vec<_>>(), FAST_SHARE);
        Ok(Self {
            fingers,
            strokes,
            zero_error_n,
            height_m,
            middle_m: 0.5 * (low + high),
            range_m: high - low,
            push_m,
            touch_n,
            step_m,
        })
    }

    /// All strokes in a direction: 0 to the right, 1 to the left.
    pub fn seen(&self, side: usize, reading: &Assumptions) -> Seen {
        let (finger, direction) = (&self.fingers[side], [1.0, -1.0][side]);
        let half_m = 0.5 * self.width_m(reading.give_m_n).unwrap_or(0.0);
        let sample = |i: usize| {
            let force = finger.force[i];
            // Along the arc on which the knob's middle moves.
            let knob_m = reading.arc_m(finger.x_m[i] - reading.give_m_n * force.x + direction * half_m - self.middle_m);
            let angle = reading.bend_1_m * knob_m;
            let [place, push] = &finger.rates;
            let rate = |k: usize| direction * (place[k][i] - reading.give_m_n * push[k][i]);
            let turned = angle.cos().max(LEAST_COSINE);
            Sample {
                at_m: direction * knob_m,
                force_n: direction * (force.x * angle.cos() - force.y * angle.sin()),
                rate_m_s: rate(0) / turned,
                acceleration: rate(1) / turned,
            }
        };
        let mut seen = Seen { rate_noise: finger.rate_noise, ..Seen::default() };
        for (_, stroke) in self.strokes.iter().filter(|(d, _)| *d == direction) {
            let Some(push) = self.push(side, stroke) else { continue };
            let settled_m = sample(push.start).at_m + SETTLED * self.push_m;
            seen.throws += 1;
            // Samples of a rate's window beyond the moment in which the knob leaves the finger are not the knob's.
            let in_touch = push.start..push.end.saturating_sub(finger.reach).max(push.start);
            seen.way.extend(in_touch.map(sample).filter(|s| s.at_m > settled_m));
            let touches = |i: &usize| finger.touches[*i] && direction * finger.force[*i].x > 0.0;
            let pressed: Vec<Sample> = (push.end..stroke.end).filter(touches).map(sample).collect();
            let most_n = pressed.iter().fold(0.0_f64, |m, s| m.max(s.force_n));
            if most_n < STOP_TOUCHES * finger.touch_n {
                continue;
            }
            seen.stop.extend(pressed.into_iter().filter(|s| s.force_n > STOP_SHARE * most_n));
        }
        seen
    }

    /// From the sample at which the finger behind the knob meets it to the one at which it loses it: the first segment
    /// in touch that moves the knob on.
    fn push(&self, side: usize, stroke: &Range<usize>) -> Option<Range<usize>> {
        let (finger, direction) = (&self.fingers[side], [1.0, -1.0][side]);
        let mut start = None;
        for i in stroke.clone() {
            let touches = finger.touches[i] && direction * finger.force[i].x > 0.0;
            match (touches, start) {
                (true, None) => start = Some(i),
                (false, Some(first)) => {
                    if direction * (finger.x_m[i] - finger.x_m[first]) > 2.0 * SETTLED * self.push_m {
                        return Some(first..i);
                    }
                    start = None;
                }
                _ => {}
            }
        }
        None
    }

    /// Distance of the tips between leaving the knob at rest and meeting it from the other side, m: about the knob's width.
    pub fn width_m(&self, give_m_n: f64) -> Option<f64> {
        let mut found = self.widths_m(give_m_n);
        found.sort_by(f64::total_cmp);
        found.get(found.len() / 2).copied()
    }

    /// The same for every pair of throws, m.
    pub fn widths_m(&self, give_m_n: f64) -> Vec<f64> {
        let [left, right] = &self.fingers;
        let place = |f: &Finger, i: usize| f.x_m[i] - give_m_n * f.force[i].x;
        let mut found = Vec::new();
        for pair in self.strokes.windows(2) {
            let rightwards = pair[0].0 > 0.0;
            let (old, new) = if rightwards { (left, right) } else { (right, left) };
            let Some(met) = self.push(usize::from(rightwards), &pair[1].1).map(|p| p.start) else { continue };
            // Left at rest means: pressed against its stop first, not lost on the way.
            let Some(lost) = self.push(usize::from(!rightwards), &pair[0].1).map(|p| p.end) else { continue };
            let pressed = |i: &usize| old.touches[*i] && old.force[*i].x.abs() > old.touch_n;
            let Some(last) = (lost..=met.max(lost)).rev().find(pressed) else { continue };
            found.push((place(new, met) - place(old, last)).abs());
        }
        found
    }
}

impl Finger {
    /// With the error of its force's zero, N, and the mean height of the tip while it touches, m.
    fn read(recording: &Recording, name: &str, period_s: f64) -> Result<(Self, f64, Option<f64>), EstimateError> {
        let tip = tip_series(recording, name)?;
        let Some(force) = &tip.force else {
            return Err(EstimateError::MissingColumn {
                task: "the task switch".to_owned(),
                column: format!("fx{name}_N"),
                recording: recording.name.clone(),
            });
        };
        Ok(Self::of(&tip, force, &times(recording), period_s))
    }

    fn of(tip: &TipSeries, force: &[Vec2], time_s: &[f64], period_s: f64) -> (Self, f64, Option<f64>) {
        let half = (CALM_HALF_S / period_s).round() as usize;
        let axis = |pick: fn(&Vec2) -> f64| force.iter().map(pick).collect::<Vec<_>>();
        let (fx, fy) = (axis(|f| f.x), axis(|f| f.y));
        let noise_n = white_noise(&fx);
        let quiet = quiet(&mean(&fx, half.max(2)), noise_n);
        let zero = |values: &[f64]| quiet.iter().map(|&i| values[i]).sum::<f64>() / quiet.len().max(1) as f64;
        let (zero_x, zero_y) = (zero(&fx), zero(&fy));
        let raw_fx = fx.clone();
        let (fx, fy) = (mean(&fx, half), mean(&fy, half));
        let force: Vec<Vec2> = fx.iter().zip(&fy).map(|(x, y)| Vec2::new(x - zero_x, y - zero_y)).collect();
        let x: Vec<f64> = tip.position.iter().map(|p| p.x).collect();
        let strongest = force.iter().fold(0.0_f64, |m, f| m.max(f.x.abs()));
        let least_n = (TOUCH_SHARE * strongest).max(CERTAIN * noise_n / ((2 * half + 1) as f64).sqrt());
        let touches: Vec<bool> = force.iter().map(|f| f.x.abs() > least_n).collect();
        let zero_error_n = 2.0 * noise_n / (quiet.len().max(1) as f64).sqrt();
        let heights: Vec<f64> = tip.position.iter().zip(&touches).filter(|(_, t)| **t).map(|(p, _)| p.y).collect();
        let height_m = (!heights.is_empty()).then(|| heights.iter().sum::<f64>() / heights.len() as f64);
        let x_m = mean(&x, half);
        let reach = ((MOVING_HALF_S / period_s).round() as usize).max(2);
        // Of slope and curvature of a parabola through 2 · reach + 1 samples of white noise.
        let (n, noise_m) = ((2 * reach + 1) as f64, white_noise(&x));
        let rate_noise = [12.0 / n.powi(3), 720.0 / n.powi(5)].map(f64::sqrt);
        let rate_noise = [noise_m * rate_noise[0] / period_s, noise_m * rate_noise[1] / period_s.powi(2)];
        let rates = [&x, &raw_fx].map(|values: &Vec<f64>| {
            let local = savitzky_golay(time_s, values, reach, 2);
            [local.first, local.second]
        });
        (Self { x_m, force, rates, reach, rate_noise, touches, touch_n: least_n }, zero_error_n, height_m)
    }
}

/// Longest way of a finger between the first and the last sample of a touch, m.
pub fn longest_push_m(x_m: &[f64], touches: &[bool]) -> f64 {
    let (mut longest_m, mut first_m) = (0.0_f64, None);
    for (x_m, touches) in x_m.iter().zip(touches) {
        first_m = touches.then(|| first_m.unwrap_or(*x_m));
        longest_m = longest_m.max(first_m.map_or(0.0, |first_m: f64| (x_m - first_m).abs()));
    }
    longest_m
}

/// Samples at which a finger touches nothing: the closest lying quarter of all forces, and all within its noise.
fn quiet(calm: &[f64], noise_n: f64) -> Vec<usize> {
    let mut sorted = calm.to_vec();
    sorted.sort_by(f64::total_cmp);
    let count = ((QUIET_SHARE * sorted.len() as f64) as usize).max(1);
    let span = |k: &usize| sorted[k + count - 1] - sorted[*k];
    let Some(best) = (0..=sorted.len().saturating_sub(count)).min_by(|a, b| span(a).total_cmp(&span(b))) else {
        return Vec::new();
    };
    let middle = sorted.get(best + count / 2).copied().unwrap_or(0.0);
    (0..calm.len()).filter(|&i| (calm[i] - middle).abs() < 3.0 * noise_n.max(1e-9)).collect()
}

/// Plain mean over `half` samples on each side.
fn mean(values: &[f64], half: usize) -> Vec<f64> {
    let n = values.len();
    (0..n)
        .map(|i| {
            let side = half.min(i).min(n - 1 - i);
            values[i - side..=i + side].iter().sum::<f64>() / (2 * side + 1) as f64
        })
        .collect()
}

/// Segments between turns of more than `turn_m`, with their direction.
fn strokes(x: &[f64], turn_m: f64) -> Vec<(f64, Range<usize>)> {
    let mut found: Vec<(f64, Range<usize>)> = Vec::new();
    let (mut start, mut far, mut direction) = (0, 0, 0.0_f64);
    for i in 0..x.len() {
        if direction == 0.0 {
            if (x[i] - x[0]).abs() > turn_m {
                (direction, far) = ((x[i] - x[0]).signum(), i);
            }
        } else if direction * (x[i] - x[far]) >= 0.0 {
            far = i;
        } else if direction * (x[far] - x[i]) > turn_m {
            found.push((direction, start..far + 1));
            (start, far, direction) = (far, i, -direction);
        }
    }
    if direction != 0.0 {
        found.push((direction, start..far + 1));
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strokes_alternate_and_small_turns_are_none() {
        let x: Vec<f64> = (0..630).map(|i| (0.02 * f64::from(i)).sin() + 0.01 * (0.9 * f64::from(i)).sin()).collect();
        let found = strokes(&x, 0.2);
        assert_eq!(found.iter().map(|s| s.0).collect::<Vec<_>>(), [1.0, -1.0, 1.0, -1.0, 1.0], "{found:?}");
    }

    #[test]
    fn the_zero_of_a_sensor_is_where_most_samples_lie_close() {
        let force: Vec<f64> = (0..1000)
            .map(|i| 0.07 + 0.004 * (f64::from(i) * 12.9898).sin() + if i > 500 { f64::from(i) * 1e-3 } else { 0.0 })
            .collect();
        let found = quiet(&force, 0.004);
        let mean = found.iter().map(|&i| force[i]).sum::<f64>() / found.len() as f64;
        assert!((mean - 0.07).abs() < 1e-3 && found.len() > 400, "{mean} of {}", found.len());
    }
}
