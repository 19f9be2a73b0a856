//! Structured errors of the path of a handle.

use super::smooth::{Discrepancy, over_time};
use haptics::Vec2;

/// A grasp that wanders along both axes. A function of the angle is left out: joint offsets, lengths and pads are such
/// functions themselves.
pub fn discrepancies(outward: &[Vec2], time_s: &[f64]) -> Vec<Discrepancy> {
    let slow = over_time(time_s, 0.5, 2.0, 32);
    let of_axis = |axis: fn(&Vec2) -> f64| {
        slow.iter().map(move |w| w.iter().zip(outward).map(|(w, o)| w * axis(o)).collect::<Vec<f64>>())
    };
    Discrepancy::new("time", of_axis(|o| o.x).chain(of_axis(|o| o.y)).collect()).into_iter().collect()
}
