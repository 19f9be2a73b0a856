//! The handle's motion along the circle, and the rows of the regression of eq. 5.2.

use super::geometry::Geometry;
use super::held::Held;
use super::laws::{LAWS, column};
use haptics::Vec2;
use haptics::law::Motion;
use haptics::recording::Recording;

/// The handle's motion along the circle and the tangential force, N, at every sample (they mean something while it is held).
pub(super) fn motions(recording: &Recording, held: &Held, geometry: &Geometry) -> (Vec<Motion>, Vec<f64>) {
    let up = if recording.meta.up.as_deref() == Some("-y") { -1.0 } else { 1.0 };
    let frame = |i: usize| {
        let handle = held.position[i] - held.force[i].component_mul(&geometry.give_m_per_n) - geometry.center_m;
        let outward = handle.normalize();
        (outward, Vec2::new(-outward.y, outward.x))
    };
    // The sign of a velocity within its noise is a guess: it is blurred over twice that (and never less than 0.5 mm/s).
    let blur = (2.0 * held.velocity_noise).max(0.5e-3);
    let mut angle_before = 0.0;
    (0..held.time_s.len())
        .map(|i| {
            let (outward, along) = frame(i);
            // The tips move with the handle plus the changing give of the pads.
            let give = &geometry.give_m_per_n;
            let speed = (held.velocity[i] - held.force_rate[i].component_mul(give)).dot(&along);
            let wrapped = outward.y.atan2(outward.x);
            let turns = ((angle_before - wrapped) / std::f64::consts::TAU).round();
            let angle = wrapped + turns * std::f64::consts::TAU;
            angle_before = angle;
            let motion = Motion {
                time_s: held.time_s[i],
                position: geometry.radius_m * angle,
                velocity: speed,
                acceleration: (held.acceleration[i] - held.force_bend[i].component_mul(give)).dot(&along),
                direction: (speed / blur).tanh(),
                normal_force_n: held.force[i].dot(&outward),
                up_along: up * along.y,
            };
            (motion, held.force[i].dot(&along))
        })
        .unzip()
}

/// The regression's rows: every law's column and the tangential force, all through one more low-pass.
///
/// A linear filter over both sides leaves the equation as it is (parallel filtering, Gautier 1997). It takes out what the
/// equation does not hold for: the noise of accelerations, which would flatten the inertia, and the tremor of the hand, which
/// the handle does not quite follow because of the pads.
pub(super) struct Rows {
    pub(super) columns: [Vec<f64>; LAWS.len()],
    pub(super) tangential: Vec<f64>,
    pub(super) weights: Vec<f64>,
}

/// Half of the low-pass window, s: what is slower than about 5 Hz stays.
const LOW_PASS_HALF_S: f64 = 0.06;

impl Rows {
    pub(super) fn new(held: &Held, motions: &[Motion], tangential: &[f64]) -> Self {
        let period_s = (held.time_s[held.time_s.len() - 1] - held.time_s[0]) / (held.time_s.len() - 1) as f64;
        let half = (LOW_PASS_HALF_S / period_s).round() as usize;
        // Only where the whole window turns: elsewhere the equation does not hold.
        let mut turns = vec![0_u32; motions.len() + 1];
        for i in &held.turning {
            turns[i + 1] = 1;
        }
        for i in 0..motions.len() {
            turns[i + 1] += turns[i];
        }
        let inside: Vec<usize> = held
            .turning
            .iter()
            .copied()
            .filter(|i| *i >= half && i + half < motions.len())
            .filter(|i| turns[i + half + 1] - turns[i - half] == 2 * half as u32 + 1)
            // After the filter, rows closer than its window share samples (parallel decimation).
            .filter(|i| i % (2 * half).max(1) == 0)
            .collect();
        let reach = (half as f64 + 0.5).powi(2);
        let weight = |k: usize, i: usize| reach - (k as f64 - i as f64).powi(2);
        let pass = |value: &dyn Fn(usize) -> f64| -> Vec<f64> {
            let total: f64 = (0..=2 * half).map(|k| weight(k, half)).sum();
            let at = |i: usize| (i - half..=i + half).map(|k| weight(k, i) * value(k)).sum::<f64>() / total;
            inside.iter().map(|i| at(*i)).collect()
        };
        let direction = pass(&|k| motions[k].direction.abs());
        Self {
            columns: std::array::from_fn(|law| pass(&|k| column(LAWS[law], &motions[k]))),
            tangential: pass(&|k| tangential[k]),
            // Around a reversal the direction is a guess within the noise: such rows count less, and not at all when the
            // direction is quite unknown.
            weights: direction.iter().map(|d| d.powi(4)).collect(),
        }
    }

    pub(super) fn len(&self) -> usize {
        self.tangential.len()
    }

    /// The rows of several recordings, one after the other.
    pub(super) fn join<'a>(all: impl Iterator<Item = &'a Self>) -> Self {
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
    pub(super) fn head(&self, rows: usize) -> Self {
        Self {
            columns: std::array::from_fn(|law| self.columns[law][..rows].to_vec()),
            tangential: self.tangential[..rows].to_vec(),
            weights: self.weights[..rows].to_vec(),
        }
    }
}
