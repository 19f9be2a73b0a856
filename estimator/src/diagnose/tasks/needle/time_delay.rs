//! Time delay of the forces after the motion of a needle, from the shift for which its sheet explains most.

use super::rows::{Needle, Phase, Row};
use crate::diagnose::recording::delay_scan::{Demands, Late, STEP_S, look};
use estimation::regression::linear::least_squares_values;

/// Time from the surface and from punctures within which rows are not compared, s, because a delay of the forces would
/// change their contact phase.
const NEAR_S: f64 = 0.06;
/// Limits of a delay. Beyond the longest one a hand is already at another movement. Other causes in a sheet are not in
/// the plain model and correlate with some delay by chance.
const DEMANDS: Demands = Demands { longest_s: 0.1, enough: 0.8, leaves: 0.5, likelier: 60.0 };

/// The smoothed forces of a recording, one per sample, to which every row refers.
pub struct Forces<'a> {
    pub force_n: &'a [f64],
    /// Sample of each row.
    pub of_row: &'a [usize],
    pub sample_s: f64,
}

/// Delay with the smallest residual of a model with held weight and a sheet that may harden and keep a dent. A sheet
/// with drag looks like a negative delay, which is therefore not reported. A needle between two pads moves in them by
/// more than a hand moves during a delay, so only single tools are tested.
pub fn late(needle: &Needle, forces: &Forces<'_>) -> Option<Late> {
    if needle.two_fingered {
        return None;
    }
    let compared: Vec<usize> = (0..needle.rows.len()).filter(|i| is_compared(needle, &needle.rows[*i])).collect();
    let columns = columns(needle, &compared);
    let step = (STEP_S / forces.sample_s.max(1e-9)).round().max(1.0);
    let late = look(step * forces.sample_s, &DEMANDS, &|by| left(forces, &compared, &columns, by * step as isize));
    late.filter(|late| late.error_s.is_finite()).map(|late| Late { is_seen: late.is_seen && late.tau_s > 0.0, ..late })
}

/// True for rows outside or on the sheet whose contact phase does not depend on the delay. The force of a hole on a
/// shaft at a reversal is not known well enough.
fn is_compared(needle: &Needle, row: &Row) -> bool {
    let at_surface = row.depth_m.abs() < NEAR_S * row.rate_m_s.abs();
    let at_puncture = needle.punctures.iter().any(|p| (row.time_s - p.time_s).abs() < 2.0 * NEAR_S);
    !matches!(row.phase, Phase::Empty | Phase::Hole) && !at_surface && !at_puncture
}

/// Regressors of the plain model over the compared rows.
fn columns(needle: &Needle, compared: &[usize]) -> Vec<Vec<f64>> {
    let of = |f: &dyn Fn(&Row) -> f64| compared.iter().map(|i| f(&needle.rows[*i])).collect::<Vec<f64>>();
    let when = |phases: &'static [Phase], f: &'static dyn Fn(&Row) -> f64| {
        of(&|r: &Row| if phases.contains(&r.phase) && r.depth_m > 0.0 { f(r) } else { 0.0 })
    };
    let mut columns: Vec<Vec<f64>> = (0..needle.holds).map(|h| of(&|r| f64::from(u8::from(r.hold == h)))).collect();
    columns.push(of(&|r| r.time_s));
    let touched: &'static [Phase] = &[Phase::Loading, Phase::Unloading];
    columns.push(when(touched, &|_| 1.0));
    columns.push(when(touched, &|r| r.depth_m));
    columns.push(when(touched, &|r| r.depth_m.powi(3)));
    // Above its deepest indentation, a sheet has another law.
    columns.push(when(&[Phase::Unloading], &|_| 1.0));
    columns.push(when(&[Phase::Unloading], &|r| r.depth_m));
    columns
}

/// Residual power per row, and number of rows, with the forces of this many samples later.
fn left(forces: &Forces<'_>, compared: &[usize], columns: &[Vec<f64>], by: isize) -> Option<(f64, f64)> {
    let later = |i: usize| forces.of_row[i].checked_add_signed(by).and_then(|at| forces.force_n.get(at));
    let (kept, y): (Vec<usize>, Vec<f64>) =
        compared.iter().enumerate().filter_map(|(k, i)| Some((k, *later(*i)?))).unzip();
    let columns: Vec<Vec<f64>> = columns
        .iter()
        .map(|column| kept.iter().map(|k| column[*k]).collect::<Vec<f64>>())
        .filter(|column| column.iter().any(|v| *v != 0.0))
        .collect();
    if y.len() <= 2 * columns.len() {
        return None;
    }
    let rms = least_squares_values(&columns, &y, None).ok()?.rms;
    Some((rms * rms, y.len() as f64))
}
