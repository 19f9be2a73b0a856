//! Stage 1 of the segmentation: from finger samples to the signals of the task (thesis, chapter 5.2.2).

use super::derive::savitzky_golay;
use crate::estimate::EstimateError;
use haptics::Vec2;
use haptics::hand::{Finger, JointAngles};
use haptics::recording::Recording;
use nalgebra::SVector;

/// Tip motion and force of one finger, or of a single tool. One entry a sample.
#[derive(Clone, Debug, PartialEq)]
pub struct TipSeries {
    /// Position in the world, m.
    pub position: Vec<Vec2>,
    /// Velocity, m/s; `None` when the log has neither velocities nor a clock.
    pub velocity: Option<Vec<Vec2>>,
    /// Force on the environment, N; `None` when no force was recorded.
    pub force: Option<Vec<Vec2>>,
}

/// The signals that states are told from.
#[derive(Clone, Debug, PartialEq)]
pub struct TaskSignals {
    /// Sample times, s (sample numbers when the log is clockless).
    pub time_s: Vec<f64>,
    /// Rigid-body position: mean of the tip positions, m.
    pub position: Vec<Vec2>,
    /// Distance of the tips along x, m (finger 2 minus finger 1).
    pub grip_width_m: Vec<f64>,
    /// Rigid-body velocity: mean of the tip velocities, m/s.
    pub velocity: Vec<Vec2>,
    /// Net force on the held object: sum of the tip forces, N.
    pub net_force_n: Vec<Vec2>,
    /// Grip normal force: min(Fx1, −Fx2), N.
    pub grip_force_n: Vec<f64>,
    /// Grip shear: half the difference of the vertical tip forces, N.
    pub shear_n: Vec<f64>,
    /// The fingers themselves (left, right).
    pub tips: [TipSeries; 2],
    /// Source of the velocities: `measured` or the derivation in words.
    pub velocity_from: String,
}

impl TaskSignals {
    /// Number of samples.
    pub fn len(&self) -> usize {
        self.time_s.len()
    }

    /// True when there is no sample.
    pub fn is_empty(&self) -> bool {
        self.time_s.is_empty()
    }

    /// Median distance of the tips over the quarter of samples with the hardest grip, m: the size of the object. Limits
    /// of lengths are multiples of it, so that they hold for objects of any size.
    pub fn object_m(&self) -> f64 {
        let mut hardest: Vec<usize> = (0..self.len()).collect();
        hardest.sort_unstable_by(|a, b| self.grip_force_n[*b].total_cmp(&self.grip_force_n[*a]));
        hardest.truncate(self.len().div_ceil(4));
        let mut widths: Vec<f64> = hardest.iter().map(|i| self.grip_width_m[*i].abs()).collect();
        widths.sort_unstable_by(f64::total_cmp);
        widths.get(widths.len() / 2).copied().unwrap_or(0.0)
    }
}

/// Least samples on each side of a cubic fit.
pub const CUBIC_HALF: usize = 2;

/// Window of the derivation of velocities from positions, s.
pub const DERIVATIVE_WINDOW_S: f64 = 0.03;

/// True when the recording has both fingers (as tips or joints).
pub fn is_two_fingered(recording: &Recording) -> bool {
    recording.channel("x1_m").is_some() || recording.channel("qb1_rad").is_some()
}

/// The task signals of a two-fingered recording with forces.
pub fn task_signals(recording: &Recording) -> Result<TaskSignals, EstimateError> {
    let tips = [tip_series(recording, "1")?, tip_series(recording, "2")?];
    let need = |series: &TipSeries, finger: &str| {
        series.force.clone().ok_or_else(|| missing(recording, &format!("fx{finger}_N")))
    };
    let forces = [need(&tips[0], "1")?, need(&tips[1], "2")?];
    let (Some(v1), Some(v2)) = (&tips[0].velocity, &tips[1].velocity) else {
        return Err(EstimateError::Clockless {
            what: "telling rest from motion".to_owned(),
            recording: recording.name.clone(),
        });
    };
    let n = recording.len();
    let pick = |f: &dyn Fn(usize) -> f64| (0..n).map(f).collect::<Vec<f64>>();
    Ok(TaskSignals {
        time_s: times(recording),
        position: (0..n).map(|i| 0.5 * (tips[0].position[i] + tips[1].position[i])).collect(),
        grip_width_m: pick(&|i| tips[1].position[i].x - tips[0].position[i].x),
        velocity: (0..n).map(|i| 0.5 * (v1[i] + v2[i])).collect(),
        net_force_n: (0..n).map(|i| forces[0][i] + forces[1][i]).collect(),
        grip_force_n: pick(&|i| forces[0][i].x.min(-forces[1][i].x)),
        shear_n: pick(&|i| 0.5 * (forces[0][i].y - forces[1][i].y)),
        velocity_from: velocity_origin(recording, "1"),
        tips,
    })
}

/// Sample times, s, or sample numbers when the log is clockless.
pub fn times(recording: &Recording) -> Vec<f64> {
    recording.time_s.clone().unwrap_or_else(|| (0..recording.len()).map(|i| i as f64).collect())
}

/// Position of one tip, sample by sample: for callers that need no series of it.
pub struct Tip<'a> {
    columns: [&'a [f64]; 2],
    /// The finger whose angles the columns are; `None` where they are the tip's own.
    finger: Option<Finger>,
}

impl<'a> Tip<'a> {
    /// Of finger `"1"`, `"2"`, or of the single tool `""`.
    pub fn of(recording: &'a Recording, finger: &str) -> Result<Self, EstimateError> {
        let pair = |a: &str, b: &str| Some([recording.channel(a)?, recording.channel(b)?]);
        if let Some(columns) = pair(&format!("x{finger}_m"), &format!("y{finger}_m")) {
            return Ok(Self { columns, finger: None });
        }
        let columns = pair(&format!("qb{finger}_rad"), &format!("qt{finger}_rad"))
            .ok_or_else(|| missing(recording, &format!("x{finger}_m")))?;
        let geometry = recording.meta.hand().fingers[usize::from(finger == "2")];
        Ok(Self { columns, finger: Some(geometry) })
    }

    /// In the world, m.
    pub fn position(&self, sample: usize) -> Vec2 {
        let [a, b] = self.columns.map(|c| c[sample]);
        self.finger.map_or(Vec2::new(a, b), |f| f.tip_in_world(JointAngles { bottom_rad: a, top_rad: b }))
    }

    fn positions(&self) -> Vec<Vec2> {
        (0..self.columns[0].len()).map(|i| self.position(i)).collect()
    }
}

/// Tip series of finger `"1"`, `"2"`, or of the single tool `""`, from tip columns or joint angles.
pub fn tip_series(recording: &Recording, finger: &str) -> Result<TipSeries, EstimateError> {
    let column = |name: String| recording.channel(&name);
    let pair = |a: String, b: String| Some((column(a)?, column(b)?));
    let zip = |(x, y): (&[f64], &[f64])| x.iter().zip(y).map(|(x, y)| Vec2::new(*x, *y)).collect::<Vec<_>>();

    let force = pair(format!("fx{finger}_N"), format!("fy{finger}_N")).map(zip);
    let tip = Tip::of(recording, finger)?;
    let position = tip.positions();
    let Some(geometry) = tip.finger else {
        let measured = pair(format!("vx{finger}_m_s"), format!("vy{finger}_m_s")).map(zip);
        let velocity = measured.or_else(|| derived(recording, &position));
        return Ok(TipSeries { position, velocity, force });
    };
    let [bottom, top] = tip.columns;
    let joints: Vec<JointAngles> =
        bottom.iter().zip(top).map(|(b, t)| JointAngles { bottom_rad: *b, top_rad: *t }).collect();
    let rates = pair(format!("dqb{finger}_rad_s"), format!("dqt{finger}_rad_s")).map(zip);
    let velocity = rates.map(|r| tip_velocities(&geometry, &joints, &r)).or_else(|| derived(recording, &position));
    Ok(TipSeries { position, velocity, force })
}

fn tip_velocities(finger: &Finger, joints: &[JointAngles], rates: &[Vec2]) -> Vec<Vec2> {
    joints.iter().zip(rates).map(|(q, rate)| finger.tip_velocity(*q, *rate)).collect()
}

fn derived(recording: &Recording, position: &[Vec2]) -> Option<Vec<Vec2>> {
    let time = recording.time_s.as_ref()?;
    let axis = |pick: fn(&Vec2) -> f64| {
        let values: Vec<f64> = position.iter().map(pick).collect();
        savitzky_golay(time, &values, half_width(time).max(CUBIC_HALF), 3).first
    };
    let (vx, vy) = (axis(|p| p.x), axis(|p| p.y));
    Some(vx.iter().zip(&vy).map(|(x, y)| Vec2::new(*x, *y)).collect())
}

/// Half of the window in which forces and velocities are calmed before states are told from them, s.
const CALM_HALF_S: f64 = 0.04;

/// Samples on either side of the window in which a recording is calmed.
fn calm_half(time_s: &[f64]) -> usize {
    let n = time_s.len();
    let period_s = if n > 1 { (time_s[n - 1] - time_s[0]) / (n - 1) as f64 } else { 1.0 };
    ((CALM_HALF_S / period_s).round() as usize).min(n / 20)
}

fn calmed_by<const AXES: usize>(series: &[SVector<f64, AXES>], half: usize) -> Vec<SVector<f64, AXES>> {
    let axis = |k: usize| parabolic_mean(&series.iter().map(|v| v[k]).collect::<Vec<_>>(), half);
    let axes: [Vec<f64>; AXES] = std::array::from_fn(axis);
    (0..series.len()).map(|i| SVector::from_fn(|k, _| axes[k][i])).collect()
}

/// A force or velocity calmed for the segmentation, as in [`calmed`].
pub fn calmed_series<const AXES: usize>(time_s: &[f64], series: &[SVector<f64, AXES>]) -> Vec<SVector<f64, AXES>> {
    match calm_half(time_s) {
        0 => series.to_vec(),
        half => calmed_by(series, half),
    }
}

/// The signals with forces and velocities calmed for the segmentation: states last longer than the window, noise does not.
pub fn calmed(signals: &TaskSignals) -> TaskSignals {
    let half = calm_half(&signals.time_s);
    if half == 0 {
        return signals.clone();
    }
    let calm = |series: &[Vec2]| calmed_by(series, half);
    let tips = [0, 1].map(|finger: usize| TipSeries {
        force: signals.tips[finger].force.as_deref().map(calm),
        velocity: signals.tips[finger].velocity.as_deref().map(calm),
        position: signals.tips[finger].position.clone(),
    });
    TaskSignals {
        velocity: calm(&signals.velocity),
        net_force_n: calm(&signals.net_force_n),
        grip_force_n: parabolic_mean(&signals.grip_force_n, half),
        shear_n: parabolic_mean(&signals.shear_n, half),
        tips,
        ..signals.clone()
    }
}

/// Mean with weights (h + ½)² − k² over `half` = h samples on each side, fewer at the ends.
///
/// The sums over the window (of values, and of values times k and k²) move along with it, so that a wider window takes
/// no longer. They are made again every so many samples, so that rounding does not gather.
fn parabolic_mean(values: &[f64], half: usize) -> Vec<f64> {
    /// Windows that are so short are summed up each.
    const SHORT: usize = 6;
    let n = values.len();
    let reach = (half as f64 + 0.5).powi(2);
    let by_itself = |i: usize| {
        let side = half.min(i).min(n - 1 - i);
        let (mut sum, mut total) = (0.0, 0.0);
        for (k, value) in (i - side..=i + side).zip(&values[i - side..=i + side]) {
            let weight = reach - (k as f64 - i as f64).powi(2);
            sum += weight * value;
            total += weight;
        }
        sum / total
    };
    // Values that are not finite would stay in the sums.
    if half <= SHORT || n <= 2 * half + 1 || values.iter().any(|v| !v.is_finite()) {
        return (0..n).map(by_itself).collect();
    }
    let h = half as f64;
    let total: f64 = (2.0 * h + 1.0) * reach - h * (h + 1.0) * (2.0 * h + 1.0) / 3.0;
    let mut means: Vec<f64> = (0..half).map(by_itself).collect();
    for first in (half..n - half).step_by(2 * half) {
        let window = &values[first - half..=first + half];
        // About a value of the window: the common part cancels nothing.
        let level = values[first];
        let (mut plain, mut linear, mut square) = (0.0, 0.0, 0.0);
        for (k, value) in window.iter().enumerate() {
            let (k, value) = (k as f64 - h, value - level);
            (plain, linear, square) = (plain + value, linear + k * value, square + k * k * value);
        }
        for i in first..(first + 2 * half).min(n - half) {
            means.push(level + (reach * plain - square) / total);
            let Some(entering) = values.get(i + half + 1) else { break };
            let (leaving, entering) = (values[i - half] - level, entering - level);
            // Seen from the next sample every k is one less.
            plain -= leaving;
            linear += h * leaving;
            square -= h * h * leaving;
            (linear, square) = (linear - plain, square - 2.0 * linear + plain);
            plain += entering;
            linear += h * entering;
            square += h * h * entering;
        }
    }
    means.extend((n - half..n).map(by_itself));
    means
}

/// A channel through one filter, and the derivative of exactly that filtered channel.
#[derive(Clone, Debug, PartialEq)]
pub struct Smoothed {
    /// Filtered value, in the channel's unit.
    pub value: Vec<f64>,
    /// Its derivative, per second.
    pub slope: Vec<f64>,
}

/// Samples on each side that [`smooth`] looks at: half of [`DERIVATIVE_WINDOW_S`], at least one.
pub fn half_width(time_s: &[f64]) -> usize {
    let n = time_s.len();
    let period_s = if n > 1 { (time_s[n - 1] - time_s[0]) / (n - 1) as f64 } else { 1.0 };
    ((0.5 * DERIVATIVE_WINDOW_S / period_s).round() as usize).max(1)
}

/// Zero-phase smoothing over [`DERIVATIVE_WINDOW_S`] (at least three samples).
///
/// The slope is that of a straight line fitted to the window (Savitzky & Golay 1964, first order). Such a slope is the
/// derivative of the channel smoothed with parabolic weights h² − k²; the value is smoothed with just these. A channel,
/// its derivative and every other channel have thus passed the same filter, and none looks delayed or weakened against
/// another.
pub fn smooth(time_s: &[f64], values: &[f64]) -> Smoothed {
    let half = half_width(time_s);
    let slope = savitzky_golay(time_s, values, half, 1).first;
    let value = smooth_value(time_s, values);
    Smoothed { value, slope }
}

/// The value of [`smooth`] alone.
pub fn smooth_value(time_s: &[f64], values: &[f64]) -> Vec<f64> {
    parabolic_mean(values, half_width(time_s))
}

/// True when velocities were recorded, not derived.
pub fn has_velocity(recording: &Recording, finger: &str) -> bool {
    recording.channel(&format!("vx{finger}_m_s")).is_some()
        || recording.channel(&format!("dqb{finger}_rad_s")).is_some()
}

fn velocity_origin(recording: &Recording, finger: &str) -> String {
    let has = |name: String| recording.channel(&name).is_some();
    if has(format!("vx{finger}_m_s")) {
        "measured".to_owned()
    } else if has(format!("dqb{finger}_rad_s")) {
        "measured joint rates".to_owned()
    } else {
        format!("derived from positions (cubics fitted over {:.0} ms, or five samples)", DERIVATIVE_WINDOW_S * 1e3)
    }
}

fn missing(recording: &Recording, column: &str) -> EstimateError {
    EstimateError::MissingColumn {
        task: recording.meta.task.map_or("this task".to_owned(), |t| t.name().to_owned()),
        column: column.to_owned(),
        recording: recording.name.clone(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use haptics::recording::Channel;

    fn recording(columns: &[(&str, f64)]) -> Recording {
        Recording {
            time_s: Some(vec![0.0, 0.001]),
            channels: columns
                .iter()
                .map(|(name, value)| Channel { name: (*name).to_owned(), unit: String::new(), values: vec![*value; 2] })
                .collect(),
            ..Recording::default()
        }
    }

    #[test]
    fn signals_of_the_thesis() {
        let log = recording(&[
            ("x1_m", -0.01),
            ("y1_m", 0.02),
            ("x2_m", 0.03),
            ("y2_m", 0.04),
            ("vx1_m_s", 0.1),
            ("vy1_m_s", 0.0),
            ("vx2_m_s", 0.3),
            ("vy2_m_s", 0.0),
            ("fx1_N", 2.0),
            ("fy1_N", 0.3),
            ("fx2_N", -1.5),
            ("fy2_N", 0.1),
        ]);
        let s = task_signals(&log).expect("all columns are there");
        assert!((s.position[0] - Vec2::new(0.01, 0.03)).norm() < 1e-15);
        assert!((s.grip_width_m[0] - 0.04).abs() < 1e-15);
        assert!((s.velocity[0] - Vec2::new(0.2, 0.0)).norm() < 1e-15);
        assert!((s.net_force_n[0] - Vec2::new(0.5, 0.4)).norm() < 1e-15);
        assert_eq!(s.grip_force_n[0], 1.5);
        assert!((s.shear_n[0] - 0.1).abs() < 1e-15);
    }

    #[test]
    fn joints_give_tips_and_their_velocities() {
        let log = recording(&[
            ("qb1_rad", 0.0),
            ("qt1_rad", std::f64::consts::FRAC_PI_2),
            ("dqb1_rad_s", 2.0),
            ("dqt1_rad_s", 0.0),
        ]);
        let tip = tip_series(&log, "1").expect("joint form");
        assert!((tip.position[0] - Vec2::new(-0.04 + 0.08, 0.08)).norm() < 1e-12);
        assert!((tip.velocity.expect("from rates")[0] - Vec2::new(0.0, 0.16)).norm() < 1e-12);
        assert!(tip.force.is_none());
    }

    #[test]
    fn value_and_slope_have_seen_the_same_filter() {
        // A 10 Hz wave: filtered value and slope are weakened by the same factor, and the slope is the value's derivative.
        let time: Vec<f64> = (0..1000).map(|i| f64::from(i) * 1e-3).collect();
        let omega = 20.0 * std::f64::consts::PI;
        let wave: Vec<f64> = time.iter().map(|t| (omega * t).sin()).collect();
        let out = smooth(&time, &wave);
        let gain_value = out.value[525] / wave[525];
        let gain_slope = out.slope[500] / (omega * (omega * time[500]).cos());
        assert!((gain_value - gain_slope).abs() < 1e-3 && gain_value < 0.95, "{gain_value} {gain_slope}");
    }

    #[test]
    fn the_moving_sums_of_the_parabolic_mean_are_its_definition() {
        use rand::{RngExt as _, SeedableRng as _};
        let mut rng = rand::rngs::StdRng::seed_from_u64(31);
        for (n, half, offset) in
            [(1, 9, 0.0), (19, 9, 0.0), (20, 9, 1.0), (500, 7, -3.0), (4001, 160, 0.5), (3000, 40, 1e3)]
        {
            let values: Vec<f64> =
                (0..n).map(|i| offset + if i > n / 2 { 2.0 } else { 0.0 } + rng.random_range(-1.0..1.0)).collect();
            let reach = (half as f64 + 0.5).powi(2);
            let found = parabolic_mean(&values, half);
            assert_eq!(found.len(), n);
            for (i, mean) in found.iter().enumerate() {
                let side = half.min(i).min(n - 1 - i);
                let weights = (i - side..=i + side).map(|k| (values[k], reach - (k as f64 - i as f64).powi(2)));
                let (sum, total) = weights.fold((0.0, 0.0), |(s, t), (v, w)| (s + w * v, t + w));
                assert!(
                    (mean - sum / total).abs() <= 1e-12 * (1.0 + offset.abs()),
                    "{n} {half}: {mean} and {}",
                    sum / total
                );
            }
        }
    }

    #[test]
    fn a_missing_force_is_named() {
        let log = recording(&[("x1_m", 0.0), ("y1_m", 0.0), ("x2_m", 0.0), ("y2_m", 0.0)]);
        let error = task_signals(&log).expect_err("no forces").to_string();
        assert!(error.contains("fx1_N"), "{error}");
    }
}
