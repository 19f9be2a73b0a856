//! Eccentric mass: a sin θ + b cos θ, θ = q/R: gravity on a mass off the axis, out of phase with the handle.
//! For θ measured from hanging, a alone is the gravity moment m g r. R is the path of one radian: 1 (or 0, unset) when the
//! coordinate q is the angle itself, the arm's length when it is the path length of a crank's handle.

use super::entry::{ANY, Entry, Kind, POSITIVE, ParameterSpec};
use super::force_law::{Law, MAX_PARAMETERS, Motion, Role};

/// Eccentric mass; equation and sign in the module's head.
#[derive(Clone, Copy, Debug)]
pub struct EccentricMass;

static ENTRY: Entry = Entry {
    id: "eccentric-mass",
    kind: Kind::Plant,
    title: "Eccentric mass",
    equation: "a sin θ + b cos θ",
    what: "Gravity on a mass off the axis that is not where the handle is.",
    shows: "As a sine of the angle, once a turn, with a phase of its own.",
    mimics: "The weight of the handle, a tilt and, over a short arc, a spring mimic it. In a free swing only its ratio \
             to the inertia is seen.",
    reveals: "A full turn with a free phase for the bias reveals it.",
    parameters: &[
        ParameterSpec::linear("a", "N", "N m", ANY),
        ParameterSpec::linear("b", "N", "N m", ANY),
        ParameterSpec::fixed("R", "m", "1", POSITIVE),
    ],
};

/// Angle at a coordinate whose path of one radian is `per_radian` (0: the coordinate is the angle).
fn angle(position: f64, per_radian: f64) -> f64 {
    if per_radian > 0.0 { position / per_radian } else { position }
}

impl Law for EccentricMass {
    fn entry(&self) -> &'static Entry {
        &ENTRY
    }

    fn role(&self) -> Role {
        Role::Smooth
    }

    fn regressor(&self, motion: &Motion, columns: &mut [f64; MAX_PARAMETERS]) {
        let (sin, cos) = motion.position.sin_cos();
        columns[0] = sin;
        columns[1] = cos;
    }

    fn force(&self, motion: &Motion, parameters: &[f64; MAX_PARAMETERS]) -> f64 {
        let (sin, cos) = angle(motion.position, parameters[2]).sin_cos();
        parameters[0] * sin + parameters[1] * cos
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

    #[test]
    fn on_a_path_of_radius_r() {
        // A crank of 22 mm after a third of a right angle along its path: 2 N sin 30° = 1 N.
        let motion = Motion { position: 0.022 * std::f64::consts::FRAC_PI_6, ..Motion::default() };
        assert!((EccentricMass.force(&motion, &[2.0, 0.0, 0.022, 0.0, 0.0]) - 1.0).abs() < 1e-12);
    }
}
