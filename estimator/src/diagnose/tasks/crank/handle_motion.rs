//! Position and velocity of a crank's handle, and the net force on it, from the fingers or the tool that hold it.

use crate::diagnose::recording::pads;
use foundation::estimate::EstimateError;
use foundation::signal::task::{TaskSignals, is_two_fingered, task_signals, tip_series};
use haptics::Vec2;
use haptics::recording::Recording;

/// Position, velocity and net force, sample by sample.
pub struct HandleMotion {
    pub position: Vec<Vec2>,
    pub velocity: Vec<Vec2>,
    pub force: Vec<Vec2>,
    /// Compliance of a pad along the line of the grip, m/N, whose give is taken off the positions.
    pub grip_m_n: Option<f64>,
}

impl HandleMotion {
    pub fn of(recording: &Recording) -> Result<Self, EstimateError> {
        if is_two_fingered(recording) {
            let signals = task_signals(recording)?;
            let grip_m_n = pads::compliance_m_n(&signals);
            let TaskSignals { mut position, velocity, net_force_n: force, .. } = signals;
            // The middle of both tips. The path alone shows only how much more the pads give along one axis than along
            // the other.
            for (place, force) in position.iter_mut().zip(&force) {
                place.x -= 0.5 * grip_m_n.unwrap_or(0.0) * force.x;
            }
            return Ok(Self { position, velocity, force, grip_m_n });
        }
        let tip = tip_series(recording, "")?;
        let velocity = tip.velocity.ok_or_else(|| EstimateError::Clockless {
            what: "a diagnosis of a crank".to_owned(),
            recording: recording.name.clone(),
        })?;
        let force = tip.force.ok_or_else(|| EstimateError::MissingColumn {
            task: "a diagnosis of a crank".to_owned(),
            column: "fx_N".to_owned(),
            recording: recording.name.clone(),
        })?;
        Ok(Self { position: tip.position, velocity, force, grip_m_n: None })
    }
}
