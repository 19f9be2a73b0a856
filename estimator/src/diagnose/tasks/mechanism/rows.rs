//! Rows of a mechanism's recording: one coordinate and the force along it.
//!
//! With inertia, force and acceleration must pass through the same filter. Dry friction jumps at a reversal and the
//! acceleration jumps back, and only their sum is smooth. Every row is therefore a mean with triangular weights over
//! two blocks. The mean acceleration with these weights is exactly the difference of the two blocks' mean velocities.

use crate::diagnose::data::interpolation::{add_point, calmed_line, points_and_samples};
use crate::diagnose::data::limits::{LEAST_PIECES, LONGEST_BLOCK_S, SHORTEST_S};
use crate::diagnose::data::regression_data::{Fine, Row, Span, Track, Weighing};
use estimation::identify::mechanism;
use estimation::identify::mechanism::Raw;
use estimation::regression::linear::least_squares;
use foundation::estimate::EstimateError;
use foundation::signal::noise::{quantum, resolution_error, white_noise, white_noise_under_fast_motion};
use foundation::signal::pieces::pieces;
use haptics::Vec2;
use haptics::law::Motion;
use haptics::recording::Recording;
use haptics::world::MechanismPath;

/// The rows of one recording. `bad`: samples that no sensor measured; `path`: path along which a tool's coordinate is
/// measured, its own if `None`.
pub fn track(recording: &Recording, bad: &[bool], path: Option<&MechanismPath>) -> Result<Track, EstimateError> {
    let raw = mechanism::raw(recording, path)?;
    let force = raw.force.as_ref().ok_or_else(|| {
        EstimateError::Other(format!(
            "{} has no force column: a diagnosis explains the force that a motion needs; record it, or map it in the sidecar",
            recording.name
        ))
    })?;
    let rate = raw.rate.clone().unwrap_or_else(|| slopes(&raw));
    let usable = |i: usize| !raw.saturated[i] && !bad.get(i).copied().unwrap_or(false);
    let (stretches, period_s) = pieces(&raw.time_s, &usable);
    let in_blocks = |block: usize| {
        let mut made = Made { rows: Vec::new(), fine: Vec::new(), noises: Vec::new(), period_s, block };
        for range in &stretches {
            made.stretch(&raw, &rate, force, range.clone());
        }
        made
    };
    // A whole number of finer points per block, which are then symmetric about the middle of every mean.
    let (_, skip) = points_and_samples(period_s);
    let whole = |samples: f64| (samples / skip as f64).round().max(1.0) as usize * skip;
    let shortest = whole(SHORTEST_S / period_s);
    let longest = whole((LONGEST_BLOCK_S / period_s).floor()).max(shortest);
    let mass = in_blocks(whole(0.5 * (shortest + longest) as f64)).mass();
    let (of_motion, of_force) = (white_noise(raw.rate.as_ref().unwrap_or(&raw.position)), white_noise(force));
    let inertial = |block: usize| mass.abs() * acceleration_noise(of_motion, raw.rate.is_some(), period_s, block);
    let quiet = |block: &usize| inertial(*block) < of_force * averaged(*block);
    let block = (shortest..=longest).step_by(skip).find(quiet).unwrap_or(longest);
    let made = in_blocks(block);
    if made.rows.is_empty() {
        return Err(EstimateError::TooFewSamples {
            recording: recording.name.clone(),
            samples: stretches.iter().map(ExactSizeIterator::len).max().unwrap_or(0),
            what: " in one uninterrupted piece".to_owned(),
            needed: LEAST_PIECES * block,
        });
    }
    Ok(made.track(&raw, inertial(block)))
}

/// Noise of a row's acceleration. `noise`: of a rate, or of a position if no rate was recorded (`is_rate`).
fn acceleration_noise(noise: f64, is_rate: bool, period_s: f64, block: usize) -> f64 {
    let (samples, length_s) = (block as f64, block as f64 * period_s);
    // Noise of a block's mean velocity: from its rates, or from the two positions at its ends.
    let velocity = if is_rate { noise / samples.sqrt() } else { std::f64::consts::SQRT_2 * noise / length_s };
    std::f64::consts::SQRT_2 * velocity / length_s
}

/// Factor by which a triangular mean over two blocks reduces white noise.
fn averaged(block: usize) -> f64 {
    (2.0 / (3.0 * block as f64)).sqrt()
}

/// Rates from positions: central differences.
fn slopes(raw: &Raw) -> Vec<f64> {
    let n = raw.time_s.len();
    let at = |i: usize| {
        let (a, b) = (i.saturating_sub(1), (i + 1).min(n - 1));
        (raw.position[b] - raw.position[a]) / (raw.time_s[b] - raw.time_s[a]).max(1e-9)
    };
    (0..n).map(at).collect()
}

/// Rows in the making.
struct Made {
    rows: Vec<Row>,
    fine: Vec<Fine>,
    /// Noise of velocity, force and position, and the position uncertainty that the sensor's steps hide however long it
    /// stands; one set per segment.
    noises: Vec<[f64; 4]>,
    period_s: f64,
    /// Samples a block.
    block: usize,
}

impl Made {
    fn stretch(&mut self, raw: &Raw, rate: &[f64], force: &[f64], range: std::ops::Range<usize>) {
        let block = self.block;
        if range.len() < LEAST_PIECES * block + 1 {
            return;
        }
        let number = self.fine.last().map_or(0, |f| f.segment + 1);
        let (calm, left) = calmed_line(&rate[range.clone()], self.period_s);
        // Rates from differences also contain the noise of the positions.
        let position = white_noise_under_fast_motion(&raw.position[range.clone()]);
        let hidden = resolution_error(quantum(&raw.position[range.clone()]), white_noise(&raw.position[range.clone()]));
        self.noises.push([
            left * white_noise(&rate[range.clone()]),
            white_noise(&force[range.clone()]),
            position,
            hidden,
        ]);
        let (fill, skip) = points_and_samples(self.period_s);
        let first_fine = self.fine.len();
        self.add_points(raw, &calm, range.clone(), number);
        let mean = |values: &[f64], from: usize| trapezoid(&values[from..=from + block]);
        let blocks = (range.len() - 1) / block;
        for b in 1..blocks {
            let (before, middle) = (range.start + (b - 1) * block, range.start + b * block);
            let (v0, v1) = (mean(rate, before), mean(rate, middle));
            let half_s = 0.5 * (raw.time_s[middle + block] - raw.time_s[before]);
            let hat = |values: &[f64]| hat(&values[before..=middle + block]);
            // The points that the triangular weights cover.
            let per = |samples: usize| samples * fill / skip;
            let start = first_fine + per((b - 1) * block);
            let end = (first_fine + per((b + 1) * block) + 1).min(self.fine.len());
            let motion = Motion {
                time_s: raw.time_s[middle],
                position: hat(&raw.position),
                velocity: hat(rate),
                acceleration: (v1 - v0) / half_s,
                up_along: raw.up_along.as_ref().map_or(0.0, |u| u[middle]),
                ..Motion::default()
            };
            let y = hat(force);
            self.rows.push(Row {
                segment: number,
                motion,
                angle_rad: motion.position,
                along: Vec2::x(),
                force: Vec2::new(y, 0.0),
                force_rate: Vec2::new((mean(force, middle) - mean(force, before)) / half_s, 0.0),
                target: y,
                span: Span { start, len: end - start, weighing: Weighing::Hat },
                ..Row::default()
            });
        }
    }

    /// Adds the points of a segment with this `number`, with the smoothed velocities `calm`.
    fn add_points(&mut self, raw: &Raw, calm: &[f64], range: std::ops::Range<usize>, number: usize) {
        let (fill, skip) = points_and_samples(self.period_s);
        for (k, i) in range.enumerate().step_by(skip) {
            let point = Fine {
                segment: number,
                time_s: raw.time_s[i],
                position: raw.position[i],
                velocity: calm[k],
                ..Fine::default()
            };
            add_point(&mut self.fine, point, fill);
        }
    }

    /// The mass or inertia, roughly.
    fn mass(&self) -> f64 {
        let column = |of: &dyn Fn(&Motion) -> f64| self.rows.iter().map(|r| of(&r.motion)).collect::<Vec<f64>>();
        let columns =
            [column(&|m| m.acceleration), column(&|m| m.velocity), column(&|m| m.velocity.signum()), column(&|_| 1.0)];
        let y: Vec<f64> = self.rows.iter().map(|r| r.target).collect();
        least_squares(&columns, &y, None).map_or(0.0, |fit| fit.values[0])
    }

    /// `inertial_noise`: of the force of the inertia in a row.
    fn track(self, raw: &Raw, inertial_noise: f64) -> Track {
        let mut rows = self.rows;
        let start_s = raw.time_s[0];
        for row in &mut rows {
            row.motion.time_s -= start_s;
        }
        let fine = self.fine.into_iter().map(|f| Fine { time_s: f.time_s - start_s, ..f }).collect();
        let span_s = rows.last().map_or(0.0, |r| r.motion.time_s) - rows.first().map_or(0.0, |r| r.motion.time_s);
        let worst = |k: usize| self.noises.iter().map(|n| n[k]).fold(0.0, f64::max);
        Track {
            rows,
            fine,
            period_s: self.period_s * self.block as f64,
            raw_period_s: self.period_s,
            velocity_noise: worst(0),
            position_noise: (averaged(self.block) * worst(2)).hypot(worst(3)),
            force_noise: (averaged(self.block) * worst(1)).max(f64::MIN_POSITIVE),
            inertial_noise,
            span_s,
            ..Track::of(raw.coordinate)
        }
    }
}

/// Mean of the line through the values.
fn trapezoid(values: &[f64]) -> f64 {
    let n = values.len();
    let ends = 0.5 * (values[0] + values[n - 1]);
    (ends + values[1..n - 1].iter().sum::<f64>()) / (n - 1) as f64
}

/// Mean of the line through the values with triangular weights over all of them.
fn hat(values: &[f64]) -> f64 {
    let half = (values.len() - 1) / 2;
    // Exact for lines between the samples: a correction of one third at the ends and at the top of the weights.
    let weight = |k: usize| match k {
        0 => 1.0 / 6.0,
        k if k == 2 * half => 1.0 / 6.0,
        k if k == half => half as f64 - 1.0 / 3.0,
        k => half as f64 - k.abs_diff(half) as f64,
    };
    values.iter().enumerate().map(|(k, v)| weight(k) * v).sum::<f64>() / (half * half) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_weights_of_a_hat_sum_to_one_and_keep_a_line() {
        for half in 1..6 {
            let ones = vec![1.0; 2 * half + 1];
            assert!((hat(&ones) - 1.0).abs() < 1e-12);
            let line: Vec<f64> = (0..=2 * half).map(|k| k as f64).collect();
            assert!((hat(&line) - half as f64).abs() < 1e-12);
        }
    }

    #[test]
    fn mean_velocities_of_two_blocks_differ_by_the_hats_acceleration() {
        // A piecewise linear velocity whose slope jumps in the middle of a block.
        let slope = |k: usize| if k < 7 { -2.0 } else { 3.0 };
        let mut velocity = vec![1.0];
        (0..20).for_each(|k| velocity.push(velocity[k] + 0.1 * slope(k)));
        let difference = (trapezoid(&velocity[10..=20]) - trapezoid(&velocity[0..=10])) / 1.0;
        // The acceleration is constant between samples: its mean with the triangular weights, step by step.
        let mean: f64 = (0..20)
            .map(|k| {
                let middle = 0.1 * (k as f64 + 0.5);
                0.1 * (1.0 - (middle - 1.0).abs()) * slope(k)
            })
            .sum();
        assert!((difference - mean).abs() < 1e-12, "{difference} {mean}");
    }
}
