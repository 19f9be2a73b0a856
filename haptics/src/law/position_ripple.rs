//! Position ripple: A cos(2π q/λ + φ): cogging, gear teeth, an uneven guide. n ripples a turn of radius R: λ = 2π R/n, or 2π/n for
//! an angle. λ = 0 (unset) adds nothing. A cos φ and −A sin φ are the two linear regressors at φ = 0 and φ = π/2.

use super::entry::{ANY, Entry, Kind, POSITIVE, ParameterSpec};
use super::force_law::{Law, MAX_PARAMETERS, Motion, Role};

/// Position ripple; equation and sign in the module's head.
#[derive(Clone, Copy, Debug)]
pub struct PositionRipple;

static ENTRY: Entry = Entry {
    id: "position-ripple",
    kind: Kind::Plant,
    title: "Position ripple",
    equation: "A cos(2π q/λ + φ)",
    what: "A force that repeats along the way: cogging, teeth, a bent guide.",
    shows: "As a wave over position that stays in place whatever the speed and direction.",
    mimics: "A local obstacle mimics it over a short range, an eccentric mass when it repeats once a turn, vibration \
             of the drive at one constant speed.",
    reveals: "Several full periods at two speeds reveal it.",
    parameters: &[
        ParameterSpec::linear("A", "N", "N m", ANY),
        ParameterSpec::nonlinear("lambda", "m", "rad", POSITIVE),
        ParameterSpec::nonlinear("phi", "rad", "rad", (-3.2, 3.2)),
    ],
};

impl Law for PositionRipple {
    fn entry(&self) -> &'static Entry {
        &ENTRY
    }

    fn role(&self) -> Role {
        Role::Smooth
    }

    fn force(&self, motion: &Motion, parameters: &[f64; MAX_PARAMETERS]) -> f64 {
        if parameters[1] > 0.0 {
            parameters[0] * (std::f64::consts::TAU * motion.position / parameters[1] + parameters[2]).cos()
        } else {
            0.0
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_effect() {
        // 12 mm are one period of 10 mm and a fifth: 0.3 cos 72°.
        let motion = Motion { position: 0.012, ..Motion::default() };
        let mut values = [0.0; MAX_PARAMETERS];
        values[..3].copy_from_slice(&[0.3, 0.01, 0.0]);
        assert!((PositionRipple.force(&motion, &values) - 0.3 * (0.4 * std::f64::consts::PI).cos()).abs() < 1e-12);
    }
}
