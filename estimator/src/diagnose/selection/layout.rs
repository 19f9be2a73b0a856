//! Rows of a channel: segment, time, weight and hold-out role of each.

use crate::diagnose::data::limits::{GAP_IN_PERIODS, LEAST_PIECES};
use crate::diagnose::hypotheses::axis::Axis;
use std::collections::HashMap;

/// Lengths of the jackknife blocks, s: correlation times of a model error, which are typical durations of a hand's
/// reversal and stroke.
/// Choice: halved, 1 of 90 answers change (1 to right); doubled, 0 of 90 answers change.
const PIECES_S: Axis = Axis::geometric(0.25, 1.0, 3);

/// Hold-out role of a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Held {
    /// Always used for training.
    Never,
    /// Tested by folds. Its quantity is not the force, and locked blocks test it for that quantity alone.
    ByFolds,
    /// Tested by folds and by locked blocks.
    Fully,
}

/// Use of a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Use {
    Always,
    /// Used for training, and tested by the fold of this number.
    Fold(usize),
    /// Tests only; the number of its block.
    Locked(usize),
    /// The same for a row of [`Held::ByFolds`]: it tests only the gain of causes that affect such rows.
    Beside(usize),
    /// Beside a locked block.
    Guard,
}

/// Kind of the rows' noise.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Noise {
    /// Unknown noise.
    Any,
    /// Noise of first or second differences of data with white noise, plus some white noise.
    OfDifferences,
}

/// Blocks of rows that share a model error, for the jackknife.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Blocks {
    /// Runs of rows within a segment, if there are enough of them.
    OfRows,
    /// Rows of the same interval of time.
    OfTime,
    /// None: every effect counts as steady.
    None,
}

/// Rows of a channel.
#[derive(Clone, Debug)]
pub struct Layout {
    pub segment: Vec<usize>,
    /// Hold-out role of each row; rows that may not be held out always train.
    pub held: Vec<Held>,
    /// Time of each row, s, or its rank: rows near in time are held out together.
    pub time_s: Vec<f64>,
    /// Weight of each row, 0 … 1: factor by which its noise is reduced.
    pub weight: Vec<f64>,
    /// Time between rows, s.
    pub period_s: f64,
    pub noise: Noise,
    /// True if standing rows have next to no weight: blocks then have equal information, not equal numbers of rows.
    pub may_stand: bool,
    pub blocks: Blocks,
}

impl Layout {
    /// Rows in the order of time, of equal weight. `testable`: true for rows that may be held out.
    pub fn of(segment: Vec<usize>, testable: &[bool], period_s: f64) -> Self {
        let rows = segment.len();
        Self {
            segment,
            held: testable.iter().map(|t| if *t { Held::Fully } else { Held::Never }).collect(),
            time_s: (0..rows).map(|i| i as f64).collect(),
            weight: vec![1.0; rows],
            period_s,
            noise: Noise::Any,
            may_stand: false,
            blocks: Blocks::OfRows,
        }
    }

    /// The same rows with these weights.
    pub fn weighted(self, weight: Vec<f64>) -> Self {
        Self { weight, ..self }
    }

    pub fn rows(&self) -> usize {
        self.segment.len()
    }

    /// Jackknife block of each row, for each length of the blocks that has enough of them.
    pub fn pieces(&self) -> Vec<Vec<usize>> {
        match self.blocks {
            Blocks::OfRows => {
                PIECES_S.values().filter_map(|piece_s| self.runs((piece_s / self.period_s) as usize)).collect()
            }
            Blocks::OfTime => PIECES_S.values().map(|piece_s| self.intervals(piece_s)).collect(),
            Blocks::None => Vec::new(),
        }
    }

    /// Runs of at most this many rows; `None` if there are too few.
    fn runs(&self, most: usize) -> Option<Vec<usize>> {
        let (mut piece, mut own) = (0, 0);
        let mut pieces = Vec::with_capacity(self.rows());
        for i in 0..self.rows() {
            let goes_on = i == 0 || self.segment[i] == self.segment[i - 1] && own < most.max(1);
            (piece, own) = if goes_on { (piece, own + 1) } else { (piece + 1, 1) };
            pieces.push(piece);
        }
        (piece + 1 >= LEAST_PIECES).then_some(pieces)
    }

    /// Intervals of this length, numbered without the empty ones.
    fn intervals(&self, piece_s: f64) -> Vec<usize> {
        let mut numbers: HashMap<i64, usize> = HashMap::new();
        let mut number = |time_s: &f64| {
            let next = numbers.len();
            *numbers.entry((time_s / piece_s).floor() as i64).or_insert(next)
        };
        self.time_s.iter().map(&mut number).collect()
    }
}

/// Numbers the segments: rows without a gap in time. `new` begins a segment in any case.
pub fn segments(time_s: &[f64], period_s: f64, new: impl Fn(usize) -> bool) -> Vec<usize> {
    let mut number = 0;
    (0..time_s.len())
        .map(|i| {
            if i > 0 && (new(i) || !(0.0..GAP_IN_PERIODS * period_s).contains(&(time_s[i] - time_s[i - 1]))) {
                number += 1;
            }
            number
        })
        .collect()
}
