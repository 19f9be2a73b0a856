//! Changing weight: W(t) (up · t), W(t) = W0 + rate · (time since t0, at most `duration`): a leak, a filling, a lost part.
//! It adds to the `weight` beside it (W0 = 0 then). duration = 0 is without end. The inertia that leaves with the weight is
//! neglected: at g/10 it is a hundredth of the force. rate < 0 loses weight; with tau the rate dies away, as a barrel empties.

use super::entry::{ANY, Entry, Kind, POSITIVE, ParameterSpec};
use super::force_law::{Law, MAX_PARAMETERS, Motion, Role};

/// Changing weight; equation and sign in the module's head.
#[derive(Clone, Copy, Debug)]
pub struct MassChange;

static ENTRY: Entry = Entry {
    id: "mass-change",
    kind: Kind::Plant,
    title: "Changing weight",
    equation: "(W0 + rate (t − t0)) (up · t)",
    what: "The weight changes while it is carried: a leaking barrel.",
    shows: "As a slow change of the vertical force, only while the object is held.",
    mimics: "Drift of the vertical force channel mimics it.",
    reveals: "A phase of free motion at the start and at the end, or a second weight, reveals it.",
    parameters: &[
        ParameterSpec::linear("W0", "N", "N m", ANY),
        ParameterSpec::linear("rate", "N/s", "N m/s", ANY),
        ParameterSpec::nonlinear("t0", "s", "s", ANY),
        ParameterSpec::nonlinear("duration", "s", "s", POSITIVE),
        ParameterSpec::fixed("tau", "s", "s", POSITIVE),
    ],
};

impl Law for MassChange {
    fn entry(&self) -> &'static Entry {
        &ENTRY
    }

    fn role(&self) -> Role {
        Role::Gravity
    }

    fn force(&self, motion: &Motion, parameters: &[f64; MAX_PARAMETERS]) -> f64 {
        let [first, rate, start_s, duration_s, tau_s] = *parameters;
        let since = (motion.time_s - start_s).max(0.0);
        let since = if duration_s > 0.0 { since.min(duration_s) } else { since };
        (first + rate * settling(since, tau_s)) * motion.up_along
    }
}

/// Time integral of a rate that decays with `tau_s` (0: never), s, at a time after its start.
pub(super) fn settling(since_s: f64, tau_s: f64) -> f64 {
    if tau_s > 0.0 { -tau_s * (-since_s / tau_s).exp_m1() } else { since_s }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_effect() {
        // (0.4 N − 0.02 N/s · 5 s, the leak stops) · ½.
        let motion = Motion { time_s: 12.0, up_along: 0.5, ..Motion::default() };
        let mut values = [0.0; MAX_PARAMETERS];
        values[..4].copy_from_slice(&[0.4, -0.02, 2.0, 5.0]);
        assert!((MassChange.force(&motion, &values) - 0.15).abs() < 1e-12);
    }
}
