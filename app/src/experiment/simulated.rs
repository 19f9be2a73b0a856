//! The mark of recordings that were simulated.

/// Sidecar key under which a recording states that its object was simulated.
pub const SIMULATED: &str = "simulated_object";

/// Description of the object simulated for a recording; `None` for a measurement.
pub fn simulated_object(recording: &haptics::recording::Recording) -> Option<&str> {
    recording.meta.other.get(SIMULATED)?.as_str()
}
