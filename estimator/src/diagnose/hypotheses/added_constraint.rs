//! A wall or a cable as a hypothesis: its place, or the direction of its anchor and its length, are searched.

use super::axis::Axis;
use super::candidate::{Candidate, Searched};
use super::dictionary::Dictionary;
use super::grid::{Near, Point, Ranges};
use super::hypothesis::{About, Found, Hypothesis};
use super::relations::{Form, Over};
use haptics::law::{AddedConstraint, Cable, Effect, Kind};
use std::f64::consts::TAU;

pub(crate) const ID: &str = "added-constraint";

/// Tried places of a wall, as shares of the positions that lie before it.
/// Choice: halved or doubled, none of 62 answers changes.
const WALLS: Axis = Axis::even(0.4, 0.9, 6);
/// Tried anchor directions of a cable, in turns.
/// Choice: halved, 5 of 62 answers change (2 to wrong); doubled, 3 of 62 answers change.
const DIRECTIONS: Axis = Axis::cells(16);
/// Tried slack of a cable, as a share of the travel.
/// Choice: halved, 6 of 62 answers change; doubled, 5 of 62 answers change.
const SLACK: Axis = Axis::even(0.35, 0.8, 3);
/// Initial distance of the anchor, in arm lengths.
/// Choice: halved, 2 of 62 answers change; doubled, 3 of 62 answers change.
const REACH: f64 = 5.0;
/// Tried distances of the anchor, in arm lengths.
/// Choice: halved, 1 of 6 answers change; doubled, 3 of 6 answers change.
const REACHES: Axis = Axis::geometric(0.5 * REACH, 4.0 * REACH, 4);
/// Points: place and side of a wall.
const WALL: &str = "wall";
/// Points: direction of the anchor, rad, length at rest, m, and distance of the anchor in arms.
const CABLE: &str = "cable";

impl Hypothesis for AddedConstraint {
    fn about(&self) -> About {
        About { id: ID, form: Form::Curve(&[Over::Place]), ..About::PLAIN }
    }

    fn coarse(&self, ranges: &Ranges<'_>) -> Vec<Point> {
        let position = |share| ranges.track.quantile(share, |r| r.motion.position);
        let sides = [(1.0, 0.0), (-1.0, 1.0)];
        let walls =
            WALLS.values().flat_map(|w| sides.map(|(side, base)| Point::two(WALL, position(base + side * w), side)));
        let rest = |share: f64| ranges.track.radius_m.unwrap_or(0.0) * (REACH - 1.0 + 2.0 * share);
        let cables = |turn: f64| SLACK.values().map(move |s| Point { form: CABLE, at: [TAU * turn, rest(s), REACH] });
        walls.chain(DIRECTIONS.values().flat_map(cables)).collect()
    }

    fn around(&self, near: &Near<'_>) -> Vec<Point> {
        let mut all = Vec::new();
        for found in near.of(ID) {
            if let (Some(direction), Some(rest)) = (found.value("anchor direction"), found.value("rest length")) {
                all.extend(cables_around(near, (direction, rest), found.value("anchor distance")));
            } else if let Some(place) = found.value("place") {
                let places = WALLS.around(place, near.ranges.range, near.step);
                all.extend(places.map(|place| Point::two(WALL, place, found.side)));
            }
        }
        all
    }

    /// Walls that leave a good part of the motion alone (else a spring explains as much), and cables to a place beside
    /// the arm.
    fn candidates(&self, data: &Dictionary<'_>) -> Vec<Candidate> {
        let length = data.units().length;
        let wall = |[place, side, _]: [f64; 3]| {
            let wall = data.plain(&AddedConstraint, &[1.0, place, side], 0).positive();
            Candidate { side, ..wall.at("place", place, length) }
        };
        let mut all: Vec<Candidate> = data.points(ID, WALL).map(wall).collect();
        let (Some(radius), true) = (data.track.radius_m, data.track.planar) else { return all };
        let cable = |[direction, rest, reach]: [f64; 3]| {
            let pull = data.law_of_place(&Cable, &[1.0, rest, direction, reach * radius, radius]);
            let cable = Candidate::of(ID, Kind::Plant, vec![pull], vec![("k", "N/m")]).positive();
            let mut cable = cable.at("anchor direction", direction, "rad").at("rest length", rest, "m");
            // The distance of the anchor hardly affects the force.
            cable.searched.push(Searched { name: "anchor distance", value: reach * radius, unit: "m" });
            cable
        };
        all.extend(data.points(ID, CABLE).map(cable));
        all
    }

    fn effects(&self, found: &Found<'_>) -> Vec<Effect> {
        let [first, second, third] = [0, 1, 2].map(|k| found.searched(k));
        let stiffness = found.value(0);
        vec![if found.candidate.searched.len() == 3 {
            Effect::new(&Cable, &[stiffness, second, first, third, found.radius_m()])
        } else {
            Effect::new(&AddedConstraint, &[stiffness, first, found.candidate.side])
        }]
    }
}

/// Cables around one that was found.
fn cables_around(near: &Near<'_>, (direction, rest): (f64, f64), distance: Option<f64>) -> Vec<Point> {
    let radius = near.ranges.track.radius_m.unwrap_or(0.0);
    let found = distance.map_or(REACH, |d| d / radius.max(f64::MIN_POSITIVE));
    let mut all = Vec::new();
    for direction in DIRECTIONS.around(direction, TAU, near.step) {
        // A share of slack is a share of both ways across the circle.
        let cables = |rest: f64, reach: f64| {
            let rests = SLACK.around(rest, 2.0 * radius, near.step);
            rests.map(|rest| Point { form: CABLE, at: [direction, rest, reach] })
        };
        all.extend(cables(rest, found));
        // The same slack with another distance of the anchor.
        for reach in REACHES.values().filter(|reach| (reach - found).abs() > 1e-6) {
            all.extend(cables(rest + (reach - found) * radius, reach));
        }
    }
    all
}
