//! Backlash as a hypothesis: a gap of searched width cuts off the force behind it.

use super::candidate::{Candidate, LEAST_SHARE, Shape};
use super::dictionary::Dictionary;
use super::grid::{Near, Point, Ranges};
use super::hypothesis::{About, Found, Hypothesis};
use super::relations::{Form, Over, Relation};
use crate::diagnose::data::stick_phases;
use haptics::law::{Backlash, Effect, Kind, Law as _};

pub(crate) const ID: &str = "backlash";

/// Points: half gap.
const GAP: &str = "half gap";

impl Hypothesis for Backlash {
    fn about(&self) -> About {
        About {
            id: ID,
            form: Form::Curve(&[Over::Motion, Over::Place]),
            relations: &[Relation::LosesMotion, Relation::NeedsForce],
            ..About::PLAIN
        }
    }

    fn coarse(&self, ranges: &Ranges<'_>) -> Vec<Point> {
        ranges.ways().into_iter().map(|way| Point::one(GAP, way)).collect()
    }

    fn around(&self, near: &Near<'_>) -> Vec<Point> {
        near.ways().into_iter().map(|way| Point::one(GAP, way)).collect()
    }

    fn candidates(&self, data: &Dictionary<'_>) -> Vec<Candidate> {
        data.points(ID, GAP).flat_map(|[way, ..]| behind(data, way)).collect()
    }

    fn effects(&self, found: &Found<'_>) -> Vec<Effect> {
        vec![Effect::new(&Backlash, &[found.searched(0)])]
    }
}

/// A gap cuts off the resisting part of the force, or all of it.
fn behind(data: &Dictionary<'_>, way: f64) -> [Candidate; 2] {
    let gap =
        data.remembered(&Backlash, &[way], &|motion, memory, values| 1.0 - Backlash.engaged(motion, values, memory));
    let felt = f64::from(u8::from(way > data.grid.felt));
    [(data.resisting, false), (data.predicted, true)].map(|(behind, whole)| {
        let mut column: Vec<f64> = gap.iter().zip(behind).map(|(g, f)| -felt * g * f).collect();
        stick_phases::plays(data.track, way, whole, &mut column);
        let share = Shape::Share { least: LEAST_SHARE, whole: LEAST_SHARE };
        let backlash = Candidate::one(ID, Kind::Plant, "share", "1", column).shaped(share);
        backlash.at("delta", way, data.units().length)
    })
}
