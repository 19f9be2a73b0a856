//! Counts the questions to a board and the faults of its answers.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

/// Why an answer counts for nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// Nothing came in time, or not all of it.
    Late,
    /// Another board's id, or angles that are no numbers.
    Foreign,
    /// A place where no hand can be, or can have come to so quickly.
    Impossible,
}

impl Fault {
    /// Every one.
    pub const ALL: [Self; 3] = [Self::Late, Self::Foreign, Self::Impossible];
}

/// Counts a board's answers, for panels and tests; read from any thread.
#[derive(Clone, Debug, Default)]
pub struct Tally {
    asked: Arc<AtomicU64>,
    faults: Arc<[AtomicU64; Fault::ALL.len()]>,
    unplugged: Arc<AtomicBool>,
    rests: Arc<AtomicBool>,
}

impl Tally {
    /// Questions that the board was asked.
    pub fn asked(&self) -> u64 {
        self.asked.load(Ordering::Relaxed)
    }

    /// Of these, those whose answer was lost or wrong (see [`super::Answer::faults`]).
    pub fn faults(&self) -> u64 {
        Fault::ALL.into_iter().map(|why| self.count(why)).sum()
    }

    /// Of these, those for one reason.
    pub fn count(&self, why: Fault) -> u64 {
        self.faults[why as usize].load(Ordering::Relaxed)
    }

    /// True since the board's cable was pulled, until the board is set up again. It gets no torque meanwhile.
    pub fn is_unplugged(&self) -> bool {
        self.unplugged.load(Ordering::Relaxed)
    }

    /// True while the board is looked for, after [`Tally::arm_rests`].
    pub fn is_looked_for(&self) -> bool {
        self.is_unplugged() && self.rests.load(Ordering::Relaxed)
    }

    /// Confirms, by a person, that the cable is in again and the arm lies in its pose of rest, so that the board may be
    /// set up. The board takes its present pose for the pose of rest: from any other pose every position and force
    /// would be off.
    pub fn arm_rests(&self) {
        self.rests.store(true, Ordering::Relaxed);
    }

    /// The cable was pulled, or the board was set up after that. (Of use outside only where a hand is shown without one.)
    pub fn note_unplugged(&self, is_out: bool) {
        self.rests.store(false, Ordering::Relaxed);
        self.unplugged.store(is_out, Ordering::Relaxed);
    }

    pub(super) fn add(&self, fault: Option<Fault>) {
        self.asked.fetch_add(1, Ordering::Relaxed);
        if let Some(why) = fault {
            self.faults[why as usize].fetch_add(1, Ordering::Relaxed);
        }
    }
}
