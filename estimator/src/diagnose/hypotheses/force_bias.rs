//! A bias of the force channel as a hypothesis.

use super::candidate::Candidate;
use super::dictionary::Dictionary;
use super::hypothesis::{About, Hypothesis};
use super::relations::Relation;
use super::sensor_fault::{SensorFault, add_each, add_halved};
use super::variable::Variable;
use crate::diagnose::data::regression_data::{Place, Zero};
use haptics::Vec2;
use haptics::law::{Effect, ForceBias, Kind};

pub(crate) const ID: &str = "force-bias";

impl Hypothesis for ForceBias {
    fn about(&self) -> About {
        About { id: ID, relations: &[Relation::NeedsForce], ..About::PLAIN }
    }

    fn candidates(&self, data: &Dictionary<'_>) -> Vec<Candidate> {
        let bias = Effect::new(&ForceBias, &[1.0]);
        if data.track.planar {
            let of = |axis: Vec2| data.every(&|r| r.along.dot(&axis) * bias.force(&r.motion));
            let columns = vec![of(Vec2::x()), of(Vec2::y())];
            return vec![Candidate::several(ID, Kind::Instrument, columns, vec![("bx", "N"), ("by", "N")])];
        }
        if data.track.zero == Zero::OfThePlant {
            return Vec::new();
        }
        let held = data.every(&|r| if r.place == Place::Along { bias.force(&r.motion) } else { 0.0 });
        vec![Candidate::one(ID, Kind::Instrument, "b", data.units().force, held)]
    }

    fn best_seen_against(&self, planar: bool) -> Variable {
        if planar { Variable::Place } else { Variable::Time }
    }

    fn add_to_fault(&self, fault: &mut SensorFault, candidate: &Candidate, values: &[f64]) -> bool {
        add_each(candidate, values, |name, value| {
            if name == "b" {
                fault.offset_along = value;
                return true;
            }
            add_halved(&mut fault.offset_n, ["bx", "by"], name, value)
        })
    }
}
