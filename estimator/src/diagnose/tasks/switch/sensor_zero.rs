//! Zero of the force sensor of a finger that pushes: its reading while it touches nothing, which may drift and jump.

use crate::diagnose::data::limits::{CERTAIN, HALF, PARTS};
use crate::diagnose::hypotheses::change_scan::{Scan, dot};
use estimation::regression::linear::least_squares_values;
use estimation::segment::threshold::percentile;
use haptics::Vec2;

/// Share of the blocks that are taken as free in each part of a recording, because a finger is free at some time.
/// Choice: halved, 6 of 21 answers change; doubled, 6 of 21 answers change.
const FREE_SHARE: f64 = 0.15;

/// Zero of both axes at each block, N. `along`: force in the direction in which the finger pushes, N.
pub fn zeros(force: &[Vec2], along: &[f64], noise_n: f64) -> Vec<Vec2> {
    let free = free_blocks(along);
    let axes = [0, 1].map(|axis| zero(&free, force.len(), noise_n, &|k| force[k][axis]));
    (0..force.len()).map(|k| Vec2::new(axes[0][k], axes[1][k])).collect()
}

/// Blocks in which a finger touches nothing: a finger pushes and cannot pull, so that the least force of some time is
/// none.
fn free_blocks(along: &[f64]) -> Vec<usize> {
    let long = along.len().div_ceil(PARTS).max(1);
    (0..along.len())
        .step_by(long)
        .flat_map(|first| {
            let window = &along[first..(first + long).min(along.len())];
            let least = percentile(&mut window.to_vec(), FREE_SHARE);
            (first..first + window.len()).filter(move |k| along[*k] <= least)
        })
        .collect()
}

/// Zero of a sensor at each block: a line through its values at the free blocks, and a jump where they show one. `of`:
/// value of a block; `noise_n`: its standard deviation, N.
fn zero(free: &[usize], blocks: usize, noise_n: f64, of: &dyn Fn(usize) -> f64) -> Vec<f64> {
    let column = |of: &dyn Fn(usize) -> f64| free.iter().map(|k| of(*k)).collect::<Vec<f64>>();
    let (ones, times, values) = (vec![1.0; free.len()], column(&|k| k as f64), column(of));
    let mut scan =
        Scan::beside(vec![ones.clone(), times.clone()], times.clone(), values.clone()).along(vec![ones.clone()]);
    let power = dot(&scan.residual, &scan.residual);
    let jump = scan.next_step().filter(|(gain, _)| *gain > HALF * power).map(|(_, at)| at);
    let since = |k: usize, at: f64| f64::from(u8::from(k as f64 >= at));
    let columns: Vec<Vec<f64>> = [ones, times].into_iter().chain(jump.map(|at| column(&|k| since(k, at)))).collect();
    let Ok(fit) = least_squares_values(&columns, &values, None) else { return vec![0.0; blocks] };
    let line = |k: usize| fit.values[0] + fit.values[1] * k as f64;
    let Some((at, size)) = jump.zip(fit.values.get(2).copied()) else { return (0..blocks).map(line).collect() };
    // The blocks between the last free one before and the first one after tell more closely when it jumped.
    let after = free.partition_point(|k| (*k as f64) < at).clamp(1, free.len() - 1);
    let (first, end) = (free[after - 1] + 1, free[after]);
    let miss = |at: usize, k: usize| {
        let off = of(k) - line(k) - if k >= at { size } else { 0.0 };
        off.abs().min(CERTAIN * noise_n)
    };
    let missed = |at: &usize| (first..end).map(|k| miss(*at, k)).sum::<f64>();
    let at = (first..=end).min_by(|a, b| missed(a).total_cmp(&missed(b))).unwrap_or(end);
    (0..blocks).map(|k| line(k) + if k >= at { size } else { 0.0 }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_zero_that_drifts_and_jumps_is_found_below_the_pushes() {
        let push = |k: usize| if k % 100 > 55 { 1.0 } else { 0.0 };
        for (slope, jump) in [(2e-4, 0.0), (0.0, 0.3), (0.0, -0.3)] {
            let right = |k: usize| 0.02 + slope * k as f64 + if k >= 740 { jump } else { 0.0 };
            let noise = |k: usize| 0.002 * (1.3 * (k * k) as f64).sin();
            let along: Vec<f64> = (0..1600).map(|k| right(k) + push(k) + noise(k)).collect();
            let force: Vec<Vec2> = along.iter().map(|f| Vec2::new(*f, 0.0)).collect();
            let found = zeros(&force, &along, 0.002);
            let worst = (0..1600).map(|k| (found[k].x - right(k)).abs()).fold(0.0, f64::max);
            assert!(worst < 0.03, "{slope} {jump}: {worst}");
        }
    }
}
