//! The mark of recordings that were simulated.

/// The key of the sidecar under which a recording says that its object was simulated.
pub const SIMULATED: &str = "simulated_object";

/// What a recording says about the object that was simulated for it; nothing for a measurement.
pub fn simulated_object(recording: &haptics::recording::Recording) -> Option<&str> {
    recording.meta.other.get(SIMULATED)?.as_str()
}
