//! Slips of the fingers on a standing block as candidates: over all rests, and finer around the best.

use super::stands::{Rows, Stand};
use crate::diagnose::data::limits::{HALF, PARTS};
use crate::diagnose::hypotheses::axis::Axis;
use crate::diagnose::hypotheses::candidate::Candidate;
use crate::diagnose::hypotheses::fingertip_slip;
use crate::diagnose::selection::comparison::ChannelFit;
use estimation::identify::block::slip_detection::{Heights, LEAST, Slip, Stretch, is_seen};
use haptics::law::Kind;
use std::iter::once;

/// Durations of a slip, s, that are tried in every rest beside a slip without duration.
/// Choice: no case of the ablation reads it.
const SLIP_DURATIONS_S: Axis = Axis::geometric(0.1, 0.3, 2);
/// Neighbouring rows, around which the start of the best slip is refined.
/// Choice: no case of the ablation reads it.
const NEXT_ROW: Axis = Axis::even(0.0, 1.0, 2);

/// Candidate slips in every rest, and finer ones around the best. `model`: regressors of the height beside them.
pub fn slips(rows: &Rows, stands: &[Stand], model: &[Vec<f64>], found: &mut Vec<Candidate>) {
    let rests = rests(stands);
    let heights = rows.heights(&rests);
    let best = heights.best(&heights.left(model), &|_| true).map(|b| b.slip);
    // The rest of the best slip gets refined neighbours instead.
    let others = (0..rests.len()).filter(|rest| best.is_none_or(|b| b.rest != *rest));
    let all = others.flat_map(|rest| {
        let starts = heights.starts(rest, PARTS);
        starts.into_iter().flat_map(move |start_s| {
            once(0.0).chain(SLIP_DURATIONS_S.values()).map(move |length_s| Slip { rest, start_s, length_s })
        })
    });
    let mut slips: Vec<Slip> = all.collect();
    slips.extend(best.map(|best| around(&heights, best)).unwrap_or_default());
    for slip in slips {
        let shown = heights.column(slip);
        if !is_seen(&shown) {
            continue;
        }
        let mut column = vec![0.0; rows.stand.len()];
        column[rests[slip.rest].rows.clone()].copy_from_slice(&shown);
        let cause = Candidate::one(fingertip_slip::ID, Kind::Plant, "dy", "m", column).at("t0", slip.start_s, "s");
        found.push(cause.at("duration", slip.length_s, "s").within(slip.rest).at_least(LEAST * rows.object_m));
    }
}

/// Distance of every chosen slip with its time and duration free (`Heights::way_m`): time, s, distance, m, and its
/// standard error, m. `model`: regressors of the height beside slips.
pub fn ways(rows: &Rows, stands: &[Stand], model: &[Vec<f64>], study: &ChannelFit) -> Vec<[f64; 3]> {
    let rests = rests(stands);
    let heights = rows.heights(&rests);
    let chosen: Vec<&Candidate> = study.picks().into_iter().map(|p| &study.candidates[p]).collect();
    let is_slip = |c: &&&Candidate| c.id == fingertip_slip::ID;
    let variance_m2 = study.solved.as_ref().map_or(0.0, |s| s.variance(study.system.rows));
    let way = |own: &&Candidate| {
        let (start_s, length_s) = (own.value("t0")?, own.value("duration")?);
        let rest = rests.iter().position(|r| own.regressors[0][r.rows.clone()].iter().any(|share| *share > 0.0))?;
        let others = chosen.iter().filter(is_slip).filter(|c| c.searched[0].value != start_s);
        let model =
            [model, &others.flat_map(|c| &c.regressors).map(|column| column.to_vec()).collect::<Vec<_>>()].concat();
        let left = heights.left(&model);
        let best = heights.tried(&left, Slip { rest, start_s, length_s })?;
        let (way_m, error_m) = heights.way_m(&left, best, variance_m2);
        Some([start_s, way_m, error_m])
    };
    chosen.iter().filter(is_slip).filter_map(way).collect()
}

fn rests(stands: &[Stand]) -> Vec<Stretch> {
    stands.iter().map(|s| Stretch { rows: s.first..s.end, from_s: s.from_s }).collect()
}

impl Rows {
    fn heights<'a>(&'a self, rests: &'a [Stretch]) -> Heights<'a> {
        Heights { time_s: &self.time_s, height_m: &self.height_m, half_s: self.half_s, rests }
    }
}

fn around(heights: &Heights<'_>, best: Slip) -> Vec<Slip> {
    let (first_s, last_s) = heights.bounds(best.rest);
    let rows = &heights.rests[best.rest].rows;
    let step_s = (last_s - heights.time_s[rows.start]) / (rows.len() - 1).max(1) as f64;
    let lengths = SLIP_DURATIONS_S.around(best.length_s, 1.0, HALF);
    let lengths = if best.length_s > 0.0 { lengths.to_vec() } else { vec![0.0] };
    let mut starts = NEXT_ROW.around(best.start_s, step_s, HALF).map(|s| s.clamp(first_s, last_s)).to_vec();
    starts.dedup();
    let with = |start_s: f64| lengths.iter().map(move |length_s| Slip { start_s, length_s: *length_s, ..best });
    starts.into_iter().flat_map(with).collect()
}
