//! Rows of forces: sums of both fingers while blocks are carried, single channels without touch.

use super::signals::Seen;
use crate::diagnose::hypotheses::force_step::{Jumps, jumps_of_fingers};
use crate::diagnose::model_error::twin::{Force, Placed};
use crate::diagnose::selection::layout::segments;
use haptics::Vec2;

/// Kind of a row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Place {
    /// Sum of both fingers along an axis, a block of this number in the air.
    Carried { number: usize, axis: usize },
    /// One finger along an axis, without touch.
    Free { finger: usize, axis: usize },
}

/// One row.
#[derive(Clone, Copy, Debug)]
pub struct Row {
    pub recording: usize,
    pub i: usize,
    pub time_s: f64,
    pub place: Place,
}

impl Row {
    /// Number of the block that is carried; 0 if none is.
    pub fn number(&self) -> usize {
        if let Place::Carried { number, .. } = self.place { number } else { 0 }
    }
}

/// All rows with their recordings.
pub struct Rows<'a> {
    pub seen: &'a [Seen<'a>],
    pub all: Vec<Row>,
    pub stretch: Vec<usize>,
}

impl<'a> Rows<'a> {
    pub fn of(seen: &'a [Seen<'a>]) -> Self {
        let mut rows = Vec::new();
        for (recording, one) in seen.iter().enumerate() {
            let mut add = |place: Place, of: &[usize]| {
                rows.extend(of.iter().map(|i| Row { recording, i: *i, time_s: one.time_s(*i), place }));
            };
            for number in 1..=one.count {
                let mut carried = one.carried(number);
                // The last row is dropped: the force filter's window may reach past the carry, to samples where the
                // ground already supports the block.
                carried.pop();
                for axis in [1, 0] {
                    add(Place::Carried { number, axis }, &carried);
                }
            }
            let free = one.free();
            for (finger, axis) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                add(Place::Free { finger, axis }, &free);
            }
        }
        let time: Vec<f64> = rows.iter().map(|r| r.time_s).collect();
        let period_s = seen.iter().map(|s| s.period_s).fold(0.0, f64::max);
        let other = |i: usize| rows[i].place != rows[i - 1].place || rows[i].recording != rows[i - 1].recording;
        let stretch = segments(&time, period_s, other);
        Self { seen, all: rows, stretch }
    }

    /// Places of the rows in their recordings.
    pub fn placed(&self) -> Vec<Placed> {
        let axes = [Vec2::x(), Vec2::y()];
        let placed = |row: &Row| Placed {
            recording: row.recording,
            time_s: row.time_s - self.seen[row.recording].time_s(0),
            force: match row.place {
                Place::Carried { axis, .. } => Force::Plane(axes[axis]),
                Place::Free { finger, axis } => Force::Finger(finger, axes[axis]),
            },
        };
        self.all.iter().map(placed).collect()
    }

    /// Time between independent rows, s.
    pub fn period_s(&self) -> f64 {
        self.seen.iter().map(|s| s.period_s).fold(0.0, f64::max)
    }

    /// Number of the block on which a regressor acts.
    pub fn touched(&self, column: &[f64]) -> usize {
        column.iter().position(|v| *v != 0.0).map_or(0, |i| self.all[i].number())
    }

    pub fn column(&self, of: impl Fn(&Row) -> f64) -> Vec<f64> {
        self.all.iter().map(of).collect()
    }

    /// A regressor over the carried rows of one axis, or of both.
    pub fn carried(&self, of: impl Fn(&Seen<'_>, &Row, usize, usize) -> f64) -> Vec<f64> {
        self.column(|row| match row.place {
            Place::Carried { number, axis } => of(&self.seen[row.recording], row, number, axis),
            Place::Free { .. } => 0.0,
        })
    }

    /// Recorded force: the sum of both fingers, or one finger's.
    pub fn force_n(&self, row: &Row) -> f64 {
        let force = &self.seen[row.recording].force;
        match row.place {
            Place::Carried { axis, .. } => force[0][axis][row.i] + force[1][axis][row.i],
            Place::Free { finger, axis } => force[finger][axis][row.i],
        }
    }

    /// Share of a fault of one finger's force along one axis in a row.
    pub fn share(row: &Row, finger: usize, axis: usize) -> f64 {
        let holds = match row.place {
            Place::Carried { axis: own, .. } => own == axis,
            Place::Free { finger: f, axis: own } => f == finger && own == axis,
        };
        f64::from(u8::from(holds))
    }

    /// The rows as those in which a sensor's zero may have jumped.
    pub fn jumps(&self) -> Jumps<impl Fn(&str, usize) -> f64> {
        let rows = self.all.iter().map(|row| (row.recording, row.time_s));
        jumps_of_fingers(rows, |finger, axis, i| Self::share(&self.all[i], finger, axis))
    }

    pub fn blocks(&self) -> usize {
        self.seen.iter().map(|s| s.count).max().unwrap_or(0)
    }

    /// Mean of the lift of a block, N.
    pub fn weight_n(&self, number: usize) -> f64 {
        let own = Place::Carried { number, axis: 1 };
        let lifts: Vec<f64> = self.all.iter().filter(|r| r.place == own).map(|r| self.force_n(r)).collect();
        lifts.iter().sum::<f64>() / lifts.len().max(1) as f64
    }
}
