//! Grasps at made-up places: dropped, fetched, left, taken again.

use super::*;
use crate::segment::segmentation::Segmentation;
use crate::segment::subtasks;
use SystemState::{FreeMotion, HoldAboveGround, HoldOnGround};
use foundation::tasks::Thresholds;
use foundation::tasks::definition::Definition;
use haptics::recording::Task;

/// A part of a recording: state, samples of 10 ms, place, mm, and weight of the held object, N.
type Part = (SystemState, usize, [f64; 2], f64);

/// Blocks as wide in mm as ten times their weight in N.
fn segmented(parts: &[Part]) -> Segmentation {
    let (mut raw, mut position, mut width_m, mut lift_n) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    for (state, samples, [x, y], weight) in parts {
        for _ in 0..*samples {
            raw.push(*state);
            position.push(Vec2::new(*x, *y) * 1e-3);
            width_m.push(weight * 0.01);
            lift_n.push(if *state == HoldAboveGround { *weight } else { 0.0 });
        }
    }
    let time: Vec<f64> = (0..raw.len()).map(|i| i as f64 * 0.01).collect();
    let hand = Hand { position: &position, width_m: &width_m, lift_n: &lift_n };
    let task = Definition::built_in(Task::BlockStack).expect("the built-in task");
    let thresholds = Thresholds { velocity_m_s: 0.05, force_n: 0.05 };
    subtasks::assemble(&time, &raw, &task, thresholds, Vec::new(), Some(&hand))
}

/// Gripped, lifted and let go in the air.
fn dropped(from: [f64; 2], at: [f64; 2], weight: f64) -> [Part; 3] {
    [(HoldOnGround, 60, from, weight), (HoldAboveGround, 150, at, weight), (FreeMotion, 100, at, 0.0)]
}

/// Gripped, carried and put down.
fn carried(from: [f64; 2], to: [f64; 2], weight: f64) -> [Part; 4] {
    [
        (HoldOnGround, 60, from, weight),
        (HoldAboveGround, 200, [to[0], to[1] + 25.0], weight),
        (HoldOnGround, 60, to, weight),
        (FreeMotion, 100, [to[0], to[1] + 25.0], 0.0),
    ]
}

const START: Part = (FreeMotion, 100, [0.0, 40.0], 0.0);

/// The numbered carries in order: number and start, s.
fn carries(found: &Segmentation) -> Vec<(&str, f64)> {
    let carried = found.states.iter().filter_map(|i| Some((i.subtask.as_deref()?.strip_prefix("carry-block-")?, i.t0)));
    carried.collect()
}

#[test]
fn a_block_that_is_dropped_and_fetched_keeps_its_number() {
    let first = dropped([-14.0, 18.0], [2.0, 35.0], 1.5);
    let found = segmented(
        &[&[START][..], &first, &carried([6.0, 6.0], [14.0, 6.0], 1.5), &carried([-14.0, 6.0], [14.0, 18.0], 2.2)]
            .concat(),
    );
    assert_eq!(found.sequence(), "132313231", "{:?}", found.states);
    assert_eq!(carries(&found), [("1", 4.7), ("2", 8.9)]);
    assert!(found.warnings.iter().any(|w| w.contains("failed attempts: 1")), "{:?}", found.warnings);
}

#[test]
fn another_block_after_a_dropped_one_has_the_next_number() {
    // An object that lay under it, of another weight: the dropped one stays in place.
    let first = dropped([-14.0, 18.0], [2.0, 35.0], 1.5);
    let found = segmented(&[&[START][..], &first, &carried([-14.0, 6.0], [14.0, 6.0], 2.2)].concat());
    assert_eq!(carries(&found), [("1", 1.6), ("2", 4.7)]);
    assert!(found.warnings.iter().any(|w| w.contains("place-block-1 was not seen")), "{:?}", found.warnings);
}

#[test]
fn a_block_that_is_left_and_fetched_after_another_keeps_its_number() {
    let first = dropped([-14.0, 18.0], [2.0, 35.0], 1.5);
    let second = carried([-14.0, 6.0], [14.0, 6.0], 2.2);
    let third = carried([-30.0, 6.0], [14.0, 30.0], 3.0);
    let found = segmented(&[&[START][..], &first, &second, &carried([5.0, 6.0], [14.0, 18.0], 1.5), &third].concat());
    assert_eq!(carries(&found), [("2", 4.7), ("1", 8.9), ("3", 13.1)], "{:?}", found.states);
    assert!(found.warnings.iter().any(|w| w.contains("object 1 was lost")), "{:?}", found.warnings);
}

#[test]
fn a_block_that_was_put_down_and_is_taken_again_is_said() {
    let found = segmented(
        &[&[START][..], &carried([-14.0, 6.0], [14.0, 6.0], 1.5), &carried([14.0, 6.0], [0.0, 6.0], 1.5)].concat(),
    );
    assert_eq!(carries(&found).iter().map(|c| c.0).collect::<Vec<_>>(), ["1", "2"]);
    assert!(found.warnings.iter().any(|w| w.contains("may be the same one")), "{:?}", found.warnings);
}

#[test]
fn a_block_that_never_left_the_ground_is_tried_again() {
    let tried: [Part; 2] = [(HoldOnGround, 60, [-14.0, 18.0], 1.5), (FreeMotion, 80, [-14.0, 30.0], 0.0)];
    let found = segmented(&[&[START][..], &tried, &tried, &carried([-14.0, 18.0], [14.0, 6.0], 1.5)].concat());
    assert_eq!(found.sequence(), "13231");
    assert!(found.warnings.iter().any(|w| w.contains("failed attempts: 2")), "{:?}", found.warnings);
}

#[test]
fn fingers_that_open_in_mid_carry_and_catch_it_again_do_not_shift_the_order() {
    let slipped: [Part; 4] = [
        (HoldOnGround, 60, [-14.0, 18.0], 1.5),
        (HoldAboveGround, 60, [-10.0, 40.0], 1.5),
        (FreeMotion, 6, [-8.0, 40.0], 0.0),
        (HoldAboveGround, 120, [-6.0, 38.0], 1.5),
    ];
    let rest: [Part; 2] = [(HoldOnGround, 60, [14.0, 6.0], 1.5), (FreeMotion, 100, [14.0, 30.0], 0.0)];
    let found = segmented(&[&[START][..], &slipped, &rest, &carried([-14.0, 6.0], [14.0, 18.0], 2.2)].concat());
    assert_eq!(found.sequence(), "132313231", "{:?}", found.states);
}
