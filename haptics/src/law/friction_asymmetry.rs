//! Direction-dependent friction: Half differences of friction between the two directions: positive motion meets Fc + dFc, negative motion Fc − dFc (and c ± dc).
//! dFc therefore acts as a constant while the coordinate moves and vanishes at rest.

use super::{Kind, Law, MAX_PARAMETERS, Motion, ParameterSpec};

/// Direction-dependent friction; equation and sign in the module's head.
#[derive(Clone, Copy, Debug)]
pub struct FrictionAsymmetry;

static PARAMETERS: [ParameterSpec; 2] = [
    ParameterSpec { name: "dFc", unit: "N", unit_angular: "N m", bounds: (f64::NEG_INFINITY, f64::INFINITY) },
    ParameterSpec { name: "dc", unit: "N s/m", unit_angular: "N m s", bounds: (f64::NEG_INFINITY, f64::INFINITY) },
];

impl Law for FrictionAsymmetry {
    fn id(&self) -> &'static str {
        "friction-asymmetry"
    }

    fn kind(&self) -> Kind {
        Kind::Plant
    }

    fn title(&self) -> &'static str {
        "Direction-dependent friction"
    }

    fn parameters(&self) -> &'static [ParameterSpec] {
        &PARAMETERS
    }

    fn is_dry(&self) -> bool {
        true
    }

    fn regressor(&self, motion: &Motion, columns: &mut [f64; MAX_PARAMETERS]) {
        columns[0] = motion.direction.abs();
        columns[1] = motion.velocity.abs() * motion.direction.abs();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_effect() {
        let motion = Motion { direction: -1.0, velocity: -2.0, ..Motion::default() };
        let mut values = [0.0; MAX_PARAMETERS];
        values[..2].copy_from_slice(&[0.1, 0.2]);
        assert!((FrictionAsymmetry.force(&motion, &values) - 0.5).abs() < 1e-12);
    }
}
