//! Experiments that a diagnosis asks for, performed: by the scripted operator on a simulated object, or shown to a person.
//!
//! [`Timetable`] says where the hand is wanted when, [`MotionPlan`] where the coordinate of a mechanism is that has no handle, [`perform`]
//! lets the scripted operator do it, [`rehearse`] does so with every object that the diagnosis leaves open and asks again each time: what would come out, and how surely?

mod along_path;
mod captured;
mod motion_plan;
mod perform;
mod rehearse;
mod sensing;
mod timetable;
mod tool;

pub use motion_plan::MotionPlan;
pub use perform::{perform, what_is_known};
pub use rehearse::{Like, Outcome, Rehearsal, Round, rehearse};
pub use timetable::{Step, Timetable};

/// The key of the sidecar under which a recording says that its object was simulated.
pub const SIMULATED: &str = "simulated_object";

/// What a recording says about the object that was simulated for it; nothing for a measurement.
pub fn simulated_object(recording: &haptics::recording::Recording) -> Option<&str> {
    recording.meta.other.get(SIMULATED)?.as_str()
}
