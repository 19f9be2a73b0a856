//! Causes found on blocks, and rival causes, as effects in a world.

use super::hypothetical_worlds::Act;
use crate::diagnose::contract::{CauseParameter, Diagnosis};
use crate::diagnose::hypotheses::{
    added_constraint, friction_change, gravity_tilt, inertia, mass_change, pad_compliance, stiffness_hardening,
    viscous_friction,
};
use haptics::Vec2;
use haptics::world::{Cable, Content, World};

/// Causes of the net-force channel: a hypothesis sets all of them again.
const OF_THE_NET_FORCE: [&str; 6] =
    [inertia::ID, mass_change::ID, gravity_tilt::ID, added_constraint::ID, viscous_friction::ID, friction_change::ID];

/// The world with the causes found in other channels and with the hypothesis on what acts on the blocks.
pub fn with_acts(world: &World, diagnosis: &Diagnosis, acts: &[Act]) -> World {
    let mut world = world.clone();
    for cause in diagnosis.causes.iter().filter(|c| !OF_THE_NET_FORCE.contains(&c.id.as_str())) {
        put(&mut world, &cause.id, &cause.parameters);
    }
    for (id, parameters) in acts {
        put(&mut world, id, parameters);
    }
    world
}

/// Adds an effect to a world.
pub fn put(world: &mut World, id: &str, parameters: &[CauseParameter]) {
    let value = |name: &str| parameters.iter().find(|p| p.name == name).map(|p| p.value);
    let number = value("block").map_or(0, |b| (b as usize).saturating_sub(1));
    match id {
        pad_compliance::ID => {
            world.pad.stiffness_n_m = value("k").filter(|k| *k > 0.0).unwrap_or(world.pad.stiffness_n_m);
            let shear = value("k_shear").filter(|k| *k > 0.0);
            world.pad.shear_stiffness_n_m = shear.unwrap_or(world.pad.shear_stiffness_n_m);
        }
        stiffness_hardening::ID => {
            world.pad.stiffness_n_m = value("k1").filter(|k| *k > 0.0).unwrap_or(world.pad.stiffness_n_m);
            world.pad.cubic_n_m3 = value("k3").map_or(world.pad.cubic_n_m3, |k| k.max(0.0));
        }
        gravity_tilt::ID => {
            // The hand resists the lateral force: gravity points along (sin, −cos) of the tilt.
            world.tilt_rad -= value("angle").unwrap_or(0.0);
        }
        "weight" => {
            let gravity = world.gravity_m_s2.max(f64::MIN_POSITIVE);
            if let (Some(weight), Some(block)) = (value("weight").filter(|w| *w > 0.0), world.blocks.get_mut(number)) {
                block.mass_kg = weight / gravity;
            }
        }
        mass_change::ID => {
            let leak_kg_s =
                value("rate").map(|rate| -rate / world.gravity_m_s2.max(f64::MIN_POSITIVE)).filter(|leak| *leak > 0.0);
            let leaks_from_s = value("t0").or(Some(0.0));
            let of_all = value("block").is_none();
            let leaking = world.blocks.iter_mut().enumerate().filter(|(k, _)| of_all || *k == number);
            for ((_, block), leak_kg_s) in leaking.zip(leak_kg_s.into_iter().cycle()) {
                block.content = Some(Content { mass_kg: 0.5 * block.mass_kg, leak_kg_s, leaks_from_s });
            }
        }
        added_constraint::ID => {
            if let (Some(k), Some(x), Some(y), Some(length_m), Some(block)) =
                (value("k"), value("anchor x"), value("anchor y"), value("length"), world.blocks.get_mut(number))
            {
                let cable = Cable { anchor_m: Vec2::new(x, y), length_m, stiffness_n_m: k, damping_n_s_m: 0.0 };
                block.cable = Some(cable);
            }
        }
        _ => {}
    }
}
