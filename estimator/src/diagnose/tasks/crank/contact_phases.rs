//! Contact phases of a crank: samples in which the hand holds the handle, and samples without touch.

use crate::diagnose::data::interpolation::mean_step_s;
use crate::diagnose::data::limits::{FEWEST, LEAST_PHASE_SAMPLES, SETTLING_S};
use estimation::identify::limits::LEAST_FREE_S;
use estimation::segment::segment;
use foundation::estimate::EstimateError;
use foundation::tasks::SystemState;
use haptics::Vec2;
use haptics::recording::{Recording, Task};

/// Distance from a change between free and held within which held samples belong to neither, s.
/// Choice: halved, 5 of 43 answers change; doubled, 5 of 43 answers change.
const MARGIN_S: f64 = 0.06;
/// Ratio of a rest's force scatter to that of the quietest one from which it is no rest.
/// Choice: halved, 3 of 43 answers change (2 to right); doubled, 3 of 43 answers change (1 to wrong).
const WANDERS: f64 = 2.5;

/// Flags of samples that are certainly held, and of those that are certainly free.
pub fn held_and_free(
    recording: &Recording,
    time_s: &[f64],
    force: &[Vec2],
) -> Result<(Vec<bool>, Vec<bool>), EstimateError> {
    let segmentation = segment(recording, Some(Task::Crank), None)?;
    let n = time_s.len();
    let mut free = vec![false; n];
    let rests: Vec<std::ops::Range<usize>> = segmentation
        .states
        .iter()
        .filter(|i| i.state == SystemState::FreeMotion && i.t1 - i.t0 >= LEAST_FREE_S)
        .map(|i| i.first..i.end)
        .collect();
    let unrest: Vec<f64> = rests
        .iter()
        .map(|r| {
            let middle = &force[middle(r)];
            off(middle, mean(middle))
        })
        .collect();
    // A few samples may be quiet by chance.
    let quietest = |least: usize| {
        let long = rests.iter().zip(&unrest).filter(|(r, _)| r.len() >= least);
        long.map(|(_, unrest)| *unrest).fold(f64::INFINITY, f64::min)
    };
    let quietest = Some(quietest(LEAST_PHASE_SAMPLES)).filter(|q| q.is_finite()).unwrap_or_else(|| quietest(0));
    for (range, unrest) in rests.iter().zip(&unrest) {
        // A hand that holds lightly is not away: its force wanders.
        if *unrest <= WANDERS * quietest {
            free[range.clone()].fill(true);
        }
    }
    let period_s = mean_step_s(time_s);
    let samples = |s: f64| (s / period_s).ceil() as usize;
    let (margin, piece) = (samples(MARGIN_S), samples(SETTLING_S).max(FEWEST));
    let mut near = vec![false; n];
    let mut surely_free = free.clone();
    for interval in rests.iter().filter(|i| free[i.start]) {
        // A grasp grows slowly: its beginning is below every threshold.
        let growing = samples(LEAST_FREE_S).min((interval.end - interval.start) / 3);
        if interval.start > 0 {
            near[interval.start.saturating_sub(margin)..interval.start].fill(true);
            surely_free[interval.start..interval.start + growing].fill(false);
        }
        if interval.end < n {
            near[interval.end..(interval.end + margin).min(n)].fill(true);
            surely_free[interval.end - growing..interval.end].fill(false);
        }
        // Samples left out here are neither free nor certainly held.
        let quiet = quiet(force, interval.clone(), piece, WANDERS * quietest);
        surely_free[interval.start..quiet.start].fill(false);
        surely_free[quiet.end..interval.end].fill(false);
    }
    let held = (0..n).map(|i| !free[i] && !near[i]).collect();
    Ok((held, surely_free))
}

/// The middle of a rest: its ends may belong to a grasp.
fn middle(rest: &std::ops::Range<usize>) -> std::ops::Range<usize> {
    let len = rest.len();
    rest.start + len / 3..rest.start + (2 * len).div_ceil(3)
}

fn mean(force: &[Vec2]) -> Vec2 {
    force.iter().sum::<Vec2>() / force.len().max(1) as f64
}

/// RMS distance of forces from a mean, N.
fn off(force: &[Vec2], mean: Vec2) -> f64 {
    (force.iter().map(|f| (f - mean).norm_squared()).sum::<f64>() / force.len().max(1) as f64).sqrt()
}

/// Part of a rest that is as quiet as its middle, followed outwards from there part by part. A hand that holds on early
/// or late may stay below every threshold for a while. A few such rows among the free ones, which have full weight,
/// count as noise and hide all smaller effects.
fn quiet(force: &[Vec2], rest: std::ops::Range<usize>, piece: usize, most_n: f64) -> std::ops::Range<usize> {
    let std::ops::Range { mut start, mut end } = middle(&rest);
    let level = mean(&force[start..end]);
    let is_quiet = |from: usize, to: usize| off(&force[from..to], level) <= most_n;
    while start > rest.start {
        let from = start.saturating_sub(piece).max(rest.start);
        if !is_quiet(from, start) {
            break;
        }
        start = from;
    }
    while end < rest.end {
        let to = (end + piece).min(rest.end);
        if !is_quiet(end, to) {
            break;
        }
        end = to;
    }
    start..end
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Noise of 0.01 N in both axes: two waves whose periods divide no part.
    fn noise(k: usize) -> Vec2 {
        let x = k as f64;
        0.014 * Vec2::new((2.7 * x).sin(), (1.9 * x + 0.4).sin())
    }

    #[test]
    fn a_rest_ends_where_a_hand_is_felt() {
        // The hand lets go during the first twentieth, and holds on lightly in the last.
        let of = |k: usize| match k {
            0..20 => noise(k) + Vec2::new(0.1 - 0.005 * k as f64, 0.0),
            380.. => noise(k) + Vec2::new(0.0, -0.08),
            _ => noise(k),
        };
        let force: Vec<Vec2> = (0..400).map(of).collect();
        let all = quiet(&force, 0..400, 10, 2.5 * 0.014);
        assert!((10..=20).contains(&all.start) && all.end == 380 - (380 - 267) % 10, "{all:?}");
        let still: Vec<Vec2> = (0..400).map(noise).collect();
        assert_eq!(quiet(&still, 0..400, 10, 2.5 * 0.014), 0..400);
    }
}
