//! A ripple over the position as a hypothesis: its wave length is searched.

use super::axis::Axis;
use super::candidate::Candidate;
use super::dictionary::Dictionary;
use super::grid::{Near, Point, Ranges};
use super::hypothesis::{About, Found, Hypothesis};
use super::relations::{Form, Over};
use haptics::law::{Effect, Kind, PositionRipple};
use std::f64::consts::{FRAC_PI_2, TAU};

pub(crate) const ID: &str = "position-ripple";

/// Tried numbers of ripples per turn (over the range, if nothing turns).
/// Choice: halved or doubled, none of 62 answers changes.
const RIPPLES: Axis = Axis::even(2.0, 40.0, 39);
/// Points: wave length.
const LENGTHS: &str = "wave lengths";

impl Hypothesis for PositionRipple {
    fn about(&self) -> About {
        About { id: ID, form: Form::Curve(&[Over::Place]), ..About::PLAIN }
    }

    fn coarse(&self, ranges: &Ranges<'_>) -> Vec<Point> {
        let whole = ranges.circumference.unwrap_or(ranges.range);
        let lengths = RIPPLES.values().map(|n| whole / n).chain(shorter(ranges));
        let least = ranges.fast * ranges.track.period_s;
        lengths.filter(|length| *length > least).map(|length| Point::one(LENGTHS, length)).collect()
    }

    fn around(&self, near: &Near<'_>) -> Vec<Point> {
        let track = near.ranges.track;
        if track.radius_m.is_some() && track.freely.is_none() {
            return Vec::new();
        }
        // The spectrum resolves one wave over the range.
        let counts = near.of(ID).filter_map(|found| Some(near.ranges.range / found.value("lambda")?));
        let counts = counts.flat_map(|n| RIPPLES.around(n, 1.0, near.step)).filter(|n| *n > 0.0);
        counts.map(|n| Point::one(LENGTHS, near.ranges.range / n)).collect()
    }

    fn candidates(&self, data: &Dictionary<'_>) -> Vec<Candidate> {
        data.points(ID, LENGTHS).map(|[length, ..]| ripple(data, length)).collect()
    }

    fn effects(&self, found: &Found<'_>) -> Vec<Effect> {
        let (cosine, sine) = (found.value(0), found.value(1));
        // cos(x − π/2) is the regressor of the sine.
        let values = [cosine.hypot(sine), found.searched(0), (-sine).atan2(cosine)];
        vec![Effect::new(&PositionRipple, &values)]
    }
}

fn ripple(data: &Dictionary<'_>, length: f64) -> Candidate {
    let units = data.units();
    let column = |phase: f64| {
        // A short ripple changes within a row.
        data.law(&PositionRipple, &[1.0, length, phase])
    };
    let columns = vec![column(0.0), column(-FRAC_PI_2)];
    let linear = vec![("A cos phi", units.force), ("A sin(-phi)", units.force)];
    Candidate::of(ID, Kind::Plant, columns, linear).at("lambda", length, units.length)
}

/// Ripples of what swings freely that are shorter than any of a turn: it goes through them slowly wherever it turns
/// round.
fn shorter(ranges: &Ranges<'_>) -> impl Iterator<Item = f64> {
    let (track, range) = (ranges.track, ranges.range);
    let longest = if track.freely.is_some() { track.radius_m.unwrap_or(0.0) * TAU / RIPPLES.high() } else { 0.0 };
    RIPPLES.values().map(move |n| range / n).filter(move |length| *length < longest)
}
