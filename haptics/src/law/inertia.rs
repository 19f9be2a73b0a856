//! Inertia: m dv/dt. m > 0. The integrator reads m directly; the replay and the fit use the term.

use super::entry::{Entry, Kind, POSITIVE, ParameterSpec};
use super::force_law::{Law, MAX_PARAMETERS, Motion, Role};

/// Inertia; equation and sign in the module's head.
#[derive(Clone, Copy, Debug)]
pub struct Inertia;

static ENTRY: Entry = Entry {
    id: "inertia",
    kind: Kind::Plant,
    title: "Inertia",
    equation: "m dv/dt",
    what: "The effective mass along the motion.",
    shows: "As a force in proportion to the acceleration, which vanishes at constant speed.",
    mimics: "Quadratic drag mimics it when speed and acceleration go together, a delay between force and motion when \
             the motion is one sine.",
    reveals: "Bursts and changes of frequency reveal it.",
    parameters: &[ParameterSpec::linear("m", "kg", "kg m²", POSITIVE)],
};

impl Law for Inertia {
    fn entry(&self) -> &'static Entry {
        &ENTRY
    }

    fn role(&self) -> Role {
        Role::Inertia
    }

    fn regressor(&self, motion: &Motion, columns: &mut [f64; MAX_PARAMETERS]) {
        columns[0] = motion.acceleration;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_effect() {
        let motion = Motion { acceleration: -2.0, ..Motion::default() };
        let mut values = [0.0; MAX_PARAMETERS];
        values[..1].copy_from_slice(&[1.5]);
        assert!((Inertia.force(&motion, &values) - (-3.0)).abs() < 1e-12);
    }
}
