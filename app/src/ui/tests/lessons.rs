//! Lessons as a trainee goes through them: shown, practised, tested, told what to do better.

use super::{in_train, train_window, until};
use crate::ui::shell::app::App;
use crate::ui::shell::message_list::Messages;
use crate::ui::shell::workspace::Workspace;
use crate::ui::train::lessons::pointer;
use crate::ui::train::lessons::practising;
use crate::ui::train::lessons::state::{Debrief, Phase};
use crate::ui::train::state::Training;
use crate::ui::train::trainees;
use crate::ui::train::trainer::live::Operator;
use egui::accesskit::Role;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use std::sync::Arc;

fn phase(harness: &Harness<'_, App>) -> Option<Phase> {
    harness.state().session.training.lessons.open.as_ref().map(|open| open.phase.clone())
}

fn click(harness: &mut Harness<'_, App>, role: Role, label: &str) {
    harness.get_by_role_and_label(role, label).click();
    harness.run_steps(3);
}

/// Does an open lesson's test with the mouse; the answer to a question is that of the world that stands there.
fn attempted(training: &mut Training, messages: &mut Messages) -> Debrief {
    practising::test_lesson(training, messages);
    pointer::follow_expert(training, 120.0);
    let open = training.lessons.open.as_ref().expect("open");
    let answer = open.lesson.question.as_ref().map(|_| open.variant);
    practising::end_lesson_now(training, messages, answer);
    match training.lessons.open.as_ref().map(|open| &open.phase) {
        Some(Phase::Debrief(debrief)) => (**debrief).clone(),
        other => panic!("{other:?}: {:?}", messages.banners),
    }
}

#[test]
fn every_lesson_can_be_completed_with_the_mouse_and_its_file_has_the_same_grade() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut session = in_train(folder.path());
    session.training.lessons.load();
    assert_eq!((session.training.lessons.all.len(), session.training.lessons.problems.len()), (11, 0));
    let mut missed = Vec::new();
    for lesson in session.training.lessons.all.clone() {
        practising::open_lesson_now(&mut session.training, &mut session.messages, &lesson);
        let debrief = attempted(&mut session.training, &mut session.messages);
        if !debrief.grade.completed {
            missed.push(format!("{}: {}", lesson.id, debrief.grade.advice));
        }
        let (again, _) =
            crate::ui::train::lessons::state::graded_from(&debrief.path, None).expect("graded from its file alone");
        assert_eq!(again, debrief.grade, "{}", lesson.id);
        assert!(debrief.trace.duration_s() > 2.0, "{}", lesson.id);
    }
    assert!(missed.is_empty(), "{missed:#?}");
}

#[test]
fn a_trainee_is_shown_a_lesson_practises_it_and_is_told_how_it_was() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut harness = train_window(in_train(folder.path()));
    let ctx = harness.ctx.clone();
    let session = &mut harness.state_mut().session;
    trainees::open_history(
        &mut session.training.learning,
        &mut session.messages,
        &ctx,
        folder.path().join("history.sqlite"),
    );
    let learning = &mut harness.state_mut().session.training.learning;
    "Ada".clone_into(&mut learning.name_field);
    learning.add_trainee();
    click(&mut harness, Role::RadioButton, "Lessons");
    click(&mut harness, Role::Link, "Lift and hold");
    assert_eq!(phase(&harness), Some(Phase::Brief));
    until(&mut harness, "the expert", |app| {
        app.session.training.lessons.open.as_ref().is_some_and(|open| open.expert.is_some())
    });
    click(&mut harness, Role::Button, "Watch");
    assert!(harness.query_by_label_contains("An expert shows it").is_some());
    harness.state_mut().session.training.trainer.advance(30.0);
    harness.run_steps(3);
    assert!(harness.query_by_label_contains("That was all").is_some());
    click(&mut harness, Role::Button, "Practise");
    assert_eq!(phase(&harness), Some(Phase::Practising));
    assert!(!harness.state().session.training.trainer.is_recording(), "practice is not recorded");
    pointer::follow_expert(&mut harness.state_mut().session.training, 60.0);
    harness.run_steps(3);
    assert!(harness.query_all_by_label_contains("All goals reached").next().is_some());
    click(&mut harness, Role::Button, "Take the test");
    assert!(harness.state().session.training.trainer.is_recording());
    pointer::follow_expert(&mut harness.state_mut().session.training, 60.0);
    until(&mut harness, "the debrief", |app| {
        app.session.training.lessons.open.as_ref().is_some_and(|open| matches!(open.phase, Phase::Debrief(_)))
    });
    let Some(Phase::Debrief(debrief)) = phase(&harness) else { panic!("no debrief") };
    assert!(debrief.grade.completed && debrief.path.is_file(), "{:?}", debrief.grade);
    assert!(harness.query_by_label(&debrief.grade.advice).is_some(), "{}", debrief.grade.advice);
    assert!(harness.query_by_label("Time to complete").is_some());
    until(&mut harness, "the history", |app| !app.session.training.learning.attempts.is_empty());
    let kept = harness.state().session.training.learning.attempts[0].clone();
    assert_eq!((kept.trainee.as_str(), kept.lesson.as_str()), ("Ada", "lift-and-hold"));
    assert_eq!((kept.score, kept.completed, kept.proficient), (debrief.grade.score, true, false));
    click(&mut harness, Role::Link, "All lessons");
    assert_eq!(phase(&harness), None);
    assert!(harness.query_by_label("Needle through a membrane").is_some());
}

#[test]
fn an_attempt_that_is_left_keeps_no_file_and_a_wrong_answer_is_told() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut session = in_train(folder.path());
    session.training.lessons.load();
    let barrel = session.training.lessons.all.iter().find(|l| l.id == "barrel").map(Arc::clone).expect("a barrel");
    practising::open_lesson_now(&mut session.training, &mut session.messages, &barrel);
    practising::watch_lesson(&mut session.training, &mut session.messages);
    practising::close_lesson(&mut session.training, &mut session.messages);
    assert_eq!(session.training.trainer.operator, Operator::You, "the expert stops");
    practising::open_lesson_now(&mut session.training, &mut session.messages, &barrel);
    practising::test_lesson(&mut session.training, &mut session.messages);
    pointer::follow_expert(&mut session.training, 3.0);
    practising::close_lesson(&mut session.training, &mut session.messages);
    assert!(!session.training.trainer.is_recording() && session.training.lessons.open.is_none());
    practising::open_lesson_now(&mut session.training, &mut session.messages, &barrel);
    practising::test_lesson(&mut session.training, &mut session.messages);
    pointer::follow_expert(&mut session.training, 120.0);
    let right = session.training.lessons.open.as_ref().expect("open").variant;
    practising::end_lesson_now(&mut session.training, &mut session.messages, Some((right + 1) % 4));
    let Some(Phase::Debrief(debrief)) = session.training.lessons.open.as_ref().map(|open| open.phase.clone()) else {
        panic!("no debrief: {:?}", session.messages.banners)
    };
    assert_eq!((debrief.grade.completed, debrief.grade.answered_rightly), (false, Some(false)));
    assert!(debrief.grade.advice.contains("answer was wrong"), "{}", debrief.grade.advice);
}

#[test]
fn a_calibrated_world_becomes_a_lesson() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut session = super::session(super::STACK.clone());
    session.training.trainer.recordings_folder = Some(folder.path().to_path_buf());
    session.training.lessons.folder = Some(folder.path().join("lessons"));
    let mut harness = train_window(session);
    let ctx = harness.ctx.clone();
    let session = &mut harness.state_mut().session;
    practising::practise_on_this(&session.calibration, &mut session.jobs, &ctx);
    until(&mut harness, "the lesson", |app| {
        app.session.training.lessons.open.as_ref().is_some_and(|open| open.expert.is_some())
    });
    let session = &mut harness.state_mut().session;
    assert_eq!(session.workspace, Workspace::Train);
    let debrief = attempted(&mut session.training, &mut session.messages);
    assert!(debrief.grade.completed, "{:?}", debrief.grade);
    let measured = session.calibration.analysis.as_ref().map(|a| a.world.blocks[0].mass_kg);
    let touched = session.training.trainer.standing_world().blocks.first().map(|b| b.mass_kg);
    assert_eq!(measured, touched, "it is the measured block");
}
