//! Constraint of a carried block: none but the hand, if all is well.

use super::existence::{Rows, existence, sentence};
use foundation::estimate::{Constraint, ConstraintKind};
use foundation::signal::task::{TaskSignals, half_width, smooth};
use haptics::Vec2;

/// Slower than this share of the carry's own speed, the direction of motion is a guess.
const SLOW_SHARE: f64 = 0.3;

/// A carry of one block.
pub struct Carry<'a> {
    /// The block's name.
    pub object: &'a str,
    /// Name of the recording.
    pub recording: &'a str,
    /// Signals of the whole recording.
    pub signals: &'a TaskSignals,
    /// Samples of the carry.
    pub samples: &'a [usize],
    /// Bias of the net force, N, and its standard error.
    pub bias_n: Vec2,
    /// N.
    pub bias_error_n: f64,
    /// m/s².
    pub gravity: f64,
}

/// The constraint entry of a carried block: free, unless force across its motion says otherwise. `None` when the carry is too
/// short to tell anything.
pub fn carried(carry: &Carry<'_>) -> Option<Constraint> {
    let rows = rows(carry);
    let (found, sided) = existence(&rows)?;
    let kind = if found.exists == Some(false) { ConstraintKind::Free } else { ConstraintKind::Undecided };
    let mut answer = Constraint::blank(Some(carry.recording.to_owned()), &sentence(&found));
    answer.object = Some(carry.object.to_owned());
    answer.kind = kind;
    answer.constraint_force_n = Some(found.unexplained_n);
    answer.existence = Some(found);
    answer.sided = sided;
    Some(answer)
}

/// Velocity, acceleration and force through one filter, a window apart, where the block moves.
fn rows(carry: &Carry<'_>) -> Rows {
    let signals = carry.signals;
    let time = &signals.time_s;
    let through = |series: &[Vec2]| {
        let [x, y] = [0, 1].map(|k| smooth(time, &series.iter().map(|v| v[k]).collect::<Vec<f64>>()));
        let pair = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| Vec2::new(*a, *b)).collect::<Vec<_>>();
        (pair(&x.value, &y.value), pair(&x.slope, &y.slope))
    };
    let (velocity, acceleration) = through(&signals.velocity);
    let (force, _) = through(&signals.net_force_n);
    let square: f64 = carry.samples.iter().map(|i| velocity[*i].norm_squared()).sum();
    let least = SLOW_SHARE * (square / carry.samples.len().max(1) as f64).sqrt();
    // Neighbours within a window share samples; the cubics that velocities may be derived with are as long again.
    let stride = 2 * half_width(time) + 1;
    let picked: Vec<usize> =
        carry.samples.iter().copied().step_by(stride).filter(|i| velocity[*i].norm() > least).collect();
    let pick = |series: &[Vec2]| picked.iter().map(|i| series[*i]).collect::<Vec<Vec2>>();
    Rows {
        velocity: pick(&velocity),
        acceleration: pick(&acceleration),
        force: pick(&force).iter().map(|f| f - carry.bias_n).collect(),
        up: Vec2::y(),
        gravity: (carry.gravity > 0.0).then_some(carry.gravity),
        rubs: false,
        bias_error_n: carry.bias_error_n,
    }
}
