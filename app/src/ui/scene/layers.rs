//! What the 3-D view of a recording shows beside the hand: switches, remembered by the session.

/// The switches over the picture.
#[allow(clippy::struct_excessive_bools)] // independent switches, shown as such
#[derive(Clone, Copy, Debug)]
pub struct SceneLayers {
    /// The path of the fingers or the tool.
    pub path: bool,
    /// Force vectors along the path.
    pub forces_on_path: bool,
    /// What weight and friction do not explain of the force, along the path.
    pub unexplained: bool,
    /// Found constraints.
    pub constraints: bool,
    /// Marks at contacts.
    pub contacts: bool,
    /// The hand and the forces of the replay, over the measured ones.
    pub replay: bool,
    /// What the marks mean, with their numbers.
    pub legend: bool,
}

impl Default for SceneLayers {
    fn default() -> Self {
        Self {
            path: true,
            forces_on_path: false,
            unexplained: false,
            constraints: true,
            contacts: true,
            replay: false,
            legend: true,
        }
    }
}
