//! Width of the barrel and give of its sides under the fingers: pad and wall in series, from the distance of the tips
//! over the grip.

use super::signals::Signals;
use crate::identify::limits::{LEAST_LINE_ROWS, SIGNIFICANT};
use crate::identify::pads::LEAST_GRIP_VARIATION;
use crate::identify::pads::{self, EVEN, PadFit, SHEAR_GIVE, width_over_force};
use crate::regression::linear::least_squares;
use crate::segment::threshold::percentile;
use foundation::estimate::EstimateError;

/// Give of a pad that was not measured, m/N, and its standard deviation.
/// Source: the thesis: pads of foam of 2 mm gave 1.1 mm at 2.75 N.
const USUAL_GIVE_M_N: (f64, f64) = (4e-4, 2e-4);
/// Share of the give at lift-off that is the pads' shear, and not the floor's, with its error.
/// Derived: evenly likely between 0.86 and 1, because floors are many times as stiff as pads.
const SHEAR_SHARE: (f64, f64) = (0.93, 0.07 * EVEN);
/// Lift between these shares of the weight: the barrel stands on the floor and is carried in part.
/// Choice: not varied. A tenth is above the noise of the lift, and 0.85 leaves the last part, in which a barrel
/// turns.
const PARTLY: (f64, f64) = (0.1, 0.85);
/// Share of the samples below the weight by itself: a cable pulls in many of those above, too.
/// Choice: no case of the ablation reads it.
const LEAST_CARRIED: f64 = 0.1;
/// Pull to the side, as a share of the weight, from which the barrel turns in the grip, so that its width is not seen.
/// Choice: no case of the ablation reads it.
const SIDEWAYS: f64 = 0.05;

/// Estimates from the grip.
pub struct Grip {
    /// Width, m, and give of one side, m/N.
    pub sides: Option<PadFit>,
    /// Distance of the tips, m, where the grip was too even.
    pub mean_width_m: f64,
    /// Mean grip, N.
    pub mean_n: f64,
    /// Give in shear of both fingers together, m/N, and its error.
    shear_m_n: (f64, f64),
    /// Samples.
    pub samples: usize,
}

impl Grip {
    /// From all samples in which it was held.
    pub fn of(signals: &Signals, pad_n_m: Option<f64>) -> Result<Self, EstimateError> {
        let weight_n = weight_n(signals).unwrap_or(0.0);
        let straight = |i: &usize| signals.net_n[*i].x.abs() < SIDEWAYS * weight_n;
        let all = signals.held();
        let held: Vec<usize> = all.iter().copied().filter(straight).collect();
        let held = if 2 * held.len() > all.len() { held } else { all };
        let rows = signals.rows(&held);
        let column = |series: &[f64]| rows.iter().map(|i| series[*i]).collect::<Vec<f64>>();
        let (width, force, rate) = (column(&signals.width_m), column(&signals.grip_n), column(&signals.width_rate));
        let n = rows.len().max(1) as f64;
        let mean = |values: &[f64]| values.iter().sum::<f64>() / n;
        let (mean_n, mean_width_m) = (mean(&force), mean(&width));
        let spread = (force.iter().map(|f| (f - mean_n).powi(2)).sum::<f64>() / n).sqrt();
        let grip = pads::Grip { width: &width, force: &force, rate: &rate };
        let sides = if spread > LEAST_GRIP_VARIATION * mean_n { width_over_force(&grip)? } else { None };
        let sides = sides.filter(|s| s.give_m_per_n > 0.0);
        let normal = sides.map_or(USUAL_GIVE_M_N.0, |s| s.give_m_per_n);
        // A wall yields under the grip, but not along itself.
        let one = 0.5 * pad_n_m.map_or(normal, f64::recip);
        let shear_m_n = shear(signals)?.unwrap_or((one * SHEAR_GIVE.0, one * SHEAR_GIVE.1));
        Ok(Self { sides, mean_width_m, mean_n, shear_m_n, samples: held.len() })
    }

    /// Shift of the tips' middle against the barrel by a force along x and y, m/N, with errors.
    pub fn give_m_n(&self) -> [(f64, f64); 2] {
        let normal = self.sides.map_or(USUAL_GIVE_M_N, |s| (s.give_m_per_n, s.give_error));
        [(0.5 * normal.0, 0.5 * normal.1), self.shear_m_n]
    }
}

/// Approximate weight of the barrel while nothing else pulls, N; `None` if it never hung.
pub fn weight_n(signals: &Signals) -> Option<f64> {
    let mut weights: Vec<f64> = signals.hanging().iter().flatten().map(|i| signals.net_n[*i].y).collect();
    (!weights.is_empty()).then(|| percentile(&mut weights, LEAST_CARRIED))
}

/// Give of the two fingers in shear: how far they rise while they take the barrel's weight over from the floor.
fn shear(signals: &Signals) -> Result<Option<(f64, f64)>, EstimateError> {
    let Some(weight_n) = weight_n(signals) else { return Ok(None) };
    let off = signals.hanging().first().and_then(|lift| lift.first().copied()).unwrap_or(0);
    let held = signals.held();
    let first = held.first().copied().unwrap_or(off);
    let partly = |i: &usize| (PARTLY.0 * weight_n..PARTLY.1 * weight_n).contains(&signals.net_n[*i].y);
    let rows: Vec<usize> = (first..off).filter(partly).collect();
    if rows.len() < LEAST_LINE_ROWS {
        return Ok(None);
    }
    let lift: Vec<f64> = rows.iter().map(|i| signals.net_n[*i].y).collect();
    let height: Vec<f64> = rows.iter().map(|i| signals.position[*i].y).collect();
    let fit = least_squares(&[vec![1.0; rows.len()], lift], &height, None)?;
    let (slope, error) = (fit.values[1], fit.std_errors[1]);
    let seen = fit.identified[1] && slope > SIGNIFICANT * error;
    Ok(seen.then(|| (SHEAR_SHARE.0 * slope, (SHEAR_SHARE.1 * slope).hypot(error))))
}
