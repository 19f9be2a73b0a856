//! Names of the states of a recording.

use estimator::segment::{Segmentation, SystemState};

/// Name of `Turning` for a mechanism that is no crank: it may slide as well.
const MOVING: &str = "Moving";

/// Name of a state.
pub fn state_name(state: SystemState) -> &'static str {
    match state {
        SystemState::FreeMotion => "Free motion",
        SystemState::HoldOnGround => "Hold on ground",
        SystemState::HoldAboveGround => "Hold above ground",
        SystemState::SlidingOnGround => "Sliding on ground",
        SystemState::Turning => "Turning",
        SystemState::Holding => "Holding",
        SystemState::Insertion => "Insertion",
        SystemState::Penetration => "Penetration",
        SystemState::Extraction => "Extraction",
        SystemState::NoState => "No state",
    }
}

/// Short name of a state, for narrow places.
pub fn state_short(state: SystemState) -> &'static str {
    match state {
        SystemState::FreeMotion => "Free",
        SystemState::HoldOnGround => "Ground",
        SystemState::HoldAboveGround => "In the air",
        SystemState::SlidingOnGround => "Slides",
        SystemState::Turning => "Turns",
        SystemState::Holding => "Holds",
        SystemState::Insertion => "In",
        SystemState::Penetration => "Through",
        SystemState::Extraction => "Out",
        SystemState::NoState => "–",
    }
}

/// Name of a state in a recording of this task.
pub fn state_of_task(segmentation: &Segmentation, state: SystemState) -> &'static str {
    if state == SystemState::Turning && segmentation.task != "crank" { MOVING } else { state_name(state) }
}
