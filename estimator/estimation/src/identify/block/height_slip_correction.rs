//! Slips of the grip on a standing block, as the fit takes them out of heights: the thesis's height that was 9 % off.

use super::placement_time::stands_from;
use super::rests::Rest;
use super::signals::{Blocks, MAIN, object};
use super::slip_detection::{Heights, LEAST, Slip, Stretch, may_stand};
use crate::identify::limits::{CERTAIN, LEAST_LINE_ROWS};
use crate::regression::linear::least_squares;
use foundation::signal::task::half_width;

/// Least decrease of −2 ln(likelihood) by a slip: no rows can be held out of so few, so it must be beyond doubt.
/// Choice: no case of the ablation reads it.
const SURE_SLIP: f64 = 50.0;

/// A slip of the grip at one end of a carry.
pub(super) struct HeightSlip {
    /// Index of the rest.
    pub(super) rest: usize,
    slip: Slip,
    half_s: f64,
    way_m: f64,
    error_m: f64,
    /// True at the end of a carry.
    placed: bool,
}

impl HeightSlip {
    /// Correction of a row's height to that of the grip in the air, m, and its error.
    pub(super) fn correction_m(&self, time_s: f64) -> (f64, f64) {
        let done = self.slip.shown(time_s, self.half_s);
        // A carried block is gripped as after a slip at its beginning, and as before one at its end.
        let share = if self.placed { -done } else { 1.0 - done };
        (share * self.way_m, share * self.error_m)
    }

    /// For the warnings of a fit.
    pub(super) fn told(&self, recording: &str, rest: &Rest) -> String {
        let when = if self.placed { "was put down" } else { "stood, before it was lifted" };
        format!(
            "{recording}: at {:.2} s the grip slipped on {} by {:.2} ± {:.2} mm when it {when}; heights have that taken out, and its error in \
             theirs",
            self.slip.start_s.max(0.0),
            object(rest.carry + 1),
            1e3 * self.way_m,
            1e3 * self.error_m
        )
    }
}

/// Rows of all rests.
#[derive(Default)]
struct Rows {
    time_s: Vec<f64>,
    height_m: Vec<f64>,
    lift_n: Vec<f64>,
    lift_rate: Vec<f64>,
    /// Contacts below.
    contacts: Vec<f64>,
    /// Index of the rest of each entry in `stretches`.
    numbers: Vec<usize>,
    stretches: Vec<Stretch>,
}

/// Slips at the ends of carries, one an end at most.
pub(super) fn height_slips(blocks: &Blocks<'_>, rests: &[Rest]) -> Vec<HeightSlip> {
    let object_m = blocks.signals.object_m();
    let rows = rows(blocks, rests, object_m);
    let half_s = half_window_s(blocks);
    let heights = Heights { time_s: &rows.time_s, height_m: &rows.height_m, half_s, rests: &rows.stretches };
    let n = rows.time_s.len();
    let mut model = model(&rows);
    let mut found: Vec<HeightSlip> = Vec::new();
    while n > model.len() + 1 {
        let left = heights.left(&model);
        let is_open = |stretch: usize| found.iter().all(|f| f.rest != rows.numbers[stretch]);
        let Some(best) = heights.best(&left, &is_open) else { break };
        let squares: f64 = left.left_m.iter().map(|l| l * l).sum();
        let after = (squares - best.taken_m2).max(1e-12 * squares);
        let variance_m2 = after / (n - model.len() - 1) as f64;
        let mut column = vec![0.0; n];
        column[heights.rests[best.slip.rest].rows.clone()].copy_from_slice(&heights.column(best.slip));
        model.push(column);
        let Ok(fit) = least_squares(&model, &rows.height_m, None) else { break };
        let own = fit.std_errors[model.len() - 1];
        let (way_m, open_m) = heights.way_m(&left, best, variance_m2);
        let score = n as f64 * (squares / after).ln();
        if score < SURE_SLIP || best.way_m.abs() < (LEAST * object_m).max(CERTAIN * own) {
            break;
        }
        let (rest, slip) = (rows.numbers[best.slip.rest], best.slip);
        found.push(HeightSlip { rest, slip, half_s, way_m, error_m: own.hypot(open_m), placed: rest % 2 == 1 });
    }
    found
}

/// Half of the window that smoothed channels are means over, s.
fn half_window_s(blocks: &Blocks<'_>) -> f64 {
    let time_s = &blocks.signals.time_s;
    let step_s = match time_s.as_slice() {
        [first, .., last] => (last - first) / (time_s.len() - 1) as f64,
        _ => 0.0,
    };
    half_width(time_s) as f64 * step_s
}

/// Regressors: each rest's own height, the give of pads and contacts, and the damping of the pads.
fn model(rows: &Rows) -> Vec<Vec<f64>> {
    let n = rows.time_s.len();
    let of = |f: &dyn Fn(usize) -> f64| (0..n).map(f).collect::<Vec<f64>>();
    let mut model: Vec<Vec<f64>> =
        rows.stretches.iter().map(|s| of(&|i| f64::from(u8::from(s.rows.contains(&i))))).collect();
    model.push(rows.lift_n.clone());
    model.push(of(&|i| rows.contacts[i] * rows.lift_n[i]));
    model.push(rows.lift_rate.clone());
    model
}

fn rows(blocks: &Blocks<'_>, rests: &[Rest], object_m: f64) -> Rows {
    let time_s = &blocks.signals.time_s;
    let half = half_width(time_s);
    let lift_rate = |i: usize| {
        let (before, after) = (i.saturating_sub(half), (i + half).min(time_s.len() - 1));
        (blocks.lift[after] - blocks.lift[before]) / (time_s[after] - time_s[before]).max(1e-9)
    };
    let mut rows = Rows::default();
    for (number, rest) in rests.iter().enumerate() {
        let (from_s, samples) = standing(blocks, rest, number % 2 == 1);
        let picked: Vec<usize> = samples.into_iter().step_by(2 * half).collect();
        if picked.len() < LEAST_LINE_ROWS || !may_stand(picked.iter().map(|i| blocks.height[*i]), object_m) {
            continue;
        }
        let first = rows.time_s.len();
        for i in picked {
            rows.time_s.push(time_s[i]);
            rows.height_m.push(blocks.height[i]);
            rows.lift_n.push(blocks.lift[i]);
            rows.lift_rate.push(lift_rate(i));
            rows.contacts.push((rest.below.len() + 1) as f64);
        }
        rows.numbers.push(number);
        rows.stretches.push(Stretch { rows: first..rows.time_s.len(), from_s });
    }
    rows
}

/// Time from which a block stands at one end of its carry, s, and the samples in which its height is that of the grip
/// over its support.
fn standing(blocks: &Blocks<'_>, rest: &Rest, placed: bool) -> (f64, Vec<usize>) {
    let time_s = &blocks.signals.time_s;
    let Some(first) = rest.samples.first().copied() else { return (0.0, Vec::new()) };
    if !placed {
        return (time_s[first], rest.samples.clone());
    }
    let carried = blocks.rows(&blocks.shown(MAIN, rest.carry + 1));
    let middle = carried.get(carried.len() / 2).map_or(first, |middle| *middle).min(first);
    let from = stands_from(blocks, &carried, middle..first, &|i| blocks.lift[i]);
    // The filter looks this far back into the air.
    let settled = if from < first { from + half_width(time_s) } else { from };
    let rest = rest.samples.iter().copied().filter(|i| *i >= settled);
    (time_s[from], (settled..first).chain(rest).collect())
}
