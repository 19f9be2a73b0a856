//! Throws that would settle the open questions about a switch: the same regressors on a recording that has not been
//! made yet.

use super::curve;
use super::model::Known;
use super::rows::{FREE_EVERY, Place, Row, Seen, direction};
use super::throw::Push;
use crate::diagnose::contract::{Alternative, Experiment, NextExperiment};
use crate::diagnose::experiment::proposal;
use crate::diagnose::experiment::strokes::FREE_S;
use crate::diagnose::experiment::waypoints;
use crate::diagnose::experiment::waypoints::{HAND_SPEEDS_M_S, THROW, Throws};
use crate::diagnose::selection::comparison::Compared;
use estimation::segment::threshold::percentile;
use haptics::Vec2;

/// Numbers of throws. The least that is likely to suffice is proposed.
/// Choice: halved or doubled, none of 21 answers changes.
const THROWS: [usize; 3] = [6, 12, 18];
/// Travel between a finger's release and the next push, as a share of the fingers' range: that of the spring and the gap.
/// Choice: halved or doubled, none of 21 answers changes.
const GAP: f64 = 0.23;
const WORDS: &str = "throw the switch over to both sides, slowly and fast in turn, press on at each stop, and let go for two seconds \
                     before and after";

/// The recording to make; `None` if it would settle no open question.
pub fn propose(
    open: &[Alternative],
    seen: &Seen,
    (push, curve, known): (&Push, Option<&Compared>, Option<&Known<'_>>),
) -> Option<NextExperiment> {
    proposal::shortest(open, THROWS, &|count| {
        let (asked, motion) = asked(seen, count)?;
        let mut channels = vec![(push.imagined(&imagine(seen, push, &motion)), &push.compared.study)];
        channels.extend(known.zip(curve).map(|(known, curve)| {
            let of = |t: &waypoints::Throw| (usize::from(!t.right), t.fast_m_s, 2.0 * asked.half_range);
            let throws: Vec<_> = motion.all().iter().map(of).collect();
            (curve::imagined(&throws, known, seen.period_s), &curve.study)
        }));
        Some((asked, format!("{WORDS}; {count} throws"), channels))
    })
}

/// The travel of the recorded throws, at least at their speed.
fn asked(seen: &Seen, count: usize) -> Option<(Experiment, Throws)> {
    let of_side = |side: usize| seen.rows.iter().filter(move |r| r.side() == Some(side));
    let way = |side: usize| {
        let mut places: Vec<f64> = of_side(side).map(|r| r.tip.x).collect();
        (percentile(&mut places.clone(), 0.01), percentile(&mut places, 0.99))
    };
    let ways = [way(0), way(1)];
    let half_m = ways.iter().map(|(low, high)| 0.5 * (high - low)).fold(0.0, f64::max);
    let mut speeds: Vec<f64> = [0, 1].into_iter().flat_map(of_side).map(|r| r.speed_m_s().abs()).collect();
    let gap_m = GAP * seen.range_m;
    let half_range = half_m + gap_m;
    // The two fingers touch the knob on either side of it.
    let middles: Vec<f64> =
        ways.iter().filter(|(low, high)| high > low).map(|(low, high)| 0.5 * (low + high)).collect();
    let mut asked = Experiment {
        id: THROW.to_owned(),
        seconds: f64::MAX,
        free_s: FREE_S,
        middle: middles.iter().sum::<f64>() / middles.len().max(1) as f64,
        half_range,
        fast: percentile(&mut speeds, 0.95).clamp(HAND_SPEEDS_M_S.0, HAND_SPEEDS_M_S.1),
        ..Experiment::default()
    };
    // Long enough for that many throws: one begins as long as there is time.
    let mut seconds = 0.0;
    for _ in 0..count {
        asked.seconds = seconds + 1e-3;
        seconds = Throws::of(&asked, half_range, half_range - gap_m)?.duration_s();
    }
    asked.seconds = seconds - 1e-3;
    let motion = Throws::of(&asked, half_range, half_range - gap_m)?;
    Some((asked, motion))
}

/// Predicted rows of these throws.
fn imagine(seen: &Seen, push: &Push, motion: &Throws) -> Seen {
    let mut rows: Vec<Row> = Vec::new();
    let row = |time_s: f64, place: Place, x_m: f64, speed_m_s: f64| Row {
        recording: 0,
        time_s,
        place,
        tip: Vec2::new(x_m, 0.0),
        velocity: Vec2::new(speed_m_s, 0.0),
        acceleration_m_s2: 0.0,
        force: Vec2::zeros(),
        above_zero: Vec2::zeros(),
    };
    let gap_m = GAP * seen.range_m;
    let mut stretch = Vec::new();
    let mut number = 0;
    for throw in motion.all() {
        let side = usize::from(!throw.right);
        let Some((low, high)) = push.seen_m(side) else { continue };
        let way_m = (high - low) + 2.0 * gap_m;
        number += 1;
        for (k, (gone, speed)) in curve::pushed(throw.fast_m_s, way_m, seen.period_s).enumerate() {
            let travel = low - gap_m + gone;
            if (low..high).contains(&travel) {
                let time_s = FREE_S + throw.begins_s + k as f64 * seen.period_s;
                rows.push(row(time_s, Place::Push(side), direction(side) * travel, direction(side) * speed));
                stretch.push(number);
            }
        }
    }
    let end_s = FREE_S + motion.duration_s();
    for (finger, axis) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
        number += 1;
        for from_s in [0.0, end_s] {
            let every_s = FREE_EVERY as f64 * seen.period_s;
            for k in 0..(FREE_S / every_s) as usize {
                rows.push(row(from_s + k as f64 * every_s, Place::Free(finger, axis), 0.0, 0.0));
                stretch.push(number);
            }
        }
    }
    Seen { rows, stretch, recordings: 1, ..*seen }
}
