//! Quadratic drag: k v |v|. k ≥ 0.

use super::{Kind, Law, MAX_PARAMETERS, Motion, ParameterSpec};

/// Quadratic drag; equation and sign in the module's head.
#[derive(Clone, Copy, Debug)]
pub struct QuadraticDrag;

static PARAMETERS: [ParameterSpec; 1] =
    [ParameterSpec { name: "k", unit: "N s²/m²", unit_angular: "N m s²", bounds: (0.0, f64::INFINITY) }];

impl Law for QuadraticDrag {
    fn id(&self) -> &'static str {
        "quadratic-drag"
    }

    fn kind(&self) -> Kind {
        Kind::Plant
    }

    fn title(&self) -> &'static str {
        "Quadratic drag"
    }

    fn parameters(&self) -> &'static [ParameterSpec] {
        &PARAMETERS
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
