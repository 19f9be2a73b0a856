//! Rows out of a recording of a mechanism: one coordinate and the force along it.

use super::track::{Place, Row, Track};
use crate::estimate::EstimateError;
use crate::identify::mechanism;
use crate::signal::noise::white_noise;
use haptics::Vec2;
use haptics::law::{Coordinate, Motion};
use haptics::recording::Recording;

/// Rows come at about this rate, Hz.
const ROW_HZ: f64 = 100.0;

/// The rows of one recording; all channels went through one zero-phase filter.
pub fn track(recording: &Recording) -> Result<Track, EstimateError> {
    let (coordinate, pieces) = mechanism::filtered(recording)?;
    let angular = coordinate == Coordinate::Angular;
    let mut rows = Vec::new();
    let (mut velocity, mut period_s, mut noise, mut raw_period_s) = (0.0_f64, 0.0_f64, 0.0_f64, 0.0_f64);
    for (stretch, piece) in pieces.iter().enumerate() {
        let force = piece.force.as_ref().ok_or_else(|| {
            EstimateError::Other(format!(
                "{} has no force column: a diagnosis explains the force that a motion needs; record it, or map it in the sidecar",
                recording.name
            ))
        })?;
        let every = (1.0 / (ROW_HZ * piece.period_s)).round().max(1.0) as usize;
        period_s = period_s.max(every as f64 * piece.period_s);
        raw_period_s = raw_period_s.max(piece.period_s);
        velocity = velocity.max(piece.velocity_noise);
        noise = noise.max(white_noise(&force.iter().copied().step_by(every).collect::<Vec<_>>()));
        let used = (0..piece.motion.len()).step_by(every).filter(|i| piece.usable[*i]);
        rows.extend(used.map(|i| {
            let before = force[i.saturating_sub(1)];
            let after = force[(i + 1).min(force.len() - 1)];
            Row {
                recording: 0,
                stretch,
                place: Place::Along,
                motion: Motion { direction: 0.0, normal_force_n: 0.0, ..piece.motion[i] },
                angle_rad: piece.motion[i].position,
                along: Vec2::x(),
                force: Vec2::new(force[i], 0.0),
                force_rate: Vec2::new((after - before) / (2.0 * piece.period_s), 0.0),
                y: force[i],
            }
        }));
    }
    let span_s = rows.last().map_or(0.0, |r| r.motion.time_s) - rows.first().map_or(0.0, |r| r.motion.time_s);
    let start_s = rows.first().map_or(0.0, |r| r.motion.time_s);
    for row in &mut rows {
        row.motion.time_s -= start_s;
    }
    Ok(Track {
        rows,
        period_s,
        raw_period_s,
        coordinate,
        radius_m: angular.then_some(1.0),
        planar: false,
        velocity_noise: velocity,
        force_noise: noise.max(1e-12),
        noise_is_measured: false,
        span_s,
    })
}
