//! Laws along one coordinate, over the locked blocks.

use super::integrate::{Side as Driven, follow, over};
use super::windows::{Compared, Errors, NO_LAW, NOT_FAITHFUL, ROLLOUT_WINDOW_S, told, windows};
use crate::diagnose::contract::{Rollout, RolloutOf};
use crate::diagnose::data::limits::HALF;
use crate::diagnose::data::regression_data::{Model, Place, Track};
use crate::diagnose::extension::model::effects_of;
use crate::diagnose::hypotheses::law_forces;
use crate::diagnose::selection::comparison::ChannelFit;
use crate::diagnose::selection::layout::Use;
use haptics::law::{Coordinate, Effect, Kind, Memories, drive_forces, inertia};

/// One side of the comparison: laws, and the measured force less the found sensor faults.
struct Side {
    effects: Vec<Effect>,
    drive: Vec<f64>,
    /// Residual of the force after the regressors, one per row.
    residual: Vec<f64>,
}

/// The rollout without and with the k-th of the chosen causes, all others in. The error is the reason why it cannot be
/// done faithfully: a cause without a law in a world, or too little held-out motion.
pub fn rollout(track: &Track, model: &Model, study: &ChannelFit, k: usize) -> Result<Rollout, String> {
    let picks = study.picks();
    let rest = study.picks_without(k);
    let sides = side(track, model, study, &rest).zip(side(track, model, study, &picks));
    let (without, with) = sides.ok_or_else(|| NO_LAW.to_owned())?;
    if !(faithful(track, study, &without, &with) && faithful(track, study, &with, &without)) {
        return Err(NOT_FAITHFUL.to_owned());
    }
    let driven = inertia(&without.effects) > 0.0 && inertia(&with.effects) > 0.0 && !track.planar;
    let sides = [&without, &with].map(|side| (side, memories(track, &side.effects)));
    let errors = |window: &Vec<usize>| {
        sides.each_ref().map(|(Side { effects, drive, .. }, starts)| {
            let row = |i: usize| (track.rows[i].motion, drive[i]);
            over(window, &row, Driven { effects, memory: starts[window[0]], acts: &mut |_, _| 0.0, driven })
        })
    };
    let windows: Vec<[Errors; 2]> = locked(track, study).iter().map(errors).collect();
    let unit = match (driven, track.coordinate) {
        (true, Coordinate::Linear) => "m",
        (true, Coordinate::Angular) => "rad",
        (false, Coordinate::Linear) => "N",
        (false, Coordinate::Angular) => "N m",
    };
    let of = if driven { RolloutOf::Position } else { RolloutOf::Force };
    told(&Compared { of, unit, window_s: ROLLOUT_WINDOW_S, in_turn: false }, &windows)
}

fn side(track: &Track, model: &Model, study: &ChannelFit, picks: &[usize]) -> Option<Side> {
    let solved = study.system.solve(picks)?;
    let effects = effects_of(track, model, study, picks, &solved)?;
    let residual = study.residual_of(picks, &solved);
    // No force drives a free motion, and its inertial force is the target.
    let mut drive = if track.freely.is_some() { vec![0.0; study.target.len()] } else { study.target.clone() };
    for (candidate, values) in study.with_values(picks, &solved.values).filter(|(c, _)| c.kind == Kind::Instrument) {
        for (column, value) in candidate.regressors.iter().zip(values) {
            drive.iter_mut().zip(column.iter()).for_each(|(d, c)| *d -= value * c);
        }
    }
    Some(Side { effects, drive, residual })
}

/// True if the laws agree with the force of the regressors.
fn faithful(track: &Track, study: &ChannelFit, side: &Side, other: &Side) -> bool {
    let (mut off, mut worth) = (0.0, 0.0);
    let of_all = track.freely.map(|_| law_forces::needed(track, &side.effects));
    for rows in segments(track) {
        let needed = match &of_all {
            Some(needed) => rows.iter().map(|i| needed[*i]).collect(),
            None => drive_forces(&side.effects, &rows.iter().map(|i| track.rows[*i].motion).collect::<Vec<_>>()),
        };
        for (i, needed) in rows.into_iter().zip(needed) {
            if study.layout.weight[i] > HALF && track.rows[i].motion.direction.abs() > HALF {
                off += (side.drive[i] - side.residual[i] - needed).powi(2);
                worth += (side.residual[i] - other.residual[i]).powi(2);
            }
        }
    }
    off <= HALF * HALF * worth
}

/// Rows along the motion that follow each other.
fn segments(track: &Track) -> Vec<Vec<usize>> {
    windows(&track.along().collect::<Vec<usize>>(), [1, usize::MAX], |_, i| track.follows(i))
}

/// Windows within the locked blocks.
fn locked(track: &Track, study: &ChannelFit) -> Vec<Vec<usize>> {
    let rows = (ROLLOUT_WINDOW_S / track.period_s).round().max(4.0) as usize;
    let uses = &study.system.uses;
    let order: Vec<usize> = track.along().filter(|i| matches!(uses[*i], Use::Locked(_))).collect();
    windows(&order, [rows.div_ceil(2), rows], |a, b| a + 1 == b && track.follows(b) && uses[a] == uses[b])
}

/// Memory of the laws at every row, after the measured motion.
fn memories(track: &Track, effects: &[Effect]) -> Vec<Memories> {
    let mut memory = Memories::default();
    (0..track.rows.len())
        .map(|i| {
            if track.follows(i) && track.rows[i].place == Place::Along {
                follow(effects, [&track.rows[i - 1].motion, &track.rows[i].motion], &mut memory);
            } else {
                memory = Memories::default();
            }
            memory
        })
        .collect()
}
