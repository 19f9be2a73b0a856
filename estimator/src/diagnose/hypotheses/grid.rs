//! Search grids of the non-linear values: coarse at first, then finer around the values found.

use super::candidate::Candidate;
use super::relations::Relation;
use crate::diagnose::data::interpolation::FINE_HZ;
use crate::diagnose::data::regression_data::{Place, Track};
use std::f64::consts::TAU;

/// Shortest distance that is felt at a reversal, in points of the motion at the usual speed. (At the reversal the
/// motion is slower.)
const STEPS: f64 = 0.06;
/// The same with inertia in the model: the filters of force and motion blur every reversal by as much.
const STEPS_OF_MASS: f64 = 0.25;
/// The same for a crank, in standard deviations of the summed rate noise within a row. Such noise alone builds up and
/// releases a shorter presliding, which reduces the friction while the handle sticks, as the noise of the velocity
/// does.
const STEPS_OF_NOISE: f64 = 3.0;
/// The same where the object was seen to stand, in standard deviations of its position noise.
const SEEN: f64 = 0.5;
/// Presliding distances and half gaps, as shares of the range of positions.
const WAYS: [f64; 14] =
    [0.00003, 0.00006, 0.00012, 0.00024, 0.0005, 0.001, 0.002, 0.004, 0.008, 0.016, 0.032, 0.065, 0.13, 0.2];
/// The same around a distance that was found, relative to it.
const WAYS_AROUND: [f64; 5] = [0.62, 0.79, 1.0, 1.26, 1.6];
/// Share of a turn from which positions on a crank count as repeating every turn.
const NEARLY_A_TURN: f64 = 0.8;
/// Time constants of a decaying drift or leak, in shares of the recording, and around one that was found.
const SETTLING: [f64; 2] = [0.2, 0.5];
const SETTLING_AROUND: [f64; 5] = [0.5, 0.7, 1.0, 1.4, 2.0];
/// Number of tried start times of a sudden change.
const STARTS: u32 = 16;
/// Places, times and phases between those of a coarse grid, in its steps.
pub(crate) const BETWEEN: [f64; 5] = [-0.67, -0.33, 0.0, 0.33, 0.67];

/// The searched values of one candidate, in the order of its law's file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Point {
    /// Form of the law, if it has several (a wall or a cable).
    pub(crate) form: &'static str,
    /// The values; unused ones are zero.
    pub(crate) at: [f64; 3],
}

impl Point {
    /// One searched value.
    pub(crate) fn one(form: &'static str, value: f64) -> Self {
        Self { form, at: [value, 0.0, 0.0] }
    }

    /// Two searched values.
    pub(crate) fn two(form: &'static str, first: f64, second: f64) -> Self {
        Self { form, at: [first, second, 0.0] }
    }
}

/// Values to try, in the units of the track.
#[derive(Clone, Debug, Default)]
pub struct Grid {
    /// Points of the laws, each with its law's id.
    points: Vec<(&'static str, Point)>,
    /// Shortest presliding distance that is felt in the force. Shorter ones show only in the displacement of a standing
    /// object.
    pub(crate) felt: f64,
    /// Period of the position; 0 if there is none.
    pub(crate) turn: f64,
}

impl Grid {
    /// A grid without points.
    pub(crate) fn empty(ranges: &Ranges<'_>) -> Self {
        Self { points: Vec::new(), felt: ranges.felt, turn: ranges.turn }
    }

    /// Adds a law's points.
    pub(crate) fn add(&mut self, id: &'static str, points: Vec<Point>) {
        self.points.extend(points.into_iter().map(|point| (id, point)));
    }

    /// Points of one form of a law, in the order in which they were added.
    pub(crate) fn of<'a>(&'a self, id: &'a str, form: &'a str) -> impl Iterator<Item = [f64; 3]> + 'a {
        self.points.iter().filter(move |(own, point)| *own == id && point.form == form).map(|(_, point)| point.at)
    }

    /// Adds another grid's values.
    pub fn with(mut self, more: Self) -> Self {
        self.points.extend(more.points);
        self
    }
}

/// Ranges of a track, from which searched values are taken as shares.
pub(crate) struct Ranges<'a> {
    pub(crate) track: &'a Track,
    /// Lowest and highest position, and their distance.
    pub(crate) low: f64,
    pub(crate) high: f64,
    pub(crate) range: f64,
    /// Usual speed of fast motion.
    pub(crate) fast: f64,
    /// Path of one turn; none along a line.
    pub(crate) circumference: Option<f64>,
    /// Period of the position; 0 if there is none.
    pub(crate) turn: f64,
    /// Shortest presliding distance that is felt in the force.
    pub(crate) felt: f64,
}

impl<'a> Ranges<'a> {
    pub(crate) fn of(track: &'a Track) -> Self {
        let (low, high) = (track.quantile(0.0, |r| r.motion.position), track.quantile(1.0, |r| r.motion.position));
        let range = (high - low).max(1e-12);
        let fast = track.quantile(0.9, |r| r.motion.velocity.abs());
        let circumference = track.radius_m.map(|r| TAU * r);
        // On a crank, positions repeat every turn.
        let turn = circumference.filter(|t| range > NEARLY_A_TURN * t).unwrap_or(0.0);
        Self { track, low, high, range, fast, circumference, turn, felt: felt(track, fast) }
    }

    /// Range in which a place may lie: a whole turn, or the positions that were reached.
    pub(crate) fn span(&self) -> f64 {
        if self.turn > 0.0 { self.turn } else { self.range }
    }

    /// Presliding distances and half gaps that are felt, or seen while the object stands.
    pub(crate) fn ways(&self) -> Vec<f64> {
        let stands = self.track.rows.iter().any(|r| matches!(r.place, Place::Stuck { .. }));
        let least = if stands { (SEEN * self.track.position_noise).min(self.felt) } else { self.felt };
        let scale = self.track.radius_m.map_or(self.range, |r| self.range.min(2.0 * r));
        WAYS.map(|share| share * scale).into_iter().filter(|way| *way > least).collect()
    }

    /// Time constants of a decaying drift or leak.
    pub(crate) fn settling(&self) -> [f64; 2] {
        SETTLING.map(|share| share * self.track.span_s)
    }

    /// Start times of a sudden change.
    pub(crate) fn starts(&self) -> impl Iterator<Item = f64> {
        let span_s = self.track.span_s;
        (1..STARTS).map(move |k| span_s * f64::from(k) / f64::from(STARTS))
    }
}

/// Shortest presliding distance that is felt in the force.
fn felt(track: &Track, fast: f64) -> f64 {
    // A distance shorter than the spacing of two points cannot be distinguished from a reversal between them.
    let between_s = track.raw_period_s.max(1.0 / FINE_HZ).min(track.period_s);
    let point_s = if track.fine.is_empty() { track.period_s } else { between_s };
    if track.planar {
        (STEPS * point_s * fast).max(STEPS_OF_NOISE * track.velocity_noise * track.period_s)
    } else {
        STEPS_OF_MASS * point_s * fast
    }
}

/// Candidates around whose values a finer grid is laid.
pub(crate) struct Near<'a> {
    pub(crate) ranges: Ranges<'a>,
    pub(crate) found: Vec<(&'a Candidate, &'static [Relation])>,
    /// Distance from the values found, 1 at first.
    pub(crate) step: f64,
}

impl Near<'_> {
    /// Found candidates of one cause.
    pub(crate) fn of(&self, id: &str) -> impl Iterator<Item = &Candidate> {
        self.found.iter().filter(move |(candidate, _)| candidate.id == id).map(|(candidate, _)| *candidate)
    }

    /// Found candidates with a relation.
    fn related(&self, relation: Relation) -> impl Iterator<Item = &Candidate> {
        self.found.iter().filter(move |(_, own)| own.contains(&relation)).map(|(candidate, _)| *candidate)
    }

    /// A value times factors, which are nearer to 1 at a smaller step.
    pub(crate) fn times<const N: usize>(&self, value: f64, factors: [f64; N]) -> [f64; N] {
        factors.map(|factor| factor.powf(self.step) * value)
    }

    /// Presliding distances or half gaps around the one of a found candidate.
    pub(crate) fn ways_of(&self, lost: &Candidate) -> [f64; 5] {
        self.times(lost.value("way").or(lost.value("delta")).unwrap_or(0.0), WAYS_AROUND)
    }

    /// The same around all that were found, apart from friction that springs back along a straight line.
    pub(crate) fn ways(&self) -> Vec<f64> {
        let lost = self.related(Relation::LosesMotion).filter(|c| c.value("shape").is_none());
        lost.flat_map(|lost| self.ways_of(lost)).collect()
    }

    /// Time constants around those that were found of a drift or a leak.
    pub(crate) fn settling(&self) -> Vec<f64> {
        let taus = self.related(Relation::Settles).filter_map(|c| c.value("tau"));
        taus.flat_map(|tau| self.times(tau, SETTLING_AROUND)).collect()
    }

    /// Start times around those that were found of any sudden change.
    pub(crate) fn starts(&self) -> Vec<f64> {
        let apart = self.step * self.ranges.track.span_s / f64::from(STARTS);
        let starts = self.found.iter().filter_map(|(c, _)| c.value("t0"));
        starts.flat_map(|start| BETWEEN.map(|s| start + s * apart)).collect()
    }
}
