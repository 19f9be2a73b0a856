//! One panel per file, behind one trait.

pub(super) mod answers;
mod assistant;
mod atlas;
mod boundaries;
mod causes;
mod check;
mod comfort;
mod compare;
mod debrief;
mod delay;
pub mod device_detail;
pub mod devices;
pub mod diagnose;
pub mod diagnosis;
mod guide;
mod incoming;
mod legend;
mod lessons;
pub mod log;
mod marks;
pub mod measured;
mod motion_plan;
mod next_experiment;
mod overlay;
mod parameter_editor;
pub mod parameters;
mod passivity;
pub mod progress;
pub mod recording;
mod remote;
pub mod results;
pub mod rules;
mod rules_table;
pub mod scene;
mod script;
pub mod segments;
pub mod sensitivity;
mod steering;
mod task_choice;
pub mod trainer_side;
pub mod trainer_timing;
pub mod trainer_view;
pub mod transport;
pub mod video;
mod why_not;
mod xy;

use super::session::Session;

/// A part of the window that shows and changes the session.
pub trait Panel {
    /// Title, for users and for tests.
    fn title(&self) -> &'static str;

    /// Draws the panel into the available space.
    fn ui(&mut self, ui: &mut egui::Ui, session: &mut Session);
}
