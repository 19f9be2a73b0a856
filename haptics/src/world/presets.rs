//! Worlds to start from.

use super::block::{Block, Cable, Content, Shape, Wall};
use super::fixture::{Membrane, Switch};
use super::guide::Guide;
use super::model::{Crank, Floor, World};
use crate::Vec2;
use crate::law::object::{CurvePoint, MembraneLaw, ToggleCurve};
use crate::law::{CoulombFriction, Effect, Inertia, LoadFriction, ViscousFriction, Weight};

/// The thesis's two blocks (table 5.4, actual values), block 1 on block 2, to the left of the middle.
pub fn stacking() -> World {
    let mut world = World::empty("Two blocks of the thesis");
    let floor_m = floor_m(&world);
    let left_m = -0.014;
    let (height_2, width_2) = (0.0127, 0.0254);
    world.blocks = vec![
        Block::upright("block-1", 0.343 / 9.81, 0.0159, 0.0160, left_m, floor_m + height_2),
        Block::upright("block-2", 0.437 / 9.81, width_2, height_2, left_m, floor_m),
    ];
    world
}

/// A crank like the thesis's: mg = 0.16 N, mu = 0.053, c = 1.0 N s/m (0.010 N per cm/s).
pub fn crank() -> World {
    let mut world = World::empty("Crank of the thesis");
    world.floor = None;
    world.crank = Some(Crank {
        center_m: world.hand.workspace.center_m,
        radius_m: 0.022,
        handle_width_m: 0.010,
        finger_friction: 1.0,
        constraint_stiffness_n_m: None,
        effects: vec![
            Effect::new(&Weight, &[0.16]),
            Effect::new(&Inertia, &[0.03]),
            Effect::new(&LoadFriction, &[0.053]),
            Effect::new(&ViscousFriction, &[1.0]),
            Effect::new(&CoulombFriction, &[0.02]),
        ],
        start_rad: -std::f64::consts::FRAC_PI_2,
    });
    world
}

/// Every built-in world.
pub fn all() -> [World; 7] {
    [stacking(), crank(), needle(), barrel(), switch(), guide(), table()]
}

/// Makes a world.
pub type Make = fn() -> World;

/// The built-in worlds by name.
pub const BUILT_IN: [(&str, Make); 7] = [
    ("stack", stacking),
    ("crank", crank),
    ("needle", needle),
    ("barrel", barrel),
    ("switch", switch),
    ("guide", guide),
    ("table", table),
];

/// The built-in world of a name.
pub fn named(name: &str) -> Option<World> {
    BUILT_IN.iter().find(|(known, _)| *known == name).map(|(_, make)| make())
}

/// A bare table: somewhere to try the fingers.
pub fn table() -> World {
    World::empty("Empty table")
}

/// A needle on the bottom of an inverted paper cup, as in the thesis's third task: pierced at about 1.5 N and 5 mm.
pub fn needle() -> World {
    let mut world = World::empty("Needle and paper cup");
    let sheet = Vec2::new(0.0, floor_m(&world) + 0.022);
    let mut needle = Block::upright("needle", 0.008, 0.006, 0.034, sheet.x, sheet.y);
    needle.shape = Shape::Needle;
    world.blocks = vec![needle];
    world.membrane = Some(Membrane {
        center_m: sheet,
        half_width_m: 0.018,
        side_stiffness_n_m: 400.0,
        law: MembraneLaw {
            stiffness_n_m: 260.0,
            cubic_n_m3: 1.5e6,
            give: 0.35,
            puncture_n: 1.5,
            friction_n: 0.25,
            drag_n_s_m: 2.0,
        },
    });
    world
}

/// A barrel of unknown contents on a cable: heavy, with a wall that yields and breaks, and leaks from then on.
pub fn barrel() -> World {
    let mut world = World::empty("Barrel on a cable");
    let floor_m = floor_m(&world);
    let mut barrel = Block::upright("barrel", 0.25, 0.026, 0.034, -0.010, floor_m);
    barrel.shape = Shape::Barrel;
    barrel.wall = Some(Wall { stiffness_n_m: 3000.0, strength_n: Some(5.0) });
    barrel.content = Some(Content { mass_kg: 0.15, leak_kg_s: 0.005, leaks_from_s: None });
    barrel.cable =
        Some(Cable { anchor_m: Vec2::new(-0.034, floor_m), length_m: 0.045, stiffness_n_m: 600.0, damping_n_s_m: 2.0 });
    world.blocks = vec![barrel];
    world
}

/// A toggle switch that snaps over at about 1.2 N.
pub fn switch() -> World {
    let mut world = World::empty("Toggle switch");
    let pivot_m = Vec2::new(0.0, floor_m(&world));
    let point = |at_m, forward_n, backward_n| CurvePoint { at_m, forward_n, backward_n };
    world.switch = Some(Switch {
        pivot_m,
        lever_m: 0.030,
        knob_radius_m: 0.006,
        mass_kg: 0.012,
        damping_n_s_m: 0.3,
        finger_friction: 0.6,
        curve: ToggleCurve {
            points: vec![
                point(-8e-3, 0.1, -0.1),
                point(-3.5e-3, 1.2, 0.9),
                point(3.5e-3, -0.9, -1.2),
                point(8e-3, 0.1, -0.1),
            ],
            reversal_m: 0.3e-3,
            stop_n_m: 4000.0,
        },
        start_m: -8e-3,
    });
    world
}

/// A slider in an S-shaped slot: a path that is neither a line nor a circle.
pub fn guide() -> World {
    let mut world = World::empty("Slider in a bent slot");
    world.floor = None;
    let middle = world.hand.workspace.center_m;
    let points_m =
        [(-0.030, -0.010), (-0.020, 0.004), (-0.008, 0.012), (0.008, -0.012), (0.020, -0.004), (0.030, 0.010)]
            .map(|(x, y)| middle + Vec2::new(x, y))
            .to_vec();
    let guide = Guide { points_m, closed: false, stiffness_n_m: 4000.0, damping_n_s_m: 6.0, friction_n: 0.1 };
    let start = guide.point(1.0).0;
    let mut slider = Block::upright("slider", 0.04, 0.012, 0.012, start.x, start.y - 0.006);
    slider.guide = Some(guide);
    world.blocks = vec![slider];
    world
}

fn floor_m(world: &World) -> f64 {
    world.floor.as_ref().map_or(0.0, |f: &Floor| f.height_m)
}
