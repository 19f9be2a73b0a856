//! Cranks, switches and mechanisms as one body on one joint.

use super::Fate;
use super::frame::{Vec3, of_plane, of_space, turned, turning};
use super::joint::{Coordinate, Laws, Seen, read, turns};
use super::scene::{Body, Moves, Outline, Scene};
use haptics::law::inertia;
use haptics::world::{Crank, Mechanism, MechanismPath, Switch};

/// Length of an arm without a measured length, m.
const SOME_ARM_M: f64 = 0.1;
/// Minimum share of the inertia in the body itself: every simulator requires some.
const LEAST_SHARE: f64 = 1e-6;

/// Adds a crank: a handle on an arm about a horizontal axis.
pub fn add_crank(crank: &Crank, scene: &mut Scene) {
    let name = scene.free_name("crank");
    let seen = Seen {
        object: &name,
        axis: turning(),
        turns: true,
        arm: crank.radius_m,
        start: crank.start_rad,
        up_along: [1.0, 0.0],
    };
    let laws = read(&crank.effects, &seen, scene);
    let outline =
        Outline::Arm { handle_m: Vec3::x() * crank.radius_m, axis: turning(), radius_m: 0.5 * crank.handle_width_m };
    add_turning(&name, of_plane(crank.center_m), Vec3::x(), crank.radius_m, laws, outline, scene);
    scene.remark(&name, "handle", Fate::Approximate, "a round handle that turns with the arm; ours keeps upright");
    if crank.constraint_stiffness_n_m.is_some() {
        scene.remark(&name, "constraint_stiffness_n_m", Fate::LeftOut, "the arm is rigid");
    }
}

/// Adds a switch: its lever between its stops, with everything but the snap. Its knob moves to the right, which is
/// clockwise.
pub fn add_switch(switch: &Switch, scene: &mut Scene) {
    let (lever_m, points) = (switch.lever_m, &switch.curve.points);
    let name = scene.free_name("switch");
    let ends = [points.first(), points.last()].map(|end| end.map(|point| point.at_m / lever_m));
    let knob_m = Vec3::z() * lever_m;
    scene.bodies.push(Body {
        name: name.clone(),
        origin_m: of_plane(switch.pivot_m),
        mass_kg: switch.mass_kg,
        middle_m: knob_m,
        inertia_kg_m2: LEAST_SHARE * switch.mass_kg * lever_m * lever_m,
        weighs: 1.0,
        moves: Moves::Along(Coordinate {
            turns: true,
            axis: -turning(),
            start: switch.start_m / lever_m,
            damping: switch.damping_n_s_m * lever_m * lever_m,
            dry: dry_n(switch) * lever_m,
            spring: None,
            range: ends,
            stop: Some(switch.curve.stop_n_m * lever_m * lever_m),
        }),
        outline: Outline::Arm { handle_m: knob_m, axis: turning(), radius_m: switch.knob_radius_m },
    });
    scene.remark(&name, "mass, lever, damping", Fate::Kept, "a body on a hinge");
    scene.remark(
        &name,
        "stops",
        Fate::Approximate,
        "at the ends of the captured curve; how hard they are goes to MuJoCo only",
    );
    scene.remark(&name, "friction", Fate::Approximate, "half of what lies between the two ways, the same everywhere");
    let why = "joints have no force that pushes on beyond the middle; it stays where it is put";
    scene.remark(&name, "snap", Fate::LeftOut, why);
}

/// Half the difference between a switch's two branches, N: the mean over the travel between its ends.
fn dry_n(switch: &Switch) -> f64 {
    let half_n = |at_m: f64| 0.5 * (switch.curve.force_n(at_m, 1.0) - switch.curve.force_n(at_m, 0.0));
    // Piecewise linear between the points.
    let pieces = switch.curve.points.windows(2).map(|pair| (pair[0].at_m, pair[1].at_m));
    let (way_m, area) = pieces.fold((0.0, 0.0), |(way_m, area), (from_m, to_m)| {
        let length_m = to_m - from_m;
        (way_m + length_m, area + 0.5 * (half_n(from_m) + half_n(to_m)) * length_m)
    });
    if way_m > 0.0 { (area / way_m).max(0.0) } else { 0.0 }
}

/// Adds a mechanism on its path, or at the origin: a slide along x, a hinge whose zero points down.
pub fn add(mechanism: &Mechanism, scene: &mut Scene) {
    let name = scene.free_name("mechanism");
    if inertia(&mechanism.effects) <= 0.0 {
        scene.remark(&name, "all of it", Fate::LeftOut, "no inertia is known, and bodies need one");
        return;
    }
    let turns = turns(mechanism.coordinate);
    match mechanism.path {
        Some(MechanismPath::Prismatic { origin_m, direction }) => {
            add_slide(mechanism, &name, of_space(origin_m), of_space(direction), scene);
        }
        Some(MechanismPath::Revolute { center_m, axis, radius_m, zero }) => {
            let (axis, zero) = (of_space(axis), of_space(zero));
            add_hinge(mechanism, &name, of_space(center_m), (axis, zero), radius_m, scene);
        }
        None if turns => {
            scene.remark(&name, "place", Fate::Approximate, "about a level axis through the origin, its zero hanging");
            add_hinge(mechanism, &name, Vec3::zeros(), (turning(), -Vec3::z()), SOME_ARM_M, scene);
        }
        None => {
            scene.remark(&name, "place", Fate::Approximate, "along x from the origin: nobody recorded where it lies");
            add_slide(mechanism, &name, Vec3::zeros(), Vec3::x(), scene);
        }
    }
}

fn add_slide(mechanism: &Mechanism, name: &str, origin_m: Vec3, axis: Vec3, scene: &mut Scene) {
    let axis = axis.normalize();
    let up_along = if mechanism.path.is_some() { axis.z } else { 0.0 };
    let seen = Seen { object: name, axis, turns: false, arm: 1.0, start: 0.0, up_along: [up_along; 2] };
    let laws = read(&mechanism.effects, &seen, scene);
    let full = -laws.inertia * scene.gravity.dot(&axis);
    let weighs = if full.abs() > 1e-9 { laws.weight[0] / full } else { 1.0 };
    if full.abs() <= 1e-9 && laws.weight[0].abs() > 1e-9 {
        scene.remark(name, "weight along a level path", Fate::LeftOut, "gravity does not act along it here");
    }
    let half_m = 0.01;
    scene.bodies.push(Body {
        name: name.to_owned(),
        origin_m,
        mass_kg: laws.inertia,
        middle_m: Vec3::zeros(),
        inertia_kg_m2: laws.inertia * half_m * half_m,
        weighs,
        moves: Moves::Along(laws.joint),
        outline: Outline::Mark { at_m: Vec3::zeros() },
    });
}

fn add_hinge(
    mechanism: &Mechanism,
    name: &str,
    center_m: Vec3,
    (axis, zero): (Vec3, Vec3),
    radius_m: f64,
    scene: &mut Scene,
) {
    let (axis, zero) = (axis.normalize(), zero.normalize());
    // Along the path at zero, and a quarter turn further.
    let up_along = if mechanism.path.is_some() { [axis.cross(&zero).z, -zero.z] } else { [0.0; 2] };
    let seen = Seen { object: name, axis, turns: true, arm: 1.0, start: 0.0, up_along };
    let laws = read(&mechanism.effects, &seen, scene);
    let outline = Outline::Mark { at_m: zero * radius_m };
    add_turning(name, center_m, zero, radius_m, laws, outline, scene);
}

/// Adds a body about an axis, with its mass at the position where gravity's moment equals that of the laws.
fn add_turning(name: &str, center_m: Vec3, zero: Vec3, radius_m: f64, laws: Laws, outline: Outline, scene: &mut Scene) {
    let axis = laws.joint.axis;
    let [at_zero, quarter_on] = laws.weight;
    let most = at_zero.hypot(quarter_on);
    // Gravity perpendicular to the axis: its magnitude, and its angle from the zero.
    let (along_zero, along_side) = (scene.gravity.dot(&zero), scene.gravity.dot(&axis.cross(&zero)));
    let across = along_zero.hypot(along_side);
    let moment_kg_m = if across > 1e-9 { most / across } else { 0.0 };
    if moment_kg_m == 0.0 && most > 0.0 {
        scene.remark(name, "weight", Fate::LeftOut, "there is no gravity across the axis");
    }
    // Closer to the axis, the mass must be larger; it is at the handle if the inertia allows.
    let reach_m = if moment_kg_m > 0.0 { radius_m.min(laws.inertia / moment_kg_m) } else { 0.0 };
    let mass_kg = if reach_m > 0.0 { moment_kg_m / reach_m } else { laws.inertia / (radius_m * radius_m) };
    let angle = at_zero.atan2(quarter_on) + along_side.atan2(along_zero);
    scene.bodies.push(Body {
        name: name.to_owned(),
        origin_m: center_m,
        mass_kg,
        middle_m: turned(zero * reach_m, axis, angle),
        inertia_kg_m2: (laws.inertia - mass_kg * reach_m * reach_m).max(LEAST_SHARE * laws.inertia),
        weighs: 1.0,
        moves: Moves::Along(laws.joint),
        outline,
    });
}
