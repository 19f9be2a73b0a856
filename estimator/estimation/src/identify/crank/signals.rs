//! Motion and force of the handle while it is held, smoothed, with their noise.

use crate::identify::limits::LEAST_FREE_S;
use crate::regression::linear::least_squares;
use crate::segment::Segmentation;
use foundation::estimate::EstimateError;
use foundation::signal::derive::savitzky_golay;
use foundation::signal::noise::{quantum, resolution_error, white_noise};
use foundation::signal::task::{
    CUBIC_HALF, TaskSignals, TipSeries, half_width, has_velocity, is_two_fingered, task_signals, times, tip_series,
};
use foundation::tasks::SystemState;
use haptics::Vec2;
use haptics::recording::Recording;
use std::ops::Deref;
use std::sync::Arc;

/// The handle's motion and force, all channels through the same smoothing filter. One entry a sample. Nothing in here depends on
/// the segmentation, so that refits of the same recording share it.
pub(crate) struct Smooth {
    pub(crate) time_s: Vec<f64>,
    /// Mean of the tips, m.
    mean_of_tips: Vec<Vec2>,
    pub(crate) velocity: Vec<Vec2>,
    /// Derivative of the velocity, m/s².
    pub(crate) acceleration: Vec<Vec2>,
    /// Net force on the handle as measured, N, and smoothed, N.
    measured_force: Vec<Vec2>,
    filtered_force: Vec<Vec2>,
    /// First and second derivative of the smoothed force, N/s and N/s².
    pub(crate) force_rate: Vec<Vec2>,
    pub(crate) force_bend: Vec<Vec2>,
    /// Noise of one velocity component after smoothing, m/s.
    pub(crate) velocity_noise: f64,
    /// Error by the resolution of the log, m and N.
    pub(crate) resolution_m: f64,
    pub(crate) resolution_n: f64,
}

/// The handle's motion and force while it is held, by the states. Fits by the same states share it.
pub(crate) struct Grasped {
    smooth: Arc<Smooth>,
    /// Net force on the handle, N, bias taken out.
    pub(crate) force: Vec<Vec2>,
    /// Samples that turn (the rest is held still or let go).
    pub(crate) turning: Vec<usize>,
    /// Standard error of the vertical force bias that was taken out, N; `None` without a free phase to see it in.
    pub(crate) bias_error_n: Option<f64>,
}

impl Deref for Grasped {
    type Target = Smooth;

    fn deref(&self) -> &Smooth {
        &self.smooth
    }
}

/// [`Grasped`], and the slips of one fit taken out.
pub(crate) struct Held {
    grasped: Arc<Grasped>,
    /// Positions without slips; `None` where there were none.
    without_slips: Option<Vec<Vec2>>,
}

impl Held {
    pub(crate) fn new(grasped: &Arc<Grasped>) -> Self {
        Self { grasped: Arc::clone(grasped), without_slips: None }
    }

    /// Mean of the tips, m; slips are taken out of it.
    pub(crate) fn position(&self) -> &[Vec2] {
        self.without_slips.as_deref().unwrap_or(&self.grasped.smooth.mean_of_tips)
    }

    /// Takes a slip by `shift` out of the positions from `sample` on.
    pub(crate) fn move_back(&mut self, sample: usize, shift: Vec2) {
        let positions = self.without_slips.get_or_insert_with(|| self.grasped.smooth.mean_of_tips.clone());
        positions.iter_mut().skip(sample).for_each(|p| *p -= shift);
    }
}

impl Deref for Held {
    type Target = Grasped;

    fn deref(&self) -> &Grasped {
        &self.grasped
    }
}

pub(crate) fn grasped(smooth: &Arc<Smooth>, segmentation: &Segmentation) -> Grasped {
    let force = &smooth.measured_force;
    let free: Vec<usize> = segmentation
        .states
        .iter()
        .filter(|i| i.state == SystemState::FreeMotion && i.t1 - i.t0 >= LEAST_FREE_S)
        .flat_map(|i| i.first..i.end)
        .collect();
    let bias =
        if free.is_empty() { Vec2::zeros() } else { free.iter().map(|i| force[*i]).sum::<Vec2>() / free.len() as f64 };
    let bias_error_n = (!free.is_empty()).then(|| {
        let vertical: Vec<f64> = free.iter().map(|i| force[*i].y).collect();
        least_squares(&[vec![1.0; vertical.len()]], &vertical, None).map_or(0.0, |fit| fit.std_errors[0])
    });
    let turning = segmentation
        .states
        .iter()
        .filter(|i| segmentation.definition.as_ref().is_none_or(|task| task.shows_something(i.state)))
        .filter_map(|i| i.subtask.as_deref())
        .flat_map(|subtask| segmentation.samples_of(subtask))
        .collect();
    Grasped {
        force: smooth.filtered_force.iter().map(|f| f - bias).collect(),
        turning,
        bias_error_n,
        smooth: Arc::clone(smooth),
    }
}

pub(crate) fn smooth(recording: &Recording) -> Result<Smooth, EstimateError> {
    let time_s = times(recording);
    let (position, velocity, force) = if is_two_fingered(recording) {
        let TaskSignals { position, velocity, net_force_n, .. } = task_signals(recording)?;
        (position, velocity, net_force_n)
    } else {
        let TipSeries { position, velocity, force } = tip_series(recording, "")?;
        let clockless =
            || EstimateError::Clockless { what: "friction in a crank".to_owned(), recording: recording.name.clone() };
        let missing = || EstimateError::MissingColumn {
            task: "the crank".to_owned(),
            column: "fx_N".to_owned(),
            recording: recording.name.clone(),
        };
        (position, velocity.ok_or_else(clockless)?, force.ok_or_else(missing)?)
    };
    let axis = |series: &[Vec2], pick: fn(&Vec2) -> f64| series.iter().map(pick).collect::<Vec<f64>>();
    let half = (2 * half_width(&time_s)).max(CUBIC_HALF);
    // Five samples of a slow log span much of a motion: there only their full polynomial does not weaken its bends.
    let order = if half == CUBIC_HALF { 4 } else { 3 };
    // Cubics, because lines and plain averages would shrink a rotating vector towards the centre of its arc.
    let smoothed = |series: &[Vec2]| {
        let x = savitzky_golay(&time_s, &axis(series, |v| v.x), half, order);
        let y = savitzky_golay(&time_s, &axis(series, |v| v.y), half, order);
        let pair = |x: &[f64], y: &[f64]| x.iter().zip(y).map(|(x, y)| Vec2::new(*x, *y)).collect::<Vec<_>>();
        [pair(&x.value, &y.value), pair(&x.first, &y.first), pair(&x.second, &y.second)]
    };
    let [position_smooth, position_rate, position_bend] = smoothed(&position);
    let [mut velocity_smooth, mut acceleration, _] = smoothed(&velocity);
    let [force_smooth, force_rate, force_bend] = smoothed(&force);
    if !has_velocity(recording, if is_two_fingered(recording) { "1" } else { "" }) {
        // Derived twice over, a velocity would be weaker than the motion: take it from the positions' own cubics.
        velocity_smooth = position_rate;
        acceleration = position_bend;
    }
    // Noise from the removed part of the signal, scaled to the remaining one: a cubic fit over m samples leaves 9/(4 m)
    // of the variance.
    let removed: Vec<f64> = velocity.iter().zip(&velocity_smooth).map(|(a, b)| (a - b).y).collect();
    let velocity_noise = white_noise(&removed) * (2.25 / (2 * half + 1) as f64).min(1.0).sqrt();
    // While it turns, the handle passes over many steps, and rounding is one more noise. Only the grip, which hardly changes,
    // and forces that do not either keep an error that no averaging removes.
    let unresolved = |values: &[f64]| resolution_error(quantum(values), white_noise(values));
    let resolution = |series: &[Vec2]| unresolved(&axis(series, |v| v.x)).max(unresolved(&axis(series, |v| v.y)));
    Ok(Smooth {
        velocity_noise,
        resolution_m: resolution(&position),
        resolution_n: resolution(&force),
        mean_of_tips: position_smooth,
        velocity: velocity_smooth,
        acceleration,
        measured_force: force,
        filtered_force: force_smooth,
        force_rate,
        force_bend,
        time_s,
    })
}
