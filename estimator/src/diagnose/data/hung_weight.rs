//! A known weight that hangs on the object.

use haptics::law::Coordinate;
use haptics::recording::Recording;

/// A known weight on the object, `known` in the sidecar: `added_weight_N`, on a mechanism that turns also
/// `added_lever_m` and `added_level_rad`, the coordinate at which its lever is level.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hung {
    /// Its largest force along the coordinate, N (N m for angles).
    pub force: f64,
    /// Its inertia, kg (kg m²).
    pub inertia: f64,
    /// Coordinate at which its lever is horizontal, rad. A crank's follows from its position.
    pub level_rad: f64,
}

impl Hung {
    /// A weight hung on the handle of a crank.
    pub fn on_crank(recording: &Recording) -> Option<Self> {
        let weight = stated(recording, "added_weight_N")?;
        Some(Self { force: weight, inertia: weight / recording.meta.gravity(), level_rad: 0.0 })
    }

    /// On a mechanism that turns.
    pub fn on_mechanism(recording: &Recording, coordinate: Coordinate) -> Option<Self> {
        if coordinate == Coordinate::Linear {
            return None;
        }
        let [weight, lever] = [stated(recording, "added_weight_N")?, stated(recording, "added_lever_m")?];
        let level_rad = recording.meta.known.get("added_level_rad").copied().filter(|v| v.is_finite())?;
        Some(Self { force: weight * lever, inertia: weight * lever * lever / recording.meta.gravity(), level_rad })
    }
}

fn stated(recording: &Recording, name: &str) -> Option<f64> {
    recording.meta.known.get(name).copied().filter(|v| v.is_finite() && *v > 0.0)
}
