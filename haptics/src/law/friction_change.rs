//! Changing friction: Fc(p) sgn(v), Fc(p) = from + (to − from) p. With time (warm-up) p = 1 − exp(−(t − t0)/tau); with
//! a positive `length`, p = 1 − exp(−travel/length) with the travel (running in, wear). from ≥ 0, to ≥ 0. tau = 0 is a
//! step at t0; from = to is Coulomb friction. The memory is the travel. It adds to the friction beside it.

use super::entry::{ANY, Entry, Kind, POSITIVE, ParameterSpec};
use super::force_law::{Law, MAX_PARAMETERS, Motion, Role};
use super::memory::Memory;

/// Changing friction; equation and sign in the module's head.
#[derive(Clone, Copy, Debug)]
pub struct FrictionChange;

static ENTRY: Entry = Entry {
    id: "friction-change",
    kind: Kind::Plant,
    title: "Changing friction",
    equation: "(from + (to − from) p) sgn(v)",
    what: "Friction that changes with time or travel: grease that warms, a bearing that runs in, a surface that wears.",
    shows: "As steps at reversals that grow or shrink over the recording.",
    mimics: "Drift of the force mimics it where the motion never reverses, a local resistance where a place is passed \
             once.",
    reveals: "A long recording with reversals throughout reveals it.",
    parameters: &[
        ParameterSpec::linear("from", "N", "N m", POSITIVE),
        ParameterSpec::linear("to", "N", "N m", POSITIVE),
        ParameterSpec::nonlinear("tau", "s", "s", POSITIVE),
        ParameterSpec::nonlinear("t0", "s", "s", ANY),
        ParameterSpec::nonlinear("length", "m", "rad", POSITIVE),
    ],
};

impl Law for FrictionChange {
    fn entry(&self) -> &'static Entry {
        &ENTRY
    }

    fn role(&self) -> Role {
        Role::Dry
    }

    fn remembers(&self) -> bool {
        true
    }

    fn force(&self, motion: &Motion, parameters: &[f64; MAX_PARAMETERS]) -> f64 {
        self.force_with(motion, parameters, &[0.0; 2])
    }

    fn force_with(&self, motion: &Motion, parameters: &[f64; MAX_PARAMETERS], memory: &Memory) -> f64 {
        let [from, to, tau_s, start_s, length] = *parameters;
        let since_s = motion.time_s - start_s;
        let progress = if length > 0.0 {
            -(-memory[0] / length).exp_m1()
        } else if tau_s > 0.0 {
            -(-since_s.max(0.0) / tau_s).exp_m1()
        } else {
            f64::from(since_s >= 0.0)
        };
        (from * (1.0 - progress) + to * progress) * motion.direction
    }

    fn advance(&self, motion: &Motion, _parameters: &[f64; MAX_PARAMETERS], memory: &mut Memory, dt_s: f64) {
        memory[0] = (memory[0] + (motion.velocity * dt_s).abs()).min(f64::MAX);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_effect() {
        // One time constant after t0: 1 + (0.4 − 1)(1 − 1/e) N; the same after one length of travel, there and back.
        let expected = 1.0 - 0.6 * (1.0 - (-1.0_f64).exp());
        let motion = Motion { time_s: 35.0, direction: -1.0, ..Motion::default() };
        assert!((FrictionChange.force(&motion, &[1.0, 0.4, 30.0, 5.0, 0.0]) + expected).abs() < 1e-12);
        let (values, mut memory) = ([1.0, 0.4, 0.0, 0.0, 0.5], [0.0; 2]);
        for velocity in [0.25, -0.25] {
            FrictionChange.advance(&Motion { velocity, ..motion }, &values, &mut memory, 1.0);
        }
        assert!((FrictionChange.force_with(&motion, &values, &memory) + expected).abs() < 1e-12);
    }
}
