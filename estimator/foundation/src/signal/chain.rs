//! Columns of a chain of two joints.

use haptics::recording::Recording;

/// Columns of the angles, first joint first.
pub const ANGLES: [&str; 2] = ["q1_rad", "q2_rad"];
/// Columns of the torques, first joint first.
pub const TORQUES: [&str; 2] = ["tau1_Nm", "tau2_Nm"];

/// True if a recording is one of a chain.
pub fn is_chain(recording: &Recording) -> bool {
    ANGLES.iter().chain(&TORQUES).all(|name| recording.channel(name).is_some())
}
