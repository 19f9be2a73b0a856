//! Experiments that a diagnosis asks for, performed: by the scripted operator on a simulated object, or shown to a person.
//!
//! [`Timetable`] says where the hand is wanted when, [`MotionPlan`] where the coordinate of a mechanism is that has no handle, [`perform`]
//! lets the scripted operator do it, [`rehearse`] does so with every object that the diagnosis leaves open and asks again each time: what would come out, and how surely?

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
