//! Settings that make training comfortable: the side of the hand, a pause when the window loses the focus, and the
//! volume. They are kept from one start to the next.

use egui::PointerButton;
use serde::{Deserialize, Serialize};

/// Settings that a person has chosen.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Comfort {
    /// The mouse is in the left hand: controls stand left of the picture, the right button pinches, the left one turns the view.
    pub left_handed: bool,
    /// The world stands still while another window has the keyboard.
    pub pauses: bool,
    /// Volume, 0 to 1.
    pub volume: f32,
    /// Not at all.
    pub muted: bool,
}

impl Default for Comfort {
    fn default() -> Self {
        Self { left_handed: false, pauses: true, volume: 0.7, muted: false }
    }
}

impl Comfort {
    /// The mouse button that pinches.
    pub fn pinches(&self) -> PointerButton {
        if self.left_handed { PointerButton::Secondary } else { PointerButton::Primary }
    }

    /// The mouse button that turns the view of the trainer.
    pub fn turns(&self) -> PointerButton {
        if self.left_handed { PointerButton::Primary } else { PointerButton::Secondary }
    }

    /// Effective volume, 0 to 1; 0 when muted.
    pub fn loudness(&self) -> f32 {
        if self.muted { 0.0 } else { self.volume.clamp(0.0, 1.0) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_left_hand_swaps_the_buttons_and_mute_is_silence() {
        let right = Comfort::default();
        let left = Comfort { left_handed: true, ..right };
        assert_eq!((left.pinches(), left.turns()), (right.turns(), right.pinches()));
        assert_ne!(left.pinches(), right.pinches());
        assert!(right.loudness() > 0.0);
        assert_eq!(Comfort { muted: true, ..right }.loudness(), 0.0);
        assert_eq!(Comfort { volume: 7.0, ..right }.loudness(), 1.0, "a file may say anything");
        // Files of older versions have less in them.
        let older: Comfort = serde_json::from_str("{\"left_handed\":true}").expect("read");
        assert_eq!(older, left);
    }
}
