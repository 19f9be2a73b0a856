use super::candidate::Candidate;
use crate::diagnose::data::regression_data::Track;
use haptics::law::{Coordinate, Effect, GravityTilt, Kind, Law as _};

/// Slope under a linear motion, as the sine of its angle. `None` if the object rotates or is driven.
pub(crate) fn tilt(track: &Track) -> Option<Candidate> {
    let free = track.freely.filter(|_| track.coordinate == Coordinate::Linear)?;
    let pull = free.inertia * free.gravity_m_s2;
    Some(Candidate::one(GravityTilt.id(), Kind::Plant, "angle", "rad", vec![pull; track.rows.len()]))
}

/// The law of such a slope. `sine`: of its angle.
pub(crate) fn tilted(track: &Track, sine: f64) -> Option<Effect> {
    let free = track.freely?;
    Some(Effect::new(&GravityTilt, &[free.inertia * free.gravity_m_s2, sine.clamp(-1.0, 1.0).asin(), 0.0]))
}
