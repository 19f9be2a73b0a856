//! Performance of the experiments that a diagnosis requests: by the scripted operator on a simulated object, or as
//! guidance for a person.
//!
//! [`Timetable`] has the desired hand positions over time, [`MotionPlan`] the desired coordinate of a mechanism without
//! a handle. [`perform`] lets the scripted operator do it. [`rehearse`] does so with every object that the diagnosis
//! leaves open and diagnoses again each time: the likely result, and its reliability.

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

/// Sidecar key under which a recording states that its object was simulated.
pub const SIMULATED: &str = "simulated_object";

/// Description of the object simulated for a recording; `None` for a measurement.
pub fn simulated_object(recording: &haptics::recording::Recording) -> Option<&str> {
    recording.meta.other.get(SIMULATED)?.as_str()
}
