//! A drift of the force channel as a hypothesis: it goes on, or settles with a searched time constant.

use super::candidate::Candidate;
use super::dictionary::Dictionary;
use super::grid::{Near, Point, Ranges};
use super::hypothesis::{About, Hypothesis};
use super::relations::{Form, Over, Relation};
use super::sensor_fault::{SensorFault, add_each, add_halved};
use super::variable::Variable;
use crate::diagnose::data::regression_data::Place;
use haptics::Vec2;
use haptics::law::{Effect, ForceDrift, Kind};

pub(crate) const ID: &str = "force-drift";

/// Points: time constant.
const SETTLING: &str = "time constant";

impl Hypothesis for ForceDrift {
    fn about(&self) -> About {
        About {
            id: ID,
            form: Form::Exact(&[Over::Time]),
            relations: &[Relation::Settles, Relation::NeedsForce],
            seen: Variable::Time,
            ..About::PLAIN
        }
    }

    fn coarse(&self, ranges: &Ranges<'_>) -> Vec<Point> {
        ranges.settling().map(|tau| Point::one(SETTLING, tau)).collect()
    }

    fn around(&self, near: &Near<'_>) -> Vec<Point> {
        near.settling().into_iter().map(|tau| Point::one(SETTLING, tau)).collect()
    }

    fn candidates(&self, data: &Dictionary<'_>) -> Vec<Candidate> {
        let settles = data.points(ID, SETTLING).map(|[tau, ..]| drift(data, tau).at("tau", tau, "s"));
        std::iter::once(drift(data, 0.0)).chain(settles).collect()
    }

    fn add_to_fault(&self, fault: &mut SensorFault, candidate: &Candidate, values: &[f64]) -> bool {
        fault.settles_s = candidate.searched.first().map_or(0.0, |s| s.value);
        add_each(candidate, values, |name, value| {
            if name == "rate" {
                fault.drift_along_per_s = value;
                return true;
            }
            add_halved(&mut fault.drift_n_s, ["rx", "ry"], name, value)
        })
    }
}

/// Drift that settles with a time constant, or never, if that is zero.
fn drift(data: &Dictionary<'_>, tau: f64) -> Candidate {
    let effect = Effect::new(&ForceDrift, &[1.0, tau]);
    if data.track.planar {
        let of = |axis: Vec2| data.every(&|r| r.along.dot(&axis) * effect.force(&r.motion));
        let columns = vec![of(Vec2::x()), of(Vec2::y())];
        return Candidate::several(ID, Kind::Instrument, columns, vec![("rx", "N/s"), ("ry", "N/s")]);
    }
    let held = data.every(&|r| if r.place == Place::Along { effect.force(&r.motion) } else { 0.0 });
    Candidate::one(ID, Kind::Instrument, "rate", data.unit(&ForceDrift, 0), held)
}
