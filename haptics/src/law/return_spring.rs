//! Return spring: k q + f0, i.e. k (q − q0) with q0 = −f0/k. k ≥ 0.

use super::{Kind, Law, MAX_PARAMETERS, Motion, ParameterSpec};

/// Return spring; equation and sign in the module's head.
#[derive(Clone, Copy, Debug)]
pub struct ReturnSpring;

static PARAMETERS: [ParameterSpec; 2] = [
    ParameterSpec { name: "k", unit: "N/m", unit_angular: "N m/rad", bounds: (0.0, f64::INFINITY) },
    ParameterSpec { name: "f0", unit: "N", unit_angular: "N m", bounds: (f64::NEG_INFINITY, f64::INFINITY) },
];

impl Law for ReturnSpring {
    fn id(&self) -> &'static str {
        "return-spring"
    }

    fn kind(&self) -> Kind {
        Kind::Plant
    }

    fn title(&self) -> &'static str {
        "Return spring"
    }

    fn parameters(&self) -> &'static [ParameterSpec] {
        &PARAMETERS
    }

    fn regressor(&self, motion: &Motion, columns: &mut [f64; MAX_PARAMETERS]) {
        columns[0] = motion.position;
        columns[1] = 1.0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_effect() {
        let motion = Motion { position: 0.2, ..Motion::default() };
        let mut values = [0.0; MAX_PARAMETERS];
        values[..2].copy_from_slice(&[5.0, -0.5]);
        assert!((ReturnSpring.force(&motion, &values) - 0.5).abs() < 1e-12);
    }
}
