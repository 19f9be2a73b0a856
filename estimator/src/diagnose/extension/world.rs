//! The worlds before and after a diagnosis.

use haptics::law::{Effect, Role};
use haptics::world::World;

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
