//! The laws of eq. 5.2 and their places in a fit.

use haptics::law::{CoulombFriction, Inertia, Law, LoadFriction, MAX_PARAMETERS, Motion, ViscousFriction, Weight};

/// The laws of eq. 5.2, with the two that it left out: each linear in one parameter.
pub static LAWS: [&dyn Law; 5] = [&Weight, &LoadFriction, &ViscousFriction, &CoulombFriction, &Inertia];

/// Places in [`LAWS`].
#[derive(Clone, Copy)]
pub enum Place {
    /// Weight of the handle.
    Weight,
    /// Friction in proportion to the load.
    Load,
    /// Viscous friction.
    Viscous,
    /// Constant friction.
    Coulomb,
    /// Inertia.
    Inertia,
}

/// True for a law that resists the motion.
pub fn is_friction(law: usize) -> bool {
    [Place::Load, Place::Viscous, Place::Coulomb].iter().any(|place| *place as usize == law)
}

/// Names of the laws' parameters in a fit; inertia is reported about the axis.
pub const NAMES: [&str; 5] = ["weight_N", "friction_mu", "viscous_N_s_m", "coulomb_N", "inertia_kg_m2"];

/// Regressor of a law: its force per unit of its parameter.
pub fn column(law: &dyn Law, motion: &Motion) -> f64 {
    let mut columns = [0.0; MAX_PARAMETERS];
    law.regressor(motion, &mut columns);
    columns[0]
}

/// Why a recording may not show a law.
pub fn missing_motion(law: usize) -> &'static str {
    match NAMES[law] {
        "weight_N" => "the handle was not turned far enough round for its weight to be told from friction",
        "inertia_kg_m2" => "the crank was turned too evenly for its inertia to show; accelerate it",
        "coulomb_N" => "the normal force hardly varied, so constant and load friction are one; push as well as pull",
        _ => "the recording does not excite it; vary speed and normal force, and reverse",
    }
}
