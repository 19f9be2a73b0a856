//! Stage 3 on made-up sequences of states.

use super::*;
use SystemState::{FreeMotion, HoldAboveGround, HoldOnGround, NoState};
use haptics::recording::Task;

fn blocks() -> Definition {
    Definition::built_in(Task::BlockStack).expect("the built-in task")
}

fn trace(parts: &[(SystemState, usize)]) -> (Vec<f64>, Vec<SystemState>) {
    let states: Vec<SystemState> = parts.iter().flat_map(|(s, n)| std::iter::repeat_n(*s, *n)).collect();
    ((0..states.len()).map(|i| i as f64 * 0.01).collect(), states)
}

const THRESHOLDS: Thresholds = Thresholds { velocity_m_s: 0.05, force_n: 0.05 };

#[test]
fn two_carries_are_told_apart_by_the_free_motion_between_them() {
    let (time, states) = trace(&[
        (FreeMotion, 100),
        (HoldOnGround, 60),
        (NoState, 3),
        (HoldAboveGround, 200),
        (HoldOnGround, 60),
        (NoState, 20),
        (FreeMotion, 100),
        (HoldOnGround, 60),
        (HoldAboveGround, 200),
        (HoldOnGround, 60),
        (FreeMotion, 100),
    ]);
    let result = assemble(&time, &states, &blocks(), THRESHOLDS, Vec::new(), None);
    assert_eq!(result.sequence(), "132313231");
    assert!(result.warnings.is_empty(), "{:?}", result.warnings);
    let carry_2 = result.samples_of("carry-block-2");
    assert_eq!((carry_2.len(), carry_2[0]), (180, 543 + 60 + 10));
}

#[test]
fn oscillation_at_touch_down_does_not_shift_the_order() {
    let mut parts = vec![(FreeMotion, 100), (HoldOnGround, 50), (HoldAboveGround, 150)];
    for _ in 0..4 {
        parts.extend([(HoldOnGround, 2), (HoldAboveGround, 2)]);
    }
    parts.extend([(HoldOnGround, 60), (FreeMotion, 100)]);
    let (time, states) = trace(&parts);
    let result = assemble(&time, &states, &blocks(), THRESHOLDS, Vec::new(), None);
    assert_eq!(result.sequence(), "13231");
}

#[test]
fn a_dropped_block_keeps_its_number_and_the_missing_step_is_said() {
    let (time, states) = trace(&[
        (FreeMotion, 100),
        (HoldOnGround, 60),
        (HoldAboveGround, 200),
        (FreeMotion, 100),
        (HoldOnGround, 60),
        (HoldAboveGround, 150),
        (HoldOnGround, 60),
        (FreeMotion, 100),
    ]);
    let result = assemble(&time, &states, &blocks(), THRESHOLDS, Vec::new(), None);
    assert_eq!(result.samples_of("carry-block-1").len(), 180);
    assert_eq!(result.samples_of("carry-block-2").len(), 134);
    assert!(result.warnings.iter().any(|w| w.contains("place-block-1")), "{:?}", result.warnings);
}

#[test]
fn a_recording_that_starts_while_holding_says_so() {
    let (time, states) = trace(&[(HoldOnGround, 60), (HoldAboveGround, 200), (HoldOnGround, 60), (FreeMotion, 100)]);
    let result = assemble(&time, &states, &blocks(), THRESHOLDS, Vec::new(), None);
    assert_eq!(result.samples_of("carry-block-1").len(), 180);
    assert!(result.warnings.iter().any(|w| w.contains("starts in the middle")), "{:?}", result.warnings);
}

#[test]
fn nothing_held_is_no_carry() {
    let (time, states) = trace(&[(FreeMotion, 500)]);
    let result = assemble(&time, &states, &blocks(), THRESHOLDS, Vec::new(), None);
    assert_eq!(result.sequence(), "1");
    assert!(result.warnings.iter().any(|w| w.contains("no object")));
}

#[test]
fn a_second_try_at_lifting_keeps_the_number_and_only_the_last_grasp_counts() {
    // Gripped and let go; then lifted a little and lost; then carried.
    let (time, states) = trace(&[
        (FreeMotion, 100),
        (HoldOnGround, 60),
        (FreeMotion, 80),
        (HoldOnGround, 50),
        (HoldAboveGround, 12),
        (FreeMotion, 80),
        (HoldOnGround, 60),
        (HoldAboveGround, 200),
        (HoldOnGround, 60),
        (FreeMotion, 100),
        (HoldOnGround, 60),
        (HoldAboveGround, 200),
        (HoldOnGround, 60),
        (FreeMotion, 100),
    ]);
    let result = assemble(&time, &states, &blocks(), THRESHOLDS, Vec::new(), None);
    assert_eq!(result.sequence(), "132313231", "{:?}", result.states);
    let pick_up = result.samples_of("pick-up-block-1");
    assert_eq!((pick_up[0], pick_up.len()), (382 + 3, 54));
    assert!(result.warnings.iter().any(|w| w.contains("failed attempts: 2")), "{:?}", result.warnings);
}

#[test]
fn a_run_too_short_to_be_a_step_gets_no_subtask() {
    let (time, states) =
        trace(&[(FreeMotion, 100), (HoldOnGround, 60), (HoldAboveGround, 200), (HoldOnGround, 7), (FreeMotion, 100)]);
    let result = assemble(&time, &states, &blocks(), THRESHOLDS, Vec::new(), None);
    assert!(result.samples_of("place-block-1").is_empty(), "{:?}", result.states);
}
