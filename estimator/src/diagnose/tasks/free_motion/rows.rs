//! Rows of a free motion: the mean acceleration, and the motion over which it is averaged.
//!
//! The acceleration is a second difference of mean positions over three blocks, or a first difference of mean rates
//! over two if a rate was measured better. Either is exactly the mean of the true acceleration with the weights of
//! [`Weighing::Bell`] or [`Weighing::Tent`]. Long blocks have little noise and no bias, because laws are evaluated
//! between the rows and averaged with the same weights.

use crate::diagnose::data::interpolation::{add_point, points_and_samples};
use crate::diagnose::data::limits::{FEWEST, LEAST_PIECES, LONGEST_BLOCK_S, SHORTEST_S, SIGNIFICANT};
use crate::diagnose::data::regression_data::{Fine, Freely, Row, Span, Track, Weighing};
use estimation::identify::mechanism;
use estimation::identify::mechanism::Raw;
use foundation::estimate::EstimateError;
use foundation::signal::derive::{Derivatives, even_period, interpolate_cubic, savitzky_golay};
use foundation::signal::noise::{quantum, resolution_error, white_noise, white_noise_under_fast_motion};
use foundation::signal::pieces::pieces as uninterrupted;
use haptics::Vec2;
use haptics::law::Motion;
use haptics::recording::Recording;
use haptics::world::MechanismPath;
use std::ops::Range;

/// Longest block as a share of a radian of the swing. A longer one would blur effects at a place or a reversal.
/// Choice: no case of the ablation reads it.
const LONGEST_RAD: f64 = 0.3;
/// Ratio of noise to acceleration below which a block need not be longer.
/// Choice: no case of the ablation reads it.
const QUIET: f64 = 0.01;
/// Share of the noise below which a measured rate is used. A rate that was derived from the positions, perhaps with a
/// delay, is no better than they are.
/// Choice: no case of the ablation reads it.
const RATE_BETTER: f64 = 0.3;
/// Deviation from an even clock, as a share of a step, up to which time stamps count as rounded.
/// Choice: no case of the ablation reads it.
const ROUNDED: f64 = 0.03;
/// Order of the local polynomials between the rows, and their least number of samples on either side.
/// Choice: no case of the ablation reads it.
const ORDER: usize = 4;
/// Derived: the least window with more samples than the five coefficients of a polynomial of order four.
const LEAST_HALF: usize = 3;

/// The rows of one recording, with forces of zero and an inertia of one.
///
/// `bad`: samples that no sensor measured; `path`: path along which a tool's coordinate is measured, its own if `None`.
///
/// # Errors
/// No coordinate, no clock, or too few samples in one segment: in a sentence.
pub fn track(recording: &Recording, bad: &[bool], path: Option<&MechanismPath>) -> Result<Track, EstimateError> {
    let raw = mechanism::raw(recording, path)?;
    let (pieces, period_s) = pieces(&raw, bad);
    let plan = Plan::of(&pieces, period_s);
    let mut made = Made { rows: Vec::new(), fine: Vec::new() };
    for piece in &pieces {
        made.piece(piece, &plan);
    }
    if made.rows.is_empty() {
        return Err(EstimateError::TooFewSamples {
            recording: recording.name.clone(),
            samples: pieces.iter().map(|piece| piece.time_s.len()).max().unwrap_or(0),
            what: " in one uninterrupted piece".to_owned(),
            needed: LEAST_PIECES * plan.block,
        });
    }
    Ok(made.track(&raw, &plan, recording.meta.gravity()))
}

/// Samples on an even clock.
pub(super) struct Piece {
    pub(super) time_s: Vec<f64>,
    pub(super) position: Vec<f64>,
    rate: Option<Vec<f64>>,
}

/// Segments without a gap, and the usual time step, s.
pub(super) fn pieces(raw: &Raw, bad: &[bool]) -> (Vec<Piece>, f64) {
    let (found, period_s) = uninterrupted(&raw.time_s, &|i| !bad.get(i).copied().unwrap_or(false));
    let long = found.into_iter().filter(|range| range.len() > 2 * LEAST_HALF + 1);
    (long.map(|range| Piece::of(raw, range, period_s)).collect(), period_s)
}

impl Piece {
    fn of(raw: &Raw, range: Range<usize>, period_s: f64) -> Self {
        let (time_s, position) = (&raw.time_s[range.clone()], &raw.position[range.clone()]);
        let rate = raw.rate.as_ref().map(|rate| &rate[range.clone()]);
        let clock = clock(time_s, period_s);
        if even_period(time_s).is_some() || is_rounded(time_s, &clock) {
            return Self { time_s: clock, position: position.to_vec(), rate: rate.map(<[f64]>::to_vec) };
        }
        let steps = ((time_s[time_s.len() - 1] - time_s[0]) / period_s).floor() as usize;
        let even: Vec<f64> = (0..=steps).map(|k| time_s[0] + k as f64 * period_s).collect();
        let onto = |values: &[f64]| interpolate_cubic(time_s, values, &even);
        Self { position: onto(position), rate: rate.map(onto), time_s: even }
    }
}

/// Even times from the first to the last one; the usual step if there is only one.
fn clock(time_s: &[f64], period_s: f64) -> Vec<f64> {
    let last = time_s.len() - 1;
    let step_s = if last > 0 { (time_s[last] - time_s[0]) / last as f64 } else { period_s };
    (0..time_s.len()).map(|k| time_s[0] + k as f64 * step_s).collect()
}

fn is_rounded(time_s: &[f64], clock: &[f64]) -> bool {
    let most_s = ROUNDED * (clock[clock.len() - 1] - clock[0]) / (clock.len() - 1) as f64;
    time_s.iter().zip(clock).all(|(t, c)| (t - c).abs() <= most_s)
}

/// Settings for making rows.
struct Plan {
    period_s: f64,
    /// Samples a block.
    block: usize,
    /// True if accelerations come from the rates.
    by_rate: bool,
    /// Noise of the acceleration of a row, m/s² or rad/s².
    acceleration_noise: f64,
    /// Position noise of a sample, and the uncertainty that the sensor's steps hide however long the object stands, m
    /// or rad.
    position_noise: f64,
    hidden: f64,
    /// Noise of a sample's rate, m/s or rad/s.
    rate_noise: Option<f64>,
}

impl Plan {
    fn of(pieces: &[Piece], period_s: f64) -> Self {
        let worst = |of: &dyn Fn(&Piece) -> f64| pieces.iter().map(of).fold(0.0, f64::max);
        let position_noise = worst(&|p| white_noise_under_fast_motion(&p.position));
        let hidden = worst(&|p| resolution_error(quantum(&p.position), white_noise(&p.position)));
        let rate_noise = pieces.iter().all(|p| p.rate.is_some());
        let rate_noise = rate_noise.then(|| worst(&|p| p.rate.as_deref().map_or(0.0, white_noise_under_fast_motion)));
        let [speed, acceleration] = usual(pieces, period_s);
        let (_, step) = points_and_samples(period_s);
        let whole = |length_s: f64| (length_s / (period_s * step as f64)).round().max(1.0) as usize * step;
        let longest_s = (LONGEST_RAD * speed / acceleration.max(f64::MIN_POSITIVE)).clamp(SHORTEST_S, LONGEST_BLOCK_S);
        let (shortest, longest) = (whole(SHORTEST_S), whole(longest_s).max(whole(SHORTEST_S)));
        let by_place = |block: usize| {
            let length_s = block as f64 * period_s;
            // Rounded positions count as one observation per step that is passed.
            let steps =
                if hidden > 0.3 * position_noise { 2.0 * speed * length_s / hidden.max(1e-300) } else { f64::MAX };
            6.0_f64.sqrt() * position_noise / ((block as f64).min(steps.max(1.0)).sqrt() * length_s * length_s)
        };
        let by_rate =
            |block: usize| rate_noise.map(|noise| (2.0 / block as f64).sqrt() * noise / (block as f64 * period_s));
        // A block is no longer than a piece, however fast the clock.
        let most = pieces.iter().map(|p| p.position.len()).max().unwrap_or(0);
        let shortest_quiet = |noise: &dyn Fn(usize) -> f64| {
            let mut blocks = (shortest..=longest).step_by(step);
            blocks.find(|b| noise(*b) < QUIET * acceleration).unwrap_or(longest).min(most)
        };
        let block = shortest_quiet(&by_place);
        let mut plan = Self {
            period_s,
            block,
            by_rate: false,
            acceleration_noise: by_place(block),
            position_noise,
            hidden,
            rate_noise,
        };
        if by_rate(block).is_some_and(|noise| noise < RATE_BETTER * by_place(block)) {
            let noise = |block: usize| by_rate(block).unwrap_or(f64::MAX);
            plan = Self { block: shortest_quiet(&noise), by_rate: true, ..plan };
            plan.acceleration_noise = noise(plan.block);
        }
        plan
    }

    /// Number of samples on either side for the local polynomials.
    fn half(&self) -> usize {
        (self.block / 2).max(LEAST_HALF)
    }

    /// Noise of the rate and of the place between the rows.
    fn noise_between(&self) -> [f64; 2] {
        let half = self.half();
        let mut impulse = vec![0.0; 4 * half + 1];
        impulse[2 * half] = 1.0;
        let time_s: Vec<f64> = (0..impulse.len()).map(|k| k as f64 * self.period_s).collect();
        let answer = savitzky_golay(&time_s, &impulse, half, ORDER);
        let size = |values: &[f64]| values.iter().map(|v| v * v).sum::<f64>().sqrt();
        let place = self.position_noise * size(&answer.value);
        let rate = match self.rate_noise.filter(|_| self.by_rate) {
            Some(noise) => noise * size(&answer.value),
            None => self.position_noise * size(&answer.first),
        };
        [rate, place.hypot(self.hidden)]
    }
}

/// Root mean square of speed and acceleration.
fn usual(pieces: &[Piece], period_s: f64) -> [f64; 2] {
    let half = ((0.5 * LONGEST_BLOCK_S / period_s).round() as usize).max(LEAST_HALF);
    let (mut sums, mut count) = ([0.0; 2], 0.0);
    for piece in pieces {
        let Derivatives { first, second, .. } = savitzky_golay(&piece.time_s, &piece.position, half, 2);
        sums[0] += first.iter().map(|v| v * v).sum::<f64>();
        sums[1] += second.iter().map(|a| a * a).sum::<f64>();
        count += first.len() as f64;
    }
    sums.map(|sum| (sum / f64::max(count, 1.0)).sqrt())
}

/// Rows in the making.
struct Made {
    rows: Vec<Row>,
    fine: Vec<Fine>,
}

impl Made {
    fn piece(&mut self, piece: &Piece, plan: &Plan) {
        let (n, block) = (piece.position.len(), plan.block);
        if n < LEAST_PIECES * block + 3 {
            return;
        }
        let stretch = self.fine.last().map_or(0, |f| f.segment + 1);
        let smooth = savitzky_golay(&piece.time_s, &piece.position, plan.half(), ORDER);
        let rate = match piece.rate.as_ref().filter(|_| plan.by_rate) {
            Some(rate) => savitzky_golay(&piece.time_s, rate, plan.half(), ORDER).value,
            None => smooth.first,
        };
        let (fill, skip) = points_and_samples(plan.period_s);
        let per = |samples: usize| samples * fill / skip;
        // The first sample has no neighbour that its block's end needs.
        let first_fine = self.fine.len();
        for i in (1..n).step_by(skip) {
            let (time_s, position, velocity) = (piece.time_s[i], smooth.value[i], rate[i]);
            let point = Fine { segment: stretch, time_s, position, velocity, ..Fine::default() };
            add_point(&mut self.fine, point, fill);
        }
        // Of both ends of a row, in blocks.
        let reach = if plan.by_rate { 2 } else { 3 };
        let length_s = block as f64 * plan.period_s;
        for b in 0..((n - 3) / block + 1).saturating_sub(reach) {
            let start = 1 + b * block;
            let acceleration = if let Some(rate) = piece.rate.as_ref().filter(|_| plan.by_rate) {
                (mean(rate, start + block, block) - mean(rate, start, block)) / length_s
            } else {
                let place = |k: usize| mean(&piece.position, start + k * block, block);
                (place(2) - 2.0 * place(1) + place(0)) / (length_s * length_s)
            };
            let span = Span {
                start: first_fine + per(b * block),
                len: per(reach * block) + 1,
                weighing: if plan.by_rate { Weighing::Tent } else { Weighing::Bell },
            };
            self.row(span, acceleration, stretch);
        }
    }

    /// One row; the motion is that in its middle.
    fn row(&mut self, span: Span, acceleration: f64, stretch: usize) {
        let middle = [self.fine[span.start + (span.len - 1) / 2], self.fine[span.start + span.len / 2]];
        let half = |of: &dyn Fn(&Fine) -> f64| 0.5 * (of(&middle[0]) + of(&middle[1]));
        let motion = Motion {
            time_s: half(&|f| f.time_s),
            position: half(&|f| f.position),
            velocity: half(&|f| f.velocity),
            acceleration,
            ..Motion::default()
        };
        let along = Vec2::x();
        self.rows.push(Row { segment: stretch, motion, angle_rad: motion.position, along, span, ..Row::default() });
    }

    fn track(self, raw: &Raw, plan: &Plan, gravity_m_s2: f64) -> Track {
        let Self { rows, mut fine } = self;
        let start_s = raw.time_s[0];
        let [velocity_noise, position_noise] = plan.noise_between();
        let mut rows = moving(&rows, [velocity_noise, plan.acceleration_noise]);
        for row in &mut rows {
            row.motion.time_s -= start_s;
        }
        for point in &mut fine {
            point.time_s -= start_s;
        }
        let span_s = rows.last().map_or(0.0, |r| r.motion.time_s) - rows.first().map_or(0.0, |r| r.motion.time_s);
        Track {
            rows,
            fine,
            period_s: plan.period_s * plan.block as f64,
            raw_period_s: plan.period_s,
            velocity_noise,
            position_noise,
            force_noise: plan.acceleration_noise.max(f64::MIN_POSITIVE),
            span_s,
            freely: Some(Freely {
                inertia: 1.0,
                relative_error: 0.0,
                is_known: false,
                gravity_m_s2,
                is_energy: false,
                known: [None; 3],
            }),
            ..Track::of(raw.coordinate)
        }
    }
}

/// The rows without the standing ones, in which friction may take any value. Segments are numbered again. `noise`: of
/// velocity and acceleration.
fn moving(rows: &[Row], noise: [f64; 2]) -> Vec<Row> {
    let still = |row: &Row| {
        row.motion.velocity.abs() < SIGNIFICANT * noise[0] && row.motion.acceleration.abs() < SIGNIFICANT * noise[1]
    };
    let (mut moving, mut number) = (Vec::with_capacity(rows.len()), 0);
    for stretch in rows.chunk_by(|a, b| a.segment == b.segment) {
        for part in stretch.chunk_by(|a, b| still(a) == still(b)) {
            if still(&part[0]) && part.len() >= FEWEST {
                number += 1;
            } else {
                moving.extend(part.iter().map(|row| Row { segment: number, ..*row }));
            }
        }
        number += 1;
    }
    moving
}

/// Mean over a block from sample `from` on, one neighbour on either side at hand: the trapezoidal rule with its first
/// correction (Euler and Maclaurin), exact for cubics.
fn mean(values: &[f64], from: usize, block: usize) -> f64 {
    let end = from + block;
    let ends = 0.5 * (values[from] + values[end]);
    let plain = ends + values[from + 1..end].iter().sum::<f64>();
    let slopes = (values[end + 1] - values[end - 1]) - (values[from + 1] - values[from - 1]);
    (plain - slopes / 24.0) / block as f64
}
