//! Landing of a carried block: the load passes from the fingers to the support. From then on only the load tells motion
//! of the fingers (pads that yield, a slip of the grip) from lowering, so the earlier it is seen the better.

use super::signals::Blocks;
use crate::identify::limits::SIGNIFICANT;
use crate::segment::threshold::percentile;
use std::ops::Range;

/// Least change of a weight in a carry, as a share of the weight.
/// Choice: no case of the ablation reads it.
const LEAST_CHANGE: f64 = 0.1;
/// Share of the weight missing from the lift at which the ground takes a part of the load.
/// Choice: no case of the ablation reads it.
const GROUND_SHARE: f64 = 0.05;
/// Share of the weight up to which the load is followed; the line through it tells the beginning.
/// Choice: no case of the ablation reads it.
const FOLLOWED_SHARE: f64 = 0.5;
/// Time over which the load is followed at most, s.
/// Choice: no case of the ablation reads it.
const RISE_S: f64 = 0.2;
/// Shares of the weight up to which lines through the first part are fitted, too.
/// Choice: no case of the ablation reads it.
const FIRST_PART_SHARES: [f64; 2] = [0.25, 0.12];
/// Largest lead of the beginning that the line tells, s.
/// Choice: no case of the ablation reads it.
const LARGEST_LEAD_S: f64 = 0.06;

/// Usual lift over the time of a carry, N: steady, or changing evenly where contents run out. `rows`: samples in which the block is carried.
pub fn usual_lift(time_s: &[f64], rows: &[usize], lift_n: &dyn Fn(usize) -> f64) -> impl Fn(f64) -> f64 + use<> {
    let middle = |rows: &[usize]| percentile(&mut rows.iter().map(|i| lift_n(*i)).collect::<Vec<_>>(), 0.5);
    let whole = middle(rows);
    let (early, late) = rows.split_at(rows.len() / 2);
    let (mut slope, mut start_s) = (0.0, 0.0);
    if let ([first, ..], [.., last]) = (early, late) {
        let (change, span_s) = (middle(late) - middle(early), time_s[*last] - time_s[*first]);
        if change.abs() > LEAST_CHANGE * whole.abs() && span_s > 0.0 {
            (slope, start_s) = (2.0 * change / span_s, time_s[*first] + 0.5 * span_s);
        }
    }
    move |time_s| whole + slope * (time_s - start_s)
}

/// The first sample of `within` from which, up to its end, the lift is less than the block needs: it stands from there
/// on. The end of `within` if that is not true at its last sample. `carried`: rows in which the block is carried;
/// `lift_n`: of every sample.
pub fn stands_from(
    blocks: &Blocks<'_>,
    carried: &[usize],
    within: Range<usize>,
    lift_n: &dyn Fn(usize) -> f64,
) -> usize {
    if carried.is_empty() {
        return within.end;
    }
    let time_s = &blocks.signals.time_s;
    let usual = usual_lift(time_s, carried, lift_n);
    let gravity = blocks.recording.meta.gravity().max(1e-9);
    let usual = |i: usize| usual(time_s[i]);
    // A falling object needs less force, the block between its pads and one that slips on them alike: it counts if that
    // is the smaller doubt.
    let falls = |i: usize| usual(i) * blocks.acceleration_y[i].min(0.0) / gravity;
    let missing = |i: usize| usual(i) - lift_n(i);
    let limit = |off: &dyn Fn(usize) -> f64| {
        let mut all: Vec<f64> = carried.iter().map(|i| off(*i)).collect();
        // Half of the range of two thirds: a few rows at the ends may stand already.
        0.5 * SIGNIFICANT * (percentile(&mut all, 0.84) - percentile(&mut all, 0.16))
    };
    let plain_n = limit(&missing);
    let moving_n = limit(&|i| missing(i) + usual(i) * blocks.acceleration_y[i] / gravity);
    let stands = |i: &usize| {
        let (plain, least) = (missing(*i), GROUND_SHARE * usual(*i));
        plain > plain_n.max(least) || plain + falls(*i) > moving_n.max(least)
    };
    let (least, end) = (within.start, within.end);
    let clear = within.rev().take_while(stands).last().unwrap_or(end);
    if clear == end {
        return end;
    }
    let rises = |i: &usize| missing(*i) < FOLLOWED_SHARE * usual(*i) && time_s[*i] - time_s[clear] < RISE_S;
    let rise = (clear..time_s.len()).take_while(rises);
    let rise: Vec<(f64, f64)> = rise.map(|i| (time_s[i], missing(i))).collect();
    let begins_s = begin(&rise, usual(clear), plain_n.min(moving_n) / SIGNIFICANT);
    let begins_s = begins_s.map_or(time_s[clear], |s| s.clamp(time_s[clear] - LARGEST_LEAD_S, time_s[clear]));
    time_s[..clear].partition_point(|t| *t < begins_s).max(least)
}

/// Beginning of the load (N, after times, s) before it rose out of the noise: the zero of a straight line through its
/// rise. The load of a hard landing rises at once and then slowly, and a line through all of it would begin too early.
/// The line through its first part counts if it begins later for certain. `None` if it does not rise.
fn begin(rise: &[(f64, f64)], weight_n: f64, noise_n: f64) -> Option<f64> {
    let (mut begins_s, _) = zero(rise, noise_n).filter(|_| rise.len() > 2)?;
    for share in FIRST_PART_SHARES {
        let end = rise.iter().position(|(_, load)| *load > share * weight_n).map_or(rise.len(), |last| last + 1);
        if let Some((own_s, error_s)) = zero(&rise[..end], noise_n)
            && own_s - SIGNIFICANT * error_s > begins_s
        {
            begins_s = own_s;
        }
    }
    Some(begins_s)
}

/// Zero of a straight line through points, and its error by their noise, which neighbours share. `None` if it does not
/// rise.
fn zero(points: &[(f64, f64)], noise_n: f64) -> Option<(f64, f64)> {
    let n = points.len() as f64;
    let mean = |of: fn(&(f64, f64)) -> f64| points.iter().map(of).sum::<f64>() / n;
    let (time, load) = (mean(|p| p.0), mean(|p| p.1));
    let rising: f64 = points.iter().map(|(t, l)| (t - time) * (l - load)).sum();
    let spread: f64 = points.iter().map(|(t, _)| (t - time).powi(2)).sum();
    (points.len() > 1 && rising > 0.0).then(|| {
        let slope = rising / spread;
        let before = load / slope;
        (time - before, noise_n / slope * (1.0 + before * before * n / spread).sqrt())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Load over time every 4 ms, from 20 ms before it begins; `after`: its value at a time.
    fn load(after: impl Fn(f64) -> f64) -> Vec<(f64, f64)> {
        let all = (0..60).map(|k| 0.004 * f64::from(k) - 0.02).map(|t| (t, after(t.max(0.0))));
        // From where it is clear of the noise on.
        all.filter(|(_, load)| *load > 0.1).collect()
    }

    #[test]
    fn what_is_set_down_hard_is_not_taken_for_lowered_slowly() {
        let hard = load(|t| if t < 0.012 { t / 0.012 * 0.45 } else { 0.45 + (t - 0.012) * 4.0 });
        let (plain_s, _) = zero(&hard, 0.01).expect("it rises");
        let begins_s = begin(&hard, 2.5, 0.01).expect("it rises");
        assert!(plain_s < -0.03 && begins_s.abs() < 0.008, "{plain_s} {begins_s}");
        let slowly = load(|t| 6.0 * t);
        let begins_s = begin(&slowly, 2.5, 0.01).expect("it rises");
        assert!(begins_s.abs() < 1e-6, "{begins_s}");
    }
}
