//! Names for the screen reader: every widget has one.

use super::diagnose::{RIPPLED, diagnosed};
use super::{CRANK, STACK, empty, harness, session};
use crate::ui::calibrate::rule_editing;
use crate::ui::document::video_actions;
use crate::ui::plots::choices::LogView;
use crate::ui::session::Session;
use crate::ui::shell::app::App;
use crate::ui::shell::panel_list;
use crate::ui::shell::workspace::Workspace;

/// The widgets without a name in one state of the whole window, with where they are.
fn unnamed(what: &str, session: Session, change: impl FnOnce(&mut App)) -> Vec<String> {
    let mut app = App::new(session);
    change(&mut app);
    // Tall, so that nothing is scrolled away.
    let mut harness = harness(app, [1480.0, 2400.0], |ui, app: &mut App| app.show(ui));
    harness.run_steps(3);
    harness.unnamed_widgets().into_iter().map(|widget| format!("{what}: {widget}")).collect()
}

fn at(workspace: Workspace, mut session: Session) -> Session {
    session.workspace = workspace;
    session
}

#[test]
fn every_widget_has_a_name_for_a_screen_reader() {
    let everywhere = |workspace: Workspace| {
        move |app: &mut App| panel_list::of(workspace).into_iter().for_each(|pane| app.dock.bring(workspace, pane))
    };
    let mut crank = session(CRANK.clone());
    crank.calibration.selected_parameter = Some("crank.radius_m".to_owned());
    let mut rules = session(STACK.clone());
    rules.calibration.rules = rule_editing::open(&rules.document, &rules.calibration, &mut rules.messages);
    let mut xy = session(STACK.clone());
    xy.plots.view = LogView::Xy;
    let mut video = session(STACK.clone());
    video_actions::open_video(
        &mut video.document,
        &mut video.wanted_pane,
        &mut video.messages,
        &mut video.jobs,
        std::path::Path::new("none.mp4"),
    );
    let found = [
        unnamed("XY", xy, |_| {}),
        unnamed("video", video, |_| {}),
        unnamed("Calibrate, empty", at(Workspace::Calibrate, empty()), |_| {}),
        unnamed("Calibrate, blocks", session(STACK.clone()), everywhere(Workspace::Calibrate)),
        unnamed("Calibrate, crank", crank, |_| {}),
        unnamed("rules", rules, |_| {}),
        unnamed("Diagnose", diagnosed(RIPPLED.clone()), everywhere(Workspace::Diagnose)),
        unnamed("Train", at(Workspace::Train, empty()), |_| {}),
        unnamed("Devices", at(Workspace::Devices, empty()), |_| {}),
        unnamed("arranging", session(STACK.clone()), |app| app.dock.arranging = true),
        unnamed("all commands", session(STACK.clone()), |app| app.palette.open()),
        unnamed("the tour", session(STACK.clone()), |app| app.tour.begin_at(2)),
    ]
    .concat();
    assert!(found.is_empty(), "a screen reader has no name for these:\n{}", found.join("\n"));
}
