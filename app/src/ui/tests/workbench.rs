//! The engineer's workbench: boundaries, other values, statements, undo, commands, panels that move, projects.

use super::{CRANK, STACK, cart, empty, harness, session, until, until_quiet};
use crate::ui::calibrate::fitting;
use crate::ui::calibrate::what_if_actions;
use crate::ui::diagnose::state::DIAGNOSE;
use crate::ui::document::opening;
use crate::ui::document::project_files;
use crate::ui::shell::actions::list::Action;
use crate::ui::shell::app::App;
use crate::ui::shell::panel_id::PanelId;
use crate::ui::shell::workspace::Workspace;
use egui::{Key, Modifiers, pos2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use haptics::recording::Recording;
use std::time::Duration;

fn window(recording: Recording) -> Harness<'static, App> {
    let mut session = session(recording);
    // However busy the machine is: what follows a change must not hang on how long a fit took.
    session.calibration.refits.at_once = Duration::MAX;
    harness(App::new(session), [1480.0, 920.0], |ui, app: &mut App| app.show(ui))
}

/// Frames pass until the jobs have nothing more to do, and changes are noted.
fn settle(harness: &mut Harness<'_, App>) {
    harness.run_steps(2);
    until_quiet(harness);
    // More than half a second of frames: a change is done with.
    harness.run_steps(60);
}

fn weight(harness: &Harness<'_, App>, object: &str) -> (f64, usize) {
    let analysis = harness.state().session.calibration.analysis.as_ref().expect("fitted");
    let parameter = analysis.fit.parameter(object, "weight_N").expect("weighed");
    (parameter.value.expect("a value"), parameter.samples)
}

#[test]
fn a_dragged_boundary_moves_the_fit_and_undo_takes_it_back() {
    let mut harness = window(STACK.clone());
    // The first fit tells how quick fits are.
    let ctx = harness.ctx.clone();
    let session = &mut harness.state_mut().session;
    fitting::refit(&session.document, &mut session.calibration, &mut session.jobs, &ctx);
    settle(&mut harness);
    let before = weight(&harness, "block-1");
    let states = harness.state().session.calibration.segmentation(0).expect("segmented").states.clone();
    let carry = states.iter().position(|i| i.subtask.as_deref() == Some("carry-block-1")).expect("carried");
    let label = format!("Boundary at {} s", crate::text::format::number(states[carry].t1, 2));
    let grip = harness.get_by_label(&label).rect().center();
    let shift = 60.0;
    harness.drag_at(grip);
    harness.run_steps(1);
    for step in 1..=6_u8 {
        harness.hover_at(pos2(grip.x - shift * f32::from(step) / 6.0, grip.y));
        harness.run_steps(1);
    }
    harness.drop_at(pos2(grip.x - shift, grip.y));
    settle(&mut harness);
    let moved = harness.state().session.calibration.segmentation(0).expect("segmented").states[carry].t1;
    assert!(moved < states[carry].t1 - 0.3, "{moved} from {}", states[carry].t1);
    let after = weight(&harness, "block-1");
    assert!(after.1 < before.1, "fewer samples: {} of {}", after.1, before.1);
    assert!(
        harness.state().session.calibration.segmentation(0).is_some_and(|s| s.by_hand)
            && !harness.state().session.calibration.stale
    );
    harness.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    settle(&mut harness);
    assert_eq!(weight(&harness, "block-1"), before, "{:?}", harness.state().session.messages.banners);
    assert!(harness.state().session.calibration.choice.segments.is_empty());
    harness.key_press_modifiers(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
    settle(&mut harness);
    assert_eq!(weight(&harness, "block-1"), after);
}

#[test]
fn a_stretch_of_a_mechanism_is_fitted_alone() {
    let mut harness = window(cart());
    let samples = |harness: &Harness<'_, App>| {
        let fit = &harness.state().session.calibration.analysis.as_ref().expect("fitted").fit;
        fit.parameter("mechanism", "mass_kg").expect("told").samples
    };
    let ctx = harness.ctx.clone();
    let session = &mut harness.state_mut().session;
    fitting::refit(&session.document, &mut session.calibration, &mut session.jobs, &ctx);
    settle(&mut harness);
    let (all, states) =
        (samples(&harness), harness.state().session.calibration.segmentation(0).expect("segmented").states.clone());
    let longest = states.iter().max_by(|a, b| (a.t1 - a.t0).total_cmp(&(b.t1 - b.t0))).expect("it moves");
    let place = states.iter().filter(|s| s.state == longest.state).position(|s| s.t0 == longest.t0).expect("it is one");
    let word = crate::text::states::state_of_task(
        harness.state().session.calibration.segmentation(0).expect("segmented"),
        longest.state,
    );
    let shown: Vec<_> = harness.get_all_by_role_and_label(egui::Role::Button, word).collect();
    shown[place].click_secondary();
    harness.run_steps(2);
    harness.get_by_label("Fit only this stretch").click();
    settle(&mut harness);
    assert_eq!(harness.state().session.calibration.choice.only_s, Some((longest.t0, longest.t1)));
    assert!(samples(&harness) < all, "{} of {all}", samples(&harness));
}

#[test]
fn another_value_is_tried_on_the_replay_and_frozen() {
    let mut harness = window(CRANK.clone());
    let ctx = harness.ctx.clone();
    let session = &mut harness.state_mut().session;
    fitting::refit(&session.document, &mut session.calibration, &mut session.jobs, &ctx);
    settle(&mut harness);
    harness.get_by_label("crank.weight_N").click();
    harness.run_steps(2);
    assert!(harness.query_by_label("Crank · weight").is_some());
    let fitted = weight(&harness, "crank").0;
    what_if_actions::try_value(&mut harness.state_mut().session.calibration, "crank.weight_N", Some(2.0 * fitted));
    settle(&mut harness);
    assert!(!harness.state().session.calibration.what_if.is_behind());
    let shown = what_if_actions::shown_curves(&harness.state().session.document, &harness.state().session.calibration)
        .expect("curves")
        .curves
        .clone();
    let first = harness.state().session.calibration.replay(0).expect("replay").curves.clone();
    assert_eq!(shown.len(), first.len());
    harness.get_by_label("Freeze").click();
    settle(&mut harness);
    let frozen = harness
        .state()
        .session
        .calibration
        .analysis
        .as_ref()
        .expect("fitted")
        .fit
        .parameter("crank", "weight_N")
        .cloned();
    let frozen = frozen.expect("there");
    assert!(
        (frozen.value.expect("a value") - 2.0 * fitted).abs() < 1e-9 && frozen.std_error == Some(0.0),
        "{frozen:?}"
    );
    harness.get_by_label("Estimate").click();
    settle(&mut harness);
    assert!((weight(&harness, "crank").0 - fitted).abs() < 1e-9);
}

#[test]
fn the_palette_finds_and_does() {
    let mut harness = window(STACK.clone());
    harness.key_press_modifiers(Modifiers::COMMAND, Key::P);
    harness.run_steps(2);
    assert!(harness.state().palette.is_open());
    for letter in ["d", "i", "a", "g"] {
        harness.event(egui::Event::Text(letter.to_owned()));
        harness.run_steps(1);
    }
    harness.key_press(Key::Enter);
    harness.run_steps(2);
    assert!(!harness.state().palette.is_open());
    assert_eq!(harness.state().session.workspace, Workspace::Diagnose);
    assert!(harness.state().session.jobs.is_running(DIAGNOSE) || harness.state().session.diagnosing.answer.is_some());
    harness.key_press_modifiers(Modifiers::COMMAND, Key::P);
    harness.run_steps(2);
    harness.key_press(Key::Escape);
    harness.run_steps(2);
    assert!(!harness.state().palette.is_open());
}

#[test]
fn panels_are_arranged_and_put_back() {
    let mut harness = window(STACK.clone());
    let ctx = harness.ctx.clone();
    assert!(harness.query_by_label("Plots").is_none(), "titles only while panels are arranged");
    Action::Arrange.run(&ctx, harness.state_mut());
    harness.run_steps(2);
    assert!(harness.query_by_label("Plots").is_some());
    Action::Panel(PanelId("sensitivity")).run(&ctx, harness.state_mut());
    Action::Panel(PanelId::SCENE).run(&ctx, harness.state_mut());
    settle(&mut harness);
    assert!(harness.query_by_label("What the force depends on").is_some());
    let at = Workspace::Calibrate;
    assert!(
        harness.state_mut().dock.has(at, PanelId("sensitivity")) && !harness.state_mut().dock.has(at, PanelId::SCENE)
    );
    Action::ResetLayout.run(&ctx, harness.state_mut());
    harness.run_steps(2);
    assert!(
        !harness.state_mut().dock.has(at, PanelId("sensitivity")) && harness.state_mut().dock.has(at, PanelId::SCENE)
    );
}

#[test]
fn a_project_brings_back_what_was_done() {
    let folder = tempfile::tempdir().expect("a folder");
    let log = folder.path().join("stack.csv");
    estimator::log::write_csv(&STACK, &log).expect("written");
    estimator::log::write_meta(&STACK, &log).expect("written");
    let mut harness = harness(App::new(empty()), [1480.0, 920.0], |ui, app: &mut App| app.show(ui));
    let ctx = harness.ctx.clone();
    let session = &mut harness.state_mut().session;
    opening::open_any(
        &mut session.document,
        &mut session.wanted_pane,
        &mut session.messages,
        &mut session.jobs,
        &ctx,
        &log,
    );
    settle(&mut harness);
    let session = &mut harness.state_mut().session;
    session.calibration.choice.stated.known.insert("block-1.weight_N".to_owned(), 0.5);
    session.document.seek(7.0);
    let file = folder.path().join("mine.touchstone.json");
    project_files::save_project_as(session, &ctx, file.clone());
    settle(&mut harness);
    let mut other = super::harness(App::new(empty()), [1480.0, 920.0], |ui, app: &mut App| app.show(ui));
    let ctx = other.ctx.clone();
    let session = &mut other.state_mut().session;
    opening::open_any(
        &mut session.document,
        &mut session.wanted_pane,
        &mut session.messages,
        &mut session.jobs,
        &ctx,
        &file,
    );
    settle(&mut other);
    let session = &other.state().session;
    assert!(session.messages.banners.is_empty(), "{:?}", session.messages.banners);
    assert_eq!((session.document.cursor_s, session.workspace), (7.0, Workspace::Calibrate));
    assert_eq!(session.calibration.analysis.as_ref().expect("fitted").fit.value("block-1", "weight_N"), Some(0.5));
    // A second recording joins the first one.
    project_files::add_log(&mut other.state_mut().session, &ctx, &log);
    settle(&mut other);
    assert_eq!((other.state().session.document.recordings.len(), other.state().session.document.sources.len()), (2, 2));
}

#[test]
fn what_a_killed_window_had_open_is_offered_and_comes_back() {
    let folder = tempfile::tempdir().expect("a folder");
    let log = folder.path().join("stack.csv");
    estimator::log::write_csv(&STACK, &log).expect("written");
    estimator::log::write_meta(&STACK, &log).expect("written");
    let state = folder.path().join("state");
    let mut app = App::new(empty());
    app.keep(&state, true);
    assert!(app.tour.is_on(), "the first start shows around");
    app.tour = crate::ui::shell::tour_progress::Tour::default();
    let mut first = harness(app, [1480.0, 920.0], |ui, app: &mut App| app.show(ui));
    let ctx = first.ctx.clone();
    let session = &mut first.state_mut().session;
    opening::open_any(
        &mut session.document,
        &mut session.wanted_pane,
        &mut session.messages,
        &mut session.jobs,
        &ctx,
        &log,
    );
    settle(&mut first);
    first.state_mut().session.calibration.choice.only_s = Some((1.0, 9.0));
    let kept = || std::fs::read_to_string(state.join("session.json")).unwrap_or_default();
    until(&mut first, "the file with the change", |_| kept().contains("[1.0,9.0]"));
    // A killed program closes nothing.
    drop(first);
    let mut app = App::new(empty());
    app.keep(&state, true);
    assert!(app.left_behind.is_some() && !app.tour.is_on());
    let mut second = harness(app, [1480.0, 920.0], |ui, app: &mut App| app.show(ui));
    second.get_by_label("Go on there").click();
    settle(&mut second);
    let session = &second.state().session;
    assert_eq!(session.calibration.choice.only_s, Some((1.0, 9.0)));
    assert!(session.calibration.analysis.is_some(), "{:?}", session.messages.banners);
    assert!(session.document.recent.files().iter().any(|p| p.ends_with("stack.csv")));
}

#[test]
fn the_tour_goes_through_the_workspaces_and_comes_back() {
    let mut app = App::new(empty());
    app.session.workspace = Workspace::Devices;
    app.tour.begin();
    let mut harness = harness(app, [1280.0, 720.0], |ui, app: &mut App| app.show(ui));
    let mut seen = Vec::new();
    while harness.state().tour.is_on() {
        seen.push(harness.state().session.workspace);
        let button = if harness.query_by_label("Done").is_some() { "Done" } else { "Next" };
        harness.get_by_label(button).click();
        harness.run_steps(3);
        assert!(seen.len() < 20, "it ends");
    }
    assert!(seen.contains(&Workspace::Train) && seen.contains(&Workspace::Diagnose));
    assert!(harness.state().tour.seen && harness.state().session.workspace == Workspace::Devices);
}
