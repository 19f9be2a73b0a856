//! Everything that the renderer can show, one picture each: for the gallery and for the tests of pictures.

mod tasks;

use haptics::Vec2;
use haptics::world::{Block, Contact, Crank, Floor, State, Surface, World};
use render::{Camera, ColorRole, ConstraintMarker, FingerStyle, ForceVector, SolidRef, Trajectory, ViewOptions};

/// One picture.
pub struct Plate {
    pub name: &'static str,
    pub world: World,
    pub state: State,
    pub options: ViewOptions,
}

/// All of them.
pub fn plates() -> Vec<Plate> {
    let mut plates = vec![stack(), grasp(), saturated(), crank(), ghost(), tool(), insertion(), touched(), guided()];
    for (name, camera) in [("close", Camera::workspace()), ("front", Camera::front())] {
        let mut plate = grasp();
        plate.name = name;
        plate.options.camera = camera;
        plates.push(plate);
    }
    plates.extend(tasks::plates());
    plates
}

fn blocks() -> World {
    let mut world = World::empty("Stack");
    let floor = Floor::default().height_m;
    world.blocks = vec![
        Block::upright("block-1", 0.035, 0.0159, 0.0160, -0.012, floor + 0.0127),
        Block::upright("block-2", 0.0445, 0.0254, 0.0127, -0.012, floor),
        Block::upright("block-3", 0.03, 0.014, 0.02, 0.026, floor),
    ];
    world
}

fn stack() -> Plate {
    let world = blocks();
    let mut state = State::resting(&world);
    state.input.tip_in_world = [Vec2::new(-0.030, -0.098), Vec2::new(0.008, -0.094)];
    Plate { name: "stack", world, state, options: ViewOptions::default() }
}

/// Block 1 carried above the table, tilted by a hair, squeezed by 2 N.
fn grasp() -> Plate {
    let world = blocks();
    let mut state = State::resting(&world);
    let center = Vec2::new(0.0, -0.088);
    hold(&mut state, 0, center, 0.0159, 1.8, 0.17);
    let options = ViewOptions { show_contacts: true, ..ViewOptions::default() };
    Plate { name: "grasp", world, state, options }
}

/// Puts the fingers to both sides of a block.
fn hold(state: &mut State, block: usize, center: Vec2, width: f64, squeeze: f64, lift: f64) {
    state.bodies[block].center_m = center;
    let depth = 0.0007;
    for (finger, side) in [(0_u8, -1.0), (1, 1.0)] {
        let tip = center + Vec2::new(side * (0.5 * width - depth), 0.0);
        state.input.tip_in_world[usize::from(finger)] = tip;
        state.tip_force_n[usize::from(finger)] = Vec2::new(-side * squeeze, lift);
        state.contacts.push(Contact {
            on: Surface::Block(block as u16),
            by: Surface::Finger(finger),
            feature: 0,
            point_m: tip,
            normal: Vec2::new(-side, 0.0),
            depth_m: depth,
            shear_m: 0.0,
            met_m_s: 0.0,
            normal_force_n: squeeze,
            tangent_force_n: lift,
            sliding: false,
        });
    }
}

fn saturated() -> Plate {
    let mut plate = grasp();
    plate.name = "saturated";
    plate.state.bodies[0].angle_rad = 0.15;
    plate.state.tip_force_n = [Vec2::new(3.2, 1.6), Vec2::new(-3.0, -0.4)];
    plate.options.saturated = [true, false];
    plate.options.highlight = Some(SolidRef::Block(1));
    plate
}

fn crank() -> Plate {
    let mut world = World::empty("Crank");
    let center = Vec2::new(0.0, -0.090);
    let radius = 0.024;
    world.crank = Some(Crank {
        center_m: center,
        radius_m: radius,
        handle_width_m: 0.010,
        finger_friction: 1.0,
        constraint_stiffness_n_m: None,
        effects: Vec::new(),
        start_rad: 0.7,
    });
    let mut state = State::resting(&world);
    let handle = state.handle_in_world(&world).unwrap_or(center);
    state.input.tip_in_world = [handle - Vec2::new(0.005, 0.0), handle + Vec2::new(0.005, 0.0)];
    state.tip_force_n = [Vec2::new(0.9, 0.4), Vec2::new(-0.6, 0.3)];
    let path: Vec<Vec2> = (0..240)
        .map(|i| {
            let turn = 0.7 + 4.6 * f64::from(i) / 239.0;
            let wobble = 1.0 + 0.012 * (9.0 * turn).sin();
            center + radius * wobble * Vec2::new(turn.cos(), turn.sin())
        })
        .collect();
    let force_vectors = path.iter().step_by(10).map(|at| {
        let outwards = (at - center) / radius;
        ForceVector {
            at_m: *at,
            force_n: 0.8 * outwards + 0.25 * Vec2::new(-outwards.y, outwards.x),
            role: ColorRole::Simulated,
        }
    });
    let options = ViewOptions {
        force_vectors: force_vectors.collect(),
        trajectories: vec![Trajectory { points_m: path, role: ColorRole::Measured, width_px: 2.2, dashed: false }],
        constraints: vec![ConstraintMarker::Revolute {
            center_m: center + Vec2::new(0.0006, -0.0004),
            radius_m: radius,
            center_axes_m: [Vec2::new(0.0018, 0.0012), Vec2::new(-0.0006, 0.0009)],
        }],
        ..ViewOptions::default()
    };
    Plate { name: "crank", world, state, options }
}

fn ghost() -> Plate {
    let mut plate = grasp();
    plate.name = "ghost";
    let mut ghost = State::resting(&plate.world);
    hold(&mut ghost, 0, Vec2::new(0.013, -0.080), 0.0159, 1.8, 0.17);
    plate.options.trajectories = vec![curve(ColorRole::Measured, 0.0, false), curve(ColorRole::Simulated, 0.002, true)];
    plate.options.ghost = Some(ghost);
    plate
}

fn curve(role: ColorRole, lift: f64, dashed: bool) -> Trajectory {
    let points_m = (0..200)
        .map(|i| {
            let t = f64::from(i) / 199.0;
            Vec2::new(-0.012 + 0.025 * t, -0.109 + 0.029 * t.sqrt() + lift * (3.0 * t).sin())
        })
        .collect();
    Trajectory { points_m, role, width_px: 2.4, dashed }
}

fn tool() -> Plate {
    let mut world = blocks();
    world.blocks.truncate(2);
    let mut state = State::resting(&world);
    state.input.tip_in_world[0] = Vec2::new(0.006, -0.1);
    state.tip_force_n[0] = Vec2::new(-0.5, -1.2);
    let options = ViewOptions { fingers: FingerStyle::Tool, ..ViewOptions::default() };
    Plate { name: "tool", world, state, options }
}

fn insertion() -> Plate {
    let mut plate = tool();
    plate.name = "prismatic";
    plate.options.constraints = vec![ConstraintMarker::Prismatic {
        origin_m: Vec2::new(0.006, -0.1),
        direction: Vec2::new(0.3, -1.0),
        length_m: 0.05,
        std_m: 0.001,
    }];
    plate
}

/// A surface that was felt from above, with its error.
fn touched() -> Plate {
    let mut plate = tool();
    plate.name = "surface";
    plate.world.blocks.clear();
    plate.state.bodies.clear();
    plate.options.constraints = vec![ConstraintMarker::Surface {
        ends_m: [Vec2::new(-0.030, -0.106), Vec2::new(0.034, -0.098)],
        normal: Vec2::new(-0.12, 0.99),
        std_m: 0.0006,
    }];
    plate.state.input.tip_in_world[0] = Vec2::new(0.006, -0.1015);
    plate
}

/// A curve that a tool was led along.
fn guided() -> Plate {
    let mut plate = touched();
    plate.name = "curve";
    let points_m: Vec<Vec2> = (0..=60)
        .map(|i| {
            let t = f64::from(i) / 60.0;
            Vec2::new(-0.035 + 0.07 * t, -0.085 + 0.02 * (5.0 * t).sin() * t)
        })
        .collect();
    plate.state.input.tip_in_world[0] = points_m[40];
    plate.options.constraints = vec![ConstraintMarker::Path { points_m }];
    plate
}
