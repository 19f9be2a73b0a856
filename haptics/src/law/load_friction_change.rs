//! Changing friction under a load: mu(p) |Fn| sgn(v), with the course p of [`FrictionChange`]. It is friction in
//! proportion to the normal force whose coefficient changes with time or travel. from ≥ 0, to ≥ 0; it adds to the
//! friction beside it. The `friction-change` of worlds with load friction.

use super::entry::{ANY, Entry, Kind, POSITIVE, ParameterSpec};
use super::force_law::{Law, MAX_PARAMETERS, Motion, Role};
use super::friction_change::FrictionChange;
use super::memory::Memory;

/// Changing friction under a load; equation and sign in the module's head.
#[derive(Clone, Copy, Debug)]
pub struct LoadFrictionChange;

static ENTRY: Entry = Entry {
    id: "load-friction-change",
    kind: Kind::Plant,
    title: "Changing friction under a load",
    equation: "(from + (to − from) p) abs(Fn) sgn(v)",
    what: "Friction in proportion to the normal force that changes with time or travel.",
    shows: "As steps at reversals that go with the pull across the motion, and grow or shrink over the recording.",
    mimics: "Drift of the force mimics it where the motion never reverses.",
    reveals: "A long recording with reversals throughout reveals it.",
    parameters: &[
        ParameterSpec::linear("from", "1", "1", POSITIVE),
        ParameterSpec::linear("to", "1", "1", POSITIVE),
        ParameterSpec::nonlinear("tau", "s", "s", POSITIVE),
        ParameterSpec::nonlinear("t0", "s", "s", ANY),
        ParameterSpec::nonlinear("length", "m", "rad", POSITIVE),
    ],
};

impl Law for LoadFrictionChange {
    fn entry(&self) -> &'static Entry {
        &ENTRY
    }

    fn role(&self) -> Role {
        Role::Dry
    }

    fn feels_load(&self) -> bool {
        true
    }

    fn remembers(&self) -> bool {
        true
    }

    fn force(&self, motion: &Motion, parameters: &[f64; MAX_PARAMETERS]) -> f64 {
        motion.normal_force_n.abs() * FrictionChange.force(motion, parameters)
    }

    fn force_with(&self, motion: &Motion, parameters: &[f64; MAX_PARAMETERS], memory: &Memory) -> f64 {
        motion.normal_force_n.abs() * FrictionChange.force_with(motion, parameters, memory)
    }

    fn advance(&self, motion: &Motion, parameters: &[f64; MAX_PARAMETERS], memory: &mut Memory, dt_s: f64) {
        FrictionChange.advance(motion, parameters, memory, dt_s);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_effect() {
        // One time constant after t0, under 3 N: 3 (0.1 + 0.2 (1 − 1/e)) N against the motion.
        let motion = Motion { time_s: 35.0, direction: -1.0, normal_force_n: -3.0, ..Motion::default() };
        let expected = -3.0 * (0.1 + 0.2 * (1.0 - (-1.0_f64).exp()));
        assert!((LoadFrictionChange.force(&motion, &[0.1, 0.3, 30.0, 5.0, 0.0]) - expected).abs() < 1e-12);
    }
}
