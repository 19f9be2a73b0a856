//! Causes found on a needle and its sheet, and rival causes, as effects in a world.

use super::hypothetical_worlds::Act;
use haptics::law::object::MembraneLaw;
use haptics::world::World;

/// Largest friction of a hole as a share of the puncture force: the law has no other.
/// Choice: no case of the ablation reads it.
const LESS_THAN_PUNCTURE: f64 = 0.95;
/// Largest dent of the law, as a share of the depth.
/// Choice: no case of the ablation reads it.
const DEEPEST_DENT: f64 = 0.9;

/// The world with these effects on its sheet and hole.
pub fn with_acts(world: &World, acts: &[Act]) -> World {
    let mut world = world.clone();
    let Some(membrane) = &mut world.membrane else { return world };
    let law = &mut membrane.law;
    for (id, parameters) in acts {
        let value = |name: &str| parameters.iter().find(|p| p.name == name).map(|p| p.value);
        put(law, id, &value);
    }
    law.friction_n = law.friction_n.clamp(0.0, LESS_THAN_PUNCTURE * law.puncture_n);
    law.give = law.give.clamp(0.0, DEEPEST_DENT);
    world
}

fn put(law: &mut MembraneLaw, id: &str, value: &dyn Fn(&str) -> Option<f64>) {
    let positive = |name: &str| value(name).filter(|v| *v > 0.0);
    match id {
        "sheet" => match (positive("k"), positive("factor")) {
            (Some(k), _) => (law.stiffness_n_m, law.cubic_n_m3, law.give) = (k, 0.0, 0.0),
            (None, Some(factor)) => {
                law.stiffness_n_m *= factor;
                law.cubic_n_m3 *= factor;
            }
            _ => {}
        },
        "sheet: stiffness-hardening" => law.cubic_n_m3 += positive("k3").unwrap_or(0.0),
        "sheet: hysteresis" => law.give += positive("share").unwrap_or(0.0) * positive("dent").unwrap_or(0.0),
        "hole" => {
            // Without a world's friction, the hole holds nothing.
            let factor = positive("factor");
            law.friction_n *= factor.unwrap_or(0.0);
            law.drag_n_s_m = factor.and(positive("c")).unwrap_or(0.0);
        }
        "hole: coulomb-friction" => law.friction_n += positive("Fc").unwrap_or(0.0),
        "hole: viscous-friction" => law.drag_n_s_m += positive("c").unwrap_or(0.0),
        // A rim that yields before the shaft slides is already the law's own friction.
        _ => {}
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::contract::parameter;
    use haptics::world::presets;

    #[test]
    fn a_sheet_is_what_it_came_out_at_and_a_hole_rubs_only_if_that_is_thought() {
        let world = presets::needle();
        let act = |id: &str, values: &[(&str, f64)]| -> Act {
            (id.to_owned(), values.iter().map(|(name, value)| parameter(name, *value, 0.0, "")).collect())
        };
        let plain = [act("sheet", &[("k", 300.0)]), act("hole", &[])];
        let law = |acts: &[Act]| with_acts(&world, acts).membrane.expect("still a sheet").law;
        let found = law(&plain);
        assert_eq!((found.stiffness_n_m, found.cubic_n_m3, found.give), (300.0, 0.0, 0.0));
        assert_eq!((found.friction_n, found.drag_n_s_m, found.puncture_n), (0.0, 0.0, 1.5));
        let rubs = law(&[plain.as_slice(), &[act("hole: coulomb-friction", &[("Fc", 0.2)])]].concat());
        assert_eq!((rubs.friction_n, rubs.drag_n_s_m), (0.2, 0.0));
        let dented = law(&[plain.as_slice(), &[act("sheet: hysteresis", &[("share", 0.9), ("dent", 0.3)])]].concat());
        assert!((dented.give - 0.27).abs() < 1e-12);
        let scaled = law(&[act("sheet", &[("factor", 1.1)]), act("hole", &[("factor", 2.0), ("c", 5.0)])]);
        assert!((scaled.stiffness_n_m - 286.0).abs() < 1e-9 && (scaled.friction_n - 0.5).abs() < 1e-12);
        with_acts(&world, &[act("hole: coulomb-friction", &[("Fc", 9.0)])]).check().expect("it can be stepped");
    }
}
