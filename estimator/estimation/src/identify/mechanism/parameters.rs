//! The terms of the base model: the law, the name of the parameter, and the regressor of each.

use super::signals::Piece;
use super::zero_step::force_at;
use foundation::signal::derive::central_differences;
use haptics::law::{
    Coordinate, CoulombFriction, EccentricMass, ForceBias, Inertia, Law, MAX_PARAMETERS, Motion, ReturnSpring,
    ViscousFriction,
};
use haptics::recording::Meta;

/// Relative error of the clock of a recording: 100 ppm, the usual tolerance of an uncompensated quartz.
/// Choice: halved or doubled, none of 5 answers changes.
pub const CLOCK_TOLERANCE: f64 = 1e-4;

/// One regressor of the fit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Term {
    /// Mass or moment of inertia.
    Inertia,
    /// Viscous friction.
    Viscous,
    /// Coulomb friction.
    Coulomb,
    /// Constant force; stands for all of the resistance when a free motion never reverses.
    Offset,
    /// Gravity moment, part that vanishes at hanging.
    GravitySine,
    /// Gravity moment, part that is largest there.
    GravityCosine,
    /// A spring: only ever a rival of the gravity moment.
    Spring,
    /// The steps of a segment's force channel, in shares of [`Piece::zero_steps`]: 1 if their sizes are right.
    ZeroStep,
    /// The time by which the force lags behind the motion, s, where [`Piece::is_late`].
    Delay,
}

impl Term {
    /// The law behind the column and the index of its parameter; `None` for a defect of the force channel.
    pub fn law(self) -> Option<(&'static dyn Law, usize)> {
        Some(match self {
            Self::Inertia => (&Inertia, 0),
            Self::Viscous => (&ViscousFriction, 0),
            Self::Coulomb => (&CoulombFriction, 0),
            Self::Offset => (&ForceBias, 0),
            Self::GravitySine => (&EccentricMass, 0),
            Self::GravityCosine => (&EccentricMass, 1),
            Self::Spring => (&ReturnSpring, 0),
            Self::ZeroStep | Self::Delay => return None,
        })
    }

    /// Name in the results; the two gravity parts are reported as moment and phase.
    pub fn name(self, coordinate: Coordinate) -> &'static str {
        let linear = coordinate == Coordinate::Linear;
        match self {
            Self::Inertia if linear => "mass_kg",
            Self::Inertia => "inertia_kg_m2",
            Self::Viscous if linear => "viscous_N_s_m",
            Self::Viscous => "viscous_Nm_s",
            Self::Coulomb if linear => "coulomb_N",
            Self::Coulomb => "coulomb_Nm",
            Self::Offset if linear => "offset_N",
            Self::Offset => "offset_Nm",
            Self::GravitySine | Self::GravityCosine => "gravity_moment_Nm",
            Self::Spring => "stiffness",
            Self::ZeroStep => "zero_step",
            Self::Delay => "delay_s",
        }
    }

    /// The law's regressor at one instant.
    pub fn regressor(self, motion: &Motion) -> f64 {
        let Some((law, index)) = self.law() else { return 0.0 };
        let mut columns = [0.0; MAX_PARAMETERS];
        law.regressor(motion, &mut columns);
        columns[index]
    }

    /// The power of 1/time in the ratio of this term to the inertia: the effect of a wrong clock on it.
    pub fn powers_of_time(self) -> f64 {
        match self {
            Self::Inertia => 0.0,
            Self::Viscous => 1.0,
            _ => 2.0,
        }
    }

    /// Sensitivity of the regressor to small errors of position, velocity and acceleration. The sign of the motion is
    /// left out: its errors are weighted down instead.
    pub fn slopes(self, position: f64) -> [f64; 3] {
        match self {
            Self::Inertia => [0.0, 0.0, 1.0],
            Self::Viscous => [0.0, 1.0, 0.0],
            Self::Coulomb | Self::Offset | Self::ZeroStep | Self::Delay => [0.0; 3],
            Self::GravitySine => [position.cos(), 0.0, 0.0],
            Self::GravityCosine => [-position.sin(), 0.0, 0.0],
            Self::Spring => [1.0, 0.0, 0.0],
        }
    }

    /// The regressor along a segment, filtered like the force: functions of filtered motion are filtered already, the
    /// sign of the motion is not.
    pub fn column(self, piece: &Piece) -> Vec<f64> {
        match self {
            Self::ZeroStep => {
                let force = |time_s| force_at(&piece.zero_steps, time_s);
                return piece.filter(&piece.times_s().map(force).collect::<Vec<f64>>());
            }
            Self::Delay if piece.is_late => {
                let times_s: Vec<f64> = piece.times_s().collect();
                return central_differences(&times_s, &piece.applied_force()).iter().map(|rate| -rate).collect();
            }
            _ => {}
        }
        let at = |(motion, &direction): (&Motion, &f64)| self.regressor(&Motion { direction, ..*motion });
        let column: Vec<f64> = piece.motion.iter().zip(&piece.direction).map(at).collect();
        if self == Self::Coulomb { piece.filter(&column) } else { column }
    }
}

/// Parameters that the sidecar states about the mechanism: not to be estimated.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Known {
    /// Terms with their values.
    pub values: Vec<(Term, f64)>,
}

impl Known {
    /// Reads `known`: the names of the results, or `mass_kg` and `com_m` of a pendulum for its gravity moment.
    pub fn from_meta(meta: &Meta, coordinate: Coordinate) -> Self {
        let get = |name: &str| meta.known.get(name).copied().filter(|v| v.is_finite());
        let mut values = Vec::new();
        for term in [Term::Inertia, Term::Viscous, Term::Coulomb, Term::Offset] {
            if let Some(value) = get(term.name(coordinate)) {
                values.push((term, value));
            }
        }
        if coordinate == Coordinate::Angular {
            let mass_and_arm = get("mass_kg").zip(get("com_m")).map(|(m, r)| m * r * meta.gravity());
            if let Some(moment) = get("gravity_moment_Nm").or(mass_and_arm) {
                let phase = get("gravity_phase_rad").unwrap_or(0.0);
                values.push((Term::GravitySine, moment * phase.cos()));
                values.push((Term::GravityCosine, -moment * phase.sin()));
            }
        }
        Self { values }
    }

    /// The value of a term, when it is known.
    pub fn value(&self, term: Term) -> Option<f64> {
        self.values.iter().find(|(t, _)| *t == term).map(|(_, v)| *v)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mass_and_arm_make_a_gravity_moment_only_for_an_angle() {
        let meta: Meta =
            serde_json::from_str(r#"{"known":{"mass_kg":0.5,"com_m":0.2},"gravity_m_s2":10}"#).expect("meta");
        let known = Known::from_meta(&meta, Coordinate::Angular);
        assert_eq!(known.value(Term::GravitySine), Some(1.0));
        assert_eq!(known.value(Term::Inertia), None, "the mass of a pendulum is not its inertia");
        assert_eq!(Known::from_meta(&meta, Coordinate::Linear).values, [(Term::Inertia, 0.5)]);
    }

    #[test]
    fn the_columns_are_the_laws() {
        let motion = Motion { velocity: 2.0, acceleration: 3.0, direction: -1.0, position: 0.5, ..Motion::default() };
        let all = [Term::Inertia, Term::Viscous, Term::Coulomb, Term::Offset].map(|t| t.regressor(&motion));
        assert_eq!(all, [3.0, 2.0, -1.0, 1.0]);
        assert_eq!(Term::GravitySine.regressor(&motion), 0.5_f64.sin());
    }
}
