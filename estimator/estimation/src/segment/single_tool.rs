//! Speed and load of a single tool, from which the rules tell not touched, held still and moved.

use super::resting::Resting;
use super::threshold::percentile;
use crate::constraint::frame::Frame;
use foundation::estimate::EstimateError;
use foundation::signal::derive::savitzky_golay;
use foundation::signal::task::{CUBIC_HALF, TipSeries, calmed_series, half_width, tip_series};
use haptics::Vec2;
use haptics::recording::Recording;
use nalgebra::Vector3;

/// Share of the usual load that a threshold keeps at least: leaning and friction are not noise, and not the event either.
const LOAD_SHARE: f64 = 0.05;
/// Level of a load above noise of this standard deviation, in multiples of it, from which it is told; below a share of
/// that it is none again.
const NOISE_MULTIPLE: f64 = 4.0;
const NOISY_LEAVE: f64 = 0.6;
/// Noise and bias that stay below the threshold by this multiple of the noise change nothing.
const CLEAR_OF_NOISE: f64 = 4.0;
/// Contact is not made and lost faster in a noisy recording, s.
const LEAST_CHANGE_S: f64 = 0.15;
/// Share of the variance between two classes from which a load has two levels. Derived: an even distribution has 0.75, and
/// the size of a sine 0.83.
const TWO_LEVELS: f64 = 0.87;
/// Share of the way from the lower level to the upper one at which a contact is told.
const ABOVE_LOWER: f64 = 0.1;

/// A single tool, in space: z is 0 where it was not recorded.
struct Tool {
    /// Position in the plane of the motion, m.
    position_m: Vec<Vec2>,
    speed_m_s: Vec<f64>,
    /// Force on the environment, N.
    force_n: Option<Vec<Vector3<f64>>>,
    /// True if the force has three axes.
    is_spatial: bool,
}

impl Tool {
    fn of(recording: &Recording) -> Result<Self, EstimateError> {
        let TipSeries { velocity, force, position } = tip_series(recording, "")?;
        let velocity = velocity.ok_or_else(|| clockless(recording))?;
        let upwards = velocity_z(recording);
        let speed = |i: usize| velocity[i].push(upwards.as_ref().map_or(0.0, |z| z[i])).norm();
        let z = recording.channel("fz_N");
        let spatial = |(i, f): (usize, &Vec2)| f.push(z.map_or(0.0, |z| z[i]));
        Ok(Self {
            speed_m_s: (0..velocity.len()).map(speed).collect(),
            force_n: force.map(|force| force.iter().enumerate().map(spatial).collect()),
            position_m: recording.channel("z_m").map_or_else(|| position.clone(), |z| flattened(&position, z)),
            is_spatial: z.is_some(),
        })
    }
}

/// Velocity along z, m/s: measured, or the slope of the position.
fn velocity_z(recording: &Recording) -> Option<Vec<f64>> {
    if let Some(measured) = recording.channel("vz_m_s") {
        return Some(measured.to_vec());
    }
    let (time_s, z) = (recording.time_s.as_ref()?, recording.channel("z_m")?);
    Some(savitzky_golay(time_s, z, half_width(time_s).max(CUBIC_HALF), 3).first)
}

/// A path in space, in its best plane, m.
fn flattened(position: &[Vec2], z: &[f64]) -> Vec<Vec2> {
    let points: Vec<Vector3<f64>> = position.iter().zip(z).map(|(p, z)| p.push(*z)).collect();
    let Some(frame) = Frame::new(&points, false) else { return position.to_vec() };
    let along = |p: &Vector3<f64>, k: usize| frame.axes[k].dot(&(p - frame.origin));
    points.iter().map(|p| Vec2::new(along(p, 0), along(p, 1))).collect()
}

/// Load of a single tool.
pub struct Load {
    /// Size of the force, N.
    pub values: Vec<f64>,
    /// Threshold from which it is a contact, N.
    pub force_n: f64,
    /// Share of the threshold below which nothing is touched any more.
    pub leave: f64,
    /// Changes that pass sooner are no contact made or lost, s.
    pub least_change_s: f64,
    /// Sentences about the force at rest.
    pub warnings: Vec<String>,
}

impl Load {
    fn of(time_s: &[f64], force_n: &[Vector3<f64>], position_m: &[Vec2], is_spatial: bool) -> Self {
        let plain: Vec<f64> = force_n.iter().map(Vector3::norm).collect();
        let usual_n = percentile(&mut plain.clone(), 0.95);
        let threshold_n = LOAD_SHARE * usual_n;
        let simple =
            Self { values: plain, force_n: threshold_n, leave: 1.0, least_change_s: 0.0, warnings: Vec::new() };
        // A sensor in three axes carries a tool that turns: its force at rest is small, not constant.
        let between_n = is_spatial.then(|| between_levels(&simple.values)).flatten();
        if let Some(force_n) = between_n.filter(|between_n| *between_n > threshold_n) {
            return Self { force_n, least_change_s: LEAST_CHANGE_S, ..simple };
        }
        // Half of the threshold is no bias that would be taken for a contact, whatever else it is.
        let Some(rest) = Resting::of(time_s, force_n, position_m, 0.5 * threshold_n) else { return simple };
        if rest.farthest_n() + CLEAR_OF_NOISE * rest.noise_n <= threshold_n {
            return simple;
        }
        let calm = calmed_series(time_s, force_n);
        let values: Vec<f64> = calm.iter().zip(time_s).map(|(f, t)| (f - rest.bias_at(*t)).norm()).collect();
        let usual_n = percentile(&mut values.clone(), 0.95);
        Self {
            values,
            force_n: (NOISE_MULTIPLE * rest.noise_of(time_s, &calm)).max(LOAD_SHARE * usual_n),
            leave: NOISY_LEAVE,
            least_change_s: LEAST_CHANGE_S,
            warnings: warnings(&rest, is_spatial),
        }
    }
}

fn warnings(rest: &Resting, is_spatial: bool) -> Vec<String> {
    let mut warnings = Vec::new();
    if rest.bias_n.norm() > (2.0 * rest.noise_n).max(0.005) {
        let axes = rest.bias_n.iter().take(if is_spatial { 3 } else { 2 }).map(|b| format!("{b:.3}"));
        let bias = axes.collect::<Vec<_>>().join(", ");
        warnings.push(format!("the force of the tool rests at ({bias}) N in free motion; this bias is subtracted"));
    }
    if rest.drifts() {
        warnings.push(format!(
            "the force of the tool rests elsewhere at other times, up to {:.3} N from zero: its sensor drifts, which is taken into account here",
            rest.farthest_n()
        ));
    }
    warnings
}

/// Threshold between two levels of a load, N. `None` if it has no two levels. They are the medians of the two classes
/// with the most variance between them (Otsu 1979, *A threshold selection method from gray-level histograms*).
fn between_levels(load_n: &[f64]) -> Option<f64> {
    let mut sorted = load_n.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    let count = sorted.len() as f64;
    let mean = sorted.iter().sum::<f64>() / count;
    let variance = sorted.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / count;
    let (mut sum, mut most, mut split) = (0.0, 0.0, 0);
    for (i, value) in sorted.iter().enumerate() {
        let below = i as f64;
        let between = if i > 0 { (sum - below * mean).powi(2) / (below * (count - below)) } else { 0.0 };
        if between > most {
            (most, split) = (between, i);
        }
        sum += value;
    }
    let (lower, upper) = (sorted.get(split / 2)?, sorted.get(usize::midpoint(split, sorted.len()))?);
    (most > TWO_LEVELS * variance).then(|| lower + ABOVE_LOWER * (upper - lower))
}

fn clockless(recording: &Recording) -> EstimateError {
    EstimateError::Clockless { what: "telling rest from motion".to_owned(), recording: recording.name.clone() }
}

/// Speed, m/s or rad/s, and load of a single tool, or of a mechanism's coordinate, which has no load.
pub fn speed_and_load(recording: &Recording, time_s: &[f64]) -> Result<(Vec<f64>, Option<Load>), EstimateError> {
    let Some(q) = ["q_m", "q_rad"].into_iter().find_map(|name| recording.channel(name)) else {
        let tool = Tool::of(recording)?;
        let load = tool.force_n.map(|force| Load::of(time_s, &force, &tool.position_m, tool.is_spatial));
        return Ok((tool.speed_m_s, load));
    };
    let measured = recording.channel("dq_m_s").or_else(|| recording.channel("dq_rad_s"));
    let rate = if let Some(rate) = measured {
        rate.to_vec()
    } else {
        let time = recording.time_s.as_ref().ok_or_else(|| clockless(recording))?;
        foundation::signal::task::smooth(time, q).slope
    };
    Ok((rate.iter().map(|v| v.abs()).collect(), None))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::segment::segment;
    use foundation::tasks::SystemState;
    use haptics::recording::{Channel, Meta, Task};

    const RATE_HZ: f64 = 100.0;
    /// The tool presses on a table between these, s.
    const PRESSED_S: (f64, f64) = (3.0, 8.0);

    /// A tool of 2 N on a wrist that turns, which goes down to a table, wipes it, and goes away again. Its sensor does not
    /// rest at one level.
    fn wiped() -> Recording {
        let time_s: Vec<f64> = (0..1100).map(|i| f64::from(i) / RATE_HZ).collect();
        let pressed = |t: f64| {
            let (after, before) = ((t - PRESSED_S.0) / 0.1, (PRESSED_S.1 - t) / 0.1);
            after.min(before).clamp(0.0, 1.0)
        };
        let tilt = |t: f64| 0.9 * (0.8 * t).sin();
        let channels: [(&str, &dyn Fn(f64) -> f64); 6] = [
            ("x_m", &|t: f64| 0.1 * (1.7 * t).sin()),
            ("y_m", &|t: f64| 0.1 * (1.7 * t).cos()),
            ("z_m", &|t: f64| 0.05 * (PRESSED_S.0 - t).max(t - PRESSED_S.1).max(0.0)),
            ("fx_N", &|t: f64| 2.0 * tilt(t).sin() + 0.3 * pressed(t)),
            ("fy_N", &|t: f64| 0.4 * (0.5 * t).cos() + 0.3 * pressed(t)),
            ("fz_N", &|t: f64| -2.0 * tilt(t).cos() - pressed(t) * (14.0 + 3.0 * (2.0 * t).sin())),
        ];
        let channels = channels.into_iter().map(|(name, of)| Channel {
            name: name.to_owned(),
            unit: String::new(),
            values: time_s.iter().map(|t| of(*t)).collect(),
        });
        let meta = Meta { task: Some(Task::Mechanism), up: Some("z".to_owned()), ..Meta::default() };
        Recording { channels: channels.collect(), time_s: Some(time_s), meta, ..Recording::default() }
    }

    #[test]
    fn a_contact_is_told_from_the_force_in_all_axes() {
        let found = segment(&wiped(), None, None).expect("segments");
        let is_free: Vec<bool> = found.states.iter().map(|s| s.state == SystemState::FreeMotion).collect();
        assert!(is_free[0] && is_free[is_free.len() - 1] && is_free.iter().filter(|free| **free).count() == 2);
        let (first, last) = (&found.states[0], &found.states[is_free.len() - 1]);
        assert!((first.t1 - PRESSED_S.0).abs() < 0.05 && (last.t0 - PRESSED_S.1).abs() < 0.05, "{:?}", found.states);
    }

    #[test]
    fn loads_that_only_vary_have_no_two_levels() {
        let even: Vec<f64> = (0..500).map(f64::from).collect();
        let sine: Vec<f64> = even.iter().map(|i| (0.07 * i).sin().abs()).collect();
        assert!(between_levels(&even).is_none() && between_levels(&sine).is_none());
        assert!(between_levels(&[1.0; 50]).is_none() && between_levels(&[]).is_none());
        let two: Vec<f64> = even.iter().map(|i| if *i < 200.0 { 1.0 } else { 11.0 } + 0.2 * i.sin()).collect();
        assert!(between_levels(&two).is_some_and(|n| (n - 2.0).abs() < 0.3));
    }
}
