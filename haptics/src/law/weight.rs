//! Weight of the handle: mg (up · t): the weight carried along the coordinate (thesis, eq. 5.2, the (mg)t term). mg
//! ≥ 0. Zero along a horizontal path.

use super::entry::{Entry, Kind, POSITIVE, ParameterSpec};
use super::force_law::{Law, MAX_PARAMETERS, Motion, Role};

/// Weight of the handle; equation and sign in the module's head.
#[derive(Clone, Copy, Debug)]
pub struct Weight;

static ENTRY: Entry = Entry {
    id: "weight",
    kind: Kind::Plant,
    title: "Weight of the handle",
    equation: "mg (up · t)",
    what: "The weight of what is carried.",
    shows: "As a force that follows the height of the path, the same in both directions and at every speed.",
    mimics: "A bias of the vertical force channel mimics it over a short arc, a tilt or an eccentric mass over a turn.",
    reveals: "A full turn, or a path up and down, with a phase of free motion for the bias, reveals it.",
    parameters: &[ParameterSpec::linear("mg", "N", "N m", POSITIVE)],
};

impl Law for Weight {
    fn entry(&self) -> &'static Entry {
        &ENTRY
    }

    fn role(&self) -> Role {
        Role::Gravity
    }

    fn regressor(&self, motion: &Motion, columns: &mut [f64; MAX_PARAMETERS]) {
        columns[0] = motion.up_along;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_effect() {
        let motion = Motion { up_along: 0.5, ..Motion::default() };
        let mut values = [0.0; MAX_PARAMETERS];
        values[..1].copy_from_slice(&[0.16]);
        assert!((Weight.force(&motion, &values) - 0.08).abs() < 1e-12);
    }
}
