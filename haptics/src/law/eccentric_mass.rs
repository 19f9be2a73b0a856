//! Eccentric mass: a sin θ + b cos θ: gravity on a mass off the axis, out of phase with the handle.
//! For θ measured from hanging, a alone is the gravity moment m g r.

use super::{Kind, Law, MAX_PARAMETERS, Motion, ParameterSpec};

/// Eccentric mass; equation and sign in the module's head.
#[derive(Clone, Copy, Debug)]
pub struct EccentricMass;

static PARAMETERS: [ParameterSpec; 2] = [
    ParameterSpec { name: "a", unit: "N", unit_angular: "N m", bounds: (f64::NEG_INFINITY, f64::INFINITY) },
    ParameterSpec { name: "b", unit: "N", unit_angular: "N m", bounds: (f64::NEG_INFINITY, f64::INFINITY) },
];

impl Law for EccentricMass {
    fn id(&self) -> &'static str {
        "eccentric-mass"
    }

    fn kind(&self) -> Kind {
        Kind::Plant
    }

    fn title(&self) -> &'static str {
        "Eccentric mass"
    }

    fn parameters(&self) -> &'static [ParameterSpec] {
        &PARAMETERS
    }

    fn regressor(&self, motion: &Motion, columns: &mut [f64; MAX_PARAMETERS]) {
        columns[0] = motion.position.sin();
        columns[1] = motion.position.cos();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_effect() {
        let motion = Motion { position: std::f64::consts::FRAC_PI_6, ..Motion::default() };
        let mut values = [0.0; MAX_PARAMETERS];
        values[..2].copy_from_slice(&[2.0, 0.0]);
        assert!((EccentricMass.force(&motion, &values) - 1.0).abs() < 1e-12);
    }
}
