//! Causes found on a switch, and rival causes, as effects in a world.

use super::hypothetical_worlds::Act;
use crate::diagnose::contract::CauseParameter;
use crate::diagnose::hypotheses::{
    added_constraint, coulomb_friction, friction_asymmetry, local_resistance, pad_compliance, return_spring,
    viscous_friction,
};
use haptics::law::object::CurvePoint;
use haptics::law::{Effect, LocalResistance, Motion};
use haptics::world::{Switch, World};

/// Number of linear parts of a local resistance in a world's curve.
/// Choice: no case of the ablation reads it.
const LINEAR_PARTS: usize = 8;

/// The world with these effects on its switch.
pub fn with_acts(world: &World, acts: &[Act]) -> World {
    let mut world = world.clone();
    for (id, parameters) in acts {
        put(&mut world, id, parameters);
    }
    world
}

/// Adds an effect to a world.
pub fn put(world: &mut World, id: &str, parameters: &[CauseParameter]) {
    let Some(switch) = &mut world.switch else { return };
    let value = |name: &str| parameters.iter().find(|p| p.name == name).map_or(0.0, |p| p.value);
    match id {
        pad_compliance::ID => {
            let softer = 1.0 / world.pad.stiffness_n_m.max(f64::MIN_POSITIVE) + value("give");
            if softer > 0.0 {
                world.pad.stiffness_n_m = 1.0 / softer;
            }
        }
        viscous_friction::ID => switch.damping_n_s_m += value("c").max(0.0),
        added_constraint::ID => {
            nearer(switch, value("left stop is nearer by").max(0.0), value("right stop is nearer by").max(0.0));
        }
        local_resistance::ID => bind(switch, [value("F"), value("place"), value("width")]),
        _ => shift(&mut switch.curve.points, id, &value),
    }
}

fn shift(points: &mut [CurvePoint], id: &str, value: &dyn Fn(&str) -> f64) {
    match id {
        coulomb_friction::ID => points.iter_mut().for_each(|p| {
            p.forward_n += value("Fc").max(0.0);
            p.backward_n -= value("Fc").max(0.0);
        }),
        friction_asymmetry::ID => points.iter_mut().for_each(|p| {
            // The curve stays above the other branch: a cycle generates no energy.
            p.forward_n = (p.forward_n + value("dFc to the right")).max(p.backward_n);
            p.backward_n = (p.backward_n - value("dFc to the left")).min(p.forward_n);
        }),
        return_spring::ID => points.iter_mut().for_each(|p| {
            let more = value("k") * p.at_m + value("f0");
            p.forward_n += more;
            p.backward_n += more;
        }),
        _ => {}
    }
}

/// Stops that come earlier.
fn nearer(switch: &mut Switch, left_m: f64, right_m: f64) {
    let curve = &mut switch.curve;
    let (Some(first), Some(last)) = (curve.points.first().copied(), curve.points.last().copied()) else { return };
    let (low, high) = (first.at_m + left_m, last.at_m - right_m);
    if low >= high {
        return;
    }
    let end =
        |at_m: f64| CurvePoint { at_m, forward_n: curve.force_n(at_m, 1.0), backward_n: curve.force_n(at_m, 0.0) };
    let (left, right) = (end(low), end(high));
    let within = curve.points.iter().filter(|p| p.at_m > low && p.at_m < high).copied();
    curve.points = std::iter::once(left).chain(within).chain([right]).collect();
    switch.start_m = switch.start_m.clamp(low, high);
}

/// Adds a local resistance in both directions by its law.
fn bind(switch: &mut Switch, [force_n, place_m, width_m]: [f64; 3]) {
    let curve = &mut switch.curve;
    let (Some(first), Some(last)) = (curve.points.first(), curve.points.last()) else { return };
    let law = Effect::new(&LocalResistance, &[force_n.max(0.0), place_m, width_m, 0.0]);
    let more = |at_m: f64| law.force(&Motion { position: at_m, direction: 1.0, velocity: 1.0, ..Motion::default() });
    let (low, high) = (first.at_m, last.at_m);
    let apart_m = 2.0 * width_m / LINEAR_PARTS as f64;
    let mut places: Vec<f64> = (0..=LINEAR_PARTS).map(|k| place_m - width_m + apart_m * k as f64).collect();
    places.retain(|at| *at > low && *at < high && curve.points.iter().all(|p| (p.at_m - at).abs() > 0.1 * apart_m));
    places.extend(curve.points.iter().map(|p| p.at_m));
    places.sort_by(f64::total_cmp);
    let point = |at_m: f64| CurvePoint {
        at_m,
        forward_n: curve.force_n(at_m, 1.0) + more(at_m),
        backward_n: curve.force_n(at_m, 0.0) - more(at_m),
    };
    curve.points = places.into_iter().map(point).collect();
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::contract::parameter;
    use haptics::world::presets;

    fn with(id: &str, values: &[(&str, f64)]) -> World {
        let parameters = values.iter().map(|(name, value)| parameter(name, *value, 0.0, "")).collect();
        let world = with_acts(&presets::switch(), &[(id.to_owned(), parameters)]);
        world.check().expect("it can be stepped");
        world
    }

    #[test]
    fn stops_come_nearer_binds_resist_and_pads_give_more() {
        let before = presets::switch().switch.expect("a switch").curve;
        let stop = with("added-constraint", &[("right stop is nearer by", 1e-3)]).switch.expect("a switch");
        assert!((stop.curve.points[3].at_m - 7e-3).abs() < 1e-12 && (stop.curve.points[0].at_m + 8e-3).abs() < 1e-12);
        let bound =
            with("local-resistance", &[("F", 0.3), ("place", -5e-3), ("width", 2e-3)]).switch.expect("a switch");
        let more = |at: f64, branch: f64| bound.curve.force_n(at, branch) - before.force_n(at, branch);
        assert!(more(-5e-3, 1.0) > 0.2 && more(-5e-3, 0.0) < -0.2 && more(5e-3, 1.0).abs() < 0.01);
        let soft = with("pad-compliance", &[("give", 1e-4)]);
        assert!(soft.pad.stiffness_n_m < presets::switch().pad.stiffness_n_m);
        let rubs = with("coulomb-friction", &[("Fc", 0.2)]).switch.expect("a switch");
        assert!((rubs.curve.force_n(0.0, 1.0) - before.force_n(0.0, 1.0) - 0.2).abs() < 1e-12);
    }
}
