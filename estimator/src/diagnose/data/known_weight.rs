//! A known weight hung on the object: its force, and the tilt of the plane, which it separates from an eccentric mass.
//!
//! Magnitude and direction of the hung weight are known. A tilted plane rotates its force as it rotates that of the
//! object. An eccentric mass does not.

use super::hung_weight::Hung;
use super::regression_data::{Place, Row, Track};

/// Weight hung on in a row's recording.
pub(crate) fn of(track: &Track, row: &Row) -> Option<Hung> {
    track.hung.get(row.recording).copied().flatten().filter(|_| row.place == Place::Along)
}

/// Share of the hung weight that acts along the coordinate.
pub(crate) fn level(track: &Track, row: &Row, hung: Hung) -> f64 {
    if track.planar { row.motion.up_along } else { (row.motion.position - hung.level_rad).cos() }
}

/// Force that the hung weight needs, one per row; `None` without a weight.
pub fn column(track: &Track) -> Option<Vec<f64>> {
    track.hung.iter().any(Option::is_some).then(|| {
        let force = |row: &Row| {
            of(track, row).map_or(0.0, |h| h.force * level(track, row, h) + h.inertia * row.motion.acceleration)
        };
        track.rows.iter().map(force).collect()
    })
}
