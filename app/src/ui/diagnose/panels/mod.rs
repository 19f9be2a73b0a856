//! Panels of the diagnosis, one a file.

pub mod atlas;
pub mod cause_card;
pub mod causes;
pub mod false_alarms;
pub mod motion_plan;
pub mod next_experiment;
pub mod residuals;
pub mod validation;
pub mod why_not;

use crate::ui::shell::panel::Registration;

/// Panels that the window offers; a new one is added here.
pub static PANELS: &[&Registration] = &[&residuals::REGISTRATION, &causes::REGISTRATION];
