//! Cable: k max(L − L0, 0) dL/dq, L² = R² + A² − 2 R A cos(q/R − φ). It is an elastic cable between a crank's handle,
//! on a circle of radius R about the axis, and an anchor at the distance A from the axis in the direction φ. It pulls
//! when it is longer than L0 and never pushes. The coordinate is the handle's path. The `added-constraint` of worlds
//! with a crank that is not one of a place along the path.

use super::added_constraint::AddedConstraint;
use super::entry::{ANY, Entry, Kind, POSITIVE, ParameterSpec};
use super::force_law::{Law, MAX_PARAMETERS, Motion, Role};
use super::memory::Memory;

/// A cable to a crank's handle; equation and sign in the module's head.
#[derive(Clone, Copy, Debug)]
pub struct Cable;

static ENTRY: Entry = Entry {
    id: "cable",
    kind: Kind::Plant,
    title: "Cable to the handle",
    equation: "k max(L − L0, 0) dL/dq",
    what: "An elastic cable from a place beside the crank to its handle, which gets taut on a part of the way round.",
    shows: "As a force in a part of the turn that changes its sign where the cable is longest, the same in both directions.",
    mimics: "Gravity on a mass off the axis mimics it where it is taut nearly everywhere.",
    reveals: "Whole turns reveal it: it is gone on the rest of the way round.",
    parameters: &[
        ParameterSpec::linear("k", "N/m", "N/m", POSITIVE),
        ParameterSpec::nonlinear("L0", "m", "m", POSITIVE),
        ParameterSpec::nonlinear("direction", "rad", "rad", ANY),
        ParameterSpec::nonlinear("distance", "m", "m", POSITIVE),
        ParameterSpec::fixed("R", "m", "m", POSITIVE),
    ],
};

/// Length at a place, m, and its first and second derivative over the path.
fn length_m(motion: &Motion, parameters: &[f64; MAX_PARAMETERS]) -> [f64; 3] {
    let [_, _, direction, distance, radius] = *parameters;
    if radius <= 0.0 {
        return [0.0; 3];
    }
    let (sin, cos) = (motion.position / radius - direction).sin_cos();
    // No direction to pull in exists at the point where handle and anchor meet.
    let length =
        (radius * radius + distance * distance - 2.0 * radius * distance * cos).max(0.0).sqrt().max(f64::MIN_POSITIVE);
    let slope = distance * sin / length;
    [length, slope, (distance * cos / radius - slope * slope) / length]
}

impl Law for Cable {
    fn entry(&self) -> &'static Entry {
        &ENTRY
    }

    fn role(&self) -> Role {
        Role::Stiff
    }

    fn force(&self, motion: &Motion, parameters: &[f64; MAX_PARAMETERS]) -> f64 {
        let [length, slope, _] = length_m(motion, parameters);
        AddedConstraint::cable_n(parameters[0], parameters[1], length) * slope
    }

    fn stiffness(&self, motion: &Motion, parameters: &[f64; MAX_PARAMETERS], _memory: &Memory) -> f64 {
        let [length, slope, bend] = length_m(motion, parameters);
        let stretch = length - parameters[1];
        if stretch > 0.0 { (parameters[0] * (slope * slope + stretch * bend)).max(0.0) } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Effect, Inertia, step_coordinate};
    use super::*;

    /// 40 N/m, slack up to 50 mm, anchored 60 mm to the right of a crank of 20 mm.
    const VALUES: [f64; MAX_PARAMETERS] = [40.0, 0.05, 0.0, 0.06, 0.02];

    fn at(angle_rad: f64) -> Motion {
        Motion { position: 0.02 * angle_rad, ..Motion::default() }
    }

    #[test]
    fn one_effect() {
        // Above the axis it is √(20² + 60²) = 63.2 mm long: 0.530 N, of which 60/63.2 point back along the path.
        let quarter = Cable.force(&at(std::f64::consts::FRAC_PI_2), &VALUES);
        assert!((quarter - 40.0 * (0.004_f64.sqrt() - 0.05) * 0.06 / 0.004_f64.sqrt()).abs() < 1e-12, "{quarter}");
        // On the near side it is slack, and furthest away it pulls across the path.
        assert_eq!(Cable.force(&at(0.2), &VALUES), 0.0);
        assert!(Cable.force(&at(std::f64::consts::PI), &VALUES).abs() < 1e-12);
        assert_eq!(Cable.force(&at(1.0), &[0.0; MAX_PARAMETERS]), 0.0);
    }

    #[test]
    fn the_force_is_the_slope_of_what_it_stores_and_the_stiffness_that_of_the_force() {
        let stored = |angle: f64| {
            let [length, ..] = length_m(&at(angle), &VALUES);
            0.5 * VALUES[0] * (length - VALUES[1]).max(0.0).powi(2)
        };
        let step = 1e-5;
        for k in -31..31 {
            let angle = 0.1 * f64::from(k) + 0.013;
            let slope = |of: &dyn Fn(f64) -> f64| (of(angle + step) - of(angle - step)) / (2.0 * step * 0.02);
            let force = |angle: f64| Cable.force(&at(angle), &VALUES);
            assert!((force(angle) - slope(&stored)).abs() < 1e-6, "{angle}");
            let stiffness = Cable.stiffness(&at(angle), &VALUES, &[0.0; 2]);
            assert!((stiffness - slope(&force).max(0.0)).abs() < 1e-3, "{angle}: {stiffness} {}", slope(&force));
        }
    }

    #[test]
    fn a_stiff_one_never_throws_back_faster() {
        let effects = [Effect::new(&Inertia, &[0.03]), Effect::new(&Cable, &[1e5, 0.05, 0.0, 0.06, 0.02])];
        let mut motion = Motion { velocity: 0.3, ..Motion::default() };
        for _ in 0..2000 {
            (motion.position, motion.velocity) = step_coordinate(&effects, &motion, 0.0, 0.0, 1e-3);
            assert!(motion.velocity.abs() <= 0.301 && motion.position.abs() < 0.03, "{motion:?}");
        }
    }
}
