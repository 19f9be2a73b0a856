//! A wall or a cable as a hypothesis: its place, or the direction of its anchor and its length, are searched.

use super::candidate::{Candidate, Searched};
use super::dictionary::Dictionary;
use super::grid::{Near, Point, Ranges};
use super::hypothesis::{About, Found, Hypothesis};
use super::relations::{Form, Over};
use haptics::law::{AddedConstraint, Cable, Effect, Kind};
use std::f64::consts::TAU;

pub(crate) const ID: &str = "added-constraint";

/// Tried places of a wall, as shares of the positions that lie before it.
const WALLS: [f64; 6] = [0.4, 0.5, 0.6, 0.7, 0.8, 0.9];
/// The same around one that was found, in ranges.
const WALLS_AROUND: [f64; 4] = [-0.06, -0.03, 0.03, 0.06];
/// Number of tried anchor directions of a cable, and the slack shares of the travel around it.
const CABLES: u32 = 16;
const SLACK: [f64; 3] = [0.35, 0.6, 0.8];
/// Initial distance of the anchor, in arm lengths, and the distances tried.
const REACH: f64 = 5.0;
const REACHES: [f64; 3] = [2.5, REACH, 20.0];
/// Directions around one that was found, in steps of the coarse grid, and lengths in arms: at the distance that was
/// found, and at another one.
const TURNS_AROUND: [f64; 5] = [-0.6, -0.3, 0.0, 0.3, 0.6];
const RESTS_AROUND: [f64; 5] = [-0.3, -0.15, 0.0, 0.15, 0.3];
const RESTS_AT_OTHER_REACH: [f64; 3] = [-0.2, 0.0, 0.2];
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
            WALLS.iter().flat_map(|w| sides.map(|(side, base)| Point::two(WALL, position(base + side * w), side)));
        let rest = |share: f64| ranges.track.radius_m.unwrap_or(0.0) * (REACH - 1.0 + 2.0 * share);
        let cable = |k: u32| {
            let direction = TAU * f64::from(k) / f64::from(CABLES);
            SLACK.map(|s| Point { form: CABLE, at: [direction, rest(s), REACH] })
        };
        walls.chain((0..CABLES).flat_map(cable)).collect()
    }

    fn around(&self, near: &Near<'_>) -> Vec<Point> {
        let mut all = Vec::new();
        for found in near.of(ID) {
            if let (Some(direction), Some(rest)) = (found.value("anchor direction"), found.value("rest length")) {
                all.extend(cables_around(near, (direction, rest), found.value("anchor distance")));
            } else if let Some(place) = found.value("place") {
                let places = WALLS_AROUND.map(|s| place + s * near.step * near.ranges.range);
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
    let found = distance.map_or(REACH, |d| d / radius.max(1e-12));
    let mut all = Vec::new();
    for turn in TURNS_AROUND.map(|s| s * near.step * TAU / f64::from(CABLES)) {
        let cable = |rest: f64, reach: f64| Point { form: CABLE, at: [direction + turn, rest, reach] };
        all.extend(RESTS_AROUND.map(|s| cable(rest + s * near.step * radius, found)));
        // The same slack with another distance of the anchor.
        for reach in REACHES.into_iter().filter(|reach| (reach - found).abs() > 1e-6) {
            all.extend(RESTS_AT_OTHER_REACH.map(|s| cable(rest + (s * near.step + reach - found) * radius, reach)));
        }
    }
    all
}
