//! Performance of the experiments that a diagnosis requests: by the scripted operator on a simulated object, or as
//! guidance for a person.
//!
//! [`Timetable`] has the desired hand positions over time, [`MotionPlan`] the desired coordinate of a mechanism without
//! a handle. [`perform`] lets the scripted operator do it. [`rehearse`] does so with every object that the diagnosis
//! leaves open and diagnoses again each time: the likely result, and its reliability.

pub(crate) mod along_path;
pub(crate) mod captured;
pub(crate) mod like;
pub(crate) mod motion_plan;
pub(crate) mod perform;
pub(crate) mod rehearse;
pub(crate) mod sensing;
pub(crate) mod simulated;
pub(crate) mod timetable;
pub(crate) mod tool;

pub use like::Like;
pub use motion_plan::MotionPlan;
pub use perform::{perform, what_is_known};
pub use rehearse::{Outcome, Rehearsal, Round, rehearse};
pub use timetable::{Step, Timetable};
