//! Worlds to start from.

use super::block::Block;
use super::model::{Crank, Floor, World};
use crate::law::{CoulombFriction, Effect, Inertia, LoadFriction, ViscousFriction, Weight};

/// The thesis's two blocks (table 5.4, actual values), block 1 on block 2, to the left of the middle.
pub fn stacking() -> World {
    let mut world = World::empty("Two blocks of the thesis");
    let floor_m = world.floor.as_ref().map_or(0.0, |f: &Floor| f.height_m);
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

/// A bare table: somewhere to try the fingers.
pub fn table() -> World {
    World::empty("Empty table")
}
