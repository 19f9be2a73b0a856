//! Force bias: F + b: a constant error of the force channel along the coordinate.

use super::{Kind, Law, MAX_PARAMETERS, Motion, ParameterSpec};

/// Force bias; equation and sign in the module's head.
#[derive(Clone, Copy, Debug)]
pub struct ForceBias;

static PARAMETERS: [ParameterSpec; 1] =
    [ParameterSpec { name: "b", unit: "N", unit_angular: "N m", bounds: (f64::NEG_INFINITY, f64::INFINITY) }];

impl Law for ForceBias {
    fn id(&self) -> &'static str {
        "force-bias"
    }

    fn kind(&self) -> Kind {
        Kind::Instrument
    }

    fn title(&self) -> &'static str {
        "Force bias"
    }

    fn parameters(&self) -> &'static [ParameterSpec] {
        &PARAMETERS
    }

    fn regressor(&self, _motion: &Motion, columns: &mut [f64; MAX_PARAMETERS]) {
        columns[0] = 1.0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_effect() {
        let motion = Motion::default();
        let mut values = [0.0; MAX_PARAMETERS];
        values[..1].copy_from_slice(&[-3.2]);
        assert!((ForceBias.force(&motion, &values) - (-3.2)).abs() < 1e-12);
    }
}
