//! The parts of the assistant that are switched on.

use serde::{Deserialize, Serialize};

/// Switches of the assistant's parts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
// The user sees one switch per part.
#[allow(clippy::struct_excessive_bools)]
pub struct Assistant {
    /// All of it.
    pub on: bool,
    /// Weight, width and stiffness of the held object.
    pub held: bool,
    /// Margin of the grip against slipping.
    pub slip: bool,
    /// Possible contents of the held object.
    pub contents: bool,
    /// Warning of excessive force.
    pub force: bool,
    /// Warning of an imminent impact.
    pub collision: bool,
    /// Warning at the edge of the workspace.
    pub edge: bool,
    /// Constraint of an object, drawn.
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
