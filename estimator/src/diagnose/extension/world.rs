//! The worlds before and after a diagnosis.

use super::hypothetical_worlds::as_found;
use crate::diagnose::contract::Diagnosis;
use crate::diagnose::options::Options;
use crate::estimate::EstimateError;
use crate::pipeline;
use haptics::law::{Effect, Role};
use haptics::recording::Recording;
use haptics::world::World;

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
pub fn worlds(recordings: &[Recording], options: &Options, diagnosis: &Diagnosis) -> Result<Worlds, EstimateError> {
    let world = calibrated(recordings, options)?;
    let mut after = with_laws(&world, &diagnosis.effects);
    after.name = format!("{}, extended", world.name);
    if world.crank.is_none() && world.mechanism.is_none() {
        super::block_world::extend(&mut after, diagnosis);
        super::switch_world::extend(&mut after, diagnosis);
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
    diagnosis: &Diagnosis,
) -> Result<World, EstimateError> {
    worlds(recordings, options, diagnosis).map(|worlds| worlds.after)
}

/// The world with other laws along its coordinate.
pub(crate) fn with_laws(world: &World, laws: &[Effect]) -> World {
    let mut world = world.clone();
    if let Some(crank) = &mut world.crank {
        crank.effects = beside(&crank.effects, laws);
    }
    if let Some(mechanism) = &mut world.mechanism {
        mechanism.effects = beside(&mechanism.effects, laws);
    }
    world
}

/// The laws, preceded by the world's inertia and weight if the laws have none. Nothing moves without inertia, and a
/// known weight is not fitted.
fn beside(had: &[Effect], laws: &[Effect]) -> Vec<Effect> {
    let missing = |role: Role| !laws.iter().any(|law| law.role() == role);
    let kept = had.iter().filter(|e| matches!(e.role(), Role::Inertia | Role::Gravity) && missing(e.role()));
    kept.chain(laws).copied().collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use haptics::law::Inertia;
    use haptics::law::ViscousFriction;
    use haptics::law::Weight;
    use haptics::world::presets;

    #[test]
    fn a_world_keeps_its_inertia_and_a_known_weight_and_can_still_be_stepped() {
        let world = presets::crank();
        let with = with_laws(&world, &[Effect::new(&ViscousFriction, &[2.0])]);
        let ids: Vec<&str> = with.crank.as_ref().expect("still a crank").effects.iter().map(|e| e.law().id()).collect();
        assert_eq!(ids, ["weight", "inertia", "viscous-friction"]);
        with.check().expect("it can be stepped");
        let laws = [Effect::new(&Inertia, &[0.2]), Effect::new(&Weight, &[0.3])];
        let replaced = with_laws(&world, &laws).crank.expect("a crank").effects;
        assert_eq!(replaced, laws, "what was found takes the place of what there was");
    }
}
