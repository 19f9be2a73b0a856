//! Stribeck friction: (Fs − Fc) exp(−(|v|/vs)^α) sgn(v) (Stribeck 1902, in the form of Bo & Pavelescu 1982). dFs = Fs −
//! Fc ≥ 0 is the excess of the static level over the Coulomb level of the effect beside it. exponential (1947);
//! measured ones lie between 0.5 and 2 (Armstrong-Hélouvry et al. 1994). vs = 0: friction of rest alone. Holds at rest.

use super::entry::{Entry, Kind, POSITIVE, ParameterSpec};
use super::force_law::{Law, MAX_PARAMETERS, Motion, Role};

/// Stribeck friction; equation and sign in the module's head.
#[derive(Clone, Copy, Debug)]
pub struct Stribeck;

static ENTRY: Entry = Entry {
    id: "stribeck",
    kind: Kind::Plant,
    title: "Stribeck friction",
    equation: "(Fs − Fc) exp(−(|v|/vs)^α) sgn(v)",
    what: "Friction that falls from its static level to the Coulomb level as the motion gets faster.",
    shows: "As a peak of force at every start and as stick-slip of a soft drive.",
    mimics: "Coulomb friction mimics it in slow motion and in small fast strokes, quadratic drag or a falling viscous \
             slope over a narrow range of speeds, presliding friction at reversals.",
    reveals: "Very slow and fast motion in one recording reveals it.",
    parameters: &[
        ParameterSpec::linear("dFs", "N", "N m", POSITIVE),
        ParameterSpec::nonlinear("vs", "m/s", "rad/s", POSITIVE),
        ParameterSpec::nonlinear("alpha", "1", "1", POSITIVE),
    ],
};

/// exp(−(v/vs)²); for vs = 0 one at rest and zero in motion.
pub(super) fn falling(velocity: f64, vs: f64) -> f64 {
    falling_by(velocity, vs, 0.0)
}

/// exp(−(|v|/vs)^α); α = 0 stands for 2.
fn falling_by(velocity: f64, vs: f64, alpha: f64) -> f64 {
    if vs > 0.0 {
        let ratio = velocity.abs() / vs;
        let power = if alpha > 0.0 { ratio.powf(alpha) } else { ratio * ratio };
        (-power).exp()
    } else {
        f64::from(velocity == 0.0)
    }
}

impl Law for Stribeck {
    fn entry(&self) -> &'static Entry {
        &ENTRY
    }

    fn role(&self) -> Role {
        Role::Dry
    }

    fn force(&self, motion: &Motion, parameters: &[f64; MAX_PARAMETERS]) -> f64 {
        parameters[0] * falling_by(motion.velocity, parameters[1], parameters[2]) * motion.direction
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_effect() {
        // Coulomb 0.3 N beside it; at v = vs the total is Fc + (Fs − Fc)/e with Fs = 0.8 N.
        let motion = Motion { direction: 1.0, velocity: 0.02, ..Motion::default() };
        let mut values = [0.0; MAX_PARAMETERS];
        values[..2].copy_from_slice(&[0.5, 0.02]);
        let expected = 0.5 / std::f64::consts::E;
        assert!((Stribeck.force(&motion, &values) - expected).abs() < 1e-12);
        let rest = Motion { velocity: 0.0, ..motion };
        assert_eq!(Stribeck.force(&rest, &values), 0.5);
        // With α = 1 it falls by e again at twice the speed, where the Gaussian has fallen by e³.
        let twice = Motion { velocity: -0.04, direction: -1.0, ..motion };
        values[2] = 1.0;
        assert!((Stribeck.force(&twice, &values) + 0.5 * (-2.0_f64).exp()).abs() < 1e-12);
        values[2] = 2.0;
        assert!((Stribeck.force(&twice, &values) + 0.5 * (-4.0_f64).exp()).abs() < 1e-12);
    }
}
