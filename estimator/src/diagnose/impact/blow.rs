//! Speed that an impact takes, at the corner of a cube that hits first: its velocity before, from the flight, and after.

use super::powers;
use crate::diagnose::answer::{Compared, Found, parameter};
use crate::diagnose::atlas::{Variable, View};
use crate::diagnose::candidate::Candidate;
use crate::diagnose::compare::Channel;
use crate::diagnose::report::CauseParameter;
use crate::estimate::EstimateError;
use crate::identify::tossed::Tossed;
use crate::identify::tossed::flight::LEAST;
use crate::identify::tossed::pose::Track;
use crate::segment::SystemState;
use haptics::law::Kind;
use nalgebra::{DVector, Vector3};
use std::ops::Range;

/// Samples before and after a blow that are looked at, at most, and those that must be free after it.
const BEFORE: usize = 8;
const LEAST_AFTER: usize = 3;
/// A velocity that changes by this much within a sample is a blow, by that much still is one; less than the last is free fall, m/s.
const BLOW_M_S: f64 = 0.15;
const STILL_M_S: f64 = 0.10;
const FREE_M_S: f64 = 0.06;
/// A second corner within this height hits at the same time, in half widths.
const TOGETHER: f64 = 0.1;
/// A slower blow tells nothing, m/s.
const SLOW_M_S: f64 = 0.4;
/// Fewer blows show nothing.
const LEAST_BLOWS: usize = 24;
/// Score that makes a cause.
pub const THRESHOLD: f64 = 20.0;

/// Compares what impacts leave of the speed. `restitution`: that of the model. `None` where too few blows are clear.
pub fn blow(seen: &Tossed, half_width_m: f64, restitution: f64) -> Result<Option<(Compared, View)>, EstimateError> {
    let pairs: Vec<(f64, f64)> =
        seen.tracks.iter().filter_map(|t| corner(t, half_width_m, seen.fall.down_m_s2)).collect();
    if pairs.len() < LEAST_BLOWS {
        return Ok(None);
    }
    let n = pairs.len();
    let y: Vec<f64> = pairs.iter().map(|(before, after)| after + restitution * before).collect();
    let column: Vec<f64> = pairs.iter().map(|(before, _)| -before).collect();
    let lost = Candidate::one("velocity-loss", Kind::Plant, "change of e", "1", column);
    let stretch: Vec<usize> = (0..n).collect();
    let channel = Channel {
        y,
        base: Vec::new(),
        candidates: vec![lost],
        stretch: stretch.clone(),
        testable: vec![true; n],
        weight: vec![1.0; n],
        period_s: 1.0,
    };
    let study = channel.compare(THRESHOLD)?;
    let floor = study.solved.as_ref().map_or(0.0, |s| (s.rss / study.system.rows.max(1.0)).sqrt());
    // What the model starts from is remembered in the unit of the parameter: see `states`.
    let mut study = study;
    for candidate in &mut study.candidates {
        candidate.searched.push(crate::diagnose::candidate::Searched {
            name: "e of the model",
            value: restitution,
            unit: "1",
        });
    }
    let along = vec![true; n];
    // A throw has one blow: all of them are seen together, over the speed that they came with.
    let view = View::of(Vec::new(), vec![(Variable::Velocity, pairs.iter().map(|(before, _)| -before).collect())]);
    // A blow is none of a segmentation's states.
    let (channel, state) = ("speed after impacts", vec![SystemState::NoState; n]);
    Ok(Some((Compared { study, channel, unit: "m/s", floor, along, stretch, state }, view)))
}

/// What a cause in the impacts is best seen against.
pub fn best_seen(_: &str) -> Variable {
    Variable::Velocity
}

/// Velocity upwards of the corner that hits first, before and after, m/s.
fn corner(track: &Track, half_m: f64, fall_m_s2: f64) -> Option<(f64, f64)> {
    let turned = track.turned.as_ref()?;
    let (hit, after) = around(track, fall_m_s2)?;
    let at_s = track.time_s[hit];
    let before = hit.saturating_sub(BEFORE)..hit;
    let rate = |range: &Range<usize>| {
        let (a, b) = (range.start, range.end - 1);
        (turned[b] * turned[a].inverse()).scaled_axis() / (track.time_s[b] - track.time_s[a])
    };
    let (spin, spin_after) = (rate(&(hit - LEAST / 2..hit)), rate(&after));
    let mut corners: Vec<Vector3<f64>> = (0..8_u32)
        .map(|k| {
            let sign = |bit: u32| if k >> bit & 1 == 1 { half_m } else { -half_m };
            turned[hit] * Vector3::new(sign(0), sign(1), sign(2))
        })
        .collect();
    corners.sort_by(|a, b| a.z.total_cmp(&b.z));
    let arm = corners[0];
    if corners[1].z - arm.z < TOGETHER * half_m {
        return None;
    }
    let up = |range: &Range<usize>, spin: Vector3<f64>| Some(rise(track, range, at_s, fall_m_s2)? + spin.cross(&arm).z);
    let (down, rebound) = (up(&before, spin)?, up(&after, spin_after)?);
    (down < -SLOW_M_S).then_some((down, rebound))
}

/// The sample of the first blow, and the free flight after it.
fn around(track: &Track, fall_m_s2: f64) -> Option<(usize, Range<usize>)> {
    let n = track.points.len();
    if n < LEAST + 4 {
        return None;
    }
    // Change of the velocity at a sample beyond what falling makes, m/s.
    let kick = |i: usize| {
        let (a, b) = (track.time_s[i] - track.time_s[i - 1], track.time_s[i + 1] - track.time_s[i]);
        let change = (track.points[i + 1] - track.points[i]) / b - (track.points[i] - track.points[i - 1]) / a;
        (change + Vector3::new(0.0, 0.0, fall_m_s2 * 0.5 * (a + b))).norm()
    };
    let mut first: Vec<f64> = (1..LEAST).map(kick).collect();
    first.sort_by(f64::total_cmp);
    // What the tracker's noise makes of free flight.
    let noise = first[first.len() / 2];
    let hit = (1..n - 1).find(|i| kick(*i) > BLOW_M_S.max(4.0 * noise))?;
    let over = (hit + 1..n - 1).find(|i| kick(*i) < STILL_M_S.max(3.0 * noise))?;
    let free = (over..n - 1).take_while(|i| kick(*i) < FREE_M_S.max(2.5 * noise)).count();
    (hit >= LEAST && free >= LEAST_AFTER).then(|| (hit, over..(over + free + 1).min(over + BEFORE)))
}

/// Speed upwards of the middle at a time, from samples that fall freely, m/s.
fn rise(track: &Track, range: &Range<usize>, at_s: f64, fall_m_s2: f64) -> Option<f64> {
    let n = range.len();
    let since = |i: usize| track.time_s[range.start + i] - at_s;
    let own = powers(n, 2, since);
    let place = DVector::from_fn(n, |i, _| track.points[range.start + i].z + 0.5 * fall_m_s2 * since(i).powi(2));
    let solved = own.pseudo_inverse(1e-12).ok()? * place;
    Some(solved[1])
}

/// The restitution out of its change against the model.
pub fn states(candidate: &Candidate, found: &[CauseParameter]) -> Vec<CauseParameter> {
    let model = candidate.searched.first().map_or(1.0, |s| s.value);
    found.first().map(|p| parameter("e", model + p.value, p.std_error, "1")).into_iter().collect()
}

/// What in the residual shows a cause.
pub fn shows(found: &Found<'_>) -> String {
    let (value, error) = found.parameters.first().map_or((0.0, 0.0), |p| (p.value, p.std_error));
    format!("the corner that hits first leaves with {value:.3} ± {error:.3} of the speed it came with")
}
