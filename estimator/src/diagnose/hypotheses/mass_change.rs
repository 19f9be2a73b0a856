//! A change of mass as a hypothesis, if the recording has a load: a leak that may settle, or a step.

use super::candidate::Candidate;
use super::dictionary::Dictionary;
use super::grid::{Near, Point, Ranges};
use super::hypothesis::{About, Found, Hypothesis};
use super::relations::{Form, Over, Relation};
use super::variable::Variable;
use haptics::law::{Effect, Kind, Law as _, MassChange, Weight};

pub(crate) const ID: &str = "mass-change";

/// Points: time constant.
const SETTLING: &str = "time constant";
/// Points: start time of a step.
const STARTS: &str = "start";

impl Hypothesis for MassChange {
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
        let starts = ranges.starts().map(|start| Point::one(STARTS, start));
        ranges.settling().map(|tau| Point::one(SETTLING, tau)).chain(starts).collect()
    }

    fn around(&self, near: &Near<'_>) -> Vec<Point> {
        let starts = near.starts().into_iter().map(|start| Point::one(STARTS, start));
        near.settling().into_iter().map(|tau| Point::one(SETTLING, tau)).chain(starts).collect()
    }

    fn candidates(&self, data: &Dictionary<'_>) -> Vec<Candidate> {
        if !data.track.planar {
            return Vec::new();
        }
        let leaks = |tau: f64| data.plain(&MassChange, &[0.0, 1.0, 0.0, 0.0, tau], 1);
        let settles = data.points(ID, SETTLING).map(|[tau, ..]| leaks(tau).at("tau", tau, "s"));
        // A step of the weight at `start`.
        let step = |[start, ..]: [f64; 3]| {
            let weight = |r: &crate::diagnose::data::regression_data::Row| {
                if r.motion.time_s >= start { Weight.force(&r.motion, &[1.0, 0.0, 0.0, 0.0, 0.0]) } else { 0.0 }
            };
            let column = data.column(&weight);
            Candidate::one(ID, Kind::Plant, "step", data.units().force, column).at("t0", start, "s")
        };
        [data.plain(&MassChange, &[0.0, 1.0], 1)]
            .into_iter()
            .chain(settles)
            .chain(data.points(ID, STARTS).map(step))
            .collect()
    }

    fn effects(&self, found: &Found<'_>) -> Vec<Effect> {
        let (first, searched) = (found.value(0), found.searched(0));
        if found.is_named("rate") {
            return vec![Effect::new(&MassChange, &[0.0, first, 0.0, 0.0, searched])];
        }
        // A step takes place within a sample.
        let step_s = found.track.period_s;
        vec![Effect::new(&MassChange, &[0.0, first / step_s, searched, step_s])]
    }
}
