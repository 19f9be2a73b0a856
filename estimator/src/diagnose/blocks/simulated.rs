//! Causes found on blocks, and rival causes, as effects in a world.

use super::carry::Carry;
use crate::diagnose::answer::parameter;
use crate::diagnose::atlas::Variable;
use crate::diagnose::candidate::Candidate;
use crate::diagnose::report::{CauseParameter, Diagnosis};
use crate::diagnose::suspects::{Act, Simulated};
use haptics::Vec2;
use haptics::world::{Cable, Content, World};
use std::collections::BTreeSet;

/// Causes of the net-force channel: a hypothesis sets all of them again.
const OF_THE_NET_FORCE: [&str; 6] =
    ["inertia", "mass-change", "gravity-tilt", "added-constraint", "viscous-friction", "friction-change"];

/// Adds the found causes to a world.
pub fn extend(world: &mut World, diagnosis: &Diagnosis) {
    for cause in &diagnosis.causes {
        put(world, &cause.id, &cause.parameters);
    }
}

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

fn put(world: &mut World, id: &str, parameters: &[CauseParameter]) {
    let value = |name: &str| parameters.iter().find(|p| p.name == name).map(|p| p.value);
    let number = value("block").map_or(0, |b| (b as usize).saturating_sub(1));
    match id {
        "pad-compliance" => {
            world.pad.stiffness_n_m = value("k").filter(|k| *k > 0.0).unwrap_or(world.pad.stiffness_n_m);
            let shear = value("k_shear").filter(|k| *k > 0.0);
            world.pad.shear_stiffness_n_m = shear.unwrap_or(world.pad.shear_stiffness_n_m);
        }
        "stiffness-hardening" => {
            world.pad.stiffness_n_m = value("k1").filter(|k| *k > 0.0).unwrap_or(world.pad.stiffness_n_m);
            world.pad.cubic_n_m3 = value("k3").map_or(world.pad.cubic_n_m3, |k| k.max(0.0));
        }
        "gravity-tilt" => {
            // The hand resists the lateral force: gravity points along (sin, −cos) of the tilt.
            world.tilt_rad -= value("angle").unwrap_or(0.0);
        }
        "weight" => {
            let gravity = world.gravity_m_s2.max(1e-9);
            if let (Some(weight), Some(block)) = (value("weight").filter(|w| *w > 0.0), world.blocks.get_mut(number)) {
                block.mass_kg = weight / gravity;
            }
        }
        "mass-change" => {
            let leak_kg_s = value("rate").map(|rate| -rate / world.gravity_m_s2.max(1e-9)).filter(|leak| *leak > 0.0);
            let leaks_from_s = value("t0").or(Some(0.0));
            let of_all = value("block").is_none();
            let leaking = world.blocks.iter_mut().enumerate().filter(|(k, _)| of_all || *k == number);
            for ((_, block), leak_kg_s) in leaking.zip(leak_kg_s.into_iter().cycle()) {
                block.content = Some(Content { mass_kg: 0.5 * block.mass_kg, leak_kg_s, leaks_from_s });
            }
        }
        "added-constraint" => {
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

impl Simulated for Carry {
    fn base(&self, values: &[f64]) -> Vec<Act> {
        let of = |(number, weight_n): (&usize, &f64)| {
            let found = vec![parameter("weight", *weight_n, 0.0, "N"), parameter("block", *number as f64, 0.0, "1")];
            ("weight".to_owned(), found)
        };
        self.weighed.iter().zip(values).map(of).collect()
    }

    /// A world has no drag in the air, no mass without weight, and no sudden change of weight.
    fn act(&self, candidate: &Candidate, values: &[f64]) -> Option<Act> {
        let linear = candidate.linear.iter().zip(values);
        let mut found: Vec<CauseParameter> =
            linear.map(|((name, unit), value)| parameter(name, *value, 0.0, unit)).collect();
        match candidate.id {
            "gravity-tilt" => {}
            "added-constraint" => {
                found.extend(candidate.searched.iter().map(|s| parameter(s.name, s.value, 0.0, s.unit)));
            }
            // The start of a leak does not carry over to another recording: there it leaks from the start.
            "mass-change" if found.iter().any(|p| p.name == "rate" && p.value < 0.0) => {}
            _ => return None,
        }
        Some((candidate.id.to_owned(), self.states(candidate, found)))
    }

    /// Such a drift leaves alone what its sensors read before.
    fn is_late(&self, candidate: &Candidate) -> bool {
        let Some((_, time_s)) = self.view.over.iter().find(|(v, _)| *v == Variable::Time) else { return false };
        let drifts = candidate.id == "force-drift" && candidate.searched.is_empty();
        drifts
            && candidate.columns.iter().any(|column| {
                let sensors: BTreeSet<usize> =
                    (0..column.len()).filter(|i| column[*i] != 0.0).map(|i| self.view.sensor[i]).collect();
                let silent = |i: &usize| column[*i] == 0.0 && sensors.contains(&self.view.sensor[*i]);
                (0..column.len()).filter(silent).any(|i| time_s[i] > 0.0)
            })
    }
}
