//! From a recording to the coordinate of a mechanism, its derivatives and the force along it: one zero-phase filter for all.

use super::resampling::Resampled;
use super::zero_step::ZeroStep;
use crate::identify::limits::LEAST_SEGMENT_ROWS;
use crate::regression::linear::COLUMN_NOISE_UNCERTAINTY;
use foundation::estimate::EstimateError;
use foundation::signal::derive::{central_differences, interpolate_cubic, stencil};
use foundation::signal::filter::{MAX_CUTOFF_SHARE, derivative_noise, edge_samples, low_pass};
use foundation::signal::noise::quantum;
use haptics::law::{Coordinate, Motion};
use haptics::recording::Recording;
use haptics::world::{Mechanism, MechanismPath};
use std::f64::consts::TAU;

/// Step in periods above which a segment ends.
/// Choice: halved or doubled, none of 5 answers changes.
const GAP_PERIODS: f64 = 10.0;
/// Noise that a filter lets through on a derivative, as a share of the derivative: the noise biases the inertia by the
/// square of this share.
/// Derived: the square root of a bias of 0.1 %.
pub(super) const DERIVATIVE_NOISE: f64 = 0.03;
/// Largest ratio of the cut-off to the fastest motion that matters: further up there is noise only.
/// Choice: halved or doubled, none of 5 answers changes.
const CUTOFF_OVER_MOTION_MAX: f64 = 100.0;
/// Least ratio of the cut-off to the fastest motion that matters.
/// Choice: halved or doubled, none of 5 answers changes.
pub(super) const CUTOFF_OVER_MOTION: f64 = 3.0;

/// Coordinate and force as recorded: every recording form is reduced to it.
#[derive(Clone, Debug)]
pub struct Raw {
    /// Length or angle.
    pub coordinate: Coordinate,
    /// Sample times, s.
    pub time_s: Vec<f64>,
    /// m or rad, unwrapped.
    pub position: Vec<f64>,
    /// Measured rate, when it was recorded.
    pub rate: Option<Vec<f64>>,
    /// N or N m along +coordinate; `None` for a free motion.
    pub force: Option<Vec<f64>>,
    /// Share of the upward unit vector along +coordinate at each sample, for a planar or spatial tool path.
    pub up_along: Option<Vec<f64>>,
    /// Force samples at the sensor's limit.
    pub saturated: Vec<bool>,
}

/// Variances of the noise left on the filtered motion, for the regressors made of it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StateNoise {
    /// Of the position, m² or rad².
    pub position: f64,
    /// Of the velocity, per s².
    pub velocity: f64,
    /// Of the acceleration, per s⁴.
    pub acceleration: f64,
    /// Covariance of position and acceleration, per s²: minus the velocity's variance when both come from the position.
    pub position_acceleration: f64,
}

impl StateNoise {
    /// All variances times `factor`.
    fn times(self, factor: f64) -> Self {
        Self {
            position: factor * self.position,
            velocity: factor * self.velocity,
            acceleration: factor * self.acceleration,
            position_acceleration: factor * self.position_acceleration,
        }
    }
}

/// Filtered signals of one segment of a recording without a gap, evenly sampled.
#[derive(Clone, Debug)]
pub struct Piece {
    /// Motion at every sample, direction not yet blurred: sign of the filtered velocity.
    pub motion: Vec<Motion>,
    /// Direction of motion, −1 … 1, blurred by the velocity noise, before the common filter.
    pub direction: Vec<f64>,
    /// Filtered force, N or N m.
    pub force: Option<Vec<f64>>,
    /// Step of the force channel's zero somewhere in the recording.
    pub zero_steps: Vec<ZeroStep>,
    /// True if the force was late: a lag was taken out of it.
    pub is_late: bool,
    /// Standard deviation of the noise left on the filtered force, N or N m, as expected of fast noise.
    pub force_noise: f64,
    /// Samples that are neither at an end nor saturated.
    pub usable: Vec<bool>,
    /// Sampling period, s.
    pub period_s: f64,
    /// Cut-off of the filter, Hz.
    pub cutoff_hz: f64,
    /// Standard deviation of the noise left on the velocity, m/s or rad/s.
    pub velocity_noise: f64,
    /// Variances of the noise left on the motion, as expected.
    pub noise: StateNoise,
    /// Share of that noise which comes from the resolution of the positions, 0 … 1.
    pub from_resolution: f64,
    /// True when there is an acceleration that stands clear of its noise.
    pub accelerates: bool,
    /// Index of the first sample of this segment in the recording (nearest, if it was resampled).
    pub first: usize,
    /// Time of the first sample, s.
    pub start_s: f64,
}

impl Piece {
    /// Relative uncertainty of the noise of the motion. The effect of rounding in the band of the motion depends on the
    /// rate at which the steps pass: between nothing and as much as white noise of that size.
    pub fn noise_known_to(&self) -> f64 {
        COLUMN_NOISE_UNCERTAINTY + 0.5 * self.from_resolution
    }

    /// Times of the samples, s.
    pub fn times_s(&self) -> impl Iterator<Item = f64> {
        (0..self.motion.len()).map(|k| self.start_s + k as f64 * self.period_s)
    }

    /// Filtered force, N or N m; zero for a free motion.
    pub fn applied_force(&self) -> Vec<f64> {
        self.force.clone().unwrap_or_else(|| vec![0.0; self.motion.len()])
    }

    /// The segment with its force this much earlier, s. Samples without a force at their new time are not usable.
    pub fn with_force_earlier(&self, by_s: f64) -> Self {
        let times_s: Vec<f64> = self.times_s().collect();
        let wanted: Vec<f64> = times_s.iter().map(|t| t + by_s).collect();
        let last_s = times_s[times_s.len() - 1];
        let inside = wanted.iter().map(|t| (self.start_s..=last_s).contains(t));
        Self {
            force: self.force.as_ref().map(|force| interpolate_cubic(&times_s, force, &wanted)),
            usable: self.usable.iter().zip(inside).map(|(usable, inside)| *usable && inside).collect(),
            is_late: true,
            ..self.clone()
        }
    }

    /// The same zero-phase filter that the force went through.
    pub fn filter(&self, values: &[f64]) -> Vec<f64> {
        low_pass(values, 1.0 / self.period_s, self.cutoff_hz)
    }

    /// Root mean square of a motion quantity over the usable samples.
    pub fn rms(&self, of: impl Fn(&Motion) -> f64) -> f64 {
        let used = self.motion.iter().zip(&self.usable).filter(|(_, u)| **u);
        let (sum, n) = used.fold((0.0, 0), |(s, n), (m, _)| (s + of(m).powi(2), n + 1));
        (sum / f64::from(n.max(1))).sqrt()
    }
}

/// The coordinate and the force along it, from columns or by projection onto `path`.
pub fn raw(recording: &Recording, path: Option<&MechanismPath>) -> Result<Raw, EstimateError> {
    let time_s = recording.time_s.clone().ok_or_else(|| EstimateError::Clockless {
        what: "a mechanism's inertia and viscous friction".to_owned(),
        recording: recording.name.clone(),
    })?;
    let direct = [("q_m", "dq_m_s", "f_N", Coordinate::Linear), ("q_rad", "dq_rad_s", "tau_Nm", Coordinate::Angular)];
    for (position, rate, force, coordinate) in direct {
        let Some(values) = recording.channel(position) else { continue };
        return Ok(Raw {
            coordinate,
            time_s,
            position: values.to_vec(),
            rate: recording.channel(rate).map(<[f64]>::to_vec),
            force: recording.channel(force).map(<[f64]>::to_vec),
            up_along: None,
            saturated: saturated(recording, &[force]),
        });
    }
    let Some(path) = path else {
        if super::path::points(recording).is_some() {
            return Err(EstimateError::Other(format!(
                "the path of {} is not decided to be a line or a circle, so there is no coordinate along which its force acts; record the coordinate itself (q_m or q_rad), or a longer part of the path",
                recording.name
            )));
        }
        return Err(EstimateError::MissingColumn {
            task: "a mechanism".to_owned(),
            column: "q_m, q_rad, or x_m and y_m".to_owned(),
            recording: recording.name.clone(),
        });
    };
    let projected = super::path::project(recording, path)?;
    Ok(Raw {
        coordinate: match path {
            MechanismPath::Prismatic { .. } => Coordinate::Linear,
            MechanismPath::Revolute { .. } => Coordinate::Angular,
        },
        time_s,
        position: projected.position,
        rate: None,
        force: projected.force,
        up_along: projected.up_along,
        saturated: saturated(recording, &["fx_N", "fy_N", "fz_N"]),
    })
}

/// Samples at which one of the columns is flagged as saturated.
pub fn saturated(recording: &Recording, columns: &[&str]) -> Vec<bool> {
    let mut flags = vec![false; recording.len()];
    let about = |column: &Option<String>| column.as_deref().is_some_and(|c| columns.contains(&c));
    for warning in recording.warnings.iter().filter(|w| w.kind == "saturation" && about(&w.column)) {
        for span in &warning.spans {
            flags[span.first..span.end.min(recording.len())].fill(true);
        }
    }
    flags
}

/// Cuts at gaps, resamples uneven segments, filters and derives. Segments that are too short are left out.
pub fn pieces(raw: &Raw, name: &str) -> Result<Vec<Piece>, EstimateError> {
    let (spans, median) = uninterrupted(&raw.time_s, name)?;
    let found: Vec<Piece> = spans.into_iter().map(|(first, end)| piece(raw, first, end, median, None)).collect();
    if found.iter().all(|p| !p.usable.contains(&true)) { Err(too_few(name, raw.time_s.len())) } else { Ok(found) }
}

/// The segments of all recordings behind filters whose cut-offs are this share of those of `usual`.
pub fn pieces_below(raws: &[Raw], usual: &[Piece], share: f64) -> Result<Vec<Piece>, EstimateError> {
    let mut usual = usual.iter();
    let mut found = Vec::new();
    for raw in raws {
        let (spans, median) = uninterrupted(&raw.time_s, "")?;
        for ((first, end), usual) in spans.into_iter().zip(usual.by_ref()) {
            found.push(piece(raw, first, end, median, Some((share * usual.cutoff_hz, usual.accelerates))));
        }
    }
    Ok(found)
}

/// Segments without a gap that are long enough (first sample, end), and the usual step, s.
pub fn uninterrupted(time_s: &[f64], name: &str) -> Result<(Vec<(usize, usize)>, f64), EstimateError> {
    let n = time_s.len();
    let mut steps: Vec<f64> = time_s.windows(2).map(|w| w[1] - w[0]).collect();
    if steps.len() + 1 < LEAST_SEGMENT_ROWS {
        return Err(too_few(name, n));
    }
    let middle = steps.len() / 2;
    let median = *steps.select_nth_unstable_by(middle, f64::total_cmp).1;
    let mut cuts = vec![0];
    cuts.extend((1..n).filter(|&i| time_s[i] - time_s[i - 1] > GAP_PERIODS * median));
    cuts.push(n);
    let longest = cuts.windows(2).map(|w| w[1] - w[0]).max().unwrap_or(0);
    let spans: Vec<_> = cuts.windows(2).map(|w| (w[0], w[1])).filter(|(a, b)| b - a >= LEAST_SEGMENT_ROWS).collect();
    if spans.is_empty() { Err(too_few(name, longest)) } else { Ok((spans, median)) }
}

fn too_few(name: &str, samples: usize) -> EstimateError {
    EstimateError::TooFewSamples {
        recording: name.to_owned(),
        samples,
        what: " in one uninterrupted piece".to_owned(),
        needed: LEAST_SEGMENT_ROWS,
    }
}

/// `known`: the cut-off, and true if the acceleration stands clear of its noise; they are sought if `None`.
fn piece(raw: &Raw, first: usize, end: usize, period: f64, known: Option<(f64, bool)>) -> Piece {
    let time = &raw.time_s[first..end];
    let even = Resampled::new(time, period);
    let onto = |values: &[f64]| even.onto(&values[first..end]);
    let position = onto(&raw.position);
    let measured_rate = raw.rate.as_ref().map(|r| Noisy { values: onto(r), noise: even.noise(&r[first..end]) });
    let saturated = even.flags(time, &raw.saturated[first..end]);
    let raw_force = raw.force.as_ref().map(|f| onto(f));
    let rate_hz = 1.0 / even.period_s;

    let position_noise = even.noise(&raw.position[first..end]);
    let choice = match known {
        Some((cutoff_hz, accelerates)) => Choice { cutoff_hz, position_noise, accelerates },
        None => choose_cutoff(&position, position_noise, rate_hz),
    };
    let rounding = quantum(&raw.position[first..end]).powi(2) / 12.0;
    let from_resolution = (rounding / choice.position_noise.powi(2).max(f64::MIN_POSITIVE)).min(1.0);
    let derived = derive(&position, measured_rate.as_ref(), rate_hz, &choice);
    let up = raw.up_along.as_ref().map(|u| onto(u));
    let grid = &even.grid;
    let n = grid.len();
    let motion: Vec<Motion> = (0..n)
        .map(|i| Motion {
            time_s: grid[i],
            position: derived.position[i],
            velocity: derived.velocity[i],
            acceleration: derived.acceleration[i],
            direction: derived.velocity[i].signum(),
            normal_force_n: 0.0,
            up_along: up.as_ref().map_or(0.0, |u| u[i]),
        })
        .collect();
    let velocity_noise = derived.noise.velocity.sqrt();
    let blur = noise_blur(velocity_noise);
    let edge = edge_samples(rate_hz, choice.cutoff_hz).min(n / 4);
    Piece {
        direction: even.through(&derived.velocity, |v| direction(v, blur)),
        motion,
        force_noise: raw
            .force
            .as_ref()
            .map_or(0.0, |force| derived_noise(even.noise(&force[first..end]), rate_hz, choice.cutoff_hz, 0)),
        force: raw_force.as_ref().map(|f| low_pass(f, rate_hz, choice.cutoff_hz)),
        zero_steps: Vec::new(),
        is_late: false,
        usable: (0..n).map(|i| i >= edge && i + edge < n && !saturated[i]).collect(),
        period_s: even.period_s,
        cutoff_hz: choice.cutoff_hz,
        velocity_noise,
        noise: derived.noise.times(1.0 - 0.5 * from_resolution),
        from_resolution,
        accelerates: choice.accelerates,
        first,
        start_s: grid[0],
    }
}

/// Speed within which the sign of a velocity with this noise is uncertain (`facts/diagnosis.md`, step 2).
pub fn noise_blur(velocity_noise: f64) -> f64 {
    1.2 * velocity_noise
}

/// Direction of motion in −1 … 1.
pub fn direction(velocity: f64, blur: f64) -> f64 {
    if blur > 0.0 {
        (velocity / blur).tanh()
    } else if velocity == 0.0 {
        0.0
    } else {
        velocity.signum()
    }
}

struct Choice {
    cutoff_hz: f64,
    position_noise: f64,
    accelerates: bool,
}

/// Noise that white position noise σ leaves on velocity and acceleration after the filter.
fn derived_noise(sigma: f64, rate_hz: f64, cutoff_hz: f64, order: i32) -> f64 {
    sigma * derivative_noise(rate_hz, cutoff_hz, order).sqrt()
}

/// A channel with the standard deviation of its white noise.
struct Noisy {
    values: Vec<f64>,
    noise: f64,
}

/// The highest cut-off at which the acceleration still stands clear of its noise: within that bound, more bandwidth
/// means better resolved reversals. Without an acceleration to speak of, the same for the velocity.
fn choose_cutoff(position: &[f64], sigma: f64, rate_hz: f64) -> Choice {
    let bottom = (8.0 * rate_hz / position.len() as f64).min(MAX_CUTOFF_SHARE * rate_hz);
    let ladder =
        || std::iter::successors(Some(MAX_CUTOFF_SHARE * rate_hz), |c| Some(c * 0.8)).take_while(move |c| *c >= bottom);
    let choice = |cutoff_hz, accelerates| Choice { cutoff_hz, position_noise: sigma, accelerates };
    let mut fallback = bottom;
    for cutoff in ladder() {
        let (velocity, acceleration) = stencil(&low_pass(position, rate_hz, cutoff), 1.0 / rate_hz);
        let edge = edge_samples(rate_hz, cutoff).min(position.len() / 4);
        let inner = edge..position.len() - edge;
        let noise = derived_noise(sigma, rate_hz, cutoff, 2);
        let clean = clean_rms(&acceleration[inner.clone()], noise);
        let speed = clean_rms(&velocity[inner], derived_noise(sigma, rate_hz, cutoff, 1));
        if fallback == bottom && derived_noise(sigma, rate_hz, cutoff, 1) <= DERIVATIVE_NOISE * speed {
            fallback = cutoff;
        }
        // The frequency at which most of the motion takes place.
        let motion_hz = clean / (TAU * speed.max(f64::MIN_POSITIVE));
        let quiet = noise <= DERIVATIVE_NOISE * clean && cutoff <= CUTOFF_OVER_MOTION_MAX * motion_hz;
        let as_low_as_can_be = cutoff < CUTOFF_OVER_MOTION * motion_hz && clean > 2.0 * noise;
        if clean > 0.0 && (quiet || as_low_as_can_be) {
            return choice(cutoff, true);
        }
    }
    choice(fallback, false)
}

/// Root mean square of a noisy signal with the noise's share taken out.
fn clean_rms(values: &[f64], noise: f64) -> f64 {
    let total = rms(values);
    (total * total - noise * noise).max(0.0).sqrt()
}

fn rms(values: &[f64]) -> f64 {
    (values.iter().map(|v| v * v).sum::<f64>() / values.len().max(1) as f64).sqrt()
}

struct Derived {
    position: Vec<f64>,
    velocity: Vec<f64>,
    acceleration: Vec<f64>,
    noise: StateNoise,
}

/// Velocity and acceleration from the positions, or from the measured rate where that is the quieter source and agrees.
fn derive(position: &[f64], measured: Option<&Noisy>, rate_hz: f64, choice: &Choice) -> Derived {
    let cutoff = choice.cutoff_hz;
    let smooth = low_pass(position, rate_hz, cutoff);
    let (velocity, acceleration) = stencil(&smooth, 1.0 / rate_hz);
    let variance = |sigma: f64, order: i32| derived_noise(sigma, rate_hz, cutoff, order).powi(2);
    let sigma = choice.position_noise;
    let from_position = Derived {
        noise: StateNoise {
            position: variance(sigma, 0),
            velocity: variance(sigma, 1),
            acceleration: variance(sigma, 2),
            position_acceleration: -variance(sigma, 1),
        },
        position: smooth,
        velocity,
        acceleration,
    };
    let Some(measured) = measured else { return from_position };
    let noise = StateNoise {
        velocity: variance(measured.noise, 0),
        acceleration: variance(measured.noise, 1),
        position_acceleration: 0.0,
        ..from_position.noise
    };
    let filtered = low_pass(&measured.values, rate_hz, cutoff);
    // Slope of the measured rate on the derived one: anything but 1 is a unit, a sign or a delay.
    let product: f64 = filtered.iter().zip(&from_position.velocity).map(|(a, b)| a * b).sum();
    let power: f64 = from_position.velocity.iter().map(|v| v * v).sum();
    let agrees = (product / power.max(f64::MIN_POSITIVE) - 1.0).abs() < 0.05;
    if !agrees || noise.velocity >= from_position.noise.velocity {
        return from_position;
    }
    let (acceleration, _) = stencil(&filtered, 1.0 / rate_hz);
    Derived { velocity: filtered, acceleration, noise, ..from_position }
}

/// The motion at every sample of the recording, for a prediction (also at the ends and across gaps).
pub fn motion(raw: &Raw, mechanism: &Mechanism) -> Vec<Motion> {
    let n = raw.time_s.len();
    let mut out: Vec<Motion> = Vec::with_capacity(n);
    let Ok(pieces) = pieces(raw, "") else { return crude_motion(raw, mechanism) };
    let blur = |p: &Piece| mechanism.direction_blur.max(noise_blur(p.velocity_noise));
    for piece in &pieces {
        // Samples before the segment (too short to filter, or in a gap) hold still.
        fill_still(raw, &mut out, piece.first);
        let end_s = piece.start_s + (piece.motion.len() - 1) as f64 * piece.period_s;
        while out.len() < n && raw.time_s[out.len()] <= end_s + 0.5 * piece.period_s {
            let at = (raw.time_s[out.len()] - piece.start_s) / piece.period_s;
            let state = blend(&piece.motion, at);
            out.push(Motion { direction: direction(state.velocity, blur(piece)), ..state });
        }
    }
    fill_still(raw, &mut out, n);
    out
}

fn fill_still(raw: &Raw, out: &mut Vec<Motion>, until: usize) {
    while out.len() < until {
        let i = out.len();
        out.push(Motion { time_s: raw.time_s[i], position: raw.position[i], ..Motion::default() });
    }
}

/// Linear interpolation between the two neighbouring samples of a segment.
fn blend(motion: &[Motion], at: f64) -> Motion {
    let low = (at.floor().max(0.0) as usize).min(motion.len() - 1);
    let high = (low + 1).min(motion.len() - 1);
    let share = (at - low as f64).clamp(0.0, 1.0);
    let mix = |of: fn(&Motion) -> f64| of(&motion[low]) + share * (of(&motion[high]) - of(&motion[low]));
    Motion {
        time_s: mix(|m| m.time_s),
        position: mix(|m| m.position),
        velocity: mix(|m| m.velocity),
        acceleration: mix(|m| m.acceleration),
        direction: 0.0,
        normal_force_n: 0.0,
        up_along: mix(|m| m.up_along),
    }
}

/// Plain differences, for a recording that is too short to filter.
fn crude_motion(raw: &Raw, mechanism: &Mechanism) -> Vec<Motion> {
    let velocity = central_differences(&raw.time_s, &raw.position);
    let acceleration = central_differences(&raw.time_s, &velocity);
    (0..raw.time_s.len())
        .map(|i| Motion {
            time_s: raw.time_s[i],
            position: raw.position[i],
            velocity: velocity[i],
            acceleration: acceleration[i],
            direction: direction(velocity[i], mechanism.direction_blur),
            normal_force_n: 0.0,
            up_along: raw.up_along.as_ref().map_or(0.0, |u| u[i]),
        })
        .collect()
}
