//! A ripple over the position as a hypothesis: its wave length is searched.

use super::candidate::Candidate;
use super::dictionary::Dictionary;
use super::grid::{Near, Point, Ranges};
use super::hypothesis::{About, Found, Hypothesis};
use super::relations::{Form, Over};
use haptics::law::{Effect, Kind, PositionRipple};
use std::f64::consts::{FRAC_PI_2, TAU};

pub(crate) const ID: &str = "position-ripple";

/// Tried numbers of ripples per turn (over the range, if nothing turns).
const RIPPLES: std::ops::RangeInclusive<u32> = 2..=40;
/// Wave lengths around one that was found, relative to it.
const LENGTHS_AROUND: [f64; 9] = [0.93, 0.96, 0.98, 0.99, 1.0, 1.01, 1.02, 1.04, 1.07];
/// Least length of a ripple, in rows of the fastest motion. The rows average out a shorter one.
const LEAST_ROWS: f64 = 1.0;
/// Length of a ripple, in rows, below which it is averaged over each row.
const SHORT: f64 = 25.0;
/// Points: wave length.
const LENGTHS: &str = "wave lengths";

impl Hypothesis for PositionRipple {
    fn about(&self) -> About {
        About { id: ID, form: Form::Curve(&[Over::Place]), ..About::PLAIN }
    }

    fn coarse(&self, ranges: &Ranges<'_>) -> Vec<Point> {
        let whole = ranges.circumference.unwrap_or(ranges.range);
        let lengths = RIPPLES.map(|n| whole / f64::from(n)).chain(shorter(ranges));
        let least = LEAST_ROWS * ranges.fast * ranges.track.period_s;
        lengths.filter(|length| *length > least).map(|length| Point::one(LENGTHS, length)).collect()
    }

    fn around(&self, near: &Near<'_>) -> Vec<Point> {
        let track = near.ranges.track;
        if track.radius_m.is_some() && track.freely.is_none() {
            return Vec::new();
        }
        let lengths = near.of(ID).map(|found| found.value("lambda").unwrap_or(0.0));
        lengths.flat_map(|length| near.times(length, LENGTHS_AROUND)).map(|l| Point::one(LENGTHS, l)).collect()
    }

    fn candidates(&self, data: &Dictionary<'_>) -> Vec<Candidate> {
        // A short ripple changes within a row.
        let short = SHORT * data.track.quantile(0.9, |r| r.motion.velocity.abs()) * data.track.period_s;
        data.points(ID, LENGTHS).map(|[length, ..]| ripple(data, length, length < short)).collect()
    }

    fn effects(&self, found: &Found<'_>) -> Vec<Effect> {
        let (cosine, sine) = (found.value(0), found.value(1));
        // cos(x − π/2) is the regressor of the sine.
        let values = [cosine.hypot(sine), found.searched(0), (-sine).atan2(cosine)];
        vec![Effect::new(&PositionRipple, &values)]
    }
}

fn ripple(data: &Dictionary<'_>, length: f64, is_short: bool) -> Candidate {
    let units = data.units();
    let column = |phase: f64| {
        let values = [1.0, length, phase];
        if is_short { data.law(&PositionRipple, &values) } else { data.law_of_place(&PositionRipple, &values) }
    };
    let columns = vec![column(0.0), column(-FRAC_PI_2)];
    let linear = vec![("A cos phi", units.force), ("A sin(-phi)", units.force)];
    Candidate::of(ID, Kind::Plant, columns, linear).at("lambda", length, units.length)
}

/// Ripples of what swings freely that are shorter than any of a turn: it goes through them slowly wherever it turns
/// round.
fn shorter(ranges: &Ranges<'_>) -> impl Iterator<Item = f64> {
    let (track, range) = (ranges.track, ranges.range);
    let longest =
        if track.freely.is_some() { track.radius_m.unwrap_or(0.0) * TAU / f64::from(*RIPPLES.end()) } else { 0.0 };
    RIPPLES.map(move |n| range / f64::from(n)).filter(move |length| *length < longest)
}
