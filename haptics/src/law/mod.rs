//! The catalogue of physical laws: one law a file, written once.
//!
//! A law adds a term to the force that is needed to move a coordinate `s` (or angle) against it. The same object is
//! integrated by the servo ([`crate::world`]), summed by the replay, put into a fit as regressor columns by the estimator and
//! proposed by the diagnosis. Ids are those of `docs/causes/README.md`.
//!
//! ```
//! use haptics::law::{CoulombFriction, Effect, Motion, ViscousFriction};
//!
//! // 0.2 N of dry friction and 3 N s/m against 0.1 m/s.
//! let laws = [Effect::new(&CoulombFriction, &[0.2]), Effect::new(&ViscousFriction, &[3.0])];
//! let motion = Motion { velocity: 0.1, direction: 1.0, ..Motion::default() };
//! let force_n: f64 = laws.iter().map(|law| law.force(&motion)).sum();
//! assert!((force_n - 0.5).abs() < 1e-12);
//! ```
//!
//! Adding a law: `docs/guide/developer.md`, *Add a law in 15 minutes*.
//! Laws of contacts, which act on no coordinate, are in [`contact`], those of captured objects in [`object`]; every cause, law or
//! not, is in [`entries`].

mod added_constraint;
mod backlash;
mod cable;
mod catalogue;
pub mod contact;
mod coordinate;
mod coulomb_friction;
mod eccentric_mass;
mod effect;
mod entry;
mod force_bias;
mod force_drift;
mod force_law;
mod friction_asymmetry;
mod friction_change;
mod gravity_tilt;
mod hysteresis;
mod inertia;
mod instrument;
mod load_friction;
mod load_friction_change;
mod load_hysteresis;
mod local_push;
mod local_resistance;
mod mass_change;
mod memory;
pub mod object;
pub mod page;
mod position_ripple;
mod quadratic_drag;
mod return_spring;
mod stribeck;
#[cfg(test)]
mod tests;
mod viscous_friction;
mod weight;

pub use added_constraint::AddedConstraint;
pub use backlash::Backlash;
pub use cable::Cable;
pub use catalogue::{CATALOGUE, cause, causes, entries, law};
pub use coordinate::{
    Resistance, advance, drive_force, drive_force_with, drive_forces, explicit_stiffness, inertia, resistance,
    resistance_with, step_coordinate, step_coordinate_with,
};
pub use coulomb_friction::CoulombFriction;
pub use eccentric_mass::EccentricMass;
pub use effect::Effect;
pub use entry::{Coordinate, Enters, Entry, Kind, ParameterSpec};
pub use force_bias::ForceBias;
pub use force_drift::ForceDrift;
pub use force_law::{Law, MAX_PARAMETERS, Motion, Role};
pub use friction_asymmetry::FrictionAsymmetry;
pub use friction_change::FrictionChange;
pub use gravity_tilt::GravityTilt;
pub use hysteresis::Hysteresis;
pub use inertia::Inertia;
pub use load_friction::LoadFriction;
pub use load_friction_change::LoadFrictionChange;
pub use load_hysteresis::LoadHysteresis;
pub use local_push::LocalPush;
pub use local_resistance::LocalResistance;
pub use mass_change::MassChange;
pub use memory::{MAX_EFFECTS, Memories, Memory};
pub use position_ripple::PositionRipple;
pub use quadratic_drag::QuadraticDrag;
pub use return_spring::ReturnSpring;
pub use stribeck::Stribeck;
pub use viscous_friction::ViscousFriction;
pub use weight::Weight;
