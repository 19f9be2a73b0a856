//! Blocks in Diagnose: the atlas of their channels; the carry that would settle what is open, rehearsed and done by hand.

use super::experiment::{asked_about, pair, quiet, settled};
use super::until;
use crate::ui::diagnose::experiment_state::REHEARSE;
use crate::ui::diagnose::guidance;
use crate::ui::diagnose::guided_experiment::Phase;
use crate::ui::headless::gallery::samples::{leaking, leaking_world};
use crate::ui::shell::app::App;
use crate::ui::shell::workspace::Workspace;
use crate::ui::train::trainer::world_choice::WorldChoice;
use egui::Role;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use estimator::diagnose::Variable;
use haptics::recording::Recording;
use std::path::Path;
use std::sync::LazyLock;

static LEAKING: LazyLock<Recording> = LazyLock::new(|| leaking().expect("performed"));

/// A block that leaked while it was held, or a sensor that drifted meanwhile: the recording cannot tell.
fn open<'a>(folder: &Path) -> Harness<'a, App> {
    asked_about(&LEAKING, folder)
}

#[test]
fn a_carry_is_rehearsed_with_a_leak_and_with_a_drift() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut harness = open(folder.path());
    harness.get_by_role_and_label(Role::Button, "Rehearse it").click();
    harness.run_steps(2);
    until(&mut harness, "the rehearsal's end", |app| !app.session.jobs.is_running(REHEARSE));
    let session = &harness.state().session;
    let rehearsal = session.diagnosing.rehearsal.clone().expect("rehearsed");
    let (right, all) = rehearsal.settled();
    assert!(all >= 6 && 6 * right >= 5 * all, "{right} of {all}");
    for label in ["If it is a changing weight", "If it is a force drift"] {
        assert!(harness.query_by_label(label).is_some(), "{label}");
    }
}

#[test]
fn a_person_carries_the_block_along_the_rings_and_settles_it() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut harness = open(folder.path());
    let trainer = &mut harness.state_mut().session.training.trainer;
    trainer.file = Some(leaking_world());
    trainer.choose(WorldChoice::File).expect("it can be touched");
    harness.get_by_role_and_label(Role::Button, "Do it in Train …").click();
    harness.run_steps(3);
    harness.get_by_role_and_label(Role::Button, "The world that stands in Train").click();
    harness.run_steps(2);
    until(&mut harness, "the experiment", |app| app.session.experiments.guided.is_some());
    assert_eq!(harness.state().session.workspace, Workspace::Train);
    harness.get_by_role_and_label(Role::Button, "Begin").click();
    harness.run_steps(2);
    assert!(harness.query_by_label("Touch nothing.").is_some());
    let session = &mut harness.state_mut().session;
    let table = session.experiments.guided.as_ref().expect("going").table.clone();
    let carried = table.steps.iter().position(|s| s.words == "Take hold.").expect("a step") + 1;
    // Half way through the carry the block is in the air.
    let middle_s = 0.5 * (table.steps[carried - 1].until_s + table.steps[carried].until_s);
    guidance::follow_rings(&session.experiments, &mut session.training.trainer, middle_s);
    let lifted_m = |session: &crate::ui::session::Session| {
        session
            .training
            .trainer
            .scene()
            .map_or(0.0, |(s, w)| s.state.bodies[0].center_m.y - w.blocks[0].start.center_m.y)
    };
    assert!(lifted_m(session) > 2e-3, "lifted by {} m", lifted_m(session));
    guidance::follow_rings(&session.experiments, &mut session.training.trainer, table.duration_s());
    assert!(lifted_m(session).abs() < 2e-3, "and put down again: {} m", lifted_m(session));
    harness.run_steps(2);
    until(&mut harness, "the recording", |app| {
        matches!(app.session.experiments.guided.as_ref().map(|g| &g.phase), Some(Phase::Recorded(_)))
    });
    harness.get_by_role_and_label(Role::Button, "Add to the diagnosis").click();
    harness.run_steps(2);
    until(&mut harness, "the answer to both", |app| {
        let s = &app.session;
        s.document.recordings.len() == 2 && s.diagnosing.answer.is_some() && quiet(&s.jobs)
    });
    let session = &harness.state().session;
    assert_eq!((session.workspace, settled(&harness)), (Workspace::Diagnose, pair("mass-change", "force-drift")));
}

#[test]
fn the_atlas_of_blocks_has_a_part_for_every_channel() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut harness = open(folder.path());
    let answer = harness.state().session.diagnosing.answer.clone().expect("an answer");
    let channels = &answer.diagnosis.atlas.channels;
    let force = channels.iter().find(|c| c.name == "net force on carried blocks").expect("a channel");
    assert!(channels.iter().any(|c| c.name == "distance of the tips"), "{}", channels.len());
    assert!(force.suspects.windows(2).all(|w| w[0].score >= w[1].score), "the strongest first");
    let of = |id: &str| force.suspects.iter().find(|s| s.id == id);
    let leak = of("mass-change").expect("a suspect");
    assert_eq!(leak.variable, Variable::Time);
    // A leak shows in the lift alone; a resting force in all that a sensor reads.
    let bias = of("force-bias").expect("a suspect");
    assert_eq!(bias.variable, Variable::Time);
    assert!(leak.rows.len() < bias.rows.len(), "{} of {}", leak.rows.len(), bias.rows.len());
    // The leak explains more than 40 % of the residual power of the lift under a constant weight.
    let power = |of: &dyn Fn(usize) -> f64| (0..leak.rows.len()).map(|k| of(k).powi(2)).sum::<f64>();
    let left = |k: usize| force.left[leak.rows[k]];
    let goes = 1.0 - power(&|k| left(k) - leak.taken[k]) / power(&left);
    assert!(goes > 0.4, "{goes}");
    let sheet = &answer.atlas[0];
    assert!(sheet.cells.iter().any(|c| c.scale.unit == "mm") && sheet.cells.iter().any(|c| c.scale.unit == "N"));
    assert!(harness.query_by_label("Net force on carried blocks").is_some());
    let cell = sheet.cells.iter().find(|c| c.id == "mass-change").expect("a cell");
    harness.get_by_role_and_label(Role::Button, &cell.words()).click();
    harness.run_steps(3);
    assert_eq!(harness.state().session.diagnosing.atlas_open.as_deref(), Some(cell.key().as_str()));
    assert!(harness.query_by_label_contains("Alone it scores").is_some());
}
