//! Slips of the grasp on the handle: the fingers' circle jumps aside (thesis, 5.3.1). They are found in the radius
//! residual and taken out of the positions, so that centre and radius survive them.

use super::geometry::{Geometry, geometry};
use super::signals::Held;
use crate::constraint::slips::steps;
use foundation::estimate::{EstimateError, Slip};
use foundation::signal::task::{CUBIC_HALF, half_width};
use haptics::Vec2;

/// Least size of a slip, as a share of the radius: less is neither felt nor does it matter.
/// Choice: halved or doubled, none of 43 answers changes.
const LEAST_GRASP_SLIP_SHARE: f64 = 0.01;
/// Least size of a slip, m.
/// Choice: halved or doubled, none of 43 answers changes.
const LEAST_GRASP_SLIP_M: f64 = 1e-4;
/// Number of rounds of search and correction: slips change the look of the first fit.
/// Choice: halved or doubled, none of 43 answers changes.
const CORRECTION_ROUNDS: usize = 2;

/// Centre and radius with all slips taken out: those of the first grasp. The positions in `held` are moved back to it.
pub(super) fn without_slips(held: &mut Held) -> Result<(Geometry, Vec<Slip>), EstimateError> {
    let mut fitted = geometry(held)?;
    let mut slips: Vec<Slip> = Vec::new();
    for _ in 0..CORRECTION_ROUNDS {
        let found = find(held, &fitted);
        if found.is_empty() {
            break;
        }
        for slip in &found {
            let shift = Vec2::new(slip.displacement_m[0], slip.displacement_m[1]);
            held.move_back(slip.sample, shift);
        }
        slips.extend(found);
        fitted = geometry(held)?;
    }
    slips.sort_by_key(|s| s.sample);
    Ok((fitted, slips))
}

/// Shifts of the centre in the radius residual, rows a filter window apart.
fn find(held: &Held, geometry: &Geometry) -> Vec<Slip> {
    let stride = (4 * half_width(&held.time_s)).max(2 * CUBIC_HALF) + 1;
    let rows: Vec<usize> = held.turning.iter().copied().step_by(stride).collect();
    let position = held.position();
    let arm = |i: usize| position[i] - geometry.center_m;
    let outward: Vec<Vec2> = rows.iter().map(|&i| arm(i).normalize()).collect();
    let column =
        |of: &dyn Fn(usize, Vec2) -> f64| -> Vec<f64> { rows.iter().zip(&outward).map(|(&i, n)| of(i, *n)).collect() };
    let base = [
        vec![1.0; rows.len()],
        column(&|_, n| n.x),
        column(&|_, n| n.y),
        column(&|i, n| n.x * held.force[i].x),
        column(&|i, n| n.y * held.force[i].y),
    ];
    let deviation = column(&|i, _| arm(i).norm() - geometry.radius_m);
    let least = LEAST_GRASP_SLIP_M.max(LEAST_GRASP_SLIP_SHARE * geometry.radius_m);
    let slip = |step: crate::constraint::slips::Step| Slip {
        time_s: Some(held.time_s[rows[step.row]]),
        not_before_s: Some(held.time_s[rows[step.row.saturating_sub(1)]]),
        sample: rows[step.row],
        displacement_m: step.shift,
        significance: step.significance,
    };
    steps(&base, &[1, 2], &deviation, least).into_iter().map(slip).collect()
}

/// Says so when there were some.
pub(super) fn slip_warning(slips: &[Slip]) -> Option<String> {
    let first = slips.first()?;
    let size = |s: &Slip| 1e3 * s.displacement_m.iter().map(|d| d * d).sum::<f64>().sqrt();
    let largest = slips.iter().map(size).fold(0.0, f64::max);
    Some(format!(
        "the grasp slipped on the handle {} time(s), first at {:.2} s and by up to {largest:.2} mm; centre and radius are those of \
         the first grasp",
        slips.len(),
        first.time_s.unwrap_or(0.0)
    ))
}
