//! Panels of the recordings and their fit, one a file.

pub mod boundaries;
pub mod loading_preview;
pub mod log;
pub mod measured;
pub mod overlay;
pub mod parameter_editor;
pub mod parameters;
mod part;
pub mod recording;
pub mod results;
pub mod rules;
pub mod rules_table;
pub mod scene;
pub mod segments;
pub mod sensitivity;
pub mod task_choice;
pub mod transport;
pub mod video;
pub mod xy;

use crate::ui::shell::panel::Registration;

/// Panels that the window offers; a new one is added here.
pub static PANELS: &[&Registration] = &[
    &recording::REGISTRATION,
    &scene::REGISTRATION,
    &log::REGISTRATION,
    &results::REGISTRATION,
    &segments::REGISTRATION,
    &sensitivity::REGISTRATION,
    &video::REGISTRATION,
];
