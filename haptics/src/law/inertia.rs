//! Inertia: m dv/dt. m > 0. The integrator reads m directly; the replay and the fit use the term.

use super::{Kind, Law, MAX_PARAMETERS, Motion, ParameterSpec};

/// Inertia; equation and sign in the module's head.
#[derive(Clone, Copy, Debug)]
pub struct Inertia;

static PARAMETERS: [ParameterSpec; 1] =
    [ParameterSpec { name: "m", unit: "kg", unit_angular: "kg m²", bounds: (0.0, f64::INFINITY) }];

impl Law for Inertia {
    fn id(&self) -> &'static str {
        "inertia"
    }

    fn kind(&self) -> Kind {
        Kind::Plant
    }

    fn title(&self) -> &'static str {
        "Inertia"
    }

    fn parameters(&self) -> &'static [ParameterSpec] {
        &PARAMETERS
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
