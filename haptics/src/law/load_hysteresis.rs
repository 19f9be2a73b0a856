//! Presliding friction under a load: F = mu |Fn| z, way dz/ds = 1 − z sgn(v) (Dahl 1968), with the shapes of
//! [`Hysteresis`]. It is friction in proportion to the normal force that bends before it slides. mu ≥ 0; way > 0 is the
//! presliding distance. The memory is z. The `hysteresis` of worlds with load friction.

use super::entry::{Entry, Kind, POSITIVE, ParameterSpec};
use super::force_law::{Law, MAX_PARAMETERS, Motion, Role};
use super::hysteresis::Hysteresis;
use super::memory::Memory;

/// Presliding hysteresis under a load; equation and sign in the module's head.
#[derive(Clone, Copy, Debug)]
pub struct LoadHysteresis;

static ENTRY: Entry = Entry {
    id: "load-hysteresis",
    kind: Kind::Plant,
    title: "Presliding hysteresis under a load",
    equation: "mu abs(Fn) z, way dz/ds = 1 − z sgn(v)",
    what: "Friction in proportion to the normal force that behaves like a spring before it slides.",
    shows: "As rounded corners of the force at reversals, which grow with the pull across the motion.",
    mimics: "Backlash mimics it at one load, a delay or a smoothing filter at one speed.",
    reveals: "Small strokes and reversals under different loads reveal it.",
    parameters: &[
        ParameterSpec::nonlinear("mu", "1", "1", POSITIVE),
        ParameterSpec::nonlinear("way", "m", "rad", POSITIVE),
        ParameterSpec::nonlinear("shape", "1", "1", (0.0, 1.0)),
    ],
};

/// The same law of a friction of one.
fn unit(parameters: &[f64; MAX_PARAMETERS]) -> [f64; MAX_PARAMETERS] {
    [1.0, 1.0 / parameters[1].max(f64::MIN_POSITIVE), parameters[2], 0.0, 0.0]
}

/// The friction when it slides, N.
fn level(motion: &Motion, parameters: &[f64; MAX_PARAMETERS]) -> f64 {
    parameters[0].max(0.0) * motion.normal_force_n.abs()
}

impl Law for LoadHysteresis {
    fn entry(&self) -> &'static Entry {
        &ENTRY
    }

    fn role(&self) -> Role {
        Role::Presliding
    }

    fn feels_load(&self) -> bool {
        true
    }

    fn remembers(&self) -> bool {
        true
    }

    fn force(&self, motion: &Motion, parameters: &[f64; MAX_PARAMETERS]) -> f64 {
        level(motion, parameters) * motion.direction
    }

    fn force_with(&self, motion: &Motion, parameters: &[f64; MAX_PARAMETERS], memory: &Memory) -> f64 {
        level(motion, parameters) * Hysteresis.force_with(motion, &unit(parameters), memory)
    }

    fn stiffness(&self, motion: &Motion, parameters: &[f64; MAX_PARAMETERS], memory: &Memory) -> f64 {
        level(motion, parameters) * Hysteresis.stiffness(motion, &unit(parameters), memory)
    }

    fn advance(&self, motion: &Motion, parameters: &[f64; MAX_PARAMETERS], memory: &mut Memory, dt_s: f64) {
        Hysteresis.advance(motion, &unit(parameters), memory, dt_s);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_effect() {
        // Bent by one way the friction is 1 − 1/e of that of sliding, and follows the load at once.
        let values = [0.2, 1e-3, 0.0, 0.0, 0.0];
        let at = |load_n: f64| Motion { velocity: 1e-3, direction: 1.0, normal_force_n: load_n, ..Motion::default() };
        let mut memory = [0.0; 2];
        LoadHysteresis.advance(&at(5.0), &values, &mut memory, 1.0);
        let bent = 1.0 - (-1.0_f64).exp();
        for load_n in [5.0_f64, -2.0] {
            let slides = 0.2 * load_n.abs();
            assert!((LoadHysteresis.force(&at(load_n), &values) - slides).abs() < 1e-12);
            assert!((LoadHysteresis.force_with(&at(load_n), &values, &memory) - slides * bent).abs() < 1e-12);
            let stiffness = LoadHysteresis.stiffness(&at(load_n), &values, &memory);
            assert!((stiffness - slides * (1.0 - bent) / 1e-3).abs() < 1e-9, "{stiffness}");
        }
    }
}
