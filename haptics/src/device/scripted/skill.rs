//! Skill of a scripted operator, and its deliberate mistakes.

/// Skill of the operator. [`Skill::default`] is a steady hand that follows its plan without looking; calibration
/// recordings are made with it. The four levels are people: they aim, miss, look, correct, and notice what they
/// dropped.
///
/// The figures of the levels are orders of magnitude, set so that the usual measures (time, path, peak force) come out in order;
/// they are no data of real trainees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Skill {
    /// Duration of a movement relative to the usual one.
    pub pace: f64,
    /// Amplitude of the physiological tremor (8–12 Hz), m.
    pub tremor_m: f64,
    /// Usual pinch force, N.
    pub pinch_n: f64,
    /// Relative spread of the pinch force from grasp to grasp (standard deviation).
    pub pinch_spread: f64,
    /// Wander of the pinch force while it is held, relative to a steady hand.
    pub wander: f64,
    /// Standard deviation of the end of a reach in the air before it is corrected, m per axis.
    pub aim_error_m: f64,
    /// Mean overshoot of a reach, relative to its length.
    pub overshoot: f64,
    /// Time from an event to the reaction to its sight, s, up to 0.6; `None`: does not look, only follows the plan.
    pub reaction_s: Option<f64>,
}

impl Default for Skill {
    fn default() -> Self {
        Self {
            pace: 1.0,
            tremor_m: 0.06e-3,
            pinch_n: 1.6,
            pinch_spread: 0.0,
            wander: 1.0,
            aim_error_m: 0.0,
            overshoot: 0.0,
            reaction_s: None,
        }
    }
}

impl Skill {
    /// First time at it: slow, tense, misses and corrects.
    pub fn novice() -> Self {
        Self {
            pace: 1.6,
            tremor_m: 0.12e-3,
            pinch_n: 3.0,
            pinch_spread: 0.20,
            wander: 1.6,
            aim_error_m: 3.5e-3,
            overshoot: 0.15,
            reaction_s: Some(0.30),
        }
    }

    /// Has done it some times.
    pub fn intermediate() -> Self {
        Self {
            pace: 1.25,
            tremor_m: 0.09e-3,
            pinch_n: 2.3,
            pinch_spread: 0.14,
            wander: 1.3,
            aim_error_m: 2.2e-3,
            overshoot: 0.09,
            reaction_s: Some(0.25),
        }
    }

    /// Does it well.
    pub fn advanced() -> Self {
        Self {
            pace: 1.0,
            tremor_m: 0.07e-3,
            pinch_n: 1.8,
            pinch_spread: 0.10,
            wander: 1.0,
            aim_error_m: 1.2e-3,
            overshoot: 0.05,
            reaction_s: Some(0.22),
        }
    }

    /// Quick, light and straight.
    pub fn expert() -> Self {
        Self {
            pace: 0.8,
            tremor_m: 0.05e-3,
            pinch_n: 1.4,
            pinch_spread: 0.06,
            wander: 0.8,
            aim_error_m: 0.5e-3,
            overshoot: 0.02,
            reaction_s: Some(0.20),
        }
    }

    /// The level of a name: `steady` (the default), `novice`, `intermediate`, `advanced`, `expert`.
    pub fn from_name(name: &str) -> Option<Self> {
        match name {
            "steady" => Some(Self::default()),
            "novice" => Some(Self::novice()),
            "intermediate" => Some(Self::intermediate()),
            "advanced" => Some(Self::advanced()),
            "expert" => Some(Self::expert()),
            _ => None,
        }
    }
}

/// A deliberate mistake. Each befalls one grasp, drawn by the seed; those that do not fit the task are left out. Only an operator
/// that looks ([`Skill::reaction_s`]) notices a drop and tries again.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mistake {
    /// The pinch loosens on the way up: the block slips and is dropped.
    WeakPinch,
    /// The pinch is several times too hard. Also on the crank's handle.
    Crush,
    /// The block is put down beside the middle of the one below.
    MisalignedStack,
    /// The block is let go on the way.
    EarlyRelease,
    /// The first turn of the crank starts the wrong way round.
    WrongDirection,
    /// The needle is pushed far beyond the sheet.
    Overshoot,
}

impl Mistake {
    /// Every mistake.
    pub const ALL: [Self; 6] = [
        Self::WeakPinch,
        Self::Crush,
        Self::MisalignedStack,
        Self::EarlyRelease,
        Self::WrongDirection,
        Self::Overshoot,
    ];

    /// True if it can happen when blocks are carried.
    pub fn is_of_blocks(self) -> bool {
        !matches!(self, Self::WrongDirection | Self::Overshoot)
    }
}
