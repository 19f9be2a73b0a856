//! Force drift: F + r t, or F + r τ (1 − exp(−t/τ)) if the sensor settles: a slow error of the force channel along the
//! coordinate. r = 0 is none, τ = 0 never settles.

use super::entry::{ANY, Entry, Kind, POSITIVE, ParameterSpec};
use super::force_law::{Law, MAX_PARAMETERS, Motion, Role};
use super::mass_change::settling;

/// Force drift; equation and sign in the module's head.
#[derive(Clone, Copy, Debug)]
pub struct ForceDrift;

static ENTRY: Entry = Entry {
    id: "force-drift",
    kind: Kind::Instrument,
    title: "Force drift",
    equation: "F + r t, or F + r τ (1 − exp(−t/τ))",
    what: "The zero of the force sensor moves, mostly with temperature.",
    shows: "As a slope in time, also in free motion.",
    mimics: "A leaking weight mimics it while an object is held, friction that changes where the motion does not \
             reverse.",
    reveals: "Free motion at the start and at the end reveals it.",
    parameters: &[ParameterSpec::linear("rate", "N/s", "N m/s", ANY), ParameterSpec::fixed("tau", "s", "s", POSITIVE)],
};

impl Law for ForceDrift {
    fn entry(&self) -> &'static Entry {
        &ENTRY
    }

    fn role(&self) -> Role {
        Role::Smooth
    }

    fn regressor(&self, motion: &Motion, columns: &mut [f64; MAX_PARAMETERS]) {
        columns[0] = motion.time_s;
    }

    fn force(&self, motion: &Motion, parameters: &[f64; MAX_PARAMETERS]) -> f64 {
        let [rate, tau_s, ..] = *parameters;
        rate * settling(motion.time_s, tau_s)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_effect() {
        let motion = Motion { time_s: 20.0, ..Motion::default() };
        let mut values = [0.0; MAX_PARAMETERS];
        values[..1].copy_from_slice(&[-0.01]);
        assert!((ForceDrift.force(&motion, &values) - (-0.2)).abs() < 1e-12);
    }
}
