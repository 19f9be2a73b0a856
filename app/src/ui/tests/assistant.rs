//! The assistant over the trainer's picture: what it says, when it is silent, and that every part of it can be switched off.

use super::{empty, train_window};
use crate::ui::session::Session;
use crate::ui::shell::app::App;
use crate::ui::shell::workspace::Workspace;
use crate::ui::train::lessons::pointer;
use crate::ui::train::lessons::practising;
use crate::ui::train::trainer::live::{Clock, Operator};
use crate::ui::train::trainer::world_choice::WorldChoice;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use haptics::Vec2;
use std::sync::Arc;

fn in_train(operator: Operator, choice: WorldChoice) -> Session {
    let mut session = empty();
    session.workspace = Workspace::Train;
    session.training.trainer.clock = Clock::Manual;
    (session.training.trainer.operator, session.training.trainer.choice) = (operator, choice);
    session.training.trainer.ensure_running().expect("runs");
    session
}

fn says(harness: &Harness<'_, App>, words: &str) -> bool {
    harness.query_all_by_label_contains(words).next().is_some()
}

/// Lets the scripted operator go on until something is said.
fn until_said(harness: &mut Harness<'_, App>, words: &str) {
    const AT_MOST_S: usize = 30;
    for _ in 0..4 * AT_MOST_S {
        harness.state_mut().session.training.trainer.advance(0.25);
        harness.run_steps(1);
        if says(harness, words) {
            return;
        }
    }
    panic!("{words:?} was never said");
}

#[test]
fn a_barrel_is_weighed_its_contents_are_guessed_and_its_cable_is_drawn() {
    let mut harness = train_window(in_train(Operator::Scripted, WorldChoice::Barrel));
    harness.run_steps(2);
    assert!(!says(&harness, "Grip to spare"), "nothing is held yet");
    until_said(&mut harness, "Grip to spare");
    until_said(&mut harness, "Density");
    assert!(says(&harness, "Inside: "));
    until_said(&mut harness, "Something holds it");
    assert!(says(&harness, "Weight") && says(&harness, " ± "));
    harness.state_mut().session.training.assistant.constraint = false;
    harness.state_mut().session.training.assistant.contents = false;
    harness.run_steps(2);
    assert!(!says(&harness, "Something holds it") && !says(&harness, "Inside: ") && says(&harness, "Grip to spare"));
    harness.state_mut().session.training.assistant.on = false;
    harness.run_steps(2);
    assert!(!says(&harness, "Grip to spare") && says(&harness, "Switched off: nothing is said"));
}

#[test]
fn a_needle_is_no_block_and_its_sheet_does_not_pass_for_its_weight() {
    let mut harness = train_window(in_train(Operator::Scripted, WorldChoice::Needle));
    until_said(&mut harness, "Grip to spare");
    until_said(&mut harness, "Width");
    let report = harness.state().session.training.trainer.watch.report().expect("measured");
    assert!(report.held.is_some() && report.parameters.iter().any(|p| p.name == "weight_N"));
    assert!(!says(&harness, "Block 1") && !says(&harness, "Weight"));
    assert_eq!(harness.query_all_by_label("Needle").count(), 3, "the world's button, the plate, the card");
}

#[test]
fn a_crank_shows_the_circle_that_was_found() {
    let mut harness = train_window(in_train(Operator::Scripted, WorldChoice::Crank));
    until_said(&mut harness, "It turns on a circle: radius");
    assert!(harness.state().session.training.trainer.watch.report().is_some());
}

#[test]
fn the_edge_of_the_reach_and_too_hard_a_grip_are_warned_of() {
    let session = in_train(Operator::You, WorldChoice::Blocks);
    let (_, world) = session.training.trainer.scene().expect("a scene");
    let workspace = world.hand.workspace;
    let mut harness = train_window(session);
    harness.run_steps(2);
    assert!(!says(&harness, "the edge of its reach"));
    harness.state_mut().session.training.trainer.pinch.move_to(workspace.center_m + Vec2::new(workspace.radius_m, 0.0));
    until_said(&mut harness, "the edge of its reach");
    harness.state_mut().session.training.assistant.edge = false;
    harness.run_steps(2);
    assert!(!says(&harness, "the edge of its reach"));
    let mut harness = train_window(squeezing());
    until_said(&mut harness, "of 2.5 N");
}

/// The lesson in which nothing may be crushed, with far too firm a hand.
fn squeezing() -> Session {
    let mut session = in_train(Operator::You, WorldChoice::Blocks);
    session.training.lessons.load();
    let lesson = session.training.lessons.all.iter().find(|l| l.id == "pinch").map(Arc::clone).expect("a lesson");
    practising::open_lesson_now(&mut session.training, &mut session.messages, &lesson);
    practising::practise_lesson(&mut session.training, &mut session.messages);
    let (_, world) = session.training.trainer.scene().expect("a scene");
    let block_m = world.blocks[0].start.center_m;
    for above_m in [0.03, 0.0] {
        session.training.trainer.pinch.move_to(block_m + Vec2::new(0.0, above_m));
        session.training.trainer.advance(1.5);
    }
    session.training.trainer.pinch.latched = true;
    session.training.trainer.pinch.strengthen(50.0);
    session
}

#[test]
fn in_a_test_of_a_lesson_nobody_helps() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut session = in_train(Operator::You, WorldChoice::Blocks);
    session.training.trainer.recordings_folder = Some(folder.path().to_path_buf());
    session.training.lessons.load();
    session.training.lessons.shown = true;
    let lesson =
        session.training.lessons.all.iter().find(|l| l.id == "lift-and-hold").map(Arc::clone).expect("a lesson");
    practising::open_lesson_now(&mut session.training, &mut session.messages, &lesson);
    practising::practise_lesson(&mut session.training, &mut session.messages);
    pointer::follow_expert(&mut session.training, 6.0);
    let mut harness = train_window(session);
    harness.run_steps(2);
    assert!(says(&harness, "Grip to spare"), "while practising");
    let session = &mut harness.state_mut().session;
    practising::test_lesson(&mut session.training, &mut session.messages);
    pointer::follow_expert(&mut harness.state_mut().session.training, 6.0);
    harness.run_steps(2);
    assert!(!says(&harness, "Grip to spare") && says(&harness, "In a test you are on your own."));
}

#[test]
fn a_finger_that_pressed_on_a_block_did_not_spoil_the_zero_of_its_sensor() {
    let mut session = in_train(Operator::You, WorldChoice::Blocks);
    session.training.lessons.load();
    let lesson = session.training.lessons.all.iter().find(|l| l.id == "stack-two").map(Arc::clone).expect("a lesson");
    practising::open_lesson_now(&mut session.training, &mut session.messages, &lesson);
    practising::practise_lesson(&mut session.training, &mut session.messages);
    // The pointer comes down on the block first, and carries it then.
    pointer::follow_expert(&mut session.training, 7.5);
    let report = session.training.trainer.watch.report().expect("watched");
    let weight = report.parameters.iter().find(|p| p.name == "weight_N").expect("weighed");
    let (_, world) = session.training.trainer.scene().expect("a scene");
    let truth_n = world.blocks[0].mass_kg * world.gravity_m_s2;
    assert!((weight.value.expect("known") - truth_n).abs() < 0.05 * truth_n, "{weight:?}");
}
