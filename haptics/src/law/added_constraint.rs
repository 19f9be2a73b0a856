//! Added constraint: a spring that acts on one side of a place (side = +1: above it, −1: below it) or on both (0): a
//! wall, a stop, a cable. Its force is k max(q − place, 0), −k max(place − q, 0), or k (q − place). k ≥ 0; k = 0 adds
//! nothing. Taken implicitly by the integrator: a hard wall loses some energy at each impact and never makes any.

use super::entry::{ANY, Entry, Kind, POSITIVE, ParameterSpec};
use super::force_law::{Law, MAX_PARAMETERS, Motion, Role};
use super::memory::Memory;

/// Added constraint; equation and sign in the module's head.
#[derive(Clone, Copy, Debug)]
pub struct AddedConstraint;

static ENTRY: Entry = Entry {
    id: "added-constraint",
    kind: Kind::Plant,
    title: "Added constraint",
    equation: "k max(q − place, 0)",
    what: "Something that holds the motion back beyond a place: a wall, a stop, a cable that gets taut.",
    shows: "As a force that rises beyond one place and is gone before it, the same in both directions.",
    mimics: "A hardening spring mimics it where only one side was visited, a local resistance where the place is not \
             left slowly.",
    reveals: "Approaching it slowly and leaving it again reveals it.",
    parameters: &[
        ParameterSpec::linear("k", "N/m", "N m/rad", POSITIVE),
        ParameterSpec::nonlinear("place", "m", "rad", ANY),
        ParameterSpec::fixed("side", "1", "1", (-1.0, 1.0)),
    ],
};

/// Signed distance of the coordinate beyond the place; zero on the free side.
fn beyond(motion: &Motion, parameters: &[f64; MAX_PARAMETERS]) -> f64 {
    let past = motion.position - parameters[1];
    match parameters[2] {
        side if side > 0.0 => past.max(0.0),
        side if side < 0.0 => past.min(0.0),
        _ => past,
    }
}

impl AddedConstraint {
    /// Pull of a cable of `rest_m` at a length, N: the law on its one side.
    pub fn cable_n(stiffness_n_m: f64, rest_m: f64, length_m: f64) -> f64 {
        let motion = Motion { position: length_m, ..Motion::default() };
        Self.force(&motion, &[stiffness_n_m, rest_m, 1.0, 0.0, 0.0])
    }
}

impl Law for AddedConstraint {
    fn entry(&self) -> &'static Entry {
        &ENTRY
    }

    fn role(&self) -> Role {
        Role::Stiff
    }

    fn force(&self, motion: &Motion, parameters: &[f64; MAX_PARAMETERS]) -> f64 {
        parameters[0] * beyond(motion, parameters)
    }

    fn stiffness(&self, motion: &Motion, parameters: &[f64; MAX_PARAMETERS], _memory: &Memory) -> f64 {
        if beyond(motion, parameters) == 0.0 { 0.0 } else { parameters[0] }
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Effect, Inertia, step_coordinate};
    use super::*;

    #[test]
    fn one_effect() {
        // 400 N/m, 5 mm beyond the place: 2 N; before it nothing; from below −2 N.
        let at = |position: f64, side: f64| {
            AddedConstraint.force(&Motion { position, ..Motion::default() }, &[400.0, 0.1, side, 0.0, 0.0])
        };
        assert!((at(0.105, 1.0) - 2.0).abs() < 1e-9 && at(0.095, 1.0) == 0.0);
        assert!((at(0.095, -1.0) + 2.0).abs() < 1e-9 && at(0.105, -1.0) == 0.0);
        assert!((at(0.095, 0.0) + 2.0).abs() < 1e-9);
    }

    #[test]
    fn a_hard_wall_never_throws_back_faster() {
        // 1e6 N/m on 30 g at 1 ms would be unstable by far if it were explicit.
        let effects = [Effect::new(&Inertia, &[0.03]), Effect::new(&AddedConstraint, &[1e6, 0.0, 1.0])];
        let mut motion = Motion { position: -0.01, velocity: 0.3, ..Motion::default() };
        for _ in 0..500 {
            (motion.position, motion.velocity) = step_coordinate(&effects, &motion, 0.0, 0.0, 1e-3);
            assert!(motion.velocity.abs() <= 0.3 && motion.position < 4e-4, "{motion:?}");
        }
    }
}
