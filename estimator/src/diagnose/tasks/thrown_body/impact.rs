//! Speed that an impact takes, at the corner of a cube that hits first: its velocity before, from the flight, and
//! after.

use crate::diagnose::answer::part::{Found, Told};
use crate::diagnose::contract::{CauseParameter, parameter};
use crate::diagnose::data::limits::{LEAST_PIECES, SIGNIFICANT};
use crate::diagnose::hypotheses::candidate::Candidate;
use crate::diagnose::hypotheses::variable::Variable;
use crate::diagnose::hypotheses::{candidate, velocity_loss};
use crate::diagnose::selection::channel::Channel;
use crate::diagnose::selection::comparison::{Compared, View};
use crate::diagnose::selection::layout::Layout;
use crate::diagnose::selection::rules::Rules;
use crate::diagnose::tasks::thrown_body::powers;
use estimation::identify::tossed::Tossed;
use estimation::identify::tossed::flight::BLOW_S;
use estimation::identify::tossed::flight::least;
use estimation::identify::tossed::pose::Track;
use foundation::estimate::EstimateError;
use foundation::tasks::SystemState;
use haptics::law::Kind;
use nalgebra::{DVector, Rotation3, Vector3};
use std::ops::Range;

/// Longest time before and after a blow that is evaluated, s.
/// Derived: eight samples of the recorded tosses at 148 Hz.
const BESIDE_S: f64 = 0.054;
/// Time on either side over which changes of the velocity are evaluated, s.
/// Derived: one sample of the recorded tosses at 148 Hz.
const REACH_S: f64 = 0.0068;
/// Least speed of a blow, as the time in which free fall makes it, s: the scatter of a slower one is as large as its restitution.
/// Choice: halved or doubled, none of 6 answers changes.
const LEAST_BLOW_S: f64 = 0.04;
/// Change of the velocity up to which a blow is over, and up to which two velocities are equal, as the
/// time in which free fall makes it, s.
/// Choice: halved or doubled, none of 6 answers changes.
const STILL_S: f64 = 0.01;
/// Height within which a second corner hits at the same time, in half widths.
/// Choice: halved or doubled, none of 6 answers changes.
const SECOND_CORNER_HEIGHT: f64 = 0.1;
/// Scatter of the blows about one restitution, as a share of their speed, above which most were several blows. They
/// then determine none.
/// Choice: halved or doubled, none of 6 answers changes.
const MIXED: f64 = 0.25;
/// Ratio of a normal distribution's standard deviation to its median absolute value.
/// Derived: 1/0.6745, the inverse median absolute deviation of a standard normal distribution (Hampel 1974).
const OVER_MEDIAN: f64 = 1.4826;
/// Share of a sampling step for which the ground may push on unseen (standard deviation of a uniform distribution).
/// Derived: 1/√12, the standard deviation of an even spread over one step.
const UNSEEN: f64 = 0.29;

/// The comparison.
pub struct Blows {
    pub compared: Compared,
    /// Error of a restitution that no scatter shows: the ground may push on behind a blow, the more of it the longer the
    /// time between samples.
    pushed: f64,
}

/// Compares what impacts leave of the speed. `restitution`: that of the model. `None` where too few blows are clear.
pub fn blow(seen: &Tossed, half_width_m: f64, restitution: f64) -> Result<Option<Blows>, EstimateError> {
    let pairs: Vec<(f64, f64)> =
        seen.tracks.iter().filter_map(|t| corner(t, half_width_m, seen.fall.down_m_s2)).collect();
    if pairs.len() < LEAST_PIECES {
        return Ok(None);
    }
    let (pairs, scatter_m_s) = without_second_blows(pairs);
    let n = pairs.len();
    let speed = (pairs.iter().map(|(before, _)| before * before).sum::<f64>() / n as f64).sqrt();
    if scatter_m_s > MIXED * speed {
        return Ok(None);
    }
    let step_s = seen.tracks.iter().map(Track::step_s).sum::<f64>() / seen.tracks.len() as f64;
    let pushed = UNSEEN * seen.fall.down_m_s2 * step_s / speed;
    let y: Vec<f64> = pairs.iter().map(|(before, after)| after + restitution * before).collect();
    let column: Vec<f64> = pairs.iter().map(|(before, _)| -before).collect();
    let lost = Candidate::one(velocity_loss::ID, Kind::Plant, "change of e", "1", column);
    let along = vec![true; n];
    let layout = Layout::of((0..n).collect(), &along, 1.0);
    let study = Channel::new(y, Vec::new(), vec![lost], layout, Rules::of_observations()).fit()?;
    let floor = study.solved.as_ref().map_or(0.0, |s| (s.rss / study.system.rows.max(1.0)).sqrt());
    // The model's restitution is kept in the unit of the parameter: see `states`.
    let mut study = study;
    for candidate in &mut study.candidates {
        candidate.searched.push(candidate::Searched { name: "e of the model", value: restitution, unit: "1" });
    }
    // A throw has one blow, so all of them are shown together, over their speed before impact.
    let over = vec![(Variable::Velocity, pairs.iter().map(|(before, _)| -before).collect())];
    let view = View::of(Vec::new(), over, |_| Variable::Velocity);
    // Segmentation has no state for a blow.
    let (channel, state) = ("speed after impacts", vec![SystemState::NoState; n]);
    Ok(Some(Blows { compared: Compared { study, channel, unit: "m/s", floor, along, state, view }, pushed }))
}

impl Told for Blows {
    /// Restitution from its change against the model.
    fn states(&self, _: usize, candidate: &Candidate, found: Vec<CauseParameter>) -> Vec<CauseParameter> {
        let model = candidate.searched.first().map_or(1.0, |s| s.value);
        found
            .first()
            .map(|p| parameter("e", model + p.value, p.std_error.hypot(self.pushed), "1"))
            .into_iter()
            .collect()
    }

    fn shows(&self, found: &Found<'_>) -> String {
        let (value, error) = found.parameters.first().map_or((0.0, 0.0), |p| (p.value, p.std_error));
        format!("the corner that hits first leaves with {value:.3} ± {error:.3} of the speed it came with")
    }
}

/// Pairs of speeds before and after, but those that are far off the rest: there, a second corner hit before the next
/// sample. The scatter of the rest, m/s, is returned beside them.
fn without_second_blows(pairs: Vec<(f64, f64)>) -> (Vec<(f64, f64)>, f64) {
    let median = |values: &mut Vec<f64>| {
        values.sort_by(f64::total_cmp);
        values[values.len() / 2]
    };
    let kept = median(&mut pairs.iter().map(|(before, after)| after / before).collect());
    let off = |(before, after): &(f64, f64)| (after - kept * before).abs();
    let scatter_m_s = OVER_MEDIAN * median(&mut pairs.iter().map(off).collect());
    (pairs.into_iter().filter(|pair| off(pair) <= SIGNIFICANT * scatter_m_s).collect(), scatter_m_s)
}

/// Upward velocity of the corner that hits first, before and after, m/s.
fn corner(track: &Track, half_m: f64, fall_m_s2: f64) -> Option<(f64, f64)> {
    let turned = track.turned.as_ref()?;
    let Beside { hit, before, after, reach } = around(track, fall_m_s2)?;
    let (falls, rises) = (free(track, &before, fall_m_s2)?, free(track, &after, fall_m_s2)?);
    let at_s = track.time_s[hit] + met((&falls, &rises), (track.time_s[hit], track.step_s()), reach, fall_m_s2);
    let spin = |range: &Range<usize>| {
        let (a, b) = (range.start, range.end - 1);
        (turned[b] * turned[a].inverse()).scaled_axis() / (track.time_s[b] - track.time_s[a])
    };
    let (spin_before, spin_after) = (spin(&before), spin(&after));
    // A cube rotates evenly in flight, so its orientation at impact follows.
    let last = before.end - 1;
    let pose = Rotation3::from_scaled_axis(spin_before * (at_s - track.time_s[last])) * turned[last];
    let mut corners: Vec<Vector3<f64>> = (0..8_u32)
        .map(|k| {
            let sign = |bit: u32| if k >> bit & 1 == 1 { half_m } else { -half_m };
            pose * Vector3::new(sign(0), sign(1), sign(2))
        })
        .collect();
    corners.sort_by(|a, b| a.z.total_cmp(&b.z));
    let arm = corners[0];
    if corners[1].z - arm.z < SECOND_CORNER_HEIGHT * half_m {
        return None;
    }
    let up = |of: &Free, spin: Vector3<f64>| of.rise_m_s(at_s, fall_m_s2) + spin.cross(&arm).z;
    let (down, rebound) = (up(&falls, spin_before), up(&rises, spin_after));
    (down < -LEAST_BLOW_S * fall_m_s2).then_some((down, rebound))
}

/// A first blow, and the free flight on either side of it.
struct Beside {
    hit: usize,
    before: Range<usize>,
    after: Range<usize>,
    /// Number of samples over which it was evaluated.
    reach: usize,
}

/// `None` without a blow, or without free flight after it.
fn around(track: &Track, fall_m_s2: f64) -> Option<Beside> {
    let (points, time) = (&track.points, &track.time_s);
    let (n, least, reach) = (points.len(), least(track), track.steps(REACH_S));
    if n < least + 4 * reach {
        return None;
    }
    // Change of the velocity at a sample beyond that by gravity, m/s.
    let kick = |i: usize| {
        let (a, b) = (time[i] - time[i - reach], time[i + reach] - time[i]);
        let change = (points[i + reach] - points[i]) / b - (points[i] - points[i - reach]) / a;
        (change + Vector3::new(0.0, 0.0, fall_m_s2 * 0.5 * (a + b))).norm()
    };
    let mut first: Vec<f64> = (reach..least).map(kick).collect();
    first.sort_by(f64::total_cmp);
    // Effect of the tracker's noise on free flight.
    let noise = first.get(first.len() / 2)?;
    let still_m_s = STILL_S * fall_m_s2;
    let hit = (reach..n - reach).find(|i| kick(*i) > (BLOW_S * fall_m_s2).max(4.0 * noise))?;
    let over = (hit + 1..n - reach).find(|i| kick(*i) < still_m_s.max(3.0 * noise))?;
    let free = (over..n - reach).take_while(|i| kick(*i) < still_m_s.max(2.5 * noise)).count();
    let beside = track.steps(BESIDE_S).max(4);
    (hit >= least && free > 0).then(|| Beside {
        hit,
        before: hit.saturating_sub(beside)..hit,
        after: over..(over + free + reach).min(over + beside),
        reach,
    })
}

/// Time at which two free flights met, s after `at_s`. A blow changes the velocity, not the position.
fn met((falls, rises): (&Free, &Free), (at_s, step_s): (f64, f64), reach: usize, fall_m_s2: f64) -> f64 {
    let faster = falls.speed_m_s - rises.speed_m_s;
    if faster.abs() < STILL_S * fall_m_s2 {
        return 0.0;
    }
    let since = (rises.at_zero_m() - falls.at_zero_m()) / faster;
    // Limited to the interval in which the blow was detected.
    (since - at_s).clamp(-step_s, 2.0 * reach as f64 * step_s)
}

/// Height in free flight: a line added to the fall from rest at time zero.
struct Free {
    /// Time and height of a point of that line, s and m.
    point: (f64, f64),
    speed_m_s: f64,
}

impl Free {
    fn at_zero_m(&self) -> f64 {
        self.point.1 - self.speed_m_s * self.point.0
    }

    fn rise_m_s(&self, at_s: f64, fall_m_s2: f64) -> f64 {
        self.speed_m_s - fall_m_s2 * at_s
    }
}

/// Free flight of the centre in these samples.
fn free(track: &Track, range: &Range<usize>, fall_m_s2: f64) -> Option<Free> {
    let time = &track.time_s[range.clone()];
    let middle_s = time.iter().sum::<f64>() / time.len().max(1) as f64;
    let own = powers(time.len(), 2, |i| time[i] - middle_s);
    let place =
        DVector::from_fn(time.len(), |i, _| track.points[range.start + i].z + 0.5 * fall_m_s2 * time[i].powi(2));
    let solved = own.pseudo_inverse(1e-12).ok()? * place;
    Some(Free { point: (middle_s, solved[0]), speed_m_s: solved[1] })
}
