//! The experiment that a diagnosis asks for: rehearsed, done by hand, loaded; and what it settles.

use super::{harness, until};
use crate::experiment::simulated::simulated_object;
use crate::ui::background::jobs::Jobs;
use crate::ui::diagnose::experiment;
use crate::ui::diagnose::experiment_state::REHEARSE;
use crate::ui::diagnose::guidance;
use crate::ui::diagnose::guided_experiment::Phase;
use crate::ui::document::opening;
use crate::ui::headless::gallery::samples::{askew, askew_world, done_with, hinge};
use crate::ui::session::Session;
use crate::ui::shell::app::App;
use crate::ui::shell::workspace::Workspace;
use crate::ui::train::trainer::live::Clock;
use crate::ui::train::trainer::world_choice::WorldChoice;
use egui::Role;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use estimator::diagnose::Verdict;
use haptics::recording::Recording;
use std::path::{Path, PathBuf};
use std::sync::LazyLock;

static ASKEW: LazyLock<Recording> = LazyLock::new(|| askew().expect("performed"));

pub(super) fn saved(recording: &Recording, folder: &Path) -> PathBuf {
    let path = folder.join(format!("{}.csv", recording.name));
    let recording = Recording { labels: None, ..recording.clone() };
    estimator::log::write_csv(&recording, &path).expect("written");
    estimator::log::write_meta(&recording, &path).expect("written");
    path
}

pub(super) fn quiet(jobs: &Jobs<Session>) -> bool {
    !jobs.is_busy()
}

/// The ambiguous recording, opened from a file and diagnosed.
fn asked<'a>(folder: &Path) -> Harness<'a, App> {
    asked_about(&ASKEW, folder)
}

/// Any that leaves something open.
pub(super) fn asked_about<'a>(recording: &Recording, folder: &Path) -> Harness<'a, App> {
    let mut session = Session::new();
    session.training.trainer.clock = Clock::Manual;
    session.training.trainer.recordings_folder = Some(folder.join("recordings"));
    let mut harness = harness(App::new(session), [1280.0, 1600.0], |ui, app: &mut App| app.show(ui));
    let ctx = harness.ctx.clone();
    let path = saved(recording, folder);
    let session = &mut harness.state_mut().session;
    opening::open(&mut session.document, &mut session.jobs, &ctx, &path);
    until(&mut harness, "the next step", |app| {
        let s = &app.session;
        s.calibration.analysis.is_some() && quiet(&s.jobs)
    });
    harness.state_mut().session.workspace = Workspace::Diagnose;
    harness.run_steps(2);
    harness.get_by_role_and_label(Role::Button, "Diagnose").click();
    harness.run_steps(2);
    until(&mut harness, "the next step", |app| {
        let s = &app.session;
        s.diagnosing.answer.is_some()
    });
    assert_eq!(verdict(&harness), Verdict::Ambiguous);
    harness
}

fn verdict(harness: &Harness<'_, App>) -> Verdict {
    harness.state().session.diagnosing.answer.as_ref().expect("an answer").diagnosis.verdict
}

/// Pairs of causes that the answer to both recordings settled: the kept one and the excluded one.
pub(super) fn settled(harness: &Harness<'_, App>) -> Vec<(String, String)> {
    let answer = harness.state().session.diagnosing.answer.as_ref().expect("an answer");
    answer.diagnosis.settled.iter().map(|s| (s.kept.clone(), s.excluded.clone())).collect()
}

/// Settled pairs without dry friction against friction that falls with speed. The crank of [`ASKEW`] has dry friction
/// beside its mass, and the second recording may tell the two apart.
fn settled_beside_friction(harness: &Harness<'_, App>) -> Vec<(String, String)> {
    settled(harness).into_iter().filter(|settled| *settled != ("coulomb-friction".into(), "stribeck".into())).collect()
}

pub(super) fn pair(kept: &str, excluded: &str) -> Vec<(String, String)> {
    vec![(kept.to_owned(), excluded.to_owned())]
}

#[test]
fn it_is_rehearsed_on_every_object_and_said_to_be_simulated() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut harness = asked(folder.path());
    harness.get_by_role_and_label(Role::Button, "Rehearse it").click();
    harness.run_steps(2);
    until(&mut harness, "the next step", |app| {
        let s = &app.session;
        !s.jobs.is_running(REHEARSE)
    });
    let rehearsal = harness.state().session.diagnosing.rehearsal.clone().expect("rehearsed");
    let ids: Vec<&str> = rehearsal.outcomes.iter().map(|o| o.id.as_str()).collect();
    assert_eq!(ids, ["eccentric-mass", "gravity-tilt"]);
    let (right, all) = rehearsal.settled();
    let came_out: Vec<_> =
        rehearsal.outcomes.iter().flat_map(|o| o.rounds.iter().map(|r| (&o.id, &r.named, &r.open))).collect();
    assert!(all == 6 && right >= 5, "{right} of {all}: {came_out:?}");
    for label in ["If it is an eccentric mass", "If it is a tilted plane"] {
        assert!(harness.query_by_label(label).is_some(), "{label}");
    }
    assert!(harness.query_by_label_contains("SIMULATED").is_some());
    assert_eq!(harness.state().session.document.recordings.len(), 1, "a rehearsal adds nothing by itself");
    // One of them can be added, as what it is.
    harness.get_by_role_and_label(Role::Link, "Add simulated gravity-tilt").click();
    harness.run_steps(2);
    until(&mut harness, "the next step", |app| {
        let s = &app.session;
        s.document.recordings.len() == 2 && s.diagnosing.answer.is_some() && quiet(&s.jobs)
    });
    let session = &harness.state().session;
    assert_eq!(simulated_object(&session.document.recordings[1].recording), Some("as if gravity tilt"));
    assert!(harness.query_by_label("Not measured").is_some());
    assert_eq!(settled_beside_friction(&harness), pair("gravity-tilt", "eccentric-mass"), "that is what was simulated");
}

#[test]
fn a_cancelled_rehearsal_leaves_nothing() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut harness = asked(folder.path());
    harness.get_by_role_and_label(Role::Button, "Rehearse it").click();
    harness.run_steps(2);
    harness.get_by_role_and_label(Role::Link, "Cancel").click();
    harness.run_steps(3);
    let session = &harness.state().session;
    assert!(!session.jobs.is_running(REHEARSE) && session.diagnosing.rehearsal.is_none());
    assert!(harness.query_by_label("Rehearse it").is_some());
}

#[test]
fn a_loaded_recording_of_the_experiment_settles_the_question() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut harness = asked(folder.path());
    let answer = harness.state().session.diagnosing.answer.clone().expect("an answer");
    let next = answer.diagnosis.next_experiment.as_ref().and_then(|n| n.experiment.clone()).expect("for a program");
    let path = saved(&done_with(&askew_world(), &next, "hung").expect("performed"), folder.path());
    harness.get_by_role_and_label(Role::TextInput, "Recording of the experiment").focus();
    harness.run_steps(2);
    harness
        .get_by_role_and_label(Role::TextInput, "Recording of the experiment")
        .type_text(&path.display().to_string());
    harness.run_steps(2);
    harness.key_press(egui::Key::Enter);
    harness.run_steps(2);
    until(&mut harness, "the next step", |app| {
        let s = &app.session;
        s.document.recordings.len() == 2 && s.diagnosing.answer.is_some() && quiet(&s.jobs)
    });
    assert_eq!(
        (settled_beside_friction(&harness), verdict(&harness)),
        (pair("eccentric-mass", "gravity-tilt"), Verdict::Causes)
    );
    assert!(harness.query_by_label("Settled").is_some());
    assert!(harness.query_by_label("Eccentric mass, not tilted plane.").is_some());
    assert!(harness.query_by_label("Not measured").is_none() && harness.query_by_label("Record next").is_none());
    assert_eq!(harness.state().session.workspace, Workspace::Diagnose);
}

#[test]
fn a_person_follows_the_rings_in_train_and_adds_what_was_recorded() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut harness = asked(folder.path());
    // The object of the recording stands in Train.
    let trainer = &mut harness.state_mut().session.training.trainer;
    trainer.file = Some(askew_world());
    trainer.choose(WorldChoice::File).expect("it can be touched");
    harness.get_by_role_and_label(Role::Button, "Do it in Train …").click();
    harness.run_steps(3);
    harness.get_by_role_and_label(Role::Button, "The world that stands in Train").click();
    harness.run_steps(2);
    until(&mut harness, "the next step", |app| {
        let s = &app.session;
        s.experiments.guided.is_some()
    });
    assert_eq!(harness.state().session.workspace, Workspace::Train);
    harness.get_by_role_and_label(Role::Button, "Begin").click();
    harness.run_steps(2);
    assert!(harness.state().session.training.trainer.is_recording());
    assert!(harness.query_by_label("Touch nothing.").is_some());
    let session = &mut harness.state_mut().session;
    let all_s = session.experiments.guided.as_ref().expect("going").table.duration_s();
    guidance::follow_rings(&session.experiments, &mut session.training.trainer, 3.0);
    harness.run_steps(2);
    assert!(harness.query_by_label("Take hold.").is_some());
    let session = &mut harness.state_mut().session;
    guidance::follow_rings(&session.experiments, &mut session.training.trainer, all_s);
    harness.run_steps(2);
    until(&mut harness, "the next step", |app| {
        let s = &app.session;
        matches!(s.experiments.guided.as_ref().map(|g| &g.phase), Some(Phase::Recorded(_)))
    });
    harness.get_by_role_and_label(Role::Button, "Add to the diagnosis").click();
    harness.run_steps(2);
    until(&mut harness, "the next step", |app| {
        let s = &app.session;
        s.document.recordings.len() == 2 && s.diagnosing.answer.is_some() && quiet(&s.jobs)
    });
    let session = &harness.state().session;
    let known = &session.document.recordings[1].recording.meta.known;
    assert!(known.get("added_weight_N").is_some_and(|w| *w > 0.05), "{known:?}");
    assert_eq!(
        (session.workspace, settled_beside_friction(&harness)),
        (Workspace::Diagnose, pair("eccentric-mass", "gravity-tilt"))
    );
}

#[test]
fn an_experiment_that_is_left_keeps_no_file() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut harness = asked(folder.path());
    harness.get_by_role_and_label(Role::Button, "Do it in Train …").click();
    harness.run_steps(3);
    harness.get_by_role_and_label(Role::Button, "This one as if it had a tilted plane").click();
    harness.run_steps(2);
    until(&mut harness, "the next step", |app| {
        let s = &app.session;
        s.experiments.guided.is_some()
    });
    assert!(harness.query_by_label_contains("SIMULATED object, as if gravity tilt").is_some());
    harness.get_by_role_and_label(Role::Button, "Begin").click();
    harness.run_steps(2);
    let session = &mut harness.state_mut().session;
    guidance::follow_rings(&session.experiments, &mut session.training.trainer, 3.0);
    harness.get_by_role_and_label(Role::Link, "Leave the experiment").click();
    harness.run_steps(3);
    let session = &harness.state().session;
    assert!(session.experiments.guided.is_none() && !session.training.trainer.is_recording());
}

#[test]
fn a_mechanisms_experiment_is_rehearsed_and_planned_and_what_was_recorded_after_it_settles_the_question() {
    let folder = tempfile::tempdir().expect("a folder");
    let (first, object) = hinge();
    let mut harness = asked_about(&first, folder.path());
    assert!(harness.query_by_label("Do it in Train …").is_none(), "there is no handle to hold");
    harness.get_by_role_and_label(Role::Button, "Rehearse it").click();
    harness.run_steps(2);
    until(&mut harness, "the rehearsal", |app| !app.session.jobs.is_running(REHEARSE));
    let session = &harness.state().session;
    assert_eq!(session.diagnosing.rehearsal_problem, None);
    let rehearsal = session.diagnosing.rehearsal.clone().expect("rehearsed");
    let (right, all) = rehearsal.settled();
    let problems: Vec<_> = rehearsal.outcomes.iter().map(|o| (&o.id, &o.problem)).collect();
    assert!(all == 6 && right >= 5, "{right} of {all}: {problems:?}");
    // The plan is shown, and saved for whatever drives the real one.
    harness.get_by_role_and_label(Role::Button, "Plan of the motion").click();
    harness.run_steps(3);
    assert!(harness.query_by_label("Plan of the motion, 22 s").is_some());
    harness.get_by_role_and_label(Role::Button, "Save the plan").click();
    harness.run_steps(2);
    until(&mut harness, "the plan", |app| quiet(&app.session.jobs));
    let plan = std::fs::read_to_string(folder.path().join("recordings/plan-1.csv")).expect("written");
    assert!(plan.starts_with("t_s,q_rad\n"), "{}", &plan[..40]);
    // The real one, moved as the answer asks by the generator's own hand.
    let answer = harness.state().session.diagnosing.answer.clone().expect("an answer");
    let next = answer.diagnosis.next_experiment.as_ref().and_then(|n| n.experiment.clone()).expect("for a program");
    let mut real = object.perform(&next, 9).expect("the hand knows the motion");
    "hung".clone_into(&mut real.name);
    let path = saved(&real, folder.path());
    let ctx = harness.ctx.clone();
    experiment::add_experiment(&mut harness.state_mut().session, &ctx, &path);
    until(&mut harness, "the answer to both", |app| {
        let s = &app.session;
        s.document.recordings.len() == 2 && s.diagnosing.answer.is_some() && quiet(&s.jobs)
    });
    assert_eq!(settled(&harness), pair("eccentric-mass", "gravity-tilt"));
}
