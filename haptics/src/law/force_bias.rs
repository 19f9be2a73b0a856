//! Force bias: F + b: a constant error of the force channel along the coordinate.

use super::entry::{ANY, Entry, Kind, ParameterSpec};
use super::force_law::{Law, MAX_PARAMETERS, Motion, Role};

/// Force bias; equation and sign in the module's head.
#[derive(Clone, Copy, Debug)]
pub struct ForceBias;

static ENTRY: Entry = Entry {
    id: "force-bias",
    kind: Kind::Instrument,
    title: "Force bias",
    equation: "F + b",
    what: "The force sensor reads something when nothing is touched.",
    shows: "As a constant, also in free motion.",
    mimics: "A weight mimics it while an object is carried, a tilt along a line, friction that differs by direction \
             where the motion does not reverse.",
    reveals: "A second of free motion at the start and at the end reveals it.",
    parameters: &[ParameterSpec::linear("b", "N", "N m", ANY)],
};

impl Law for ForceBias {
    fn entry(&self) -> &'static Entry {
        &ENTRY
    }

    fn role(&self) -> Role {
        Role::Smooth
    }

    fn regressor(&self, _motion: &Motion, columns: &mut [f64; MAX_PARAMETERS]) {
        columns[0] = 1.0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_effect() {
        let motion = Motion::default();
        let mut values = [0.0; MAX_PARAMETERS];
        values[..1].copy_from_slice(&[-3.2]);
        assert!((ForceBias.force(&motion, &values) - (-3.2)).abs() < 1e-12);
    }
}
