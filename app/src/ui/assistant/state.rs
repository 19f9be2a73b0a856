//! The parts of the assistant that are switched on.

use serde::{Deserialize, Serialize};

/// Parts of the assistant that are switched on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
// One switch for each part is what the user sees.
#[allow(clippy::struct_excessive_bools)]
pub struct Assistant {
    /// All of it.
    pub on: bool,
    /// Weight, width and stiffness of what is held.
    pub held: bool,
    /// How near it is to slipping.
    pub slip: bool,
    /// What may be in it.
    pub contents: bool,
    /// Warning of too much force.
    pub force: bool,
    /// Warning of a blow that comes.
    pub collision: bool,
    /// Warning of the edge of the workspace.
    pub edge: bool,
    /// Draws what holds an object.
    pub constraint: bool,
}

impl Default for Assistant {
    fn default() -> Self {
        Self {
            on: true,
            held: true,
            slip: true,
            contents: true,
            force: true,
            collision: true,
            edge: true,
            constraint: true,
        }
    }
}
