//! Axis signs of a mechanism: a force that drives its motion on balance is counted the other way.

use crate::diagnose::contract::Cause;
use crate::diagnose::data::regression_data::Track;
use crate::diagnose::recording::sample_faults;
use crate::diagnose::tasks::baseline_models::named;
use crate::diagnose::tasks::one_coordinate;
use foundation::estimate::EstimateError;
use haptics::recording::Recording;

/// Detects a force with the sign of the reaction: mass and friction are then negative, each of them significantly. The
/// sign is corrected in the rows.
pub fn of_mechanism(
    track: &mut Track,
    recording: &Recording,
    rate: Option<&str>,
) -> Result<Option<Cause>, EstimateError> {
    if !one_coordinate::drives(track, &named("mass+viscous+coulomb")?)? {
        return Ok(rate.map(sample_faults::against_motion));
    }
    for row in &mut track.rows {
        row.y = -row.y;
        row.force = -row.force;
        row.force_rate = -row.force_rate;
    }
    // If a rate contradicts the position and the force drives the motion, the position is the mirrored one.
    let names: &[&str] = if rate.is_some() { &["q_m", "q_rad"] } else { &["f_N", "tau_Nm"] };
    let name = names.iter().find(|name| recording.channel(name).is_some()).unwrap_or(&"the force");
    Ok(Some(sample_faults::driving(name)))
}
