//! Poses of the window: menus, cards of the tour, messages, long names, every panel in every workspace.

use super::pages::Stage;
use crate::ui::calibrate::sensitivity_actions;
use crate::ui::calibrate::state::Calibration;
use crate::ui::diagnose::state::Diagnosing;
use crate::ui::document::autosave::State;
use crate::ui::document::overlays;
use crate::ui::document::prepared::Prepared;
use crate::ui::document::project::{Project, Source};
use crate::ui::document::state::Document;
use crate::ui::plots::choices::LogView;
use crate::ui::session::Session;
use crate::ui::shell::app::App;
use crate::ui::shell::dock::name_field::Naming;
use crate::ui::shell::message_list::Tone;
use crate::ui::shell::panel_id::PanelId;
use crate::ui::shell::panel_list;
use crate::ui::shell::workspace::Workspace;
use crate::ui::tests::diagnose::{RIPPLED, diagnosed};
use crate::ui::tests::{CRANK, STACK, cart, empty, picture, session};
use egui_kittest::kittest::Queryable as _;
use haptics::recording::{Channel, Recording};
use std::sync::Arc;

const WORKSPACES: [Workspace; 4] = [Workspace::Train, Workspace::Calibrate, Workspace::Diagnose, Workspace::Devices];

fn page(app: App) -> Stage {
    Stage::new(app, picture("workbench"), true, [1280.0, 720.0])
}

/// Another window over the same results: they take seconds to compute.
fn like(workspace: Workspace, document: &Document, calibration: &Calibration, diagnosing: &Diagnosing) -> Session {
    let mut other = empty();
    other.show(document.recordings.clone());
    (other.workspace, other.calibration.choice) = (workspace, calibration.choice.clone());
    (other.calibration.analysis, other.calibration.replays) =
        (calibration.analysis.clone(), calibration.replays.clone());
    other.calibration.enough.clone_from(&calibration.enough);
    other.calibration.sensitivity.clone_from(&calibration.sensitivity);
    other.calibration.refits.answered(&calibration.choice);
    (other.diagnosing.answer, other.diagnosing.problem) = (diagnosing.answer.clone(), diagnosing.problem.clone());
    other
}

fn in_workspace(mut session: Session, workspace: Workspace) -> App {
    session.workspace = workspace;
    App::new(session)
}

fn none(found: &str) {
    assert!(found.is_empty(), "{found}");
}

#[test]
fn workspaces_with_nothing_in_them_can_be_read() {
    let found: Vec<String> = WORKSPACES
        .iter()
        .map(|workspace| page(in_workspace(empty(), *workspace)).look(&format!("empty {workspace:?}")))
        .collect();
    none(&found.concat());
}

#[test]
fn every_panel_can_be_brought_in_and_read_and_arranged() {
    let mut found = String::new();
    let mut full = diagnosed(RIPPLED.clone());
    sensitivity_actions::look_at_sensitivity(&full.document, &mut full.calibration);
    for workspace in [Workspace::Calibrate, Workspace::Diagnose] {
        for pane in panel_list::of(workspace) {
            let mut app =
                in_workspace(like(full.workspace, &full.document, &full.calibration, &full.diagnosing), workspace);
            app.dock.bring(workspace, pane);
            found += &page(app).look(&format!("{workspace:?} with {pane:?}"));
        }
        let mut app =
            in_workspace(like(full.workspace, &full.document, &full.calibration, &full.diagnosing), workspace);
        app.dock.arranging = true;
        found += &page(app).look(&format!("{workspace:?} arranged"));
    }
    none(&found);
}

#[test]
fn every_panel_alone_can_be_read() {
    let mut found = String::new();
    let mut full = session(STACK.clone());
    sensitivity_actions::look_at_sensitivity(&full.document, &mut full.calibration);
    for workspace in WORKSPACES {
        for pane in panel_list::of(workspace) {
            let mut app =
                in_workspace(like(full.workspace, &full.document, &full.calibration, &full.diagnosing), workspace);
            for other in panel_list::of(workspace).into_iter().filter(|other| *other != pane) {
                if app.dock.has(workspace, other) {
                    app.dock.toggle(workspace, other);
                }
            }
            app.dock.bring(workspace, pane);
            found += &page(app).look(&format!("{workspace:?}, only {pane:?}"));
        }
    }
    none(&found);
}

#[test]
fn menus_can_be_read() {
    let mut found = String::new();
    let full = session(STACK.clone());
    for group in ["File", "Edit", "Calibrate", "Time", "View", "Help"] {
        let mut session = like(full.workspace, &full.document, &full.calibration, &full.diagnosing);
        for file in ["a recording with a very long name, of the third day, second try.csv", "crank.mcap"] {
            session.document.recent.note(std::path::Path::new(file));
        }
        let mut app = App::new(session);
        for name in [
            "curves only",
            "for the wall",
            "one panel a screen",
            "states and results",
            "a name of thirty-nine letters, no longer",
        ] {
            assert!(app.dock.save_as(Workspace::Calibrate, name));
        }
        let mut stage = page(app);
        stage.harness.get_by_label("Menu").click();
        stage.harness.run_steps(3);
        let entries: Vec<_> = stage.harness.query_all_by_label_contains(group).collect();
        let entry = entries.last().map(|node| node.rect().center());
        stage.harness.hover_at(entry.expect("the group stands in the menu"));
        found += &stage.look(&format!("menu {group}"));
    }
    none(&found);
}

#[test]
fn the_dialog_for_a_name_can_be_read() {
    let mut app = App::new(session(STACK.clone()));
    assert!(app.dock.save_as(Workspace::Calibrate, "curves only"));
    app.dock.naming = Some(Naming::to_save(Workspace::Calibrate, Some("curves only")));
    none(&page(app).look("naming"));
}

#[test]
fn every_card_of_the_tour_can_be_read() {
    let mut found = String::new();
    let full = session(STACK.clone());
    for step in 0..7 {
        let mut app = App::new(like(full.workspace, &full.document, &full.calibration, &full.diagnosing));
        app.tour.begin_at(step);
        found += &page(app).look(&format!("tour {step}"));
    }
    none(&found);
}

#[test]
fn messages_can_be_read() {
    let mut session = session(STACK.clone());
    session
        .messages
        .say(Tone::Done, "Undone: states set by hand, known value, prior, bounds, part of the recording.".to_owned());
    session.messages.fail("The file cannot be written (permission denied); check the folder and its permissions: /home/someone/with/a/long/name/and/many/folders/below/it/recording-of-the-third-day.csv");
    let mut app = App::new(session);
    let source = Source { log: "/data/a-recording-with-a-very-long-name-of-the-third-day.csv".into(), meta: None };
    let project = Project { recordings: vec![source.clone(), source], ..Project::default() };
    app.left_behind = Some(Box::new(State { project, ..State::default() }));
    none(&page(app).look("messages"));
}

/// Many channels with the names that loggers give them.
fn long_names(name: &str) -> Recording {
    let mut recording = cart();
    recording.name = name.to_owned();
    let time: Vec<f64> = recording.time_s.clone().unwrap_or_default();
    for (unit, stem) in
        [("N", "left_hand_index_fingertip_force"), ("m", "tool_centre_point_position"), ("Nm", "wrist_torque")]
    {
        for axis in ["x_of_the_robot_base", "y_of_the_robot_base", "z_of_the_robot_base", "norm"] {
            let values = time.iter().map(|t| (1.7 * t + axis.len() as f64).sin() * 1234.5678).collect();
            recording.channels.push(Channel { name: format!("{stem}_{axis}_{unit}"), unit: unit.to_owned(), values });
        }
    }
    recording
}

fn over_each_other() -> Session {
    let mut session = session(long_names("a very long name of a recording, the third day, trial 17"));
    let other = Arc::new(Prepared::new(long_names("another very long name of a recording, the fourth day, trial 2")));
    session.document.recordings.push(other);
    session
}

#[test]
fn long_names_of_channels_and_recordings_can_be_read() {
    let mut found = String::new();
    let full = over_each_other();
    for view in [LogView::Time, LogView::Xy] {
        for only in [false, true] {
            let mut session = like(full.workspace, &full.document, &full.calibration, &full.diagnosing);
            overlays::toggle_overlay(&mut session.plots, 1);
            session.plots.view = view;
            let mut app = App::new(session);
            for pane in [PanelId::RECORDING, PanelId::SCENE, PanelId::RESULTS].iter().filter(|_| only) {
                app.dock.toggle(Workspace::Calibrate, *pane);
            }
            found += &page(app).look(&format!("long names, {view:?}, alone {only}"));
        }
    }
    none(&found);
}

#[test]
fn every_parameter_can_be_looked_at_closely() {
    let mut found = String::new();
    for recording in [STACK.clone(), CRANK.clone()] {
        let full = session(recording);
        let fit = &full.calibration.analysis.as_ref().expect("fitted").fit;
        for name in fit.parameters.iter().map(estimator::estimate::Parameter::full_name) {
            let mut session = like(full.workspace, &full.document, &full.calibration, &full.diagnosing);
            session.calibration.selected_parameter = Some(name.clone());
            found += &page(App::new(session)).look(&name);
        }
    }
    none(&found);
}
