//! Whether the barrel slipped in the grip: where the fingers are when the floor takes half of its weight over, before and after.
//!
//! Two fingers see where they are, not where the barrel is between them. The floor has not moved: what the fingers are higher when the
//! barrel is put down than when it was picked up, it slid down between them. At the same lift pads give the same, so it cancels.

use super::signals::Signals;
use super::wall_stiffness::weight_n;

/// Pads that creep and a floor that is not quite even: less than this way is no slip, m.
const CREEP_M: f64 = 4e-5;
/// … and less than so many standard errors.
const CLEAR: f64 = 4.0;
/// Share of the weight at which heights are compared.
const HALF: f64 = 0.5;

/// How far the barrel slid down (below 0: up) in the grip within its lifts, m; `None` where it did not, or was not put down again.
pub fn slipped_m(signals: &Signals) -> Option<f64> {
    let half_n = HALF * weight_n(signals)?;
    let lifts = signals.hanging();
    let ways = lifts.iter().filter_map(|lift| {
        let (first, last) = (*lift.first()?, *lift.last()?);
        let up = (1..=first).rev().find(|i| signals.net_n[i - 1].y < half_n)?;
        let down = (last + 1..signals.time_s.len()).find(|i| signals.net_n[*i].y < half_n)?;
        Some(height_m(signals, down, half_n) - height_m(signals, up, half_n))
    });
    let noise_m = CLEAR * signals.resolution_m.hypot(signals.place_noise_m());
    ways.max_by(|a, b| a.abs().total_cmp(&b.abs())).filter(|way| way.abs() > CREEP_M.max(noise_m))
}

/// Height of the fingers' middle where the lift passes `lift_n` between sample `i − 1` and `i`, m.
fn height_m(signals: &Signals, i: usize, lift_n: f64) -> f64 {
    let (before, after) = (signals.net_n[i - 1].y, signals.net_n[i].y);
    let share = if after == before { 0.5 } else { ((lift_n - before) / (after - before)).clamp(0.0, 1.0) };
    signals.position[i - 1].y + share * (signals.position[i].y - signals.position[i - 1].y)
}
