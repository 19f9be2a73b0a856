//! Coulomb friction: Fc sgn(v), independent of the load (Coulomb 1785). Fc ≥ 0.

use super::{Kind, Law, MAX_PARAMETERS, Motion, ParameterSpec};

/// Coulomb friction; equation and sign in the module's head.
#[derive(Clone, Copy, Debug)]
pub struct CoulombFriction;

static PARAMETERS: [ParameterSpec; 1] =
    [ParameterSpec { name: "Fc", unit: "N", unit_angular: "N m", bounds: (0.0, f64::INFINITY) }];

impl Law for CoulombFriction {
    fn id(&self) -> &'static str {
        "coulomb-friction"
    }

    fn kind(&self) -> Kind {
        Kind::Plant
    }

    fn title(&self) -> &'static str {
        "Coulomb friction"
    }

    fn parameters(&self) -> &'static [ParameterSpec] {
        &PARAMETERS
    }

    fn is_dry(&self) -> bool {
        true
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
