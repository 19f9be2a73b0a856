//! Load friction: mu |Fn| sgn(v): friction in proportion to the normal force (thesis, eq. 5.2). mu ≥ 0.
//! The coordinate is a length; for an angle the caller passes the normal force times its arm.

use super::{Kind, Law, MAX_PARAMETERS, Motion, ParameterSpec};

/// Load friction; equation and sign in the module's head.
#[derive(Clone, Copy, Debug)]
pub struct LoadFriction;

static PARAMETERS: [ParameterSpec; 1] =
    [ParameterSpec { name: "mu", unit: "1", unit_angular: "1", bounds: (0.0, 10.0) }];

impl Law for LoadFriction {
    fn id(&self) -> &'static str {
        "load-friction"
    }

    fn kind(&self) -> Kind {
        Kind::Plant
    }

    fn title(&self) -> &'static str {
        "Load friction"
    }

    fn parameters(&self) -> &'static [ParameterSpec] {
        &PARAMETERS
    }

    fn is_dry(&self) -> bool {
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
