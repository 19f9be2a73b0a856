//! Give of the pads with which two fingers hold a handle, from the closing of their grip.

use crate::diagnose::data::limits::HALF;
use crate::diagnose::recording::grip_axis_signs::PRESSING;
use estimation::regression::linear::least_squares_values;
use foundation::signal::task::TaskSignals;
use haptics::Vec2;

/// Displacement of the middle of both tips along their line of grip by a net force, m/N. A handle of constant width, held
/// by two equal pads, brings the tips nearer to each other by four times as much for each newton of grip.
///
/// The path of the handle alone does not determine it: it shows only how much more the pads give along one axis than
/// along the other. `None` if the grip does not explain most of the changes of its width.
pub fn give_m_n(signals: &TaskSignals) -> Option<f64> {
    let force = |k: usize, i: usize| signals.tips[k].force.as_ref().map_or(0.0, |force: &Vec<Vec2>| force[i].x);
    let grip_n = |i: usize| 0.5 * (force(0, i) - force(1, i));
    let firmest_n = signals.grip_force_n.iter().copied().fold(0.0, f64::max);
    let pressed: Vec<usize> =
        (0..signals.grip_force_n.len()).filter(|i| signals.grip_force_n[*i] > PRESSING * firmest_n).collect();
    let width_m: Vec<f64> = pressed.iter().map(|i| signals.grip_width_m[*i]).collect();
    let grips: Vec<f64> = pressed.iter().map(|i| grip_n(*i)).collect();
    let fit = least_squares_values(&[vec![1.0; grips.len()], grips], &width_m, None).ok()?;
    let mean_m = width_m.iter().sum::<f64>() / width_m.len() as f64;
    let spread_m = (width_m.iter().map(|w| (w - mean_m).powi(2)).sum::<f64>() / width_m.len() as f64).sqrt();
    let explains = fit.rms.powi(2) < HALF * spread_m.powi(2);
    (explains && fit.values[1] < 0.0).then_some(-0.25 * fit.values[1])
}
