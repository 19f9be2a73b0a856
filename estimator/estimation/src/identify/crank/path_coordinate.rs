//! The handle's motion along the circle, and the rows of the regression of eq. 5.2.

use super::frame::{Frame, Handled, LOW_PASS_HALF_S, blur};
use super::geometry::Geometry;
use super::laws::{LAWS, column};
use super::signals::{Grasped, Held};
use haptics::Vec2;
use haptics::law::Motion;
use haptics::recording::Recording;
use rayon::prelude::*;

/// Turns the motion of a held handle into motion along its circle, sample by sample.
pub(crate) struct Along<'a> {
    held: &'a Grasped,
    position: &'a [Vec2],
    frame: Frame,
}

impl<'a> Along<'a> {
    pub(crate) fn new(recording: &Recording, held: &'a Held, geometry: &'a Geometry) -> Self {
        let up = if recording.meta.up.as_deref() == Some("-y") { -1.0 } else { 1.0 };
        let (center_m, give_m_per_n) = (geometry.center_m, geometry.give_m_per_n);
        Self {
            held,
            position: held.position(),
            frame: Frame { center_m, give_m_per_n, up, blur_m_s: blur(held.velocity_noise) },
        }
    }

    /// The motion (its position left out) and the tangential force, N, at a sample; they mean something while it is held.
    fn at(&self, i: usize) -> (Motion, f64) {
        let held = self.held;
        let handled = Handled {
            position: self.position[i],
            velocity: held.velocity[i],
            acceleration: held.acceleration[i],
            force: held.force[i],
            force_rate: held.force_rate[i],
            force_bend: held.force_bend[i],
        };
        self.frame.at(held.time_s[i], &handled)
    }
}

/// The handle's motion along the circle and the tangential force, N, at every sample (they mean something while it is held).
pub(crate) fn motions(recording: &Recording, held: &Held, geometry: &Geometry) -> (Vec<Motion>, Vec<f64>) {
    motions_at(recording, held, geometry, 0..held.time_s.len())
}

/// [`motions`] at chosen samples, less than half a turn apart.
pub(crate) fn motions_at(
    recording: &Recording,
    held: &Held,
    geometry: &Geometry,
    samples: impl Iterator<Item = usize>,
) -> (Vec<Motion>, Vec<f64>) {
    let along = Along::new(recording, held, geometry);
    let mut angle_before = 0.0;
    samples
        .map(|i| {
            let outward = along.frame.outward(along.position[i], held.force[i]);
            let wrapped = outward.y.atan2(outward.x);
            let turns = ((angle_before - wrapped) / std::f64::consts::TAU).round();
            let angle = wrapped + turns * std::f64::consts::TAU;
            angle_before = angle;
            let (motion, tangential) = along.at(i);
            (Motion { position: geometry.radius_m * angle, ..motion }, tangential)
        })
        .unzip()
}

/// The regression's rows: every law's regressor and the tangential force, all through one more low-pass.
///
/// A linear filter over both sides leaves the equation as it is (parallel filtering, Gautier 1997). It takes out
/// signals for which the equation does not hold: the noise of accelerations, which would flatten the inertia, and the
/// tremor of the hand, which the handle does not quite follow because of the pads.
pub(crate) struct Rows {
    pub(crate) columns: [Vec<f64>; LAWS.len()],
    pub(crate) tangential: Vec<f64>,
    pub(crate) weights: Vec<f64>,
}

fn half(time_s: &[f64]) -> usize {
    let period_s = (time_s[time_s.len() - 1] - time_s[0]) / (time_s.len() - 1) as f64;
    (LOW_PASS_HALF_S / period_s).round() as usize
}

/// Samples a window apart whose whole window turns: elsewhere the equation does not hold, and rows closer than the filter's window
/// share samples (parallel decimation).
fn inside(held: &Grasped, half: usize) -> Vec<usize> {
    let samples = held.time_s.len();
    let mut turns = vec![0_u32; samples + 1];
    for i in &held.turning {
        turns[i + 1] = 1;
    }
    for i in 0..samples {
        turns[i + 1] += turns[i];
    }
    let whole = 2 * half as u32 + 1;
    held.turning
        .iter()
        .copied()
        .filter(|i| i % (2 * half).max(1) == 0 && *i >= half && i + half < samples)
        .filter(|i| turns[i + half + 1] - turns[i - half] == whole)
        .collect()
}

impl Rows {
    pub(crate) fn new(along: &Along<'_>) -> Self {
        Self::thinned(along, 1)
    }

    /// The same from about `taps` samples in each window of the low-pass: enough for the effect of a small change of
    /// the geometry.
    pub(crate) fn coarse(along: &Along<'_>, taps: usize) -> Self {
        Self::thinned(along, (2 * half(&along.held.time_s) / taps).max(1))
    }

    fn thinned(along: &Along<'_>, step: usize) -> Self {
        let held = along.held;
        let half = half(&held.time_s);
        let inside = inside(held, half);
        let reach = (half as f64 + 0.5).powi(2);
        let taps: Vec<(usize, f64)> =
            (0..=2 * half).step_by(step).map(|k| (k, reach - (k as f64 - half as f64).powi(2))).collect();
        let total: f64 = taps.iter().map(|(_, w)| w).sum();
        let row = |i: &usize| {
            let (mut sums, mut tangential, mut direction) = ([0.0; LAWS.len()], 0.0, 0.0);
            for (k, weight) in &taps {
                let (motion, force) = along.at(i - half + k);
                for (sum, law) in sums.iter_mut().zip(LAWS) {
                    *sum += weight * column(law, &motion);
                }
                tangential += weight * force;
                direction += weight * motion.direction.abs();
            }
            // Around a reversal the direction is a guess within the noise: such rows count less, and not at all when the
            // direction is quite unknown.
            (sums.map(|sum| sum / total), tangential / total, (direction / total).powi(4))
        };
        let made: Vec<_> = inside.par_iter().map(row).collect();
        Self {
            columns: std::array::from_fn(|law| made.iter().map(|(columns, ..)| columns[law]).collect()),
            tangential: made.iter().map(|(_, tangential, _)| *tangential).collect(),
            weights: made.iter().map(|(.., weight)| *weight).collect(),
        }
    }

    pub(crate) fn len(&self) -> usize {
        self.tangential.len()
    }

    /// The rows of several recordings, one after the other.
    pub(crate) fn join<'a>(all: impl Iterator<Item = &'a Self>) -> Self {
        let mut joined = Self { columns: Default::default(), tangential: Vec::new(), weights: Vec::new() };
        for rows in all {
            for (column, more) in joined.columns.iter_mut().zip(&rows.columns) {
                column.extend_from_slice(more);
            }
            joined.tangential.extend_from_slice(&rows.tangential);
            joined.weights.extend_from_slice(&rows.weights);
        }
        joined
    }

    /// The first rows, as they come in time.
    pub(crate) fn head(&self, rows: usize) -> Self {
        Self {
            columns: std::array::from_fn(|law| self.columns[law][..rows].to_vec()),
            tangential: self.tangential[..rows].to_vec(),
            weights: self.weights[..rows].to_vec(),
        }
    }
}
