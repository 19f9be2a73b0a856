//! Energy of a free pendulum from one turning point to the next.
//!
//! At a turning point nothing moves, so that the work of all forces over a half swing is zero. Its mean over the path is
//! a row without any acceleration, and therefore without the noise of one: the loss of amplitude shows dry friction,
//! viscous friction and drag apart. Gravity per unit of inertia follows from the durations of the half swings by the
//! complete elliptic integral, which the arithmetic-geometric mean gives.

use super::rows::{Piece, pieces};
use crate::diagnose::data::limits::{HALF, LEAST_ROWS_OF_A_FIT, SIGNIFICANT};
use crate::diagnose::data::regression_data::{Fine, Freely, Row, Span, Track, Weighing};
use estimation::identify::mechanism;
use foundation::estimate::EstimateError;
use foundation::signal::derive::savitzky_golay;
use foundation::signal::noise::white_noise_under_fast_motion;
use haptics::Vec2;
use haptics::law::{Coordinate, EccentricMass, Effect, Motion};
use haptics::recording::Recording;
use haptics::world::MechanismPath;
use std::f64::consts::{PI, TAU};

/// A turning point of the motion.
#[derive(Clone, Copy, Debug)]
struct Turn {
    time_s: f64,
    /// rad
    angle: f64,
}

/// The half swings of a recording, with gravity per unit of inertia taken for known; `None` if it does not swing freely
/// for long enough.
///
/// # Errors
/// No coordinate or no clock: in a sentence.
pub fn track(
    recording: &Recording,
    bad: &[bool],
    path: Option<&MechanismPath>,
    freely: Freely,
) -> Result<Option<Track>, EstimateError> {
    let raw = mechanism::raw(recording, path)?;
    if raw.coordinate != Coordinate::Angular {
        return Ok(None);
    }
    let (pieces, period_s) = pieces(&raw, bad);
    let longest = pieces.iter().max_by_key(|piece| piece.position.len());
    Ok(longest.and_then(|piece| of_piece(piece, period_s, raw.time_s[0], freely)))
}

fn of_piece(piece: &Piece, period_s: f64, start_s: f64, freely: Freely) -> Option<Track> {
    let noise = white_noise_under_fast_motion(&piece.position);
    let turns = free_part(&turns(piece, period_s)?, noise);
    if turns.len() < LEAST_ROWS_OF_A_FIT {
        return None;
    }
    let rest = rest(&turns);
    let gravity = gravity(&turns, rest)?;
    let mut track = Track { raw_period_s: period_s, ..Track::of(Coordinate::Angular) };
    for pair in turns.windows(2) {
        half_swing(&mut track, [pair[0], pair[1]], (rest, gravity), start_s);
    }
    let (first, last) = (turns[0], turns[turns.len() - 1]);
    let inertia = freely.inertia;
    track.period_s = (last.time_s - first.time_s) / (turns.len() - 1) as f64;
    track.span_s = last.time_s - first.time_s;
    // Of two turning points, over the path between them.
    track.force_noise = (inertia * gravity * noise * 0.5_f64.sqrt()).max(f64::MIN_POSITIVE);
    track.velocity_noise = noise * gravity.sqrt();
    let hanging = Effect::new(&EccentricMass, &[gravity * rest.cos(), -gravity * rest.sin()].map(|g| inertia * g));
    track.freely = Some(Freely { is_energy: true, known: [Some(hanging), freely.known[0], freely.known[1]], ..freely });
    Some(track)
}

/// Turning points. `None` if the motion is too short.
fn turns(piece: &Piece, period_s: f64) -> Option<Vec<Turn>> {
    let crossings = |half: usize| -> Vec<Turn> {
        let smooth = savitzky_golay(&piece.time_s, &piece.position, half, 4);
        let at = |k: usize| {
            let [before, after] = [smooth.first[k], smooth.first[k + 1]];
            let share = before / (before - after);
            let [here, next] = [smooth.value[k], smooth.value[k + 1]];
            // A parabola through both values with the slopes at hand.
            let angle = here + share * (next - here) + 0.5 * share * (1.0 - share) * period_s * before;
            Turn { time_s: piece.time_s[k] + share * period_s, angle }
        };
        let is_turn = |k: &usize| {
            let [before, after] = [smooth.first[*k], smooth.first[k + 1]];
            before > 0.0 && after <= 0.0 || before < 0.0 && after >= 0.0
        };
        let last = smooth.first.len().saturating_sub(1);
        (half..last.saturating_sub(half)).filter(is_turn).map(at).collect()
    };
    let shortest = ((0.02 / period_s).round() as usize).max(3);
    if piece.position.len() < 8 * shortest {
        return None;
    }
    let found = crossings(shortest);
    let mut lengths: Vec<f64> = found.windows(2).map(|pair| pair[1].time_s - pair[0].time_s).collect();
    lengths.sort_by(f64::total_cmp);
    // The longest third are half swings; noise at rest crosses more often.
    let usual_s = lengths.get(5 * lengths.len() / 6)?;
    // An eighth of a radian of the phase on either side.
    let found = crossings(((usual_s / PI / 8.0 / period_s).round() as usize).max(shortest));
    // Noise may cross several times at one turn.
    let is_one = |a: &Turn, b: &Turn| b.time_s - a.time_s < HALF * usual_s;
    Some(found.chunk_by(is_one).map(|turn| turn[turn.len() / 2]).collect())
}

/// The longest run of turning points between which the swings never grow and stand out of the noise.
fn free_part(turns: &[Turn], noise: f64) -> Vec<Turn> {
    let ways: Vec<f64> = turns.windows(2).map(|pair| (pair[1].angle - pair[0].angle).abs()).collect();
    let is_clear = |way: f64| (10.0 * SIGNIFICANT * noise..TAU).contains(&way);
    let decays = |a: &f64, b: &f64| is_clear(*a) && is_clear(*b) && *b < a + 2.0 * SIGNIFICANT * noise;
    let (mut first, mut longest) = (0, 0..0);
    for run in ways.chunk_by(decays) {
        if run.len() > longest.len() {
            longest = first..first + run.len();
        }
        first += run.len();
    }
    // The hand may still hold it at the first turn.
    turns.get(longest.start + 1..=longest.end).map_or_else(Vec::new, <[Turn]>::to_vec)
}

/// Angle at which it hangs, rad: the loss of amplitude between neighbours cancels.
fn rest(turns: &[Turn]) -> f64 {
    median(turns.windows(3).map(|t| 0.25 * (t[0].angle + 2.0 * t[1].angle + t[2].angle)).collect())
}

/// Gravity moment over inertia, 1/s². `None` for swings over the top.
fn gravity(turns: &[Turn], rest: f64) -> Option<f64> {
    let rate = |pair: &[Turn]| {
        let amplitude = 0.5 * ((pair[0].angle - rest).abs() + (pair[1].angle - rest).abs());
        (amplitude < PI).then(|| PI / (mean_of_agm(1.0, (0.5 * amplitude).cos()) * (pair[1].time_s - pair[0].time_s)))
    };
    let rates = turns.windows(2).map(rate).collect::<Option<Vec<f64>>>()?;
    // Early half swings are timed best.
    Some(median(rates[..rates.len().div_ceil(2)].to_vec()).powi(2))
}

/// Arithmetic-geometric mean (Gauss).
fn mean_of_agm(mut a: f64, mut b: f64) -> f64 {
    while (a - b).abs() > 1e-15 * a {
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
    }
    a
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(0.0)
}

/// Adds one half swing, at points evenly spread over its path.
fn half_swing(track: &mut Track, [from, to]: [Turn; 2], (rest, gravity): (f64, f64), start_s: f64) {
    // The midpoint rule is then exact to 0.03 %.
    let points = 24;
    let start = track.fine.len();
    let amplitudes = [from, to].map(|turn| (turn.angle - rest).abs());
    for k in 0..points {
        let share = (k as f64 + 0.5) / points as f64;
        let position = from.angle + share * (to.angle - from.angle);
        let amplitude = amplitudes[0] + share * (amplitudes[1] - amplitudes[0]);
        let square = 2.0 * gravity * ((position - rest).cos() - amplitude.cos());
        let phase = (1.0 - 2.0 * share).acos() / PI;
        track.fine.push(Fine {
            time_s: from.time_s - start_s + phase * (to.time_s - from.time_s),
            position,
            velocity: square.max(0.0).sqrt() * (to.angle - from.angle).signum(),
            ..Fine::default()
        });
    }
    let own = &track.fine[start..];
    let motion = Motion {
        time_s: 0.5 * (from.time_s + to.time_s) - start_s,
        position: 0.5 * (from.angle + to.angle),
        velocity: own.iter().map(|point| point.velocity).sum::<f64>() / points as f64,
        ..Motion::default()
    };
    let span = Span { start, len: points, weighing: Weighing::Even };
    track.rows.push(Row { motion, angle_rad: motion.position, along: Vec2::x(), span, ..Row::default() });
}
