//! The Diagnose workspace: what it asks for, what it answers, the extended model and how it is felt.

use super::{STACK, cart, clockless_path, count_near, empty, harness, no_driver, session, until, until_done};
use crate::ui::diagnose::actions;
use crate::ui::diagnose::state::{DIAGNOSE, EXTEND, SIMULATE_EXTENDED, StartFrom, ask, extend};
use crate::ui::headless::screenshot;
use crate::ui::kit::theme;
use crate::ui::session::Session;
use crate::ui::shell::app::App;
use crate::ui::shell::dispatch;
use crate::ui::shell::workspace::Workspace;
use crate::ui::tests::picture;
use crate::ui::train::trainer::live::Operator;
use crate::ui::train::trainer::world_choice::WorldChoice;
use blind::{Bench, Effect, Spec};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use estimator::diagnose::{Progress, Verdict};
use haptics::recording::{Recording, Task};
use std::sync::{Arc, LazyLock};

/// A turned crank in which something is hidden, from a generator that shares nothing with the program.
fn hiding(effect: Effect, bench: Bench, seed: u64) -> Recording {
    hiding_so_much(effect, bench, seed, 2.0)
}

/// The same; `ratio`: the effect over the noise.
pub fn hiding_so_much(effect: Effect, bench: Bench, seed: u64, ratio: f64) -> Recording {
    let effects = vec![(effect, 0)];
    let spec = Spec::hiding(effects, ratio, bench);
    blind::make(&spec, seed).0.recordings.remove(0)
}

pub static RIPPLED: LazyLock<Recording> = LazyLock::new(|| hiding(Effect::Ripple, Bench::OneFinger, 3));
static ECCENTRIC: LazyLock<Recording> = LazyLock::new(|| hiding(Effect::Eccentric, Bench::OneFinger, 3));

fn loaded(recording: Recording) -> Session {
    let mut session = session(recording);
    session.workspace = Workspace::Diagnose;
    session
}

pub fn diagnosed(recording: Recording) -> Session {
    let mut session = loaded(recording);
    let from = session.diagnosing.from;
    let answer = ask(&session.document.recordings, &session.calibration.choice, from, Progress::default());
    match answer {
        Ok(answer) => session.diagnosing.answer = Some(Arc::new(answer)),
        Err(problem) => session.diagnosing.problem = Some(problem),
    }
    session
}

fn window<'a>(session: Session) -> Harness<'a, App> {
    harness(App::new(session), [1280.0, 1400.0], |ui, app: &mut App| app.show(ui))
}

#[test]
fn without_a_recording_it_says_what_to_do() {
    let mut session = empty();
    session.workspace = Workspace::Diagnose;
    let harness = window(session);
    assert!(harness.query_by_label("Nothing to diagnose yet").is_some());
    assert!(harness.query_by_label("or record one in Train").is_some());
}

#[test]
fn a_recording_that_cannot_be_diagnosed_says_why_in_a_sentence() {
    let mut recording = clockless_path();
    recording.meta.task = Some(Task::Switch);
    let harness = window(diagnosed(recording));
    assert!(harness.query_by_label("This recording cannot be diagnosed").is_some());
    let problem = harness.state().session.diagnosing.problem.clone().expect("why");
    assert!(problem.ends_with('.') && problem.len() > 30, "{problem}");
    assert!(harness.query_by_label(&problem).is_some(), "{problem}");
}

#[test]
fn the_button_diagnoses_in_the_background_names_the_cause_and_extends_the_model() {
    let mut harness = window(loaded(RIPPLED.clone()));
    harness.get_by_role_and_label(egui::Role::Button, "Diagnose").click();
    harness.run_steps(2);
    until_done(&mut harness, DIAGNOSE);
    let answer = harness.state().session.diagnosing.answer.clone().expect("an answer");
    assert_eq!(answer.diagnosis.causes[0].id, "position-ripple");
    for label in [
        "Force along the motion",
        "Left over against angle within a turn",
        "Left over against normal force",
        "1  Position ripple",
    ] {
        assert!(harness.query_by_label(label).is_some(), "{label}");
    }
    harness.get_by_role_and_label(egui::Role::Button, "Extend the model").click();
    harness.run_steps(2);
    until_done(&mut harness, EXTEND);
    let worlds = harness.state().session.diagnosing.worlds.clone().expect("both worlds");
    until_done(&mut harness, SIMULATE_EXTENDED);
    let replayed = harness.state().session.diagnosing.replay(0).expect("played through the extended world");
    assert!(replayed.curves.iter().any(|(name, _)| name == "fx_N"), "for the plots: {:?}", replayed.curves.len());
    let laws = |world: &haptics::world::World| -> Vec<&'static str> {
        world.crank.as_ref().expect("a crank").effects.iter().map(|e| e.law().id()).collect()
    };
    assert!(laws(&worlds.after).contains(&"position-ripple") && !laws(&worlds.before).contains(&"position-ripple"));
    harness.get_by_role_and_label(egui::Role::Button, "Feel it in Train").click();
    harness.run_steps(4);
    let session = &harness.state().session;
    assert_eq!((session.workspace, session.training.trainer.choice), (Workspace::Train, WorldChoice::After));
    assert!(session.messages.banners.is_empty(), "{:?}", session.messages.banners);
}

#[test]
fn the_key_switches_the_world_under_the_hand_and_everything_stays_where_it_is() {
    let mut session = diagnosed(RIPPLED.clone());
    let answer = session.diagnosing.answer.clone().expect("an answer");
    let worlds = extend(&session.document.recordings, &session.calibration.choice, session.diagnosing.from, &answer);
    session.diagnosing.worlds = Some(Arc::new(worlds.expect("both worlds")));
    session.training.trainer.compare = Some(actions::comparison(&session.diagnosing).expect("a crank can be felt"));
    session.training.trainer.operator = Operator::Scripted;
    session.training.trainer.choose(WorldChoice::After).expect("the extended world");
    session.workspace = Workspace::Train;
    let mut harness = window(session);
    assert!(harness.query_by_label("Feel it").is_some());
    let mut last_n = 0.0;
    for switch in 0..12 {
        harness.state_mut().session.training.trainer.advance(0.45);
        let before = harness.state().session.training.trainer.scene().expect("running").0.clone();
        harness.key_press(egui::Key::B);
        harness.step();
        let trainer = &mut harness.state_mut().session.training.trainer;
        let wanted = if switch % 2 == 0 { WorldChoice::Before } else { WorldChoice::After };
        assert_eq!(trainer.choice, wanted);
        trainer.advance(1e-3);
        let (after, world) = trainer.scene().expect("running");
        assert_eq!(
            world.crank.as_ref().map(|c| c.effects.len()),
            trainer.compare.as_ref().map(|c| {
                let world = if wanted == WorldChoice::After { &c.after } else { &c.before };
                world.crank.as_ref().expect("a crank").effects.len()
            }),
            "switch {switch}"
        );
        assert!(after.state.time_s >= before.state.time_s, "the performance goes on");
        let moved = (after.state.crank.angle_rad - before.state.crank.angle_rad).abs();
        assert!(moved < 0.3, "switch {switch}: the handle moved by {moved} rad");
        last_n = f64::max(last_n, after.tick.sent_force_n[0].norm());
    }
    assert!(last_n > 0.2, "the handle was held: {last_n} N");
    assert!(harness.state().session.messages.banners.is_empty());
}

#[test]
fn the_results_of_a_fit_lead_to_the_diagnosis() {
    let mut session = loaded(RIPPLED.clone());
    session.workspace = Workspace::Calibrate;
    let mut harness = harness(session, [420.0, 1400.0], |ui, session: &mut Session| {
        let ctx = ui.ctx().clone();
        dispatch::poll(session, &ctx);
        crate::ui::shell::panel::Panel::ui(
            &mut crate::ui::calibrate::panels::results::ResultsPanel::default(),
            ui,
            session,
        );
    });
    harness.get_by_label("Diagnose …").click();
    harness.run_steps(2);
    assert_eq!(harness.state().workspace, Workspace::Diagnose);
    until(&mut harness, "the answer", |session| session.diagnosing.answer.is_some());
}

#[test]
fn two_recordings_of_one_object_are_diagnosed_together_and_shown_by_turns() {
    let mut session = Session::new();
    session.workspace = Workspace::Diagnose;
    let mut second = RIPPLED.clone();
    second.name = "again".to_owned();
    let recordings = [RIPPLED.clone(), second].map(|r| Arc::new(crate::ui::document::prepared::Prepared::new(r)));
    session.show(recordings.to_vec());
    let answer =
        ask(&session.document.recordings, &session.calibration.choice, session.diagnosing.from, Progress::default());
    let answer = answer.expect("an answer");
    assert_eq!(answer.residuals.len(), 2);
    assert!(answer.residuals.iter().all(|r| !r.is_empty()));
    session.diagnosing.answer = Some(Arc::new(answer));
    let mut harness = window(session);
    harness.get_by_role_and_label(egui::Role::ComboBox, "Recording of the curves").click();
    harness.run_steps(3);
    harness.get_by_role_and_label(egui::Role::Button, "again").click();
    harness.run_steps(3);
    assert_eq!(harness.state().session.document.current, 1);
}

#[test]
fn what_cannot_be_told_apart_is_shown_with_the_recording_that_would() {
    let session = diagnosed(ECCENTRIC.clone());
    let diagnosis = session.diagnosing.answer.clone().expect("an answer");
    assert_eq!(diagnosis.diagnosis.verdict, Verdict::Ambiguous);
    let harness = window(session);
    assert!(
        harness
            .query_by_label("The model misses an eccentric mass or a tilted plane: this recording cannot tell which.")
            .is_some()
    );
    assert!(harness.query_by_label("Record next").is_some());
}

#[test]
fn a_mechanism_starts_from_a_model_that_can_be_chosen_and_cannot_be_felt() {
    let mut session = loaded(cart());
    session.diagnosing.from = StartFrom::Mass;
    let mut harness = window(session);
    assert!(harness.query_by_role_and_label(egui::Role::RadioButton, "Inertia").is_some());
    harness.get_by_role_and_label(egui::Role::Button, "Diagnose").click();
    harness.run_steps(2);
    until_done(&mut harness, DIAGNOSE);
    let session = &mut harness.state_mut().session;
    let answer = session.diagnosing.answer.clone().expect("an answer");
    let ids: Vec<&str> = answer.diagnosis.causes.iter().map(|c| c.id.as_str()).collect();
    assert!(ids.contains(&"viscous-friction") && ids.contains(&"coulomb-friction"), "{ids:?}");
    let worlds = extend(&session.document.recordings, &session.calibration.choice, session.diagnosing.from, &answer);
    session.diagnosing.worlds = Some(Arc::new(worlds.expect("both worlds")));
    let why = actions::comparison(&session.diagnosing).expect_err("nothing to hold");
    assert!(why.contains("save the extended world"), "{why}");
    // Another model to start from asks anew.
    harness.get_by_role_and_label(egui::Role::RadioButton, "+ dry").click();
    harness.run_steps(2);
    until_done(&mut harness, DIAGNOSE);
    let answer = harness.state().session.diagnosing.answer.clone().expect("another answer");
    assert!(answer.diagnosis.baseline.model.contains("coulomb-friction"), "{}", answer.diagnosis.baseline.model);
}

#[test]
fn a_cancelled_diagnosis_says_so_and_can_be_begun_again() {
    let mut session = loaded(RIPPLED.clone());
    let ctx = egui::Context::default();
    actions::diagnose(&session.document, &session.calibration, &mut session.diagnosing, &mut session.jobs, &ctx);
    session.give_up(&ctx, DIAGNOSE);
    assert!(!session.jobs.is_running(DIAGNOSE));
    let harness = window(session);
    assert!(harness.query_by_label("Try again").is_some());
    assert!(harness.state().session.diagnosing.problem.as_ref().is_some_and(|p| p.contains("cancelled")));
    // And the engine itself ends when nobody wants its answer.
    let session = loaded(RIPPLED.clone());
    let unwanted = Progress::new(|share| share < 0.3);
    let ended = ask(&session.document.recordings, &session.calibration.choice, session.diagnosing.from, unwanted);
    assert!(ended.is_err_and(|problem| problem.contains("cancelled")));
}

#[test]
fn another_log_forgets_the_answer() {
    let mut session = diagnosed(RIPPLED.clone());
    let recordings = loaded(cart()).document.recordings;
    session.show(recordings);
    assert!(session.diagnosing.answer.is_none() && session.diagnosing.worlds.is_none());
    assert_eq!(session.document.prepared().map(|p| p.task), Some(Some(Task::Mechanism)));
}

#[test]
fn every_state_of_the_workspace_fits_into_every_window() {
    let sessions: [fn() -> Session; 5] = [
        empty,
        || loaded(STACK.clone()),
        || diagnosed(STACK.clone()),
        || diagnosed(ECCENTRIC.clone()),
        || diagnosed(cart()),
    ];
    for make in sessions {
        let mut session = make();
        session.workspace = Workspace::Diagnose;
        let mut harness = window(session);
        for size in [[60.0, 40.0], [1120.0, 680.0], [2560.0, 1440.0]] {
            harness.set_size(size.into());
            harness.run_steps(2);
        }
    }
}

#[test]
fn the_picture_has_curves_of_all_three_kinds_in_both_themes() {
    if no_driver() {
        return;
    }
    for dark in [false, true] {
        let picture =
            screenshot::draw(diagnosed(RIPPLED.clone()), picture("diagnose"), [1280, 720], dark).expect("drawn");
        let simulated = theme::role(dark, render::ColorRole::Simulated);
        for (what, color) in [("model", simulated), ("extended", theme::Palette::of(dark).good)] {
            let found = count_near(&picture, color);
            assert!(found > 300, "{what}, dark {dark}: {found} pixels");
        }
    }
}
