//! Return spring: k (q − q0) + k3 (q − q0)³ + f0 (Hooke 1678; hardening as in Duffing 1918). k ≥ 0, k3 ≥ 0. f0 is a preload; with
//! q0 = 0 it carries the spring's rest place as −k q0, which keeps the law linear. k3 = 0 is the linear spring.

use super::entry::{ANY, Entry, Kind, POSITIVE, ParameterSpec};
use super::force_law::{Law, MAX_PARAMETERS, Motion, Role};
use super::memory::Memory;

/// Return spring; equation and sign in the module's head.
#[derive(Clone, Copy, Debug)]
pub struct ReturnSpring;

static ENTRY: Entry = Entry {
    id: "return-spring",
    kind: Kind::Plant,
    title: "Return spring",
    equation: "k (q − q0) + k3 (q − q0)³ + f0",
    what: "A spring towards a rest place.",
    shows: "As a force in proportion to the position, the same in both directions; when it hardens, as a bend of that \
            line.",
    mimics: "An eccentric mass mimics it over a short arc, its own hardening over a short range, a wall where only one \
             side was visited.",
    reveals: "A long range in both directions reveals it.",
    parameters: &[
        ParameterSpec::linear("k", "N/m", "N m/rad", POSITIVE),
        ParameterSpec::linear("f0", "N", "N m", ANY),
        ParameterSpec::linear("k3", "N/m³", "N m/rad³", POSITIVE),
        ParameterSpec::nonlinear("q0", "m", "rad", ANY),
    ],
};

impl Law for ReturnSpring {
    fn entry(&self) -> &'static Entry {
        &ENTRY
    }

    fn role(&self) -> Role {
        Role::Stiff
    }

    fn regressor(&self, motion: &Motion, columns: &mut [f64; MAX_PARAMETERS]) {
        columns[0] = motion.position;
        columns[1] = 1.0;
        columns[2] = motion.position.powi(3);
    }

    fn force(&self, motion: &Motion, parameters: &[f64; MAX_PARAMETERS]) -> f64 {
        let stretch = motion.position - parameters[3];
        (parameters[0] + parameters[2] * stretch * stretch) * stretch + parameters[1]
    }

    fn stiffness(&self, motion: &Motion, parameters: &[f64; MAX_PARAMETERS], _memory: &Memory) -> f64 {
        // The linear part stays explicit: a free swing keeps its amplitude.
        3.0 * parameters[2] * (motion.position - parameters[3]).powi(2)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_effect() {
        let motion = Motion { position: 0.2, ..Motion::default() };
        let mut values = [0.0; MAX_PARAMETERS];
        values[..2].copy_from_slice(&[5.0, -0.5]);
        assert!((ReturnSpring.force(&motion, &values) - 0.5).abs() < 1e-12);
    }

    #[test]
    fn hardening() {
        // 5 · 0.2 + 100 · 0.2³ = 1.8 N, 0.2 m from the rest place at 0.1 m.
        let motion = Motion { position: 0.3, ..Motion::default() };
        assert!((ReturnSpring.force(&motion, &[5.0, 0.0, 100.0, 0.1, 0.0]) - 1.8).abs() < 1e-12);
    }
}
