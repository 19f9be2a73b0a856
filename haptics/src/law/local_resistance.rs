//! Local resistance: F ½ (1 + cos(2π (q − place)/width)) sgn(v) within half a width of the place: a bind, a catch, a burr.
//! F ≥ 0; it resists both ways and holds at rest. A period makes it come again (2π R on a crank's path); 0 is once.
//! width = 0 adds nothing. For a stop that springs back see `added-constraint`.

use super::entry::{Entry, Kind, POSITIVE};
use super::force_law::{Law, MAX_PARAMETERS, Motion, Role};
use super::local_push::{LocalPush, parameters};

/// Local resistance; equation and sign in the module's head.
#[derive(Clone, Copy, Debug)]
pub struct LocalResistance;

static ENTRY: Entry = Entry {
    id: "local-resistance",
    kind: Kind::Plant,
    title: "Local resistance",
    equation: "F hann((q − place)/width) sgn(v)",
    what: "Extra resistance in one range of the motion: a bind, a catch, something that is brushed.",
    shows: "As a hump of force at one place that changes sign with the direction.",
    mimics: "Ripple mimics it when less than a turn is seen, a change of friction with time when the place is passed \
             once.",
    reveals: "Passing the place several times, in both directions, reveals it.",
    parameters: &parameters("F", POSITIVE),
};

impl Law for LocalResistance {
    fn entry(&self) -> &'static Entry {
        &ENTRY
    }

    fn role(&self) -> Role {
        Role::Dry
    }

    fn times_direction(&self) -> Option<&'static dyn Law> {
        Some(&LocalPush)
    }

    fn force(&self, motion: &Motion, parameters: &[f64; MAX_PARAMETERS]) -> f64 {
        LocalPush.force(motion, parameters) * motion.direction
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_effect() {
        // A quarter of a width off the place half of 0.8 N is left; moving back it is −0.4 N; half a width off nothing.
        let mut values = [0.0; MAX_PARAMETERS];
        values[..4].copy_from_slice(&[0.8, 0.05, 0.02, 0.1]);
        let at =
            |position: f64| LocalResistance.force(&Motion { position, direction: -1.0, ..Motion::default() }, &values);
        assert!((at(0.055) + 0.4).abs() < 1e-12 && at(0.061) == 0.0);
        assert!((at(0.255) + 0.4).abs() < 1e-12, "it comes again every 0.1 m");
    }
}
