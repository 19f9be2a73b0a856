//! One panel a file, behind one trait; [`list`] names them all.

pub mod answers;
pub mod atlas;
pub mod causes;
pub mod check;
pub mod device_detail;
pub mod devices;
pub mod diagnose;
pub mod diagnosis;
pub mod list;
pub mod motion_plan;
pub mod next_experiment;
pub mod remote;
pub mod why_not;
