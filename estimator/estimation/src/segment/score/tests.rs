//! Scores of made-up segmentations whose figures can be counted by hand.

use super::*;
use crate::segment::subtasks;
use foundation::tasks::Thresholds;
use foundation::tasks::definition::Definition;
use haptics::recording::Labels;

fn recording(labels: &[(&str, usize)]) -> Recording {
    let mut all = Labels::default();
    for (label, n) in labels {
        (0..*n).for_each(|_| all.push(label));
    }
    Recording {
        time_s: Some((0..all.len()).map(|i| i as f64 * 0.01).collect()),
        labels: Some(all),
        ..Recording::default()
    }
}

fn found(task: Task, states: &[(SystemState, usize)]) -> Segmentation {
    let raw: Vec<SystemState> = states.iter().flat_map(|(s, n)| std::iter::repeat_n(*s, *n)).collect();
    let time: Vec<f64> = (0..raw.len()).map(|i| i as f64 * 0.01).collect();
    let task = Definition::built_in(task).expect("the built-in task");
    let thresholds = Thresholds { velocity_m_s: 0.05, force_n: 0.05 };
    subtasks::assemble(&time, &raw, &task, thresholds, Vec::new(), None)
}

use SystemState::{FreeMotion, HoldAboveGround, HoldOnGround, Holding, Turning};

#[test]
fn samples_states_and_boundaries_are_counted() {
    let log =
        recording(&[("free-motion", 100), ("hold-on-ground", 50), ("hold-above-ground", 150), ("free-motion", 100)]);
    // The first boundary 5 samples late, the second 20, the third in place.
    let claims =
        found(Task::BlockStack, &[(FreeMotion, 105), (HoldOnGround, 65), (HoldAboveGround, 130), (FreeMotion, 100)]);
    let score = score(&log, &claims).expect("labels");
    assert_eq!((score.samples, score.boundaries, score.tolerance_s), (400, 3, 0.1));
    assert!((score.accuracy - 375.0 / 400.0).abs() < 1e-12);
    let ground = score.states["hold-on-ground"];
    assert_eq!((ground.labelled, ground.found, ground.right), (50, 65, 45));
    assert!((ground.f1 - 90.0 / 115.0).abs() < 1e-12);
    assert!((score.boundary_f1 - 4.0 / 6.0).abs() < 1e-12, "{}", score.boundary_f1);
}

#[test]
fn labels_that_name_no_state_are_left_out_and_said() {
    let log = recording(&[("free-motion", 50), ("juggling", 50), ("", 10), ("free-motion", 50)]);
    let score = score(&log, &found(Task::BlockStack, &[(FreeMotion, 160)])).expect("labels");
    assert_eq!((score.samples, score.accuracy, score.boundary_f1), (100, 1.0, 1.0));
    assert_eq!(score.unknown_labels, ["juggling"]);
    assert!(super::score(&recording(&[("juggling", 160)]), &found(Task::BlockStack, &[(FreeMotion, 160)])).is_none());
    assert!(super::score(&Recording::default(), &found(Task::BlockStack, &[(FreeMotion, 160)])).is_none());
}

#[test]
fn states_that_the_labels_do_not_tell_apart_count_as_one() {
    let claims = found(Task::Crank, &[(FreeMotion, 50), (Holding, 50), (Turning, 100), (FreeMotion, 50)]);
    let coarse = score(&recording(&[("free-motion", 50), ("turning", 150), ("free-motion", 50)]), &claims);
    assert!(coarse.is_some_and(|s| s.accuracy == 1.0 && s.boundary_f1 == 1.0 && s.as_one.len() == 2));
    let fine = [("free-motion", 50), ("holding", 50), ("turning", 100), ("free-motion", 50)];
    assert!(
        score(&recording(&fine), &claims)
            .is_some_and(|s| s.accuracy == 1.0 && s.as_one.is_empty() && s.boundaries == 3)
    );
}
