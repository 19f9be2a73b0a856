//! Baseline models by name, and the terms of them that a recording or its sidecar states.

use crate::diagnose::data::regression_data::Model;
use foundation::estimate::EstimateError;
use haptics::law::{Coordinate, CoulombFriction, Effect, Inertia, Law, LoadFriction, ViscousFriction, Weight};
use haptics::recording::Recording;

/// The thesis's crank (eq. 5.2).
pub fn plain_crank() -> Model {
    [&Weight as &dyn Law, &LoadFriction, &ViscousFriction].map(|law| Effect::new(law, &[1.0])).to_vec()
}

/// Laws of a mechanism that the sidecar states, which are taken out of the fitted ones.
pub fn known_laws(recording: &Recording, coordinate: Coordinate, model: &mut Model) -> Model {
    let known = &recording.meta.known;
    // The mass of a pendulum is not its moment of inertia.
    let names = match coordinate {
        Coordinate::Linear => ["mass_kg", "viscous_N_s_m", "coulomb_N"],
        Coordinate::Angular => ["inertia_kg_m2", "viscous_Nm_s", "coulomb_Nm"],
    };
    let laws: [&'static dyn Law; 3] = [&Inertia, &ViscousFriction, &CoulombFriction];
    let mut fixed = Model::new();
    for (law, name) in laws.into_iter().zip(names) {
        let Some(value) = known.get(name).copied().filter(|_| model.iter().any(|e| e.law().id() == law.id())) else {
            continue;
        };
        model.retain(|e| e.law().id() != law.id());
        fixed.push(Effect::new(law, &[value]));
    }
    fixed
}

/// Laws of the baseline with this name.
///
/// # Errors
/// A term that is no law of a baseline, in a sentence.
pub fn named(name: &str) -> Result<Model, EstimateError> {
    name.split('+')
        .map(|part| match part.trim() {
            "mass" | "inertia" => Ok(Effect::new(&Inertia, &[1.0])),
            "viscous" => Ok(Effect::new(&ViscousFriction, &[1.0])),
            "coulomb" => Ok(Effect::new(&CoulombFriction, &[1.0])),
            other => Err(EstimateError::Other(format!(
                "`{other}` is no part of a baseline; write mass, mass+viscous or mass+viscous+coulomb, or name a world file"
            ))),
        })
        .collect()
}
