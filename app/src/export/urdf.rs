//! URDF: links and joints, without gravity, friction of surfaces, springs, or a start other than zero.

use super::Fate;
use super::frame::{Vec3, of_plane, turning};
use super::joint::Coordinate;
use super::mjcf::inertias;
use super::scene::{Body, DEPTH_M, Ground, Moves, Outline, Scene, axis_of};
use super::xml::{Element, numbers};
use haptics::world::World;

/// Limits required by the format where none is known: N or N m, m/s or rad/s, m.
const NO_LIMIT: f64 = 1e3;
/// Size of the ground, m.
const GROUND_M: f64 = 2.0;

/// The whole document.
pub fn write(world: &World, scene: &mut Scene) -> Element {
    without_cables(world, scene);
    remarks(scene);
    let ground = scene.grounds.iter().flat_map(ground);
    let bodies = scene.bodies.iter().flat_map(|body| [link(body), joint(body)]);
    Element::new("robot")
        .with("name", &scene.name)
        .containing(Element::new("link").with("name", "world"))
        .containing_all(ground)
        .containing_all(bodies)
}

/// Remarks that cables are omitted: neither URDF nor SDF has them.
pub fn without_cables(world: &World, scene: &mut Scene) {
    for index in (0..world.blocks.len()).filter(|index| world.blocks[*index].cable.is_some()) {
        let name = scene.bodies[index].name.clone();
        scene.remark(&name, "cable", Fate::LeftOut, "the format has no cables");
    }
}

fn remarks(scene: &mut Scene) {
    let gravity =
        format!("{} m/s², which the program that reads the file must be told", numbers(scene.gravity.as_slice()));
    scene.remark("world", "gravity", Fate::LeftOut, gravity);
    for name in scene.grounds.iter().map(|ground| ground.name).collect::<Vec<_>>() {
        scene.remark(
            name,
            "friction, stiffness and damping",
            Fate::LeftOut,
            "surfaces have a shape here and nothing else",
        );
    }
    let mut all = Vec::new();
    for body in &scene.bodies {
        let name = body.name.clone();
        match &body.moves {
            Moves::InPlane { upright, .. } => {
                all.push((
                    name.clone(),
                    "friction, stiffness and damping",
                    Fate::LeftOut,
                    "surfaces have a shape only",
                ));
                if *upright {
                    all.push((name, "keeps upright", Fate::LeftOut, "a planar joint turns, too"));
                }
            }
            Moves::Along(along) => {
                if along.start != 0.0 {
                    all.push((name.clone(), "start", Fate::Approximate, "the joint's zero is where the world starts"));
                }
                if along.spring.is_some() {
                    all.push((name.clone(), "return-spring", Fate::LeftOut, "joints have no springs here"));
                }
                if !along.turns && along.range.contains(&None) {
                    all.push((
                        name.clone(),
                        "range",
                        Fate::Approximate,
                        "the format wants ends; 1000 m stands for none",
                    ));
                }
                if body.weighs != 1.0 {
                    all.push((
                        name,
                        "weight",
                        Fate::Approximate,
                        "all of the moving mass weighs; in the world, some of it",
                    ));
                }
            }
        }
    }
    for (object, what, fate, how) in all {
        // General remarks of the laws on joints do not apply to this format.
        scene.remarks.retain(|r| !(r.object == object && r.what == what && r.fate != fate));
        scene.remark(&object, what, fate, how);
    }
}

fn origin(at_m: Vec3) -> Element {
    Element::new("origin").with("xyz", numbers(at_m.as_slice()))
}

fn turned_origin(at_m: Vec3, axis: Vec3, angle_rad: f64) -> Element {
    origin(at_m).with("rpy", numbers(&roll_pitch_yaw(axis, angle_rad)))
}

/// Rotation about an axis as the angles of both formats, rad.
pub fn roll_pitch_yaw(axis: Vec3, angle_rad: f64) -> [f64; 3] {
    let axis = nalgebra::Unit::new_normalize(axis);
    let (roll, pitch, yaw) = nalgebra::Rotation3::from_axis_angle(&axis, angle_rad).euler_angles();
    [roll, pitch, yaw]
}

/// Rotation of z to a direction of the plane: a horizontal surface then faces there.
pub fn facing(normal: Vec3) -> [f64; 3] {
    roll_pitch_yaw(Vec3::y(), normal.x.atan2(normal.z))
}

fn ground(of: &Ground) -> [Element; 2] {
    let thickness_m = 0.1;
    let middle = of.point_m - of.normal * (0.5 * thickness_m);
    let shape = || {
        let size = numbers(&[GROUND_M, GROUND_M, thickness_m]);
        Element::new("geometry").containing(Element::new("box").with("size", size))
    };
    let place = Element::new("origin").with("xyz", numbers(middle.as_slice())).with("rpy", numbers(&facing(of.normal)));
    let link = Element::new("link")
        .with("name", of.name)
        .containing(Element::new("visual").containing(shape()))
        .containing(Element::new("collision").containing(shape()));
    [link, joint_of(of.name, "fixed").containing(place)]
}

fn joint_of(name: &str, kind: &str) -> Element {
    Element::new("joint")
        .with("name", format!("{name}-joint"))
        .with("type", kind)
        .containing(Element::new("parent").with("link", "world"))
        .containing(Element::new("child").with("link", name))
}

fn link(of: &Body) -> Element {
    let [ixx, iyy, izz] = inertias(of);
    let inertia = [("ixx", ixx), ("ixy", 0.0), ("ixz", 0.0), ("iyy", iyy), ("iyz", 0.0), ("izz", izz)];
    let inertia = inertia.into_iter().fold(Element::new("inertia"), |element, (name, value)| element.with(name, value));
    let inertial = Element::new("inertial")
        .containing(origin(of.middle_m))
        .containing(Element::new("mass").with("value", of.mass_kg))
        .containing(inertia);
    let (place, shape) = shape(&of.outline);
    let geometry = || Element::new("geometry").containing(shape.clone());
    Element::new("link")
        .with("name", &of.name)
        .containing(inertial)
        .containing(Element::new("visual").containing(place.clone()).containing(geometry()))
        .containing(Element::new("collision").containing(place).containing(geometry()))
}

fn shape(outline: &Outline) -> (Element, Element) {
    match outline {
        Outline::Box { size_m, .. } => (origin(Vec3::zeros()), Element::new("box").with("size", numbers(size_m))),
        Outline::Arm { handle_m, radius_m, .. } => {
            let lying = turned_origin(*handle_m, Vec3::x(), std::f64::consts::FRAC_PI_2);
            (lying, Element::new("cylinder").with("radius", *radius_m).with("length", DEPTH_M))
        }
        Outline::Mark { at_m } => (origin(*at_m), Element::new("sphere").with("radius", 0.005)),
    }
}

fn joint(of: &Body) -> Element {
    let axis = Element::new("axis").with("xyz", numbers(axis_of(of).as_slice()));
    match &of.moves {
        Moves::InPlane { start_m, angle_rad, .. } => joint_of(&of.name, "planar")
            .containing(turned_origin(of.origin_m + of_plane(*start_m), turning(), *angle_rad))
            .containing(axis)
            .containing(limit([-NO_LIMIT, NO_LIMIT])),
        Moves::Along(along) => {
            let free = along.turns && along.range == [None, None];
            let kind = if free {
                "continuous"
            } else if along.turns {
                "revolute"
            } else {
                "prismatic"
            };
            let place = if along.turns {
                turned_origin(of.origin_m, along.axis, along.start)
            } else {
                origin(of.origin_m + along.axis * along.start)
            };
            let dynamics = Element::new("dynamics").with("damping", along.damping).with("friction", along.dry);
            let joint = joint_of(&of.name, kind).containing(place).containing(axis).containing(dynamics);
            if free { joint } else { joint.containing(limit(reach(along))) }
        }
    }
}

/// Limits relative to the world's initial position.
pub fn reach(along: &Coordinate) -> [f64; 2] {
    let [low, high] = along.range.map(|end| end.map(|place| place - along.start));
    [low.unwrap_or(-NO_LIMIT), high.unwrap_or(NO_LIMIT)]
}

fn limit([lower, upper]: [f64; 2]) -> Element {
    let limit = Element::new("limit").with("lower", lower).with("upper", upper);
    limit.with("effort", NO_LIMIT).with("velocity", NO_LIMIT)
}
