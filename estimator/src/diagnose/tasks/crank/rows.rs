//! Rows of a crank's recording: positions and forces of the fingers or tool that hold the handle.

use super::contact_phases::held_and_free;
use super::handle_motion::HandleMotion;
use super::path::{Arm, unwrapped};
use super::path_points::{Path, PathPoint};
use crate::diagnose::data::hung_weight::Hung;
use crate::diagnose::data::interpolation::{acceleration, add_point, calmed, mean_step_s, offsets, points_and_samples};
use crate::diagnose::data::limits::{FAST_ROW_S, LEAST_ROWS_OF_A_FIT};
use crate::diagnose::data::regression_data::{Fine, Place, Row, Track};
use foundation::estimate::EstimateError;
use foundation::signal::derive::savitzky_golay;
use foundation::signal::noise::{white_noise, white_noise_under_fast_motion};
use foundation::signal::task::{is_two_fingered, times};
use haptics::Vec2;
use haptics::hand::JointAngles;
use haptics::law::{Coordinate, Motion};
use haptics::recording::Recording;

/// Window of the acceleration, s.
/// Choice: halved or doubled, none of 43 answers changes.
const ACCELERATION_WINDOW_S: f64 = 0.09;

/// Signals at the rate of the rows, each the mean of the same samples.
pub struct Signals {
    pub time_s: Vec<f64>,
    pub position: Vec<Vec2>,
    pub velocity: Vec<Vec2>,
    pub force: Vec<Vec2>,
    /// True if two fingers hold the handle. Positions are then means of both tips.
    pub two_fingered: bool,
    /// Compliance of a pad along the line of the grip, m/N, whose give is taken off the positions.
    grip_m_n: Option<f64>,
    /// Joint angles of each finger, if recorded.
    joints: [Option<Vec<JointAngles>>; 2],
    pub held: Vec<bool>,
    pub free: Vec<bool>,
    pub period_s: f64,
    /// Sampling period of the recording itself, s.
    pub raw_period_s: f64,
    /// Recorded samples a row.
    every: usize,
    /// Time, position and smoothed velocity of every recorded sample.
    raw: RawMotion,
}

/// Map from the recorded force axes to the true ones: some cables are swapped or inverted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Axes {
    pub swapped: bool,
    pub signs: [f64; 2],
}

impl Axes {
    fn of(self, force: Vec2) -> Vec2 {
        let force = if self.swapped { force.yx() } else { force };
        Vec2::new(self.signs[0] * force.x, self.signs[1] * force.y)
    }
}

/// Recorded motion at its own rate.
struct RawMotion {
    time_s: Vec<f64>,
    position: Vec<Vec2>,
    velocity: Vec<Vec2>,
    /// Noise of one sample after smoothing, relative to before.
    calmed_to: f64,
    /// Velocity as recorded, from which its noise is estimated.
    as_recorded: Vec<Vec2>,
}

/// The motion at an instant between two samples.
struct Between {
    time_s: f64,
    position: Vec2,
    velocity: Vec2,
    /// The nearest sample.
    nearest: usize,
}

impl RawMotion {
    /// `offset`: samples after the one of index `first`.
    fn between(&self, first: usize, offset: f64) -> Between {
        let last = self.time_s.len() - 1;
        let whole = offset.max(0.0) as usize;
        let (k, part) = ((first + whole).min(last), offset.max(0.0) - whole as f64);
        let next = (k + 1).min(last);
        Between {
            time_s: self.time_s[k] + part * (self.time_s[next] - self.time_s[k]),
            position: self.position[k] + (self.position[next] - self.position[k]) * part,
            velocity: self.velocity[k] + (self.velocity[next] - self.velocity[k]) * part,
            nearest: if part < 0.5 { k } else { next },
        }
    }
}

impl Signals {
    /// `bad`: samples that no sensor measured.
    pub fn of(recording: &Recording, bad: &[bool]) -> Result<Self, EstimateError> {
        let time_s = times(recording);
        let HandleMotion { position, velocity, force, grip_m_n } = HandleMotion::of(recording)?;
        let n = time_s.len();
        let (mut held, mut free) = held_and_free(recording, &time_s, &force)?;
        for (i, bad) in bad.iter().enumerate().filter(|(_, b)| **b) {
            (held[i], free[i]) = (held[i] && !bad, free[i] && !bad);
        }
        let period_s = mean_step_s(&time_s);
        let every = (FAST_ROW_S / period_s).round().max(1.0) as usize;
        let groups = n / every;
        let mean = |values: &[Vec2]| -> Vec<Vec2> {
            (0..groups).map(|g| values[g * every..(g + 1) * every].iter().sum::<Vec2>() / every as f64).collect()
        };
        let number = |values: &[f64]| -> Vec<f64> {
            (0..groups).map(|g| values[g * every..(g + 1) * every].iter().sum::<f64>() / every as f64).collect()
        };
        let all = |flags: &[bool]| -> Vec<bool> {
            (0..groups).map(|g| flags[g * every..(g + 1) * every].iter().all(|f| *f)).collect()
        };
        let angles = |bottom: &str, top: &str| -> Option<Vec<JointAngles>> {
            let pairs = number(recording.channel(bottom)?).into_iter().zip(number(recording.channel(top)?));
            Some(pairs.map(|(bottom_rad, top_rad)| JointAngles { bottom_rad, top_rad }).collect())
        };
        let two_fingered = is_two_fingered(recording);
        let joints = if two_fingered {
            [angles("qb1_rad", "qt1_rad"), angles("qb2_rad", "qt2_rad")]
        } else {
            [angles("qb_rad", "qt_rad"), None]
        };
        let (calm, calmed_to) = calmed(&velocity, period_s);
        Ok(Self {
            every,
            time_s: number(&time_s).iter().map(|t| t - time_s[0]).collect(),
            position: mean(&position),
            velocity: mean(&velocity),
            force: mean(&force),
            two_fingered,
            grip_m_n,
            joints,
            held: all(&held),
            free: all(&free),
            period_s: period_s * every as f64,
            raw_period_s: period_s,
            raw: RawMotion {
                time_s: time_s.iter().map(|t| t - time_s[0]).collect(),
                position,
                velocity: calm,
                calmed_to,
                as_recorded: velocity,
            },
        })
    }

    /// The path of the handle, for the geometry.
    pub fn path(&self, recording: &Recording) -> Path {
        let fingers = recording.meta.hand().fingers;
        let two_fingered = self.two_fingered;
        // The position is the mean of both tips.
        let share = if two_fingered { 0.5 } else { 1.0 };
        let stretches = stretches(&self.held);
        let spread_s2 = self.raw_period_s.powi(2) * (self.every * self.every - 1) as f64 / 24.0;
        let points = stretches
            .iter()
            .enumerate()
            .flat_map(|(stretch, range)| range.clone().map(move |i| (stretch, i)))
            .map(|(stretch, i)| {
                let joint = |finger: usize| {
                    let q = self.joints[finger].as_ref()?[i];
                    let jacobian = fingers[finger].jacobian(q);
                    let length = Vec2::new(q.bottom_rad.cos(), q.bottom_rad.sin());
                    Some([Vec2::new(jacobian[(0, 1)], jacobian[(1, 1)]), length].map(|v| share * v))
                };
                PathPoint {
                    index: i,
                    stretch,
                    time_s: self.time_s[i],
                    position: self.position[i],
                    force: self.force[i],
                    joints: [joint(0), joint(1)],
                    // The radius times half the variance of the angle within the row.
                    inside_m2: self.velocity[i].norm_squared() * spread_s2,
                }
            })
            .collect();
        Path { points, period_s: self.period_s, two_fingered, grip_m_n: self.grip_m_n }
    }

    /// The rows along the circle of `arm`, then the free ones, with the force as it was recorded.
    pub fn rows(&self, recording: &Recording, arm: &Arm) -> Result<Track, EstimateError> {
        let up = if recording.meta.up.as_deref() == Some("-y") { -1.0 } else { 1.0 };
        let mut rows = Vec::new();
        let mut fine = Vec::new();
        let mut stretch_number = 0;
        let mut noise = Vec::new();
        let mut slope = None;
        for range in stretches(&self.held) {
            let (mut made, finest) = self.stretch(range.clone(), stretch_number, arm, up);
            slope = slope.max(Some(finest));
            noise.push(self.finely(range, arm, &mut made, &mut fine));
            rows.extend(made);
            stretch_number += 1;
        }
        if rows.len() < LEAST_ROWS_OF_A_FIT {
            return Err(EstimateError::TooFewSamples {
                recording: recording.name.clone(),
                samples: rows.len(),
                what: " in which the handle is held".to_owned(),
                needed: LEAST_ROWS_OF_A_FIT,
            });
        }
        rows.extend(self.free_rows(stretch_number));
        let (force_noise, noise_is_measured) = force_noise(&rows);
        Ok(Track {
            period_s: self.period_s,
            raw_period_s: self.raw_period_s,
            radius_m: Some(arm.radius_m),
            planar: true,
            velocity_noise: mean_square(&noise, 0),
            position_noise: mean_square(&noise, 1) / (self.every as f64).sqrt(),
            force_noise,
            noise_is_measured,
            span_s: self.time_s.last().copied().unwrap_or(0.0),
            hung: vec![Hung::on_crank(recording)],
            slope,
            rows,
            fine,
            ..Track::of(Coordinate::Linear)
        })
    }

    /// The rows of a segment, and the window and order of their acceleration.
    fn stretch(&self, range: std::ops::Range<usize>, stretch: usize, arm: &Arm, up: f64) -> (Vec<Row>, (usize, usize)) {
        let time = &self.time_s[range.clone()];
        let directions: Vec<(Vec2, Vec2)> = range
            .clone()
            .map(|i| {
                let outward = arm.arm(i, self.position[i]).normalize();
                (outward, Vec2::new(-outward.y, outward.x))
            })
            .collect();
        let speed: Vec<f64> =
            range.clone().zip(&directions).map(|(i, (_, along))| self.velocity[i].dot(along)).collect();
        let half = ((0.5 * ACCELERATION_WINDOW_S / self.period_s).round() as usize).max(2);
        let (acceleration, slope) = acceleration(time, &speed, half, self.period_s);
        let axis = |pick: fn(&Vec2) -> f64| {
            savitzky_golay(time, &self.force[range.clone()].iter().map(pick).collect::<Vec<_>>(), half.min(3), 2).first
        };
        let (rate_x, rate_y) = (axis(|f| f.x), axis(|f| f.y));
        let mut before = 0.0_f64;
        let rows = range
            .enumerate()
            .map(|(k, i)| {
                let (outward, along) = directions[k];
                before = unwrapped(outward, before);
                let angle = before;
                let force = self.force[i];
                Row {
                    segment: stretch,
                    motion: Motion {
                        time_s: self.time_s[i],
                        position: arm.radius_m * angle,
                        velocity: speed[k],
                        acceleration: acceleration[k],
                        normal_force_n: force.dot(&outward),
                        up_along: up * along.y,
                        ..Motion::default()
                    },
                    angle_rad: angle,
                    along,
                    force,
                    force_rate: Vec2::new(rate_x[k], rate_y[k]),
                    target: force.dot(&along),
                    ..Row::default()
                }
            })
            .collect();
        (rows, slope)
    }

    /// Adds the motion between the rows of a segment; returns the noise of its velocity, m/s, and of one recorded
    /// position, m.
    fn finely(&self, range: std::ops::Range<usize>, arm: &Arm, rows: &mut [Row], fine: &mut Vec<Fine>) -> [f64; 2] {
        let number = fine.last().map_or(0, |f: &Fine| f.segment + 1);
        let raw = &self.raw;
        // Recorded samples are thinned out, or interpolated, to about the same rate.
        let (fill, _) = points_and_samples(self.raw_period_s);
        let mut recorded = Vec::with_capacity(range.len() * self.every);
        let mut places = Vec::with_capacity(range.len() * self.every);
        let mut angle = 0.0_f64;
        for (row, i) in rows.iter_mut().zip(range) {
            for (k, offset) in offsets(self.every, self.raw_period_s).enumerate() {
                let at = raw.between(i * self.every, offset);
                let outward = arm.arm(i, at.position).normalize();
                let along = Vec2::new(-outward.y, outward.x);
                let near = if fine.last().is_some_and(|f| f.segment == number) { angle } else { row.angle_rad };
                angle = unwrapped(outward, near);
                let point = Fine {
                    segment: number,
                    time_s: at.time_s,
                    position: arm.radius_m * angle,
                    velocity: at.velocity.dot(&along),
                    ..Fine::default()
                };
                // Recorded positions, because interpolated ones have less noise.
                places.push(point.position + (raw.position[at.nearest] - at.position).dot(&along));
                recorded.push(raw.as_recorded[at.nearest].dot(&along));
                add_point(fine, point, fill);
                if k == 0 {
                    row.span.start = fine.len() - 1;
                }
            }
            row.span.len = fine.len() - row.span.start;
        }
        [raw.calmed_to * white_noise(&recorded), white_noise_under_fast_motion(&places)]
    }

    fn free_rows(&self, first_stretch: usize) -> Vec<Row> {
        let mut rows = Vec::new();
        for (k, range) in stretches(&self.free).into_iter().enumerate() {
            for (a, place) in [Place::FreeX, Place::FreeY].into_iter().enumerate() {
                rows.extend(range.clone().map(|i| Row {
                    segment: first_stretch + 2 * k + a,
                    place,
                    motion: Motion { time_s: self.time_s[i], ..Motion::default() },
                    along: if a == 0 { Vec2::x() } else { Vec2::y() },
                    force: self.force[i],
                    target: self.force[i][a],
                    ..Row::default()
                }));
            }
        }
        rows
    }
}

/// Noise of one row's force, N, and true if it was measured without touch.
fn force_noise(rows: &[Row]) -> (f64, bool) {
    let (mut square, mut count) = (0.0, 0_usize);
    let is_free = |row: &Row| matches!(row.place, Place::FreeX | Place::FreeY);
    for rows in rows.chunk_by(|a, b| a.segment == b.segment).filter(|rows| is_free(&rows[0])) {
        let mean = rows.iter().map(|r| r.target).sum::<f64>() / rows.len() as f64;
        square += rows.iter().map(|r| (r.target - mean).powi(2)).sum::<f64>();
        count += rows.len();
    }
    let is_measured = count > LEAST_ROWS_OF_A_FIT;
    let along = || rows.iter().filter(|r| r.place == Place::Along).map(|r| r.target).collect::<Vec<f64>>();
    let noise = if is_measured { (square / count as f64).sqrt() } else { white_noise(&along()) };
    (noise.max(f64::MIN_POSITIVE), is_measured)
}

/// The same motion with the recorded force in the true axes.
pub fn with_axes(as_recorded: &Track, axes: Axes) -> Track {
    let mut track = as_recorded.clone();
    for row in &mut track.rows {
        row.force = axes.of(row.force);
        match row.place {
            Place::FreeX => row.target = row.force.x,
            Place::FreeY => row.target = row.force.y,
            Place::Along | Place::Stuck { .. } => {
                row.force_rate = axes.of(row.force_rate);
                row.motion.normal_force_n = row.force.dot(&Vec2::new(row.along.y, -row.along.x));
                row.target = row.force.dot(&row.along);
            }
        }
    }
    (track.force_noise, track.noise_is_measured) = force_noise(&track.rows);
    track
}

/// Root mean square of one of the noises.
fn mean_square(noises: &[[f64; 2]], k: usize) -> f64 {
    (noises.iter().map(|n| n[k] * n[k]).sum::<f64>() / noises.len().max(1) as f64).sqrt()
}

/// Segments of held rows that are long enough to be differentiated.
fn stretches(flags: &[bool]) -> Vec<std::ops::Range<usize>> {
    let mut end = 0;
    let ranges = flags.chunk_by(|a, b| a == b).map(|run| {
        end += run.len();
        end - run.len()..end
    });
    ranges.filter(|range| flags[range.start] && range.len() >= 8).collect()
}
