//! The workspaces of the window.

use crate::ui::kit::icons::Icon;
use serde::{Deserialize, Serialize};

/// The workspaces.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Workspace {
    /// Touch a virtual world.
    #[default]
    Train,
    /// Measure a real one.
    Calibrate,
    /// Errors of the model.
    Diagnose,
    /// Devices that move the fingers, and their quality.
    Devices,
}

impl Workspace {
    /// All of them: icon, name and purpose.
    pub const CHOICES: [(Self, (Icon, &str), &str); 4] = [
        (Self::Train, (Icon::Touch, "Train"), "Touch a virtual world (Ctrl+1)"),
        (Self::Calibrate, (Icon::Calibrate, "Calibrate"), "Measure a real one from a log (Ctrl+2)"),
        (Self::Diagnose, (Icon::Diagnose, "Diagnose"), "What the model gets wrong, and why (Ctrl+3)"),
        (Self::Devices, (Icon::Device, "Devices"), "What moves the fingers, and how well (Ctrl+4)"),
    ];

    /// Its name.
    pub fn title(self) -> &'static str {
        self.face().1
    }

    /// Its icon.
    pub fn icon(self) -> Icon {
        self.face().0
    }

    fn face(self) -> (Icon, &'static str) {
        Self::CHOICES.iter().find(|(w, ..)| *w == self).map_or((Icon::Panel, ""), |(_, face, _)| *face)
    }
}
