//! Tilt of the plane by δ, an error of the assumed vertical: W (cos(φ − δ) − cos φ), with cos φ = up · t of the path
//! and W the carried weight. φ = q/R on a circle (R: path of one radian; 1 if the coordinate is the angle from the
//! horizontal); R = 0 is a straight path. δ counter-clockwise; δ = 0 adds nothing.

use super::entry::{Entry, Kind, POSITIVE, ParameterSpec};
use super::force_law::{Law, MAX_PARAMETERS, Motion, Role};

/// Tilted plane; equation and sign in the module's head.
#[derive(Clone, Copy, Debug)]
pub struct GravityTilt;

static ENTRY: Entry = Entry {
    id: "gravity-tilt",
    kind: Kind::Plant,
    title: "Tilted plane",
    equation: "W (cos(φ − δ) − cos φ)",
    what: "The set-up stands askew, so that gravity points elsewhere in its plane.",
    shows: "As a gravity force with a shifted phase, in proportion to the weight carried.",
    mimics: "An eccentric mass is the same along one circle; a bias of the horizontal force channel mimics it along a \
             line.",
    reveals: "A free phase, a second weight or turning the set-up reveals it.",
    parameters: &[
        ParameterSpec::linear("W", "N", "N m", POSITIVE),
        ParameterSpec::nonlinear("angle", "rad", "rad", (-1.6, 1.6)),
        ParameterSpec::fixed("R", "m", "1", POSITIVE),
    ],
};

impl Law for GravityTilt {
    fn entry(&self) -> &'static Entry {
        &ENTRY
    }

    fn role(&self) -> Role {
        Role::Gravity
    }

    fn force(&self, motion: &Motion, parameters: &[f64; MAX_PARAMETERS]) -> f64 {
        let (cos, sin) = if parameters[2] > 0.0 {
            let (sin, cos) = (motion.position / parameters[2]).sin_cos();
            (cos, sin)
        } else {
            (motion.up_along, (1.0 - motion.up_along * motion.up_along).max(0.0).sqrt())
        };
        let (turn_sin, turn_cos) = parameters[1].sin_cos();
        parameters[0] * (cos * turn_cos + sin * turn_sin - cos)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_effect() {
        // Along a horizontal line a tilt of 30° makes half of 0.4 N act along it; at the top of a circle (φ = 90°) likewise.
        let straight = Motion { up_along: 0.0, ..Motion::default() };
        let tilt = std::f64::consts::FRAC_PI_6;
        assert!((GravityTilt.force(&straight, &[0.4, tilt, 0.0, 0.0, 0.0]) - 0.2).abs() < 1e-12);
        let top = Motion { position: 0.022 * std::f64::consts::FRAC_PI_2, ..Motion::default() };
        assert!((GravityTilt.force(&top, &[0.4, tilt, 0.022, 0.0, 0.0]) - 0.2).abs() < 1e-12);
    }
}
