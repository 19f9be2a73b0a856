//! Quadratic drag: k v |v| (Newton 1687, Rayleigh 1876). k ≥ 0: it takes energy out.

use super::entry::{Entry, Kind, POSITIVE, ParameterSpec};
use super::force_law::{Law, MAX_PARAMETERS, Motion, Role};

/// Quadratic drag; equation and sign in the module's head.
#[derive(Clone, Copy, Debug)]
pub struct QuadraticDrag;

static ENTRY: Entry = Entry {
    id: "quadratic-drag",
    kind: Kind::Plant,
    title: "Quadratic drag",
    equation: "k v abs(v)",
    what: "Resistance of a fluid that is pushed aside.",
    shows: "As a force that grows with the square of the speed.",
    mimics: "Viscous friction mimics it over a narrow range of speeds, inertia and Stribeck friction at one-way \
             speeds.",
    reveals: "A sweep from slow to fast in both directions reveals it.",
    parameters: &[ParameterSpec::linear("k", "N s²/m²", "N m s²", POSITIVE)],
};

impl Law for QuadraticDrag {
    fn entry(&self) -> &'static Entry {
        &ENTRY
    }

    fn role(&self) -> Role {
        Role::Viscous
    }

    fn regressor(&self, motion: &Motion, columns: &mut [f64; MAX_PARAMETERS]) {
        columns[0] = motion.velocity * motion.velocity.abs();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_effect() {
        let motion = Motion { velocity: -3.0, ..Motion::default() };
        let mut values = [0.0; MAX_PARAMETERS];
        values[..1].copy_from_slice(&[0.5]);
        assert!((QuadraticDrag.force(&motion, &values) - (-4.5)).abs() < 1e-12);
    }
}
