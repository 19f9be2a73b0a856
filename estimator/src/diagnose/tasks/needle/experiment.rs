//! Insertions that would settle the open questions about a needle: the same regressors on a recording that has not been
//! made yet.

use super::hole::Shaft;
use super::rows::{Needle, Phase, Row};
use super::sheet;
use crate::diagnose::contract::{Alternative, Experiment, NextExperiment};
use crate::diagnose::data::limits::GAP_IN_PERIODS;
use crate::diagnose::data::regression_data::Span;
use crate::diagnose::experiment::proposal;
use crate::diagnose::experiment::strokes::FREE_S;
use crate::diagnose::experiment::waypoints::{Insertions, PIERCE};
use crate::diagnose::selection::comparison::Compared;
use estimation::segment::threshold::percentile;
use haptics::law::object::MembraneLaw;

/// Numbers of insertions. The least that is likely to suffice is proposed.
/// Choice: halved or doubled, none of 15 answers changes.
const INSERTIONS: [usize; 3] = [1, 2, 4];
/// Half of a stroke in the hole, in depths of the dent.
/// Choice: halved or doubled, none of 15 answers changes.
const HALF_STROKE: f64 = 0.85;
/// Lowest and highest speed of a proposed motion, in depths of the dent per second.
/// Choice: not varied. They change the words of a proposal and no diagnosis.
const SPEEDS_S: (f64, f64) = (9.0, 43.0);
/// Time without touch before and after, s.
const WORDS: &str = "push in slowly, draw back before the sheet gives way, push through, move to and fro in the hole slowly and fast, \
                     draw out";

/// The recording to make; `None` if it would settle no open question.
pub fn propose(
    open: &[Alternative],
    (needle, law): (&Needle, Option<&MembraneLaw>),
    (sheet, shaft): (&Compared, Option<&Shaft<'_>>),
) -> Option<NextExperiment> {
    proposal::shortest(open, INSERTIONS, &|count| {
        let (asked, motion) = asked(needle, count)?;
        let imagined = imagine(needle, &motion, asked.free_s);
        let mut channels = vec![(sheet::columns(&imagined, law).imagined(), &sheet.study)];
        channels.extend(shaft.map(|s| (s.imagined(&imagined, law), &s.compared.study)));
        let places = if count == 1 { "" } else { "; the same at other places" };
        Some((asked, format!("{WORDS}{places}"), channels))
    })
}

/// As deep as the sheet was pressed before the puncture, and at least as fast as before.
fn asked(needle: &Needle, count: usize) -> Option<(Experiment, Insertions)> {
    let pressed = needle.rows.iter().filter(|r| matches!(r.phase, Phase::Loading | Phase::Unloading));
    let deep_m = pressed.map(|r| r.depth_m).fold(0.0, f64::max);
    let moving = needle.rows.iter().filter(|r| r.depth_m > 0.0).map(|r| r.rate_m_s.abs());
    let mut asked = Experiment {
        id: PIERCE.to_owned(),
        seconds: f64::MIN_POSITIVE,
        free_s: if needle.two_fingered { FREE_S } else { 0.0 },
        middle: deep_m * (1.0 + HALF_STROKE),
        half_range: deep_m * HALF_STROKE,
        fast: percentile(&mut moving.collect::<Vec<_>>(), 0.95).clamp(SPEEDS_S.0 * deep_m, SPEEDS_S.1 * deep_m),
        ..Experiment::default()
    };
    let one_s = Insertions::of(&asked)?.duration_s();
    asked.seconds = (count as f64 - 0.5) * one_s;
    let motion = Insertions::of(&asked)?;
    asked.seconds = motion.duration_s() - 1e-6;
    Some((asked, motion))
}

/// Predicted rows of that motion.
fn imagine(needle: &Needle, motion: &Insertions, free_s: f64) -> Needle {
    let period_s = needle.period_s;
    let count = |seconds: f64| (seconds / period_s) as usize;
    let at = |t: f64| motion.depth_m(t - free_s);
    let mut rows: Vec<Row> = Vec::new();
    let (mut deepest, mut through, mut push) = (f64::MIN, false, 0);
    for k in 0..count(motion.duration_s() + 2.0 * free_s) {
        let time_s = k as f64 * period_s;
        let is_held = (free_s..=free_s + motion.duration_s()).contains(&time_s);
        let (depth, before, after) = (at(time_s), at(time_s - 0.5 * period_s), at(time_s + 0.5 * period_s));
        let rate = (after - before) / period_s;
        let (here, _) = motion.place(time_s - free_s);
        if here != push {
            (push, deepest, through) = (here, f64::MIN, false);
        }
        let phase = match depth {
            _ if !is_held => Some(Phase::Empty),
            d if d < -needle.at_surface_m => Some(Phase::Outside),
            d if d < needle.at_surface_m => None,
            _ if through => Some(Phase::Hole),
            d if d > deepest => Some(Phase::Loading),
            _ => Some(Phase::Unloading),
        };
        deepest = deepest.max(depth);
        through |= depth > motion.puncture_m();
        let Some(phase) = phase else { continue };
        let is_new = rows.last().is_none_or(|r| r.phase != phase || time_s - r.time_s > GAP_IN_PERIODS * period_s);
        let stretch = rows.last().map_or(0, |r| r.stretch + usize::from(is_new));
        rows.push(Row {
            recording: 0,
            start_s: 0.0,
            time_s,
            depth_m: depth,
            rate_m_s: rate,
            side_m: 0.0,
            acceleration_m_s2: 4.0 * (after - 2.0 * depth + before) / (period_s * period_s),
            force_n: 0.0,
            phase,
            hold: 0,
            push,
            deepest_m: deepest,
            stretch,
            span: Span::default(),
        });
    }
    let directions = needle.directions.clone();
    Needle { rows, fine: Vec::new(), recordings: 1, holds: 1, punctures: Vec::new(), late: None, directions, ..*needle }
}
