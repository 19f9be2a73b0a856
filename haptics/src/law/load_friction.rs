//! Load friction: mu |Fn| sgn(v): friction in proportion to the normal force (thesis, eq. 5.2). mu ≥ 0.
//! Fn is a measured quantity: the pull of the fingers across the path (eq. 5.2 and `docs/causes/README.md`), as it
//! stands in a log. It is not the force in the bearing: the weight across the path and the centrifugal force are left
//! to the other laws of friction, and a released crank feels none of this one.
//! The coordinate is a length; for an angle the caller passes the normal force times its arm.

use super::entry::{Entry, Kind, ParameterSpec};
use super::force_law::{Law, MAX_PARAMETERS, Motion, Role};

/// Load friction; equation and sign in the module's head.
#[derive(Clone, Copy, Debug)]
pub struct LoadFriction;

static ENTRY: Entry = Entry {
    id: "load-friction",
    kind: Kind::Plant,
    title: "Load friction",
    equation: "mu abs(Fn) sgn(v)",
    what: "Dry friction in proportion to the normal force.",
    shows: "As a step at reversals that grows with the pull across the motion.",
    mimics: "At constant load it is Coulomb friction.",
    reveals: "Pulling and pushing with different strength while reversing reveals it.",
    parameters: &[ParameterSpec::linear("mu", "1", "1", (0.0, 10.0))],
};

impl Law for LoadFriction {
    fn entry(&self) -> &'static Entry {
        &ENTRY
    }

    fn role(&self) -> Role {
        Role::Dry
    }

    fn feels_load(&self) -> bool {
        true
    }

    fn regressor(&self, motion: &Motion, columns: &mut [f64; MAX_PARAMETERS]) {
        columns[0] = motion.normal_force_n.abs() * motion.direction;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_effect() {
        let motion = Motion { direction: 1.0, normal_force_n: -2.0, ..Motion::default() };
        let mut values = [0.0; MAX_PARAMETERS];
        values[..1].copy_from_slice(&[0.05]);
        assert!((LoadFriction.force(&motion, &values) - 0.1).abs() < 1e-12);
    }
}
