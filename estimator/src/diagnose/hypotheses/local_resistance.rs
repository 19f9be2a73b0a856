//! A local resistance in both directions, or a push at a place, as a hypothesis: place and width are searched.

use super::axis::Axis;
use super::candidate::Candidate;
use super::dictionary::Dictionary;
use super::grid::{Near, Point, Ranges};
use super::hypothesis::{About, Found, Hypothesis};
use super::relations::{Form, Over};
use haptics::law::{Effect, Kind, Law, LocalPush, LocalResistance};
use std::f64::consts::TAU;

pub(crate) const ID: &str = "local-resistance";

/// Tried places, as shares of the range.
/// Choice: halved, 7 of 74 answers change (1 to wrong); doubled, 4 of 74 answers change.
pub(crate) const PLACES: Axis = Axis::cells(24);
/// Tried widths, as shares of the range.
/// Choice: halved, 4 of 62 answers change; doubled, 3 of 62 answers change.
const WIDTHS: Axis = Axis::geometric(0.12, 0.35, 3);
/// Points: place and width.
const HUMP: &str = "place and width";

impl Hypothesis for LocalResistance {
    fn about(&self) -> About {
        About { id: ID, form: Form::Curve(&[Over::Place]), ..About::PLAIN }
    }

    fn coarse(&self, ranges: &Ranges<'_>) -> Vec<Point> {
        let (from, span) = (if ranges.turn > 0.0 { 0.0 } else { ranges.low }, ranges.span());
        let places = PLACES.values().map(|share| from + span * share);
        places.flat_map(|place| WIDTHS.values().map(move |width| Point::two(HUMP, place, width * span))).collect()
    }

    fn around(&self, near: &Near<'_>) -> Vec<Point> {
        let found = near.of(ID).filter_map(|found| found.value("place").zip(found.value("width")));
        let refined = |(place, width): (f64, f64)| {
            PLACES
                .around(place, near.ranges.span(), near.step)
                .into_iter()
                .flat_map(move |place| WIDTHS.around(width, 1.0, near.step).map(|width| Point::two(HUMP, place, width)))
        };
        found.flat_map(refined).collect()
    }

    fn candidates(&self, data: &Dictionary<'_>) -> Vec<Candidate> {
        let units = data.units();
        let both = |[place, width, _]: [f64; 3]| {
            let values = [1.0, place, width, data.grid.turn];
            let named = |law: &'static dyn Law| {
                let linear = vec![(law.parameters()[0].name, units.force)];
                let found = Candidate::of(ID, Kind::Plant, vec![data.law_of_place(law, &values)], linear);
                found.at("place", place, units.length).at("width", width, units.length)
            };
            [named(&LocalResistance).positive(), named(&LocalPush)]
        };
        data.points(ID, HUMP).flat_map(both).collect()
    }

    fn effects(&self, found: &Found<'_>) -> Vec<Effect> {
        let turn = if found.radius_m() > 0.0 { TAU * found.radius_m() } else { 0.0 };
        let values = [found.value(0), found.searched(0), found.searched(1), turn];
        let law: &'static dyn Law = if found.is_named("P") { &LocalPush } else { &LocalResistance };
        vec![Effect::new(law, &values)]
    }
}
