//! Search grids of the non-linear values: coarse at first, then finer around the values found.

use super::axis::Axis;
use super::candidate::Candidate;
use super::relations::Relation;
use crate::diagnose::data::interpolation::FINE_HZ;
use crate::diagnose::data::limits::SIGNIFICANT;
use crate::diagnose::data::regression_data::{Place, Row, Track};
use std::f64::consts::TAU;

/// Shortest distance that is felt at a reversal, in points of the motion at the usual speed. (At the reversal the
/// motion is slower.)
/// Choice: halved or doubled, none of 43 answers changes.
const STEPS: f64 = 0.06;
/// The same with inertia in the model: the filters of force and motion blur every reversal by as much.
/// Choice: halved or doubled, none of 19 answers changes.
const STEPS_OF_MASS: f64 = 0.25;
/// The same where the object was seen to stand, in standard deviations of its position noise.
/// Choice: halved or doubled, none of 48 answers changes.
const SEEN: f64 = 0.5;
/// Presliding distances and half gaps, as shares of the range of positions.
/// Choice: halved or doubled, none of 62 answers changes.
const WAYS: Axis = Axis::geometric(3e-5, 0.2, 14);
/// Share of a turn from which positions on a crank count as repeating every turn.
/// Choice: halved, 1 of 47 answers change; doubled, 0 of 47 answers change.
const NEARLY_A_TURN: f64 = 0.8;
/// Time constants of a decaying drift or leak, in shares of the recording.
/// Choice: halved, 0 of 62 answers change; doubled, 3 of 62 answers change (1 to right).
const SETTLING_SHARES: Axis = Axis::geometric(0.2, 0.5, 2);
/// Start times of a sudden change, in shares of the recording.
/// Choice: halved, 0 of 62 answers change; doubled, 1 of 62 answers change.
const START_SHARES: Axis = Axis::even(1.0 / 16.0, 15.0 / 16.0, 15);

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
    /// Lowest position, and distance to the highest.
    pub(crate) low: f64,
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
        let range = (high - low).max(f64::MIN_POSITIVE);
        let fast = track.quantile(0.9, |r| r.motion.velocity.abs());
        let circumference = track.radius_m.map(|r| TAU * r);
        // On a crank, positions repeat every turn.
        let turn = circumference.filter(|t| range > NEARLY_A_TURN * t).unwrap_or(0.0);
        Self { track, low, range, fast, circumference, turn, felt: felt(track, fast) }
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
        WAYS.values().map(|share| share * scale).filter(|way| *way > least).collect()
    }

    /// Time constants of a decaying drift or leak.
    pub(crate) fn settling(&self) -> impl Iterator<Item = f64> {
        let span_s = self.track.span_s;
        SETTLING_SHARES.values().map(move |share| share * span_s)
    }

    /// Start times of a sudden change.
    pub(crate) fn starts(&self) -> impl Iterator<Item = f64> {
        let span_s = self.track.span_s;
        START_SHARES.values().map(move |share| share * span_s).filter(|start_s| may_start(self.track, *start_s))
    }
}

/// True if enough of the motion lies before and after a sudden change. Otherwise it may be a grasp that begins or ends.
pub(crate) fn may_start(track: &Track, start_s: f64) -> bool {
    let before = |row: &Row| row.motion.time_s < start_s;
    let way = |counts: &dyn Fn(&Row) -> bool| -> f64 {
        let rows = track.along().map(|i| &track.rows[i]).filter(|row| counts(row));
        rows.map(|row| row.motion.velocity.abs()).sum()
    };
    (START_SHARES.low()..=START_SHARES.high()).contains(&(way(&before) / way(&|_| true)))
}

/// Shortest presliding distance that is felt in the force.
fn felt(track: &Track, fast: f64) -> f64 {
    // A distance shorter than the spacing of two points cannot be distinguished from a reversal between them.
    let between_s = track.raw_period_s.max(1.0 / FINE_HZ).min(track.period_s);
    let point_s = if track.fine.is_empty() { track.period_s } else { between_s };
    if track.planar {
        (STEPS * point_s * fast).max(SIGNIFICANT * track.velocity_noise * track.period_s)
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

    /// Presliding distances or half gaps around the one of a found candidate.
    pub(crate) fn ways_of(&self, lost: &Candidate) -> [f64; 5] {
        WAYS.around(lost.value("way").or(lost.value("delta")).unwrap_or(0.0), 1.0, self.step)
    }

    /// The same around all that were found, apart from friction that springs back along a straight line.
    pub(crate) fn ways(&self) -> Vec<f64> {
        let lost = self.related(Relation::LosesMotion).filter(|c| c.value("shape").is_none());
        lost.flat_map(|lost| self.ways_of(lost)).collect()
    }

    /// Time constants around those that were found of a drift or a leak.
    pub(crate) fn settling(&self) -> Vec<f64> {
        let taus = self.related(Relation::Settles).filter_map(|c| c.value("tau"));
        taus.flat_map(|tau| SETTLING_SHARES.around(tau, 1.0, self.step)).collect()
    }

    /// Start times around those that were found of any sudden change.
    pub(crate) fn starts(&self) -> Vec<f64> {
        let starts = self.found.iter().filter_map(|(c, _)| c.value("t0"));
        let near = starts.flat_map(|start| START_SHARES.around(start, self.ranges.track.span_s, self.step));
        near.filter(|start_s| may_start(self.ranges.track, *start_s)).collect()
    }
}
