//! MuJoCo's format. A body's joint coordinates are those of this program: x, y and angle of a block, the angle of a
//! crank.
//!
//! MuJoCo parameterizes contacts by acceleration, not force. A stiffness becomes the square of the frequency at which
//! the body bounces on its two corners, and a damper the decay rate of that bounce.

use super::Fate;
use super::frame::{Vec3, of_plane, turned, turning};
use super::joint::Coordinate;
use super::scene::{Body, DEPTH_M, Moves, Outline, Scene, Surface, axis_of};
use super::xml::{Element, numbers};
use haptics::world::World;

/// Time step, s; short enough for the stiffest usual contact.
const STEP_S: f64 = 5e-4;
/// Half the size of an unbounded object, m.
const FAR_M: f64 = 1.0;
/// Fingertip: radius, m, mass, kg, and damping ratio of its spring.
const TIP_RADIUS_M: f64 = 0.003;
const TIP_KG: f64 = 0.05;
const TIP_DAMPING_RATIO: f64 = 0.7;
/// Contact parameters of a tip (MuJoCo's time constant, s, and damping ratio). They are much stiffer than MuJoCo's
/// default: the spring behind the tip is the pad, and a compliant contact in series would take most of the grip away.
const TIP_CONTACT: &str = "0.002 1";
/// Number of MuJoCo's iterations after each step against creep of frictional contacts: a held block would otherwise
/// sink by millimetres per second.
const ROUNDS_AGAINST_CREEP: u32 = 10;
/// Distance of the waiting tips from the workspace's centre, to each side, m.
const TIP_AWAY_M: f64 = 0.03;
/// Torsional and rolling friction of MuJoCo's pairs: its defaults; neither acts in a plane.
const OTHER_FRICTION: &str = "0.005 0.0001 0.0001";

/// Friction parameters of a joint. MuJoCo's dry friction creeps at rest and is rounded at low speed; these values
/// reduce both effects.
const STIFF_FRICTION: &str = "0.002 1";
const FIRM_FRICTION: &str = "0.99 0.999 0.001";
/// Impedance of a stop with known stiffness (see `stop`), and its maximum rotation in a step, rad.
const STOP_SHARE: f64 = 0.01;
const STOP_PER_STEP: f64 = 0.5;

/// The whole document.
pub fn write(world: &World, scene: &mut Scene, fingers: bool) -> Element {
    remark_on_contacts(scene);
    let mut things = vec![
        Element::new("light").with("pos", "0 -1 1").with("dir", "0 1 -1"),
        Element::new("camera").with("name", "front").with("pos", "0 -0.35 -0.08").with("xyaxes", "1 0 0 0 0 1"),
    ];
    things.extend(scene.grounds.iter().map(|ground| {
        Element::new("geom")
            .with("name", ground.name)
            .with("type", "plane")
            .with("size", numbers(&[FAR_M, FAR_M, 0.1]))
            .with("pos", numbers(ground.point_m.as_slice()))
            .with("zaxis", numbers(ground.normal.as_slice()))
            .with("friction", ground.friction)
    }));
    let tendons = cables(world, scene, &mut things);
    things.extend(scene.bodies.iter().map(body));
    let mut pairs = ground_pairs(scene);
    pairs.extend(block_pairs(scene));
    let mut root = Element::new("mujoco")
        .with("model", &scene.name)
        .containing(Element::new("compiler").with("angle", "radian").with("autolimits", true))
        .containing(
            Element::new("option")
                .with("timestep", STEP_S)
                .with("gravity", numbers(scene.gravity.as_slice()))
                .with("cone", "elliptic")
                .with("impratio", 10)
                .with("noslip_iterations", ROUNDS_AGAINST_CREEP),
        );
    let hand = fingers.then(|| hand(world, scene));
    if let Some(hand) = &hand {
        things.extend(hand.bodies.iter().cloned());
        pairs.extend(hand.pairs.iter().cloned());
    }
    root = root.containing(Element::new("worldbody").containing_all(things));
    for (name, parts) in [("contact", pairs), ("tendon", tendons)] {
        if !parts.is_empty() {
            root = root.containing(Element::new(name).containing_all(parts));
        }
    }
    match hand {
        Some(hand) => root
            .containing(Element::new("actuator").containing_all(hand.motors))
            .containing(Element::new("keyframe").containing(hand.start)),
        None => root,
    }
}

/// Frequency and damping of a contact in MuJoCo's form.
fn solref(stiffness_n_m: f64, damping_n_s_m: f64, mass_kg: f64) -> String {
    numbers(&[-2.0 * stiffness_n_m / mass_kg, -2.0 * damping_n_s_m / mass_kg])
}

fn remark_on_contacts(scene: &mut Scene) {
    let touching: Vec<String> = scene.grounds.iter().map(|ground| ground.name.to_owned()).collect();
    for name in touching {
        scene.remark(&name, "friction", Fate::Kept, "of each pair");
        let how = "as frequency and damping of each body that rests on it on two corners";
        scene.remark(&name, "stiffness and damping", Fate::Approximate, how);
    }
}

fn body(of: &Body) -> Element {
    let (start_m, angle_rad) = match &of.moves {
        Moves::InPlane { start_m, angle_rad, .. } => (of.origin_m + of_plane(*start_m), *angle_rad),
        Moves::Along(along) if along.turns => (of.origin_m, along.start),
        Moves::Along(along) => (of.origin_m + along.axis * along.start, 0.0),
    };
    let axis = axis_of(of);
    let mut element = Element::new("body").with("name", &of.name).with("pos", numbers(start_m.as_slice()));
    if angle_rad != 0.0 {
        element = element.with("axisangle", numbers(&[axis.x, axis.y, axis.z, angle_rad]));
    }
    if of.weighs != 1.0 {
        element = element.with("gravcomp", 1.0 - of.weighs);
    }
    element
        .containing_all(joints(of, angle_rad))
        .containing(
            Element::new("inertial")
                .with("pos", numbers(of.middle_m.as_slice()))
                .with("mass", of.mass_kg)
                .with("diaginertia", numbers(&inertias(of))),
        )
        .containing_all(outline(of))
}

/// Moments of inertia about x, y and z, kg m²; only the one about the joint's axis acts.
pub fn inertias(of: &Body) -> [f64; 3] {
    match of.outline {
        Outline::Box { size_m: [width, depth, height], .. } => {
            let about = |a: f64, b: f64| of.mass_kg * (a * a + b * b) / 12.0;
            [about(depth, height), of.inertia_kg_m2, about(width, depth)]
        }
        _ => [of.inertia_kg_m2; 3],
    }
}

fn joints(of: &Body, angle_rad: f64) -> Vec<Element> {
    let named = |suffix: &str| Element::new("joint").with("name", format!("{}{suffix}", of.name));
    match &of.moves {
        Moves::InPlane { start_m, upright, .. } => {
            // Axes are given in the body's own frame, which may start rotated.
            let own = |axis: Vec3| numbers(turned(axis, turning(), -angle_rad).as_slice());
            let slide = |suffix, axis: Vec3, at_m: f64| {
                named(suffix).with("type", "slide").with("axis", own(axis)).with("ref", at_m)
            };
            let mut all = vec![slide("-x", Vec3::x(), start_m.x), slide("-y", Vec3::z(), start_m.y)];
            if !upright {
                let hinge = named("-angle").with("type", "hinge").with("axis", numbers(turning().as_slice()));
                all.push(hinge.with("ref", angle_rad));
            }
            all
        }
        Moves::Along(along) => vec![along_one(named(""), along, inertia_along(of, along))],
    }
}

/// Inertia along one coordinate, kg or kg m².
fn inertia_along(of: &Body, along: &Coordinate) -> f64 {
    if along.turns { of.inertia_kg_m2 + of.mass_kg * of.middle_m.norm_squared() } else { of.mass_kg }
}

/// Joint limit as a spring of known stiffness, damped no more than the joint. A limit's force is the remaining free
/// acceleration plus the share `d` of a spring's pull. The pull is scaled so that `d` cancels; with a small `d` the
/// limit is that spring (error: `STOP_SHARE` of the outer force).
fn stop(joint: Element, stiffness: f64, inertia: f64) -> Element {
    let rate_1_s = (stiffness / inertia).sqrt().min(STOP_PER_STEP / STEP_S);
    joint
        .with("solreflimit", numbers(&[-rate_1_s.powi(2), 0.0]))
        .with("solimplimit", numbers(&[STOP_SHARE, STOP_SHARE, 0.001]))
}

fn along_one(joint: Element, along: &Coordinate, inertia: f64) -> Element {
    let mut joint = joint
        .with("type", if along.turns { "hinge" } else { "slide" })
        .with("axis", numbers(along.axis.as_slice()))
        .with("ref", along.start)
        .with("damping", along.damping)
        .with("frictionloss", along.dry)
        .with("solreffriction", STIFF_FRICTION)
        .with("solimpfriction", FIRM_FRICTION);
    if let Some((stiffness, rest)) = along.spring {
        joint = joint.with("stiffness", stiffness).with("springref", rest);
    }
    if along.range != [None, None] {
        // An open end is out of reach.
        let [low, high] = along.range;
        joint = joint.with("range", numbers(&[low.unwrap_or(-1e3), high.unwrap_or(1e3)]));
        if let Some(stiffness) = along.stop {
            joint = stop(joint, stiffness, inertia);
        }
    }
    joint
}

fn outline(of: &Body) -> Vec<Element> {
    let geom = |kind| Element::new("geom").with("name", &of.name).with("type", kind).with("mass", 0);
    match &of.outline {
        Outline::Box { size_m: [width, depth, height], contact } => vec![
            geom("box")
                .with("size", numbers(&[0.5 * width, 0.5 * depth, 0.5 * height]))
                .with("friction", contact.friction)
                .with("solref", solref(0.5 * contact.stiffness_n_m, 0.5 * contact.damping_n_s_m, 0.5 * of.mass_kg)),
            Element::new("site").with("name", format!("{}-middle", of.name)),
        ],
        Outline::Arm { handle_m, axis, radius_m } => {
            let (from, to) = (handle_m - axis * (0.5 * DEPTH_M), handle_m + axis * (0.5 * DEPTH_M));
            let ends = [from.x, from.y, from.z, to.x, to.y, to.z];
            let arm = [axis.x * DEPTH_M, axis.y * DEPTH_M, axis.z * DEPTH_M];
            let bar = [arm[0], arm[1], arm[2], handle_m.x + arm[0], handle_m.y + arm[1], handle_m.z + arm[2]];
            vec![
                geom("cylinder").with("fromto", numbers(&ends)).with("size", *radius_m),
                Element::new("geom")
                    .with("type", "capsule")
                    .with("fromto", numbers(&bar))
                    .with("size", 0.3 * radius_m)
                    .with("mass", 0)
                    .with("contype", 0)
                    .with("conaffinity", 0),
                Element::new("site")
                    .with("name", format!("{}-handle", of.name))
                    .with("pos", numbers(handle_m.as_slice())),
            ]
        }
        Outline::Mark { at_m } => vec![
            geom("sphere").with("size", 0.005).with("pos", numbers(at_m.as_slice())),
            Element::new("site").with("name", format!("{}-tool", of.name)).with("pos", numbers(at_m.as_slice())),
        ],
    }
}

/// Blocks of a scene with their surfaces.
fn blocks(scene: &Scene) -> impl Iterator<Item = (&Body, &Surface)> {
    scene.bodies.iter().filter_map(|body| match &body.outline {
        Outline::Box { contact, .. } => Some((body, contact)),
        _ => None,
    })
}

fn pair(a: &str, b: &str, friction: f64) -> Element {
    Element::new("pair")
        .with("geom1", a)
        .with("geom2", b)
        .with("friction", format!("{friction} {friction} {OTHER_FRICTION}"))
}

/// Friction and compliance of the ground under each block: MuJoCo would take the larger friction of the two.
fn ground_pairs(scene: &Scene) -> Vec<Element> {
    let on = |(body, _): (&Body, &Surface)| {
        let of = scene.grounds.iter().map(|ground| {
            let give = solref(ground.stiffness_n_m, ground.damping_n_s_m, body.mass_kg);
            pair(ground.name, &body.name, ground.friction).with("solref", give)
        });
        of.collect::<Vec<_>>()
    };
    blocks(scene).flat_map(on).collect()
}

/// Contact pairs of blocks with different friction, by its geometric mean.
fn block_pairs(scene: &Scene) -> Vec<Element> {
    let all: Vec<(&Body, &Surface)> = blocks(scene).collect();
    let with = |index: usize| {
        let (body, one) = all[index];
        let others = all[index + 1..].iter().filter(move |(_, other)| other.friction != one.friction);
        others.map(move |(other, two)| pair(&body.name, &other.name, (one.friction * two.friction).sqrt()))
    };
    (0..all.len()).flat_map(with).collect()
}

/// Cables and their anchors.
fn cables(world: &World, scene: &mut Scene, things: &mut Vec<Element>) -> Vec<Element> {
    let tied = world.blocks.iter().enumerate().filter_map(|(index, block)| Some((index, block.cable?)));
    let mut tendons = Vec::new();
    for (index, cable) in tied {
        let name = scene.bodies[index].name.clone();
        things.push(
            Element::new("site")
                .with("name", format!("{name}-anchor"))
                .with("pos", numbers(of_plane(cable.anchor_m).as_slice())),
        );
        scene.remark(&name, "cable", Fate::Approximate, "a tendon that brakes while it is slack, too");
        tendons.push(
            Element::new("spatial")
                .with("name", format!("{name}-cable"))
                .with("springlength", numbers(&[0.0, cable.length_m]))
                .with("stiffness", cable.stiffness_n_m)
                .with("damping", cable.damping_n_s_m)
                .containing(Element::new("site").with("site", format!("{name}-anchor")))
                .containing(Element::new("site").with("site", format!("{name}-middle"))),
        );
    }
    tendons
}

/// Two fingertips.
struct Hand {
    bodies: Vec<Element>,
    pairs: Vec<Element>,
    motors: Vec<Element>,
    start: Element,
}

/// Fingertips on springs as stiff as the pads; a motor's control is the desired tip position, m.
fn hand(world: &World, scene: &mut Scene) -> Hand {
    let (pad, middle) = (&world.pad, world.hand.workspace.center_m);
    let how = "each tip a ball on springs as stiff as the pad, of a mass of its own; lead it by its motors, in m";
    scene.remark("pad", "stiffness and damping", Fate::Approximate, how);
    if pad.cubic_n_m3 > 0.0 || pad.hertz_n_m15 > 0.0 {
        scene.remark("pad", "stiffness-hardening", Fate::LeftOut, "motors' springs are straight lines");
    }
    if pad.face_m > 0.0 {
        scene.remark("pad", "face", Fate::LeftOut, "the tips are balls");
    }
    let mut hand = Hand { bodies: Vec::new(), pairs: Vec::new(), motors: Vec::new(), start: Element::new("key") };
    let mut controls = Vec::new();
    for (name, side) in [("finger-1", -1.0), ("finger-2", 1.0)] {
        let tip_m = [middle.x + side * TIP_AWAY_M, middle.y];
        controls.extend(tip_m);
        let axes = [("-x", "1 0 0", tip_m[0], pad.stiffness_n_m), ("-y", "0 0 1", tip_m[1], pad.shear_stiffness_n_m)];
        let joints = axes.map(|(suffix, axis, at_m, stiffness)| {
            let joint = Element::new("joint").with("name", format!("{name}{suffix}")).with("type", "slide");
            let damping = 2.0 * TIP_DAMPING_RATIO * (stiffness * TIP_KG).sqrt();
            joint.with("axis", axis).with("ref", at_m).with("damping", damping)
        });
        hand.motors.extend(axes.map(|(suffix, _, _, stiffness)| {
            let motor = Element::new("position").with("name", format!("{name}{suffix}"));
            motor.with("joint", format!("{name}{suffix}")).with("kp", stiffness)
        }));
        let ball = Element::new("geom").with("name", name).with("type", "sphere").with("size", TIP_RADIUS_M);
        let body = Element::new("body").with("name", name).with("pos", numbers(&[tip_m[0], 0.0, tip_m[1]]));
        hand.bodies.push(body.with("gravcomp", 1).containing_all(joints).containing(
            // The tip is its surface, not its centre.
            ball.with("pos", numbers(&[side * TIP_RADIUS_M, 0.0, 0.0])).with("mass", TIP_KG),
        ));
        let touch = |what: &str, friction: f64| pair(name, what, friction).with("solref", TIP_CONTACT);
        hand.pairs.extend(blocks(scene).map(|(body, contact)| touch(&body.name, contact.finger_friction)));
        // A crank comes before a switch, as in the scene.
        let arms = scene.bodies.iter().filter(|body| matches!(body.outline, Outline::Arm { .. }));
        let crank = world.crank.as_ref().map(|crank| crank.finger_friction);
        let switch = world.switch.as_ref().map(|switch| switch.finger_friction);
        let frictions = crank.into_iter().chain(switch);
        hand.pairs.extend(arms.zip(frictions).map(|(body, friction)| touch(&body.name, friction)));
    }
    hand.pairs.push(Element::new("exclude").with("body1", "finger-1").with("body2", "finger-2"));
    hand.start = Element::new("key").with("name", "start").with("ctrl", numbers(&controls));
    hand
}
