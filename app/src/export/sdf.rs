//! SDF for Gazebo: a world of models, with gravity, friction and compliance of surfaces, springs of joints.

use super::Fate;
use super::frame::{Vec3, of_plane, turning};
use super::joint::Coordinate;
use super::mjcf::inertias;
use super::scene::{Body, DEPTH_M, Ground, Moves, Outline, Scene, Surface};
use super::urdf::{facing, reach, roll_pitch_yaw, without_cables};
use super::xml::{Element, numbers};
use haptics::world::World;

/// Step of the simulation, s.
const STEP_S: f64 = 5e-4;

/// The whole document.
pub fn write(world: &World, scene: &mut Scene) -> Element {
    without_cables(world, scene);
    remarks(scene);
    let physics = Element::new("physics")
        .with("name", "steps")
        .with("type", "ode")
        .containing(Element::text("max_step_size", STEP_S))
        .containing(Element::text("real_time_factor", 1));
    let world = Element::new("world")
        .with("name", &scene.name)
        .containing(physics)
        .containing(Element::text("gravity", numbers(scene.gravity.as_slice())))
        .containing_all(scene.grounds.iter().map(ground))
        .containing_all(scene.bodies.iter().map(model));
    Element::new("sdf").with("version", "1.9").containing(world)
}

fn remarks(scene: &mut Scene) {
    let names: Vec<&str> = scene.grounds.iter().map(|ground| ground.name).collect();
    for name in names {
        let how = "friction, kp and kd of the surface; which surface's count, the program decides";
        scene.remark(name, "friction, stiffness and damping", Fate::Approximate, how);
    }
    let mut all = Vec::new();
    for body in &scene.bodies {
        match &body.moves {
            Moves::InPlane { .. } => {
                all.push((
                    body.name.clone(),
                    "plane",
                    Fate::LeftOut,
                    "nothing holds it in the plane: it is free in space",
                ));
            }
            Moves::Along(along) => {
                if along.start != 0.0 {
                    let how = "the joint's zero is where the world starts";
                    all.push((body.name.clone(), "start", Fate::Approximate, how));
                }
                if body.weighs != 1.0 && body.weighs != 0.0 {
                    let how = "all of the moving mass weighs; in the world, some of it";
                    all.push((body.name.clone(), "weight", Fate::Approximate, how));
                }
            }
        }
    }
    for (object, what, fate, how) in all {
        scene.remarks.retain(|r| !(r.object == object && r.what == what));
        scene.remark(&object, what, fate, how);
    }
}

fn pose(at_m: Vec3, turn: [f64; 3]) -> Element {
    Element::text("pose", format!("{} {}", numbers(at_m.as_slice()), numbers(&turn)))
}

fn surface(friction: f64, stiffness_n_m: f64, damping_n_s_m: f64) -> Element {
    let friction =
        Element::new("ode").containing(Element::text("mu", friction)).containing(Element::text("mu2", friction));
    let give = Element::new("ode")
        .containing(Element::text("kp", stiffness_n_m))
        .containing(Element::text("kd", damping_n_s_m));
    Element::new("surface")
        .containing(Element::new("friction").containing(friction))
        .containing(Element::new("contact").containing(give))
}

fn ground(of: &Ground) -> Element {
    let plane = || {
        let plane = Element::new("plane").containing(Element::text("normal", "0 0 1"));
        Element::new("geometry").containing(plane.containing(Element::text("size", "2 2")))
    };
    let link = Element::new("link")
        .with("name", "link")
        .containing(Element::new("collision").with("name", "collision").containing(plane()).containing(surface(
            of.friction,
            of.stiffness_n_m,
            of.damping_n_s_m,
        )))
        .containing(Element::new("visual").with("name", "visual").containing(plane()));
    Element::new("model")
        .with("name", of.name)
        .containing(Element::text("static", true))
        .containing(pose(of.point_m, facing(of.normal)))
        .containing(link)
}

fn model(of: &Body) -> Element {
    let (at_m, turn) = match &of.moves {
        Moves::InPlane { start_m, angle_rad, .. } => {
            (of.origin_m + of_plane(*start_m), roll_pitch_yaw(turning(), *angle_rad))
        }
        Moves::Along(along) if along.turns => (of.origin_m, roll_pitch_yaw(along.axis, along.start)),
        Moves::Along(along) => (of.origin_m + along.axis * along.start, [0.0; 3]),
    };
    let model = Element::new("model").with("name", &of.name).containing(pose(at_m, turn)).containing(link(of));
    match &of.moves {
        Moves::InPlane { .. } => model,
        Moves::Along(along) => model.containing(joint(along)),
    }
}

fn link(of: &Body) -> Element {
    let [ixx, iyy, izz] = inertias(of);
    let inertia = [("ixx", ixx), ("iyy", iyy), ("izz", izz), ("ixy", 0.0), ("ixz", 0.0), ("iyz", 0.0)];
    let inertia = Element::new("inertia").containing_all(inertia.map(|(name, value)| Element::text(name, value)));
    let inertial = Element::new("inertial")
        .containing(pose(of.middle_m, [0.0; 3]))
        .containing(Element::text("mass", of.mass_kg))
        .containing(inertia);
    let (place, shape, contact) = shape(&of.outline);
    let geometry = || Element::new("geometry").containing(shape.clone());
    let touch = contact.map(|c| surface(c.friction, c.stiffness_n_m, c.damping_n_s_m));
    let collision = Element::new("collision").with("name", "collision").containing(place.clone());
    let mut link = Element::new("link").with("name", "link").containing(inertial);
    if of.weighs == 0.0 {
        link = link.containing(Element::text("gravity", false));
    }
    link.containing(collision.containing(geometry()).containing_all(touch))
        .containing(Element::new("visual").with("name", "visual").containing(place).containing(geometry()))
}

fn shape(outline: &Outline) -> (Element, Element, Option<Surface>) {
    match outline {
        Outline::Box { size_m, contact } => {
            let size = Element::text("size", numbers(size_m));
            (pose(Vec3::zeros(), [0.0; 3]), Element::new("box").containing(size), Some(*contact))
        }
        Outline::Arm { handle_m, radius_m, .. } => {
            let lying = pose(*handle_m, roll_pitch_yaw(Vec3::x(), std::f64::consts::FRAC_PI_2));
            let radius = Element::text("radius", radius_m);
            let shape = Element::new("cylinder").containing(radius).containing(Element::text("length", DEPTH_M));
            (lying, shape, None)
        }
        Outline::Mark { at_m } => {
            let shape = Element::new("sphere").containing(Element::text("radius", 0.005));
            (pose(*at_m, [0.0; 3]), shape, None)
        }
    }
}

fn joint(along: &Coordinate) -> Element {
    let [lower, upper] = reach(along);
    let mut dynamics = Element::new("dynamics")
        .containing(Element::text("damping", along.damping))
        .containing(Element::text("friction", along.dry));
    if let Some((stiffness, rest)) = along.spring {
        dynamics = dynamics
            .containing(Element::text("spring_reference", rest - along.start))
            .containing(Element::text("spring_stiffness", stiffness));
    }
    let mut axis = Element::new("axis").containing(Element::text("xyz", numbers(along.axis.as_slice())));
    if along.range != [None, None] {
        let limit = Element::new("limit").containing(Element::text("lower", lower));
        axis = axis.containing(limit.containing(Element::text("upper", upper)));
    }
    let kind = if along.turns { "revolute" } else { "prismatic" };
    Element::new("joint")
        .with("name", "joint")
        .with("type", kind)
        .containing(Element::text("parent", "world"))
        .containing(Element::text("child", "link"))
        .containing(axis.containing(dynamics))
}
