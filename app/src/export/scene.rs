//! Rigid bodies on joints from a world, in the frame of other simulators.

use super::frame::{Vec3, of_plane, turning};
use super::joint::Coordinate;
use super::{Fate, Remark, mechanism, xml};
use haptics::Vec2;
use haptics::world::{Block, Shape, World};

/// Depth of blocks, m: they have none here, but other simulators require one.
pub const DEPTH_M: f64 = 0.02;

/// Exportable content of a world.
pub struct Scene {
    /// Name for the file.
    pub name: String,
    /// Gravity, m/s².
    pub gravity: Vec3,
    /// Movable bodies.
    pub bodies: Vec<Body>,
    /// Fixed surfaces.
    pub grounds: Vec<Ground>,
    /// Remarks on the parts.
    pub remarks: Vec<Remark>,
}

/// Half-space that supports bodies.
pub struct Ground {
    /// `floor` or `plane`.
    pub name: &'static str,
    /// A point of the surface, m.
    pub point_m: Vec3,
    /// Outward unit normal.
    pub normal: Vec3,
    /// Coulomb coefficient.
    pub friction: f64,
    /// Stiffness per contact point, N/m.
    pub stiffness_n_m: f64,
    /// Damping per contact point, N s/m.
    pub damping_n_s_m: f64,
}

/// Rigid body; its own frame is parallel to the world's where its coordinates are zero.
pub struct Body {
    /// Unique name in the file.
    pub name: String,
    /// Origin of its frame where its coordinates are zero, m.
    pub origin_m: Vec3,
    /// Mass, kg.
    pub mass_kg: f64,
    /// Centre of mass in its own frame, m.
    pub middle_m: Vec3,
    /// Moment of inertia about the centre of mass, about the joint's axis, kg m².
    pub inertia_kg_m2: f64,
    /// Factor on gravity for this body; only MJCF supports values other than 1.
    pub weighs: f64,
    /// Motion of the body.
    pub moves: Moves,
    /// Shape of the body.
    pub outline: Outline,
}

/// Motion of a body.
pub enum Moves {
    /// Freely in the plane: two lengths and, unless it keeps upright, an angle about [`turning`].
    InPlane {
        /// Centre at the start, m in the plane.
        start_m: Vec2,
        /// Angle at the start, rad.
        angle_rad: f64,
        /// True if its angle is fixed.
        upright: bool,
    },
    /// Along one coordinate.
    Along(Coordinate),
}

/// Shape of a body.
pub enum Outline {
    /// A box of a width, a depth and a height, m.
    Box {
        /// Sizes, m.
        size_m: [f64; 3],
        /// Contact with the ground and other blocks.
        contact: Surface,
    },
    /// An arm from the axis to a handle, a cylinder along the axis.
    Arm {
        /// Middle of the handle in the body's frame, m.
        handle_m: Vec3,
        /// Direction of the handle.
        axis: Vec3,
        /// Radius of the handle, m.
        radius_m: f64,
    },
    /// Ball, for an object without a shape in the world, m.
    Mark {
        /// Its middle in the body's frame, m.
        at_m: Vec3,
    },
}

/// Contact properties of a body.
#[derive(Clone, Copy)]
pub struct Surface {
    /// Coulomb coefficient with other blocks.
    pub friction: f64,
    /// Coulomb coefficient with fingers.
    pub finger_friction: f64,
    /// Stiffness per contact point, N/m.
    pub stiffness_n_m: f64,
    /// Damping per contact point, N s/m.
    pub damping_n_s_m: f64,
}

impl Scene {
    /// Adds a remark on a part.
    pub fn remark(&mut self, object: &str, what: &str, fate: Fate, how: impl Into<String>) {
        self.remarks.push(Remark { object: object.to_owned(), what: what.to_owned(), fate, how: how.into() });
    }

    /// Unique name for a body.
    pub fn free_name(&self, wanted: &str) -> String {
        let taken: Vec<String> = self.bodies.iter().map(|body| body.name.clone()).collect();
        xml::name(wanted, &taken)
    }
}

/// The scene of a world.
pub fn of_world(world: &World) -> Scene {
    let mut scene = Scene {
        name: xml::name(&world.name, &[]),
        gravity: of_plane(world.gravity_vector()),
        bodies: Vec::new(),
        grounds: Vec::new(),
        remarks: Vec::new(),
    };
    grounds(world, &mut scene);
    for block in &world.blocks {
        add_block(block, &mut scene);
    }
    if let Some(crank) = &world.crank {
        mechanism::add_crank(crank, &mut scene);
    }
    if let Some(found) = &world.mechanism {
        mechanism::add(found, &mut scene);
    }
    if world.membrane.is_some() {
        scene.remark("membrane", "all of it", Fate::LeftOut, "a sheet that gives and breaks is no body on a joint");
    }
    if let Some(switch) = &world.switch {
        mechanism::add_switch(switch, &mut scene);
    }
    if world.pad.slip.is_some() {
        scene.remark("pad", "fingertip-slip", Fate::LeftOut, "slips happen here when friction says so");
    }
    scene
}

fn grounds(world: &World, scene: &mut Scene) {
    if let Some(floor) = &world.floor {
        scene.grounds.push(Ground {
            name: "floor",
            point_m: Vec3::new(0.0, 0.0, floor.height_m),
            normal: Vec3::z(),
            friction: floor.loss.map_or(floor.friction, |loss| loss.mu),
            stiffness_n_m: floor.stiffness_n_m,
            damping_n_s_m: if floor.loss.is_some() { 0.0 } else { floor.damping_n_s_m },
        });
        if floor.loss.is_some() {
            scene.remark("floor", "velocity-loss", Fate::LeftOut, "no restitution that is the same for every mass");
        }
    }
    if let Some(plane) = &world.plane {
        scene.grounds.push(Ground {
            name: "plane",
            point_m: of_plane(plane.point_m),
            normal: of_plane(plane.normal()),
            friction: plane.friction,
            stiffness_n_m: plane.stiffness_n_m,
            damping_n_s_m: plane.damping_n_s_m,
        });
    }
}

fn add_block(block: &Block, scene: &mut Scene) {
    let (width, height) = (block.width_m, block.height_m);
    let name = scene.free_name(&block.name);
    scene.bodies.push(Body {
        origin_m: Vec3::zeros(),
        mass_kg: block.mass_kg,
        middle_m: Vec3::zeros(),
        inertia_kg_m2: block.mass_kg * (width * width + height * height) / 12.0,
        weighs: 1.0,
        moves: Moves::InPlane {
            start_m: block.start.center_m,
            angle_rad: block.start.angle_rad,
            upright: block.keeps_upright(),
        },
        outline: Outline::Box {
            size_m: [width, DEPTH_M, height],
            contact: Surface {
                friction: block.block_friction,
                finger_friction: block.finger_friction,
                stiffness_n_m: block.stiffness_n_m,
                damping_n_s_m: block.damping_n_s_m,
            },
        },
        name: name.clone(),
    });
    let depth = format!("{} mm, taken for granted: this world is flat", DEPTH_M * 1e3);
    scene.remark(&name, "depth", Fate::Approximate, depth);
    scene.remark(&name, "mass, width, height, start", Fate::Kept, "the body's own");
    let mut lost = |there: bool, what: &str, why: &str| {
        if there {
            scene.remark(&name, what, Fate::LeftOut, why);
        }
    };
    lost(block.wall.is_some(), "wall", "bodies are rigid; there is no wall that gives and breaks");
    lost(block.content.is_some_and(|c| c.leak_kg_s > 0.0), "content", "masses do not change; it stays full");
    lost(block.guide.is_some(), "guide", "joints are lines and circles, not curves");
    lost(block.shape == Shape::Needle, "point", "it is a box here, without a point that pierces");
}

/// Axis of a body's only or last rotational coordinate.
pub fn axis_of(body: &Body) -> Vec3 {
    match &body.moves {
        Moves::InPlane { .. } => turning(),
        Moves::Along(coordinate) => coordinate.axis,
    }
}
