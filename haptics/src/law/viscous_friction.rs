//! Viscous friction: c v (Newton 1687). c ≥ 0: it takes energy out.

use super::entry::{Entry, Kind, POSITIVE, ParameterSpec};
use super::force_law::{Law, MAX_PARAMETERS, Motion, Role};

/// Viscous friction; equation and sign in the module's head.
#[derive(Clone, Copy, Debug)]
pub struct ViscousFriction;

static ENTRY: Entry = Entry {
    id: "viscous-friction",
    kind: Kind::Plant,
    title: "Viscous friction",
    equation: "c v",
    what: "Resistance in proportion to speed.",
    shows: "As a slope of force over speed through zero.",
    mimics: "At constant speed it is Coulomb friction; over a narrow range of speeds quadratic drag or the falling \
             branch of Stribeck friction mimic it.",
    reveals: "Slow and fast motion in both directions reveals it.",
    parameters: &[ParameterSpec::linear("c", "N s/m", "N m s", POSITIVE)],
};

impl Law for ViscousFriction {
    fn entry(&self) -> &'static Entry {
        &ENTRY
    }

    fn role(&self) -> Role {
        Role::Viscous
    }

    fn regressor(&self, motion: &Motion, columns: &mut [f64; MAX_PARAMETERS]) {
        columns[0] = motion.velocity;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_effect() {
        // 1.5 N s/m · 0.2 m/s.
        let motion = Motion { velocity: 0.2, ..Motion::default() };
        let mut values = [0.0; MAX_PARAMETERS];
        values[..1].copy_from_slice(&[1.5]);
        assert!((ViscousFriction.force(&motion, &values) - 0.3).abs() < 1e-12);
    }
}
