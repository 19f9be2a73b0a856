//! Performance of the experiments that a diagnosis requests: by the scripted operator on a simulated object, or as
//! guidance for a person.
//!
//! [`Timetable`] has the desired hand positions over time, [`MotionPlan`] the desired coordinate of a mechanism without
//! a handle. [`perform`] lets the scripted operator do it. [`rehearse`] does so with every object that the diagnosis
//! leaves open and diagnoses again each time: the likely result, and its reliability.

pub mod along_path;
pub mod captured;
pub mod like;
pub mod motion_plan;
pub mod perform;
pub mod rehearse;
pub mod sensing;
pub mod simulated;
pub mod timetable;
pub mod tool;
