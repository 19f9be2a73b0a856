//! A spring as a hypothesis, linear or hardening: the rest position of a hardening one is searched.

use super::added_constraint;
use super::axis::Axis;
use super::candidate::{Candidate, Shape, about_its_zero};
use super::dictionary::Dictionary;
use super::grid::{Near, Point, Ranges};
use super::hypothesis::{About, Found, Hypothesis};
use super::relations::{Form, Over};
use crate::diagnose::data::regression_data::Track;
use haptics::law::{Effect, Kind, ReturnSpring};

pub(crate) const ID: &str = "return-spring";

/// Tried rest positions of a hardening spring, as shares of the range from its lower end. They are twice as many if the
/// linear part of the spring shows.
/// Choice: halved or doubled, none of 62 answers changes.
const RESTS: Axis = Axis::even(-0.25, 1.25, 13);
/// Points: rest position of a cubic.
const CUBIC: &str = "cubic";
/// Points: rest position of a spring whose linear part shows, too. Tried if such a spring was found.
const HARDENING: &str = "hardening";

impl Hypothesis for ReturnSpring {
    fn about(&self) -> About {
        About { id: ID, form: Form::Curve(&[Over::Place]), ..About::PLAIN }
    }

    fn coarse(&self, ranges: &Ranges<'_>) -> Vec<Point> {
        rests(RESTS, ranges).map(|rest| Point::one(CUBIC, rest)).collect()
    }

    fn around(&self, near: &Near<'_>) -> Vec<Point> {
        let hardens = |found: &&Candidate| found.regressors.len() > 2 || !found.searched.is_empty();
        // A wall and a hardening spring are similar.
        let is_similar = near.of(added_constraint::ID).next().is_some() || near.of(ID).any(|found| hardens(&found));
        let finer = is_similar.then(|| rests(RESTS.halved(), &near.ranges)).into_iter().flatten();
        let cubics = near.of(ID).filter(hardens).filter_map(|found| found.value("q0"));
        let cubics =
            cubics.flat_map(|q0| RESTS.around(q0, near.ranges.range, near.step)).map(|q0| Point::one(CUBIC, q0));
        finer.map(|rest| Point::one(HARDENING, rest)).chain(cubics).collect()
    }

    fn candidates(&self, data: &Dictionary<'_>) -> Vec<Candidate> {
        let [middle, half] = middle_and_half(data.track);
        let column = |values: &[f64]| data.law_of_place(&ReturnSpring, values);
        let line = || vec![column(&[1.0, 0.0, 0.0, middle]), column(&[0.0, 1.0])];
        let [k, _, k3, q0] = [0, 1, 2, 3].map(|index| data.unit(&ReturnSpring, index));
        let names = || vec![("k", k), ("f0", data.units().force)];
        let spring = |columns, linear| Candidate::of(ID, Kind::Plant, columns, linear);
        let mut all = vec![spring(line(), names()).shaped(Shape::Spring { half })];
        if !data.track.planar {
            // Beside a constant force (a sensor's zero, a slope) the rest position is not identifiable.
            all.push(spring(vec![column(&[1.0, 0.0, 0.0, middle])], vec![("k", k)]).positive());
        }
        // A cubic about any place is the sum of one about the middle and one beside it.
        let cubics = [column(&[0.0, 0.0, 1.0, middle]), column(&[0.0, 0.0, 1.0, middle + half])];
        let columns = line().into_iter().chain(cubics).collect();
        let linear = names().into_iter().chain([("k3", k3), ("k3 aside", k3)]).collect();
        all.push(spring(columns, linear).shaped(Shape::Hardening { half }));
        // Far from its rest position, only the cubic shows.
        let cubic = |rest: f64| data.plain(&ReturnSpring, &[0.0, 0.0, 1.0, rest], 2).positive().at("q0", rest, q0);
        all.extend(data.points(ID, CUBIC).map(|[rest, ..]| cubic(rest)));
        // Near its rest position the force is zero there: one parameter less than two cubics have.
        let stiffening = |rest: f64| {
            let columns = vec![column(&[1.0, 0.0, 0.0, rest]), column(&[0.0, 0.0, 1.0, rest])];
            spring(columns, vec![("k", k), ("k3", k3)]).shaped(Shape::Stiffening).at("q0", rest, q0)
        };
        all.extend(data.points(ID, HARDENING).map(|[rest, ..]| stiffening(rest)));
        all
    }

    fn effects(&self, found: &Found<'_>) -> Vec<Effect> {
        let values = if found.is_named("k3") {
            [0.0, 0.0, found.value(0), found.searched(0)]
        } else if found.candidate.searched.is_empty() {
            about_its_rest(found.values, found.track)
        } else {
            [found.value(0), 0.0, found.value(1), found.searched(0)]
        };
        vec![Effect::new(&ReturnSpring, &values)]
    }
}

/// Parameters of a spring, k, f0, k3 and rest position, from the coefficients of its regressors.
pub(crate) fn about_its_rest(values: &[f64], track: &Track) -> [f64; 4] {
    let [middle, half] = middle_and_half(track);
    let cube = half.powi(3);
    let at = |k: usize| values.get(k).copied().unwrap_or(0.0);
    let [k, f0, k3, place] = about_its_zero([at(0) * half, at(1), at(2) * cube, at(3) * cube]);
    [k / half, f0, k3 / cube, middle + place * half]
}

/// Middle of the positions, and half their range.
fn middle_and_half(track: &Track) -> [f64; 2] {
    let (low, high) = (track.quantile(0.0, |r| r.motion.position), track.quantile(1.0, |r| r.motion.position));
    [0.5 * (low + high), 0.5 * (high - low).max(f64::MIN_POSITIVE)]
}

/// Rest positions of a spring.
fn rests(axis: Axis, ranges: &Ranges<'_>) -> impl Iterator<Item = f64> {
    let (low, range) = (ranges.low, ranges.range);
    axis.values().map(move |share| low + range * share)
}
