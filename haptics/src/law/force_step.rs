//! Force step: F + b from the time t0 on: the zero of the force channel jumps and stays. b = 0 is none.

use super::entry::{ANY, Entry, Kind, ParameterSpec};
use super::force_law::{Law, MAX_PARAMETERS, Motion, Role};

/// Force step; equation and sign in the module's head.
#[derive(Clone, Copy, Debug)]
pub struct ForceStep;

static ENTRY: Entry = Entry {
    id: "force-step",
    kind: Kind::Instrument,
    title: "Step of the force channel",
    equation: "F + b from t0 on",
    what: "The zero of the force sensor jumps at one instant: somebody tares it, a knock shifts it, an amplifier resets.",
    shows: "As a jump at one time that stays, also in free motion.",
    mimics: "Drift of the force mimics a small one in a short recording, friction that changes at once where the motion \
             does not reverse.",
    reveals: "Free motion before and after it reveals it.",
    parameters: &[ParameterSpec::linear("step", "N", "N m", ANY), ParameterSpec::nonlinear("t0", "s", "s", ANY)],
};

impl Law for ForceStep {
    fn entry(&self) -> &'static Entry {
        &ENTRY
    }

    fn role(&self) -> Role {
        Role::Smooth
    }

    fn force(&self, motion: &Motion, parameters: &[f64; MAX_PARAMETERS]) -> f64 {
        let [step, start_s, ..] = *parameters;
        if motion.time_s >= start_s { step } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_effect() {
        let at = |time_s| {
            let motion = Motion { time_s, ..Motion::default() };
            let mut values = [0.0; MAX_PARAMETERS];
            values[..2].copy_from_slice(&[-3.1, 21.4]);
            ForceStep.force(&motion, &values)
        };
        assert_eq!([at(21.3), at(21.5), at(40.0)].map(f64::to_bits), [0.0_f64, -3.1, -3.1].map(f64::to_bits));
    }
}
