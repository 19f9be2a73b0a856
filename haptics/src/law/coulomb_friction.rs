//! Coulomb friction: Fc sgn(v), independent of the load (Coulomb 1785). Fc ≥ 0. At rest it holds up to Fc.

use super::entry::{Entry, Kind, POSITIVE, ParameterSpec};
use super::force_law::{Law, MAX_PARAMETERS, Motion, Role};

/// Coulomb friction; equation and sign in the module's head.
#[derive(Clone, Copy, Debug)]
pub struct CoulombFriction;

static ENTRY: Entry = Entry {
    id: "coulomb-friction",
    kind: Kind::Plant,
    title: "Coulomb friction",
    equation: "Fc sgn(v)",
    what: "Dry friction that does not depend on the load.",
    shows: "As a step of 2 Fc at every reversal.",
    mimics: "At constant load it cannot be told from load friction, at constant speed not from viscous friction, \
             without reversals not from a bias.",
    reveals: "Reversals with changing load and speed reveal it.",
    parameters: &[ParameterSpec::linear("Fc", "N", "N m", POSITIVE)],
};

impl Law for CoulombFriction {
    fn entry(&self) -> &'static Entry {
        &ENTRY
    }

    fn role(&self) -> Role {
        Role::Dry
    }

    fn regressor(&self, motion: &Motion, columns: &mut [f64; MAX_PARAMETERS]) {
        columns[0] = motion.direction;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_effect() {
        let motion = Motion { direction: -1.0, velocity: -0.3, ..Motion::default() };
        let mut values = [0.0; MAX_PARAMETERS];
        values[..1].copy_from_slice(&[0.4]);
        assert!((CoulombFriction.force(&motion, &values) - (-0.4)).abs() < 1e-12);
    }
}
