//! Panels of the live world, one a file.

pub mod assistant;
pub mod before_after;
pub mod comfort;
pub mod debrief;
pub mod delay;
pub mod guide;
pub mod legend;
pub mod lessons;
pub mod overlay_marks;
pub mod passivity;
pub mod progress;
pub mod scripted_operator;
pub mod touch_and_keys;
pub mod trainer_side;
pub mod trainer_timing;
pub mod trainer_view;

use crate::ui::shell::panel::Registration;

/// Panels that the window offers; a new one is added here.
pub static PANELS: &[&Registration] =
    &[&trainer_view::REGISTRATION, &trainer_side::REGISTRATION, &progress::REGISTRATION];
