//! Layers of the 3-D view of a recording beside the hand: switches, stored in the session.

/// Switches above the picture.
#[allow(clippy::struct_excessive_bools)] // independent switches, shown as such
#[derive(Clone, Copy, Debug)]
pub struct SceneLayers {
    /// Path of the fingers or the tool.
    pub path: bool,
    /// Force vectors along the path.
    pub forces_on_path: bool,
    /// Residual force along the path, which weight and friction do not explain.
    pub unexplained: bool,
    /// Detected constraints.
    pub constraints: bool,
    /// Marks at contacts.
    pub contacts: bool,
    /// The hand and the forces of the replay, over the measured ones.
    pub replay: bool,
    /// Legend of the marks, with their values.
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
