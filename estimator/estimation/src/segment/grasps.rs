//! Places of gripping and letting go: they tell whether a grasp takes up again an object left by the one before. A
//! dropped block lies below the place of its loss and has the same weight; the next block of the task lies elsewhere.

use super::runs::{LEAST_RUN_S, Run};
use super::threshold::percentile;
use foundation::tasks::SystemState;
use haptics::Vec2;
use std::ops::Range;

/// Motion of the hand, one entry a sample.
#[derive(Clone, Copy, Debug)]
pub struct Hand<'a> {
    /// Middle between the fingers, m.
    pub position: &'a [Vec2],
    /// Distance of the fingers, m.
    pub width_m: &'a [f64],
    /// Force that lifts, N.
    pub lift_n: &'a [f64],
}

/// Relation of the objects of two grasps, told by their places.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Next {
    /// The second one takes up the object that the first one lost.
    Again,
    /// The second one takes something else.
    Other,
    /// Not known: the order alone decides.
    Unknown,
}

/// Time of a hold on the ground at the end that is putting down, s.
const PUT_DOWN_S: f64 = 0.35;
/// The same time if the block did not fall afterwards; shorter is the passage of the forces when something is lost.
const JUST_PUT_DOWN_S: f64 = 0.12;
/// A block that was gripped but not lifted stays within this share of its width.
const STAYS: f64 = 0.4;
/// Largest sideways distance at which a block lost in the air comes to rest, in widths.
const FALLS_WITHIN: f64 = 1.0;
/// The same distance for a block with the same width within [`ALIKE`].
const ROLLS_WITHIN: f64 = 2.0;
/// Widths of one block in two grasps differ by less than this share: pads give with the pinch. A block that tumbled is
/// held by another side.
const ALIKE: f64 = 0.08;
/// Relative difference of weights below which they are those of one block; `OTHER_WEIGHT`: above which they are those
/// of two.
const SAME_WEIGHT: f64 = 0.12;
const OTHER_WEIGHT: f64 = 0.3;
/// Least time in the air for a weight, s.
const WEIGHED_S: f64 = 0.3;
/// A grasp that is lower by this share of the block's width is at another height.
const LOWER: f64 = 0.15;
/// Time over which the place of a grasp is averaged, s.
const PLACE_S: f64 = 0.1;

/// From closing the fingers to opening them.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Grasp {
    /// Its runs.
    pub(super) runs: Range<usize>,
    from_m: Vec2,
    to_m: Vec2,
    width_m: f64,
    /// Weight, N, if it was in the air for long enough.
    weight_n: Option<f64>,
    lifted: bool,
    /// Time for which it rested in the grip before it was let go, s.
    rested_s: f64,
}

fn is_held(state: SystemState) -> bool {
    !matches!(state, SystemState::FreeMotion | SystemState::NoState)
}

/// All grasps in order. Free motion that is too short to be one does not end a grasp.
pub(super) fn grasps(time_s: &[f64], runs: &[Run], hand: &Hand<'_>) -> Vec<Grasp> {
    let mut spans: Vec<Range<usize>> = Vec::new();
    let mut open = false;
    for (index, run) in runs.iter().enumerate() {
        match spans.last_mut() {
            Some(span) if is_held(run.state) && open => span.end = index + 1,
            _ if is_held(run.state) => {
                spans.push(index..index + 1);
                open = true;
            }
            _ => {}
        }
        if run.state == SystemState::FreeMotion && run.length >= LEAST_RUN_S {
            open = false;
        }
    }
    spans.into_iter().map(|span| grasp(time_s, runs, hand, span)).collect()
}

fn grasp(time_s: &[f64], runs: &[Run], hand: &Hand<'_>, span: Range<usize>) -> Grasp {
    let (first, end) = (runs[span.start].first, runs[span.end - 1].end);
    let mean =
        |samples: Range<usize>| hand.position[samples.clone()].iter().sum::<Vec2>() / samples.len().max(1) as f64;
    let early = first + time_s[first..end].partition_point(|t| *t <= time_s[first] + PLACE_S).max(1);
    let late = first + time_s[first..end].partition_point(|t| *t < time_s[end - 1] - PLACE_S).min(end - first - 1);
    let held = runs[span.clone()].iter().filter(|run| is_held(run.state));
    let mut widths: Vec<f64> = held.flat_map(|run| &hand.width_m[run.first..run.end]).copied().collect();
    let above = |run: &&Run| run.state == SystemState::HoldAboveGround && run.length >= LEAST_RUN_S;
    let lifts = || runs[span.clone()].iter().filter(above);
    let mut lift: Vec<f64> = lifts().flat_map(|run| &hand.lift_n[run.first..run.end]).copied().collect();
    let weighed = lifts().map(|run| run.length).sum::<f64>() >= WEIGHED_S;
    let last = runs[span.clone()].iter().rev().find(|run| is_held(run.state));
    let on_ground = |run: &Run| matches!(run.state, SystemState::HoldOnGround | SystemState::SlidingOnGround);
    Grasp {
        from_m: mean(first..early),
        to_m: mean(late..end),
        width_m: percentile(&mut widths, 0.5),
        weight_n: weighed.then(|| percentile(&mut lift, 0.5)),
        lifted: lifts().next().is_some(),
        rested_s: last.filter(|run| on_ground(run)).map_or(0.0, |run| run.length),
        runs: span,
    }
}

impl Grasp {
    /// Relation of the object of the grasp after this one to that of this one.
    fn next(&self, next: &Self) -> Next {
        let beside_m = (next.from_m.x - self.to_m.x).abs();
        let below_m = self.to_m.y - next.from_m.y;
        if !self.lifted {
            let stayed = (next.from_m - self.to_m).norm() < STAYS * self.width_m;
            return if stayed { Next::Again } else { Next::Unknown };
        }
        let alike = self.is_as_wide_as(next);
        let lower_m = LOWER * self.width_m;
        let same = alike && self.weighs_like(next) == Some(true);
        let fell = below_m > lower_m && (same || beside_m < FALLS_WITHIN * self.width_m);
        if self.was_put_down() && !(fell && self.rested_s < PUT_DOWN_S) || below_m < -lower_m {
            return Next::Other;
        }
        // True for an object that lay under it before it was taken.
        let uncovered = (next.from_m.x - self.from_m.x).abs() < STAYS * self.width_m
            && next.from_m.y < self.from_m.y - lower_m
            && beside_m > STAYS * self.width_m;
        let again = match self.weighs_like(next) {
            Some(same) => same && !uncovered,
            None if alike => beside_m < ROLLS_WITHIN * self.width_m && !uncovered,
            None => beside_m < FALLS_WITHIN * self.width_m && !uncovered,
        };
        if again { Next::Again } else { Next::Other }
    }

    fn was_put_down(&self) -> bool {
        self.rested_s >= JUST_PUT_DOWN_S
    }

    fn is_as_wide_as(&self, other: &Self) -> bool {
        (other.width_m - self.width_m).abs() < ALIKE * self.width_m
    }

    /// True if both have the same weight; `None` if that is not clear.
    fn weighs_like(&self, other: &Self) -> Option<bool> {
        let (own, other) = (self.weight_n?, other.weight_n?);
        let differ = (own - other).abs() / own.abs().max(other.abs()).max(f64::MIN_POSITIVE);
        (!(SAME_WEIGHT..OTHER_WEIGHT).contains(&differ)).then_some(differ < SAME_WEIGHT)
    }

    /// True if a later grasp takes the object that this one lost, not fetched since.
    pub(super) fn left_for(&self, later: &Self) -> bool {
        self.lifted && !self.was_put_down() && self.is_as_wide_as(later) && self.next(later) == Next::Again
    }

    /// True if a later grasp takes the object that this one put down.
    pub(super) fn is_where_it_was_put(&self, later: &Self) -> bool {
        self.lifted && self.was_put_down() && later.lifted && (later.from_m - self.to_m).norm() < LOWER * self.width_m
    }
}

/// For every run: the relation of the grasps on both sides of the free motion that it is part of. Runs elsewhere:
/// `None`.
pub(super) fn between(runs: &[Run], grasps: &[Grasp]) -> Vec<Option<Next>> {
    let mut told = vec![None; runs.len()];
    for pair in grasps.windows(2) {
        let next = pair[0].next(&pair[1]);
        let gap = pair[0].runs.end..pair[1].runs.start;
        for (run, told) in runs[gap.clone()].iter().zip(&mut told[gap]) {
            if run.state == SystemState::FreeMotion {
                *told = Some(next);
            }
        }
    }
    told
}

#[cfg(test)]
mod tests;
