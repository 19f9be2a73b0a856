//! Local push: P ½ (1 + cos(2π (q − place)/width)) within half a width of the place, whichever way the motion goes: an obstacle that is
//! climbed and left again. P > 0 pushes towards −q (the drive must supply +P). The `local-resistance` of worlds that does not depend on the
//! direction; a period makes it come again (2π R on a crank's path).

use super::entry::{ANY, Entry, Kind, POSITIVE, ParameterSpec};
use super::force_law::{Law, MAX_PARAMETERS, Motion, Role};

/// Local push; equation and sign in the module's head.
#[derive(Clone, Copy, Debug)]
pub struct LocalPush;

static ENTRY: Entry = Entry {
    id: "local-push",
    kind: Kind::Plant,
    title: "Local push",
    equation: "P hann((q − place)/width)",
    what: "A force at one place that is the same in both directions: an obstacle, a spring catch.",
    shows: "As a hump of force at one place that does not change its sign with the direction.",
    mimics: "Ripple and springs mimic it when only a part of the way round is seen.",
    reveals: "Passing the place several times, in both directions, reveals it.",
    parameters: &parameters("P", ANY),
};

impl Law for LocalPush {
    fn entry(&self) -> &'static Entry {
        &ENTRY
    }

    fn role(&self) -> Role {
        Role::Smooth
    }

    fn force(&self, motion: &Motion, parameters: &[f64; MAX_PARAMETERS]) -> f64 {
        let [push, place, width, period, ..] = *parameters;
        push * hump(motion.position - place, width, period)
    }
}

/// Parameters of a hump of force at one place: its height, under the name and within the bounds given, where it is, how wide, and how
/// often it comes.
pub(super) const fn parameters(name: &'static str, bounds: (f64, f64)) -> [ParameterSpec; 4] {
    [
        ParameterSpec::linear(name, "N", "N m", bounds),
        ParameterSpec::nonlinear("place", "m", "rad", ANY),
        ParameterSpec::nonlinear("width", "m", "rad", POSITIVE),
        ParameterSpec::fixed("period", "m", "rad", POSITIVE),
    ]
}

/// A hump of height one and this width around zero, which comes again with a period (0: never).
pub(super) fn hump(off: f64, width: f64, period: f64) -> f64 {
    let off = if period > 0.0 { off - period * (off / period).round() } else { off };
    if off.abs() < 0.5 * width { 0.5 * (1.0 + (std::f64::consts::TAU * off / width).cos()) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_effect() {
        // A quarter of a width off the place half of 0.8 N is left, both ways; half a width off nothing.
        let mut values = [0.0; MAX_PARAMETERS];
        values[..4].copy_from_slice(&[0.8, 0.05, 0.02, 0.1]);
        for direction in [-1.0, 1.0] {
            let at = |position: f64| LocalPush.force(&Motion { position, direction, ..Motion::default() }, &values);
            assert!((at(0.055) - 0.4).abs() < 1e-12 && at(0.061) == 0.0);
            assert!((at(0.255) - 0.4).abs() < 1e-12, "it comes again every 0.1 m");
        }
    }
}
