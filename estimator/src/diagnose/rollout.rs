//! What a cause is worth when the model runs on its own: forward in time from the measured state, over short windows of the locked blocks.
//!
//! A model with an inertia is driven by the measured force, and its position is compared. A model without one (a light crank) would follow
//! every error of the force at once: there a hand holds on, which wants to be where the handle was measured, and its force is compared. The
//! laws are stepped by the integrator of the servo's worlds.

use super::extend::effects_of;
use super::force::{self, Model};
use super::geometry::Study;
use super::report::{Rollout, RolloutOf};
use super::system::Use;
use super::track::{Place, Track};
use haptics::device::HandImpedance;
use haptics::law::{Coordinate, Effect, Kind, Memories, Motion, advance, drive_forces, inertia, step_coordinate_with};

/// Length of a window, s; windows are shorter at the end of a block, but never than half of it.
pub const WINDOW_S: f64 = 0.5;
/// Longest steps, s: of a coordinate with its own inertia, and of one that a hand holds.
const STEP_S: f64 = 1e-3;
const HELD_STEP_S: f64 = 2.5e-4;
/// What the fingertips move along with a handle without inertia, kg: small beside every force here, large enough for the step.
const TIP_KG: f64 = 5e-3;
/// Fewer windows say nothing.
const LEAST_WINDOWS: usize = 3;
/// The laws must give what the comparison of columns gives, up to this share of what the cause takes off.
const FAITHFUL: f64 = 0.5;
/// Draws of the bootstrap over windows.
const DRAWS: usize = 400;
/// Rows that are trusted less are no judge of the laws.
const TRUSTED: f64 = 0.5;

/// One side of the comparison: laws, and the measured force without what the found faults of the sensor make of it.
struct Side {
    effects: Vec<Effect>,
    drive: Vec<f64>,
    /// What the columns leave of the force, one a row.
    left: Vec<f64>,
}

/// The rollout without and with the k-th of the chosen causes, all others in; nothing where it cannot be done faithfully: a cause that no
/// law of the world can run, or too little held-out motion.
pub fn rollout(track: &Track, model: &Model, study: &Study, k: usize) -> Option<Rollout> {
    let picks = study.picks();
    let rest: Vec<usize> = picks.iter().enumerate().filter(|(i, _)| *i != k).map(|(_, p)| *p).collect();
    let (without, with) = (side(track, model, study, &rest)?, side(track, model, study, &picks)?);
    if !(faithful(track, study, &without, &with) && faithful(track, study, &with, &without)) {
        return None;
    }
    let windows = windows(track, study);
    if windows.len() < LEAST_WINDOWS {
        return None;
    }
    let driven = inertia(&without.effects) > 0.0 && inertia(&with.effects) > 0.0 && !track.planar;
    let errors = |side: &Side| -> Vec<(f64, f64)> {
        let starts = memories(track, &side.effects);
        windows.iter().map(|window| run(track, side, window.clone(), &starts[window.start], driven)).collect()
    };
    let (before, after) = (errors(&without), errors(&with));
    let all: Vec<usize> = (0..windows.len()).collect();
    let mean = |of: &[(f64, f64)], drawn: &[usize]| {
        let (sum, count) = drawn.iter().fold((0.0, 0.0), |(s, n), w| (s + of[*w].0, n + of[*w].1));
        sum / f64::max(count, 1.0)
    };
    let share = |drawn: &[usize]| 1.0 - mean(&after, drawn) / mean(&before, drawn).max(1e-300);
    let interval = super::gain::bootstrap(all.len(), DRAWS, &share);
    let unit = match (driven, track.coordinate) {
        (true, Coordinate::Linear) => "m",
        (true, Coordinate::Angular) => "rad",
        (false, Coordinate::Linear) => "N",
        (false, Coordinate::Angular) => "N m",
    };
    let (rms_before, rms_after) = (mean(&before, &all).sqrt(), mean(&after, &all).sqrt());
    (rms_before.is_finite() && rms_after.is_finite()).then(|| Rollout {
        of: if driven { RolloutOf::Position } else { RolloutOf::Force },
        unit: unit.to_owned(),
        window_s: WINDOW_S,
        windows: windows.len(),
        rms_before,
        rms_after,
        share: share(&all),
        interval,
    })
}

fn side(track: &Track, model: &Model, study: &Study, picks: &[usize]) -> Option<Side> {
    let solved = study.system.solve(picks)?;
    let effects = effects_of(track, model, study, picks, &solved)?;
    let left = super::geometry::residual(&study.y, &study.base, &study.candidates, picks, &solved);
    // Nothing drives what moves freely, and what its mass needs stands on the other side.
    let mut drive = if track.freely.is_some() { vec![0.0; study.y.len()] } else { study.y.clone() };
    let mut at = study.base.len();
    for candidate in picks.iter().map(|p| &study.candidates[*p]) {
        for (column, value) in candidate.columns.iter().zip(&solved.values[at..]) {
            if candidate.kind == Kind::Instrument {
                drive.iter_mut().zip(column.iter()).for_each(|(d, c)| *d -= value * c);
            }
        }
        at += candidate.columns.len();
    }
    Some(Side { effects, drive, left })
}

/// Whether the laws need the force that the columns say.
fn faithful(track: &Track, study: &Study, side: &Side, other: &Side) -> bool {
    let (mut off, mut worth) = (0.0, 0.0);
    for stretch in stretches(track) {
        let motions: Vec<Motion> = track.rows[stretch.clone()].iter().map(|r| r.motion).collect();
        let needed = match track.freely {
            Some(_) => force::needed(track, &side.effects)[stretch.clone()].to_vec(),
            None => drive_forces(&side.effects, &motions),
        };
        for (i, needed) in stretch.zip(needed) {
            if study.weight[i] > TRUSTED && track.rows[i].motion.direction.abs() > TRUSTED {
                off += (side.drive[i] - side.left[i] - needed).powi(2);
                worth += (side.left[i] - other.left[i]).powi(2);
            }
        }
    }
    off <= FAITHFUL * FAITHFUL * worth
}

/// Rows along the motion that follow each other.
fn stretches(track: &Track) -> Vec<std::ops::Range<usize>> {
    let mut found: Vec<std::ops::Range<usize>> = Vec::new();
    for i in track.along() {
        match found.last_mut() {
            Some(last) if last.end == i && track.follows(i) => last.end = i + 1,
            _ => found.push(i..i + 1),
        }
    }
    found
}

/// Pieces of the locked blocks.
fn windows(track: &Track, study: &Study) -> Vec<std::ops::Range<usize>> {
    let rows = (WINDOW_S / track.period_s).round().max(4.0) as usize;
    let mut found = Vec::new();
    for stretch in stretches(track) {
        let mut start = stretch.start;
        while start < stretch.end {
            let block = study.system.uses[start];
            let Use::Locked(_) = block else {
                start += 1;
                continue;
            };
            let until = (start + rows).min(stretch.end);
            let end = (start..until).find(|i| study.system.uses[*i] != block).unwrap_or(until);
            if 2 * (end - start) >= rows {
                found.push(start..end);
            }
            start = end.max(start + 1);
        }
    }
    found
}

/// What the laws remember at every row, after the measured motion.
fn memories(track: &Track, effects: &[Effect]) -> Vec<Memories> {
    let mut memory = Memories::default();
    (0..track.rows.len())
        .map(|i| {
            if track.follows(i) && track.rows[i].place == Place::Along {
                let (before, now) = (&track.rows[i - 1].motion, &track.rows[i].motion);
                let step_s = (now.time_s - before.time_s).max(1e-9);
                let velocity = (now.position - before.position) / step_s;
                advance(effects, &Motion { velocity, ..*now }, &mut memory, step_s);
            } else {
                memory = Memories::default();
            }
            memory
        })
        .collect()
}

/// Sum of the squared errors over a window, and their number.
fn run(track: &Track, side: &Side, window: std::ops::Range<usize>, start: &Memories, driven: bool) -> (f64, f64) {
    let rows = &track.rows;
    let mut memory = *start;
    let first = &rows[window.start].motion;
    let (mut position, mut velocity) = (first.position, first.velocity);
    let hand = HandImpedance::default();
    let extra = if driven { 0.0 } else { (TIP_KG - inertia(&side.effects)).max(0.0) };
    let (mut sum, mut count) = (0.0, 0.0);
    for i in window.start + 1..window.end {
        let (from, to) = (&rows[i - 1].motion, &rows[i].motion);
        let span_s = (to.time_s - from.time_s).max(1e-9);
        let parts = (span_s / if driven { STEP_S } else { HELD_STEP_S }).ceil().max(1.0);
        let mut held_n = 0.0;
        for part in 0..parts as usize {
            let x = (part as f64 + 0.5) / parts;
            let between = |a: f64, b: f64| a + x * (b - a);
            if !driven {
                let (wanted, speed) = (between(from.position, to.position), between(from.velocity, to.velocity));
                held_n = hand.stiffness_n_m * (wanted - position) + hand.damping_n_s_m * (speed - velocity);
            }
            let motion = Motion {
                time_s: between(from.time_s, to.time_s),
                position,
                velocity,
                acceleration: 0.0,
                direction: velocity.signum(),
                normal_force_n: between(from.normal_force_n, to.normal_force_n),
                up_along: between(from.up_along, to.up_along),
            };
            let drive = between(side.drive[i - 1], side.drive[i]) + held_n;
            (position, velocity) =
                step_coordinate_with(&side.effects, &motion, &mut memory, drive, extra, span_s / parts);
        }
        let error = if driven { position - to.position } else { held_n };
        sum += error * error;
        count += 1.0;
    }
    (sum, count)
}
