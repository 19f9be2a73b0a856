//! The laws of eq. 5.2 and their places in a fit.

use haptics::law::{CoulombFriction, Inertia, Law, LoadFriction, MAX_PARAMETERS, Motion, ViscousFriction, Weight};

/// The laws of eq. 5.2, with the two that it left out: each linear in one parameter.
pub static LAWS: [&dyn Law; 5] = [&Weight, &LoadFriction, &ViscousFriction, &CoulombFriction, &Inertia];

/// Index of the weight.
/// Derived: position in [`LAWS`].
pub const WEIGHT: usize = 0;
/// Index of the inertia.
/// Derived: position in [`LAWS`].
pub const INERTIA: usize = 4;
/// Index of the constant friction.
/// Derived: position in [`LAWS`].
pub const COULOMB: usize = 3;
/// Indices of the laws that resist the motion.
/// Derived: positions in [`LAWS`].
pub const FRICTION: [usize; 3] = [1, 2, COULOMB];

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
    match law {
        WEIGHT => "the handle was not turned far enough round for its weight to be told from friction",
        INERTIA => "the crank was turned too evenly for its inertia to show; accelerate it",
        COULOMB => "the normal force hardly varied, so constant and load friction are one; push as well as pull",
        _ => "the recording does not excite it; vary speed and normal force, and reverse",
    }
}
