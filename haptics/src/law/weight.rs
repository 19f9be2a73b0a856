//! Weight of the handle: mg (up · t): the weight of what is carried along the coordinate (thesis, eq. 5.2, the (mg)t term). mg ≥ 0.

use super::{Kind, Law, MAX_PARAMETERS, Motion, ParameterSpec};

/// Weight of the handle; equation and sign in the module's head.
#[derive(Clone, Copy, Debug)]
pub struct Weight;

static PARAMETERS: [ParameterSpec; 1] =
    [ParameterSpec { name: "mg", unit: "N", unit_angular: "N m", bounds: (0.0, f64::INFINITY) }];

impl Law for Weight {
    fn id(&self) -> &'static str {
        "weight"
    }

    fn kind(&self) -> Kind {
        Kind::Plant
    }

    fn title(&self) -> &'static str {
        "Weight of the handle"
    }

    fn parameters(&self) -> &'static [ParameterSpec] {
        &PARAMETERS
    }

    fn regressor(&self, motion: &Motion, columns: &mut [f64; MAX_PARAMETERS]) {
        columns[0] = motion.up_along;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_effect() {
        let motion = Motion { up_along: 0.5, ..Motion::default() };
        let mut values = [0.0; MAX_PARAMETERS];
        values[..1].copy_from_slice(&[0.16]);
        assert!((Weight.force(&motion, &values) - 0.08).abs() < 1e-12);
    }
}
