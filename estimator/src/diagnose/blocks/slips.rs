//! Where a slip of the fingers on a standing block is looked for: first everywhere by plain least squares, then closely around the best place.

use super::ground::{Rows, Stand};
use super::moved::LEAST_M;
use crate::diagnose::candidate::Candidate;
use haptics::law::Kind;
use std::ops::Range;

/// Starts that are asked about in every rest, besides its very beginning.
const STARTS: usize = 10;
/// How long a slip may take, s: those that are asked about in every rest, …
const LENGTHS_S: [f64; 3] = [0.0, 0.1, 0.3];
/// … and those of the search for the best place.
const SEARCHED_S: [f64; 9] = [0.0, 0.02, 0.05, 0.08, 0.1, 0.13, 0.17, 0.23, 0.3];
/// Most starts of that search in one rest.
const MOST_STARTS: usize = 60;
/// The best place is approached in so many rounds, each with steps of this share of those before.
const ROUNDS: usize = 8;
const SHRINKS: f64 = 0.6;
/// Around the best place: shares of a row's time, and of the duration.
const STEPS: [f64; 5] = [-0.4, -0.15, 0.0, 0.15, 0.4];
const SHARES: [f64; 5] = [0.75, 0.9, 1.0, 1.1, 1.33];
/// A slip of no duration is tried beside such ones, s.
const SHORT_S: [f64; 3] = [0.0, 0.01, 0.02];
/// So much of a slip must fall between the first and the last row of its rest: of one of which less is seen, anything could be said.
const SEEN: f64 = 0.3;
/// Less than this share of a column beside the model's own says nothing.
const OWN: f64 = 1e-3;

/// The ramp of one slip as the rows would show it.
#[derive(Clone, Copy, Debug)]
struct Slip {
    stand: usize,
    start_s: f64,
    length_s: f64,
}

/// Slips in every rest, and closer ones around the best. `model`: what the height is made of beside them.
pub fn slips(rows: &Rows, stands: &[Stand], model: &[Vec<f64>], found: &mut Vec<Candidate>) {
    let best = best(rows, stands, model);
    // Where the best one is, its neighbours are those around it.
    let others = (0..stands.len()).filter(|stand| best.is_none_or(|b| b.stand != *stand));
    let all = others.flat_map(|stand| {
        let starts = starts(rows, &stands[stand], STARTS);
        starts.into_iter().flat_map(move |start_s| LENGTHS_S.map(|length_s| Slip { stand, start_s, length_s }))
    });
    let mut slips: Vec<Slip> = all.collect();
    slips.extend(best.map(|best| around(rows, &stands[best.stand], best)).unwrap_or_default());
    for slip in slips {
        let stand = &stands[slip.stand];
        let mut column = vec![0.0; rows.stand.len()];
        (stand.first..stand.end).for_each(|i| column[i] = rows.slipped(i, slip));
        if !is_seen(&column[stand.first..stand.end]) {
            continue;
        }
        let cause = Candidate::one("fingertip-slip", Kind::Plant, "dy", "m", column).at("t0", slip.start_s, "s");
        found.push(cause.at("duration", slip.length_s, "s").within(slip.stand).at_least(LEAST_M));
    }
}

/// What has happened before the first row is in the rest's own height.
fn is_seen(column: &[f64]) -> bool {
    column.last().zip(column.first()).is_some_and(|(last, first)| last - first > SEEN)
}

/// Times in a rest at which a slip may begin: its beginning, and those of its rows.
fn starts(rows: &Rows, stand: &Stand, most: usize) -> Vec<f64> {
    let every = (stand.end - stand.first).div_ceil(most).max(1);
    // The load shows the contact through a filter, too.
    let mut found = vec![stand.from_s - 0.5 * rows.half_s];
    found.extend((stand.first..stand.end).step_by(every).map(|i| rows.time_s[i]));
    found.dedup();
    found
}

/// The slip that takes most off the squares of what the model leaves.
fn best(rows: &Rows, stands: &[Stand], model: &[Vec<f64>]) -> Option<Slip> {
    let own = orthonormal(model);
    let mut left = rows.height_m.clone();
    for unit in &own {
        let share = dot(unit, &left, 0..left.len());
        left.iter_mut().zip(unit).for_each(|(l, u)| *l -= share * u);
    }
    let taken = |slip: Slip| {
        let range = stands[slip.stand].first..stands[slip.stand].end;
        let column: Vec<f64> = range.clone().map(|i| rows.slipped(i, slip)).collect();
        let along = |of: &[f64]| column.iter().zip(&of[range.clone()]).map(|(c, v)| c * v).sum::<f64>();
        let whole = column.iter().map(|c| c * c).sum::<f64>();
        let beside = whole - own.iter().map(|unit| along(unit).powi(2)).sum::<f64>();
        (is_seen(&column) && beside > OWN * whole).then(|| (along(&left).powi(2) / beside, slip))
    };
    let most = |slips: Vec<Slip>| slips.into_iter().filter_map(&taken).max_by(|a, b| a.0.total_cmp(&b.0));
    let everywhere = stands.iter().enumerate().flat_map(|(stand, at)| {
        let starts = starts(rows, at, MOST_STARTS);
        starts.into_iter().flat_map(move |start_s| SEARCHED_S.map(|length_s| Slip { stand, start_s, length_s }))
    });
    let (mut held, mut best) = most(everywhere.collect())?;
    let mut step = 1.0;
    for _ in 0..ROUNDS {
        if let Some((more, better)) = most(about(rows, &stands[best.stand], best, step)).filter(|(m, _)| *m > held) {
            (held, best) = (more, better);
        }
        step *= SHRINKS;
    }
    Some(best)
}

/// Slips that begin a little earlier or later and take a little more or less time.
fn about(rows: &Rows, stand: &Stand, slip: Slip, step: f64) -> Vec<Slip> {
    let last_s = rows.time_s[stand.end - 1];
    let starts =
        [-1.0, 0.0, 1.0].map(|s| (slip.start_s + s * step * rows.half_s).clamp(stand.from_s - rows.half_s, last_s));
    let lengths = [-0.3, 0.0, 0.3].map(|s| (slip.length_s * (1.0 + s * step)).max(0.0));
    let with = |start_s: f64| lengths.map(|length_s| Slip { start_s, length_s, ..slip });
    starts.into_iter().flat_map(with).collect()
}

fn around(rows: &Rows, stand: &Stand, best: Slip) -> Vec<Slip> {
    let last_s = rows.time_s[stand.end - 1];
    let step_s = (last_s - rows.time_s[stand.first]) / (stand.end - stand.first - 1).max(1) as f64;
    let lengths = if best.length_s > 0.0 { SHARES.map(|s| s * best.length_s).to_vec() } else { SHORT_S.to_vec() };
    let mut starts = STEPS.map(|s| (best.start_s + s * step_s).clamp(stand.from_s - rows.half_s, last_s)).to_vec();
    starts.dedup();
    let with = |start_s: f64| lengths.iter().map(move |length_s| Slip { start_s, length_s: *length_s, ..best });
    starts.into_iter().flat_map(with).collect()
}

impl Rows {
    /// Share of a slip's way that a row shows: its heights are means over a filter's window.
    fn slipped(&self, row: usize, slip: Slip) -> f64 {
        /// Places in the window, as shares of its half, and how much they count.
        const WINDOW: [(f64, f64); 5] = [(-0.8, 0.36), (-0.4, 0.84), (0.0, 1.0), (0.4, 0.84), (0.8, 0.36)];
        let share = |t: f64| {
            let since = t - slip.start_s;
            if slip.length_s > 0.0 {
                (since / slip.length_s).clamp(0.0, 1.0)
            } else {
                f64::from(u8::from(since >= 0.0))
            }
        };
        let weights: f64 = WINDOW.iter().map(|(_, w)| w).sum();
        WINDOW.iter().map(|(at, w)| w * share(self.time_s[row] + at * self.half_s)).sum::<f64>() / weights
    }
}

fn dot(a: &[f64], b: &[f64], range: Range<usize>) -> f64 {
    range.map(|i| a[i] * b[i]).sum()
}

/// An orthonormal basis of what the columns span (Gram and Schmidt, twice); what is nearly in the others is left out.
fn orthonormal(columns: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let mut found: Vec<Vec<f64>> = Vec::new();
    for column in columns {
        let n = column.len();
        let mut unit = column.clone();
        let size = dot(&unit, &unit, 0..n);
        for _ in 0..2 {
            for other in &found {
                let share = dot(other, &unit, 0..n);
                unit.iter_mut().zip(other).for_each(|(u, o)| *u -= share * o);
            }
        }
        let left = dot(&unit, &unit, 0..n);
        if left > 1e-12 * size {
            for u in &mut unit {
                *u /= left.sqrt();
            }
            found.push(unit);
        }
    }
    found
}
