//! Direction-dependent friction: half differences of Fc, c and mu between the two directions: positive motion meets Fc + dFc,
//! negative motion Fc − dFc (and c ± dc, mu ± dmu). dFc therefore acts as a constant while the coordinate moves and vanishes
//! at rest. Needs friction beside it: the sum of both stays ≥ 0.

use super::entry::{ANY, Entry, Kind, ParameterSpec};
use super::force_law::{Law, MAX_PARAMETERS, Motion, Role};

/// Direction-dependent friction; equation and sign in the module's head.
#[derive(Clone, Copy, Debug)]
pub struct FrictionAsymmetry;

static ENTRY: Entry = Entry {
    id: "friction-asymmetry",
    kind: Kind::Plant,
    title: "Direction-dependent friction",
    equation: "(dFc + dc abs(v) + dmu abs(Fn)) abs(sgn(v))",
    what: "Friction that is larger in one direction than in the other: a ratchet, a worn thread, a lip seal.",
    shows: "As a constant offset while the object moves, which is gone at rest.",
    mimics: "A force bias and a tilt mimic it; for dmu an error across the axes of the force sensor is identical \
             unless the load changes its sign.",
    reveals: "Reversals, rests at different places and a free phase reveal it.",
    parameters: &[
        ParameterSpec::linear("dFc", "N", "N m", ANY),
        ParameterSpec::linear("dc", "N s/m", "N m s", ANY),
        ParameterSpec::linear("dmu", "1", "1", ANY),
    ],
};

impl Law for FrictionAsymmetry {
    fn entry(&self) -> &'static Entry {
        &ENTRY
    }

    fn role(&self) -> Role {
        Role::Dry
    }

    fn feels_load(&self) -> bool {
        true
    }

    fn regressor(&self, motion: &Motion, columns: &mut [f64; MAX_PARAMETERS]) {
        let moving = motion.direction.abs();
        columns[0] = moving;
        columns[1] = motion.velocity.abs() * moving;
        columns[2] = motion.normal_force_n.abs() * moving;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_effect() {
        // 0.1 + 0.2 · 2 + 0.05 · 3.
        let motion = Motion { direction: -1.0, velocity: -2.0, normal_force_n: -3.0, ..Motion::default() };
        let mut values = [0.0; MAX_PARAMETERS];
        values[..3].copy_from_slice(&[0.1, 0.2, 0.05]);
        assert!((FrictionAsymmetry.force(&motion, &values) - 0.65).abs() < 1e-12);
    }
}
