//! Slip of the barrel in the grip: the heights of the fingers at which the floor takes half of its weight over, before
//! and after.
//!
//! The positions of two fingers do not show the barrel between them. The floor has not moved: a greater height of the
//! fingers at putting down than at picking up is a slip down between them. At the same lift pads yield the same, so
//! that cancels.

use super::signals::Signals;
use super::wall_stiffness::weight_n;
use crate::identify::limits::CLEARLY_SIGNIFICANT;

/// Least way of a slip, as a share of the barrel's size: pads creep, and a floor is not quite even.
/// Choice: no case of the ablation reads it.
const CREEP: f64 = 0.0016;
/// Share of the weight at which heights are compared.
/// Choice: no case of the ablation reads it.
const COMPARED_LOAD: f64 = 0.5;

/// Way that the barrel slid down (below 0: up) in the grip within its lifts, m; `None` if it did not, or was not put
/// down again.
pub fn slipped_m(signals: &Signals) -> Option<f64> {
    let half_n = COMPARED_LOAD * weight_n(signals)?;
    let lifts = signals.hanging();
    let ways = lifts.iter().filter_map(|lift| {
        let (first, last) = (*lift.first()?, *lift.last()?);
        let up = (1..=first).rev().find(|i| signals.net_n[i - 1].y < half_n)?;
        let down = (last + 1..signals.time_s.len()).find(|i| signals.net_n[*i].y < half_n)?;
        Some(height_m(signals, down, half_n) - height_m(signals, up, half_n))
    });
    let noise_m = CLEARLY_SIGNIFICANT * signals.resolution_m.hypot(signals.place_noise_m());
    ways.max_by(|a, b| a.abs().total_cmp(&b.abs()))
        .filter(|way| way.abs() > (CREEP * signals.task.object_m()).max(noise_m))
}

/// Height of the fingers' middle where the lift passes `lift_n` between sample `i − 1` and `i`, m.
fn height_m(signals: &Signals, i: usize, lift_n: f64) -> f64 {
    let (before, after) = (signals.net_n[i - 1].y, signals.net_n[i].y);
    let share = if after == before { 0.5 } else { ((lift_n - before) / (after - before)).clamp(0.0, 1.0) };
    signals.position[i - 1].y + share * (signals.position[i].y - signals.position[i - 1].y)
}
