//! Worlds of a diagnosis: without and with its causes, and one for every answer that the recordings leave open.

use super::extension::{block_world, needle_world, switch_world};
use super::findings::Findings;
use super::options::Options;
use crate::diagnose::extension::hypothetical_worlds::{Hypothesis, Inside};
use crate::diagnose::extension::world::with_laws;
use crate::diagnose::hypotheses::sensor_fault::SensorFault;
use estimation::pipeline;
use foundation::estimate::EstimateError;
use haptics::recording::Recording;
use haptics::world::World;

/// A hypothesis as a world with a sensor fault.
#[derive(Clone, Debug, PartialEq)]
pub struct Suspect {
    /// The assumed cause.
    pub id: String,
    /// The object with it.
    pub world: World,
    /// Fault of the force sensors.
    pub fault: SensorFault,
    /// Share of a hung weight that acts along a mechanism's coordinate: all of it, unless its axis is assumed to be
    /// vertical with a tilt.
    pub hung_share: f64,
}

/// The world with all causes found on a needle, by its first hypothesis.
pub(crate) fn as_found(world: &World, diagnosis: &Findings) -> Option<World> {
    let first = diagnosis.hypotheses.first().filter(|_| world.membrane.is_some())?;
    match first.inside.as_ref()? {
        Inside::Acts(acts) => Some(needle_world::with_acts(world, acts)),
        Inside::Laws(_) => None,
    }
}

/// All answers that the recordings leave open, as worlds, the one found first. Answers that no world can simulate are
/// left out. The list is empty if a sensor fault was found that cannot be added to a recording.
pub fn suspects(
    recordings: &[Recording],
    options: &Options,
    diagnosis: &Findings,
) -> Result<Vec<Suspect>, EstimateError> {
    let world = calibrated(recordings, options)?;
    let suspect = |h: &Hypothesis| {
        let mut world = match h.inside.as_ref()? {
            Inside::Laws(laws) => with_laws(&world, laws),
            Inside::Acts(acts) if world.membrane.is_some() => needle_world::with_acts(&world, acts),
            Inside::Acts(acts) if world.switch.is_some() => switch_world::with_acts(&world, acts),
            Inside::Acts(acts) => block_world::with_acts(&world, diagnosis, acts),
        };
        world.name = format!("{}, with {}", world.name, h.id.replace('-', " "));
        Some(Suspect { id: h.id.clone(), world, fault: h.fault?, hung_share: h.hung_share })
    };
    let mut found: Vec<Suspect> = Vec::new();
    for suspect in diagnosis.hypotheses.iter().filter_map(suspect) {
        if found.iter().all(|s| s.id != suspect.id) {
            found.push(suspect);
        }
    }
    if found.is_empty() && world.crank.is_none() && world.mechanism.is_none() {
        let mut world = world;
        extend(&mut world, diagnosis);
        found.extend(diagnosis.causes.first().map(|c| Suspect {
            id: c.id.clone(),
            world,
            fault: SensorFault::default(),
            hung_share: 1.0,
        }));
    }
    Ok(found)
}

/// Adds the found causes to a world of blocks or of a switch.
fn extend(world: &mut World, diagnosis: &Findings) {
    for put in [block_world::put, switch_world::put] {
        diagnosis.causes.iter().for_each(|cause| put(world, &cause.id, &cause.parameters));
    }
}

/// Two worlds: one with the base model's laws at their own best fit, one with the causes found beside them. All else is
/// equal, so that one can replace the other while somebody touches it.
#[derive(Clone, Debug, PartialEq)]
pub struct Worlds {
    /// With the base model alone.
    pub before: World,
    /// With the causes found.
    pub after: World,
}

/// Both worlds of a diagnosis, from its initial world or from one calibrated from the recordings.
pub fn worlds(recordings: &[Recording], options: &Options, diagnosis: &Findings) -> Result<Worlds, EstimateError> {
    let world = calibrated(recordings, options)?;
    let mut after = with_laws(&world, &diagnosis.effects);
    after.name = format!("{}, extended", world.name);
    if world.crank.is_none() && world.mechanism.is_none() {
        extend(&mut after, diagnosis);
        after = as_found(&after, diagnosis).unwrap_or(after);
    }
    Ok(Worlds { before: with_laws(&world, &diagnosis.plain), after })
}

/// The initial world of the diagnosis, or one calibrated from the recordings.
pub(crate) fn calibrated(recordings: &[Recording], options: &Options) -> Result<World, EstimateError> {
    if let Some(world) = &options.world {
        return Ok(world.clone());
    }
    let fit = pipeline::Options { task: options.task, ..pipeline::Options::default() };
    Ok(pipeline::analyse(recordings, &fit)?.world)
}

/// The world that runs what the diagnosis found: the one it started from, or one calibrated from the recordings, with
/// the extended laws.
pub fn extended_world(
    recordings: &[Recording],
    options: &Options,
    diagnosis: &Findings,
) -> Result<World, EstimateError> {
    worlds(recordings, options, diagnosis).map(|worlds| worlds.after)
}
