//! An eccentric mass as a hypothesis: gravity that the model does not have.

use super::candidate::Candidate;
use super::dictionary::Dictionary;
use super::gravity_tilt;
use super::hypothesis::{About, Found, Hypothesis};
use super::relations::{Form, Over, Relation};
use haptics::law::{EccentricMass, Effect, Kind};

pub(crate) const ID: &str = "eccentric-mass";

impl Hypothesis for EccentricMass {
    fn about(&self) -> About {
        About {
            id: ID,
            form: Form::Exact(&[Over::Place]),
            relations: &[Relation::SameAs(
                gravity_tilt::ID,
                "on one crank gravity on a mass off the axis and a tilted plane are the same force",
            )],
            ..About::PLAIN
        }
    }

    /// Across the arm's weight; for an angle without any gravity in the model, both parts.
    fn candidates(&self, data: &Dictionary<'_>) -> Vec<Candidate> {
        let Some(radius) = data.track.radius_m else { return Vec::new() };
        let part = |values: &[f64]| data.law_of_place(&EccentricMass, values);
        let (mut columns, mut linear) = (vec![part(&[1.0, 0.0, radius])], vec![("a", data.units().force)]);
        if !data.track.planar {
            columns.push(part(&[0.0, 1.0, radius]));
            linear.push(("b", data.units().force));
        }
        vec![Candidate::of(ID, Kind::Plant, columns, linear)]
    }

    fn effects(&self, found: &Found<'_>) -> Vec<Effect> {
        vec![Effect::new(&EccentricMass, &[found.value(0), found.value(1), found.radius_m()])]
    }
}
