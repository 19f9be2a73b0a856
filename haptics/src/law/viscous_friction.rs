//! Viscous friction: c v. c ≥ 0.

use super::{Kind, Law, MAX_PARAMETERS, Motion, ParameterSpec};

/// Viscous friction; equation and sign in the module's head.
#[derive(Clone, Copy, Debug)]
pub struct ViscousFriction;

static PARAMETERS: [ParameterSpec; 1] =
    [ParameterSpec { name: "c", unit: "N s/m", unit_angular: "N m s", bounds: (0.0, f64::INFINITY) }];

impl Law for ViscousFriction {
    fn id(&self) -> &'static str {
        "viscous-friction"
    }

    fn kind(&self) -> Kind {
        Kind::Plant
    }

    fn title(&self) -> &'static str {
        "Viscous friction"
    }

    fn parameters(&self) -> &'static [ParameterSpec] {
        &PARAMETERS
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
        let motion = Motion { velocity: -0.5, ..Motion::default() };
        let mut values = [0.0; MAX_PARAMETERS];
        values[..1].copy_from_slice(&[3.0]);
        assert!((ViscousFriction.force(&motion, &values) - (-1.5)).abs() < 1e-12);
    }
}
