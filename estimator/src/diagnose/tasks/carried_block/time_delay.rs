//! Time delay of the forces after the motion of carried blocks, from the shift for which their weight and inertia
//! explain most.

use super::rows::{Place, Row, Rows};
use crate::diagnose::recording::delay_scan::{Demands, Late, STEP_S, look};
use estimation::regression::linear::least_squares_values;

/// Limits of a delay: beyond the longest one a hand is already at another movement.
const DEMANDS: Demands = Demands { longest_s: 0.12, enough: 0.8, leaves: 0.9, likelier: 40.0 };

/// Delay with the smallest residual of weights, their inertia and constant sensor errors. `known`: weights that the
/// sidecar states, N.
pub fn late(rows: &Rows<'_>, known: &[Option<f64>]) -> Option<Late> {
    let carried: Vec<&Row> = rows.all.iter().filter(|r| matches!(r.place, Place::Carried { .. })).collect();
    let sample_s = rows.seen.iter().map(|s| s.sample_s).fold(0.0, f64::max);
    let step = (STEP_S / sample_s.max(1e-9)).round().max(1.0);
    let late = look(step * sample_s, &DEMANDS, &|by| left(rows, &carried, known, by * step as isize));
    late.filter(|late| late.error_s.is_finite())
}

/// Residual power per row, and number of rows, with the forces of this many samples later.
fn left(rows: &Rows<'_>, carried: &[&Row], known: &[Option<f64>], by: isize) -> Option<(f64, f64)> {
    let blocks = rows.blocks();
    let mut columns = vec![Vec::new(); blocks + 2];
    let mut y = Vec::new();
    for row in carried {
        let Place::Carried { number, axis } = row.place else { continue };
        let one = &rows.seen[row.recording];
        let Some(acceleration) = row.i.checked_add_signed(-by).and_then(|i| one.acceleration[axis].get(i)) else {
            continue;
        };
        let up = if axis == 1 { 1.0 } else { 0.0 };
        let needed = up + acceleration / one.blocks.recording.meta.gravity().max(1e-9);
        let given = known[number - 1].map_or(0.0, |weight_n| weight_n * needed);
        for (k, column) in columns[..blocks].iter_mut().enumerate() {
            column.push(if k + 1 == number && known[k].is_none() { needed } else { 0.0 });
        }
        for (k, column) in columns[blocks..].iter_mut().enumerate() {
            // Beside free weights, a constant would leave only the accelerations to determine them.
            let is_open = axis == 1 && known.iter().any(Option::is_none);
            column.push(f64::from(u8::from(k == axis && !is_open)));
        }
        y.push(rows.force_n(row) - given);
    }
    columns.retain(|column| column.iter().any(|v| *v != 0.0));
    if y.len() <= 2 * columns.len() {
        return None;
    }
    let rms = least_squares_values(&columns, &y, None).ok()?.rms;
    Some((rms * rms, y.len() as f64))
}
