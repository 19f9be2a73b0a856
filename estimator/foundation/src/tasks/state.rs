//! The contact configurations that recordings are divided into.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Contact configuration of the system.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, JsonSchema, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum SystemState {
    /// Nothing is touched.
    FreeMotion,
    /// An object is held and rests on something.
    HoldOnGround,
    /// An object is held in the air.
    HoldAboveGround,
    /// An object is held and slides over what it rests on.
    SlidingOnGround,
    /// A crank or mechanism is moved.
    Turning,
    /// A crank or mechanism is held still.
    Holding,
    /// A needle presses a sheet in.
    Insertion,
    /// A needle goes on through the sheet.
    Penetration,
    /// A needle is drawn out.
    Extraction,
    /// None of the known states: these samples enter no estimate.
    NoState,
}

impl SystemState {
    /// Every one of them.
    pub const ALL: [Self; 10] = [
        Self::FreeMotion,
        Self::HoldOnGround,
        Self::HoldAboveGround,
        Self::SlidingOnGround,
        Self::Turning,
        Self::Holding,
        Self::Insertion,
        Self::Penetration,
        Self::Extraction,
        Self::NoState,
    ];

    /// The name used in JSON and in labels.
    pub fn name(self) -> &'static str {
        match self {
            Self::FreeMotion => "free-motion",
            Self::HoldOnGround => "hold-on-ground",
            Self::HoldAboveGround => "hold-above-ground",
            Self::SlidingOnGround => "sliding-on-ground",
            Self::Turning => "turning",
            Self::Holding => "holding",
            Self::Insertion => "insertion",
            Self::Penetration => "penetration",
            Self::Extraction => "extraction",
            Self::NoState => "no-state",
        }
    }

    /// The thesis's symbol in figure 5.5: 1 free motion, 2 hold above ground, 3 hold on ground, x sliding, 0 none.
    pub fn symbol(self) -> char {
        match self {
            Self::FreeMotion => '1',
            Self::HoldAboveGround => '2',
            Self::HoldOnGround => '3',
            Self::SlidingOnGround => 'x',
            Self::Turning => 't',
            Self::Holding => 'h',
            Self::Insertion => 'i',
            Self::Penetration => 'p',
            Self::Extraction => 'e',
            Self::NoState => '0',
        }
    }
}
