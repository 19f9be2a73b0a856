//! The catalogue: every law of a coordinate, and the page of every cause.

use super::added_constraint::AddedConstraint;
use super::backlash::Backlash;
use super::cable::Cable;
use super::coulomb_friction::CoulombFriction;
use super::eccentric_mass::EccentricMass;
use super::entry::Entry;
use super::force_bias::ForceBias;
use super::force_drift::ForceDrift;
use super::force_law::Law;
use super::friction_asymmetry::FrictionAsymmetry;
use super::friction_change::FrictionChange;
use super::gravity_tilt::GravityTilt;
use super::hysteresis::Hysteresis;
use super::inertia::Inertia;
use super::load_friction::LoadFriction;
use super::load_friction_change::LoadFrictionChange;
use super::load_hysteresis::LoadHysteresis;
use super::local_push::LocalPush;
use super::local_resistance::LocalResistance;
use super::mass_change::MassChange;
use super::position_ripple::PositionRipple;
use super::quadratic_drag::QuadraticDrag;
use super::return_spring::ReturnSpring;
use super::stribeck::Stribeck;
use super::viscous_friction::ViscousFriction;
use super::weight::Weight;
use super::{contact, instrument};

/// Every law of a coordinate, in the order it is shown.
pub static CATALOGUE: [&dyn Law; 24] = [
    &Weight,
    &Inertia,
    &CoulombFriction,
    &LoadFriction,
    &ViscousFriction,
    &FrictionAsymmetry,
    &Stribeck,
    &QuadraticDrag,
    &Hysteresis,
    &EccentricMass,
    &GravityTilt,
    &ReturnSpring,
    &PositionRipple,
    &LocalResistance,
    &LocalPush,
    &Backlash,
    &MassChange,
    &FrictionChange,
    &AddedConstraint,
    &Cable,
    &LoadHysteresis,
    &LoadFrictionChange,
    &ForceBias,
    &ForceDrift,
];

/// The law with this id.
pub fn law(id: &str) -> Option<&'static dyn Law> {
    CATALOGUE.iter().copied().find(|law| law.id() == id)
}

/// The page of every cause that the catalogue knows: laws of coordinates, then of contacts, then faults of the measurement.
pub fn entries() -> impl Iterator<Item = &'static Entry> {
    CATALOGUE.iter().map(|law| law.entry()).chain(contact::ENTRIES.iter().copied()).chain(&instrument::ENTRIES)
}

/// The pages of everything that a diagnosis can name. Laws that only models are made of are left out: the weight, the
/// push under the name of `local-resistance`, the cable under that of `added-constraint`, and the variants under load.
pub fn causes() -> impl Iterator<Item = &'static Entry> {
    let models: [&dyn Law; 5] = [&Weight, &LocalPush, &Cable, &LoadHysteresis, &LoadFrictionChange];
    entries().filter(move |entry| models.iter().all(|law| law.id() != entry.id))
}

/// The page of the cause with this id.
pub fn cause(id: &str) -> Option<&'static Entry> {
    causes().find(|entry| entry.id == id)
}
