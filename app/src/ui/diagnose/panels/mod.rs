//! Panels of the diagnosis, one a file.

pub mod atlas;
pub mod cause_card;
pub mod causes;
pub mod motion_plan;
pub mod next_experiment;
pub mod residuals;
pub mod validation;
pub mod why_not;
