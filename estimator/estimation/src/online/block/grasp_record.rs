//! Data collected about one carried object.

use super::super::change::ChangeDetector;
use super::super::decimating_store::DecimatingStore;
use super::super::recursive::Recursive;
use super::pull::{Hold, Left};
use haptics::Vec2;

/// Rows of a reading that are kept for judging a leak.
const KEPT: usize = 400;
/// Columns of the readings: time, vertical sum, vertical and horizontal acceleration, horizontal sum, vertical force of each finger.
pub(super) const READING: usize = 7;

/// Changes of weight (N) and of the mass by accelerations (kg) that matter.
const MATTERS: [f64; 2] = [0.004, 0.02];

/// One row: all channels through the same filter, bias in.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Row {
    pub(super) time_s: f64,
    /// Sum of the vertical forces, N.
    pub(super) lift_n: f64,
    pub(super) acceleration: [f64; 2],
    /// Sum of the horizontal forces, N.
    pub(super) across_n: f64,
    /// Vertical force of each finger, N.
    pub(super) fingers_n: [f64; 2],
    /// Mean normal force without bias, N.
    pub(super) grip_n: f64,
    pub(super) width_m: f64,
    pub(super) width_rate_m_s: f64,
    /// Middle between the tips, m in the world.
    pub(super) at_m: Vec2,
    /// Largest ratio of shear to normal force that is certain, and its error.
    pub(super) ratio: Option<(f64, f64)>,
    pub(super) carried: bool,
}

#[derive(Clone, Debug)]
pub(super) struct GraspRecord {
    /// Weight with the bias in it, and mass by accelerations.
    pub(super) weight: Recursive<2>,
    pub(super) change: ChangeDetector<2>,
    /// Width at no force, less of it per force, damping of the pads.
    pub(super) width: Recursive<3>,
    pub(super) reading: DecimatingStore<READING>,
    pub(super) bound: Option<(f64, f64)>,
    /// Anything else that holds it.
    pub(super) hold: Hold,
    /// Mean and mean square of the grip, N and N².
    pub(super) grip: [f64; 2],
    pub(super) held_rows: u64,
    pub(super) carried_rows: u64,
    /// True once it is known which object it is.
    pub(super) told: bool,
}

impl GraspRecord {
    pub(super) fn new(memory_rows: f64, block_rows: u32, false_alarms: f64, row_s: f64) -> Self {
        Self {
            weight: Recursive::new([1.0, 0.5], memory_rows, block_rows),
            change: ChangeDetector::new(false_alarms, row_s, MATTERS),
            width: Recursive::new([1.0, 1.0, 0.01], memory_rows, block_rows),
            reading: DecimatingStore::new(KEPT),
            bound: None,
            hold: Hold::new(false_alarms, row_s),
            grip: [0.0; 2],
            held_rows: 0,
            carried_rows: 0,
            told: false,
        }
    }

    /// Forgets everything about the object.
    pub(super) fn clear(&mut self) {
        self.weight.reset();
        self.width.reset();
        self.change.restart(0.0);
        self.reading.clear();
        self.hold.clear();
        (self.bound, self.grip, self.held_rows, self.carried_rows, self.told) = (None, [0.0; 2], 0, 0, false);
    }

    /// Takes in a row and, if it is known, the residual force after weight and inertia; reports a jump of the weight,
    /// with the weight before, bias in.
    pub(super) fn take(&mut self, row: &Row, left: Option<&Left>) -> Option<(super::super::change::Change, f64)> {
        self.held_rows += 1;
        let share = 1.0 / self.held_rows as f64;
        self.grip[0] += share * (row.grip_n - self.grip[0]);
        self.grip[1] += share * (row.grip_n * row.grip_n - self.grip[1]);
        self.width.push(&[1.0, row.grip_n, row.width_rate_m_s], row.width_m, 1.0);
        if let Some((ratio, error)) = row.ratio
            && self.bound.is_none_or(|(r, e)| ratio - 2.0 * error > r - 2.0 * e)
        {
            self.bound = Some((ratio, error));
        }
        if !row.carried {
            return None;
        }
        if left.is_some_and(|left| self.hold.take(left)) {
            return None;
        }
        self.carried_rows += 1;
        let [ax, ay] = row.acceleration;
        let [left, right] = row.fingers_n;
        self.reading.push([row.time_s, row.lift_n, ay, ax, row.across_n, left, right]);
        let before = self.weight.values()[0];
        let columns = [1.0, ay];
        let innovation = self.weight.push(&columns, row.lift_n, 1.0)?;
        let change = self.change.push(row.time_s, &columns, innovation.residual, innovation.leverage)?;
        self.weight.reset();
        Some((change, before))
    }

    /// Mean grip and its spread, N.
    pub(super) fn grip_and_spread(&self) -> (f64, f64) {
        (self.grip[0], (self.grip[1] - self.grip[0] * self.grip[0]).max(0.0).sqrt())
    }
}
