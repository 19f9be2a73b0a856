//! Named arrangements, used as a person does: by the palette, the menu and the dialog.

use super::{STACK, harness, session};
use crate::ui::document::autosave::Autosave;
use crate::ui::shell::app::App;
use crate::ui::shell::panel_id::PanelId;
use crate::ui::shell::workspace::Workspace;
use egui::{Event, Key, Modifiers, Role};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;

const AT: Workspace = Workspace::Calibrate;

fn window() -> Harness<'static, App> {
    harness(App::new(session(STACK.clone())), [1280.0, 720.0], |ui, app: &mut App| app.show(ui))
}

fn find(harness: &mut Harness<'_, App>, words: &str) {
    harness.key_press_modifiers(Modifiers::COMMAND, Key::P);
    harness.run_steps(3);
    harness.event(Event::Text(words.to_owned()));
    harness.run_steps(2);
    harness.key_press(Key::Enter);
    harness.run_steps(3);
}

fn name_it(harness: &mut Harness<'_, App>, name: &str) {
    harness.key_press_modifiers(Modifiers::COMMAND, Key::A);
    harness.event(Event::Text(name.to_owned()));
    harness.run_steps(2);
    harness.key_press(Key::Enter);
    harness.run_steps(3);
}

#[test]
fn an_arrangement_is_saved_renamed_chosen_and_deleted_by_palette_and_menu() {
    let mut harness = window();
    find(&mut harness, "panel: states");
    assert!(harness.state_mut().dock.has(AT, PanelId::SEGMENTS));
    find(&mut harness, "save arrangement");
    assert!(harness.query_by_label("Save the arrangement").is_some());
    name_it(&mut harness, "with R and space");
    assert_eq!(harness.state().dock.names(AT).collect::<Vec<_>>(), ["with R and space"]);
    assert!(!harness.state().session.document.playing, "letters of a name are no commands");
    find(&mut harness, "rename arrangement");
    name_it(&mut harness, "states");
    find(&mut harness, "standard arrangement");
    assert!(!harness.state_mut().dock.has(AT, PanelId::SEGMENTS));
    harness.get_by_label("Menu").click();
    harness.run_steps(3);
    harness.query_all_by_label_contains("View").last().expect("a menu").click();
    harness.run_steps(4);
    harness.get_by_label_contains("Arrangement: states").click();
    harness.run_steps(4);
    assert!(harness.state_mut().dock.has(AT, PanelId::SEGMENTS));
    assert_eq!(harness.state().dock.chosen(AT), Some("states"));
    find(&mut harness, "delete arrangement");
    assert_eq!(harness.state().dock.names(AT).count(), 0);
    assert!(harness.state_mut().dock.has(AT, PanelId::SEGMENTS), "panels stay");
}

#[test]
fn an_empty_name_cannot_be_saved_and_escape_leaves() {
    let mut harness = window();
    find(&mut harness, "save arrangement");
    harness.key_press(Key::Enter);
    harness.run_steps(2);
    assert!(harness.query_by_label("Give it a name.").is_some());
    harness.get_by_role_and_label(Role::Button, "Save").click();
    harness.run_steps(2);
    assert!(harness.state().dock.naming.is_some() && harness.state().dock.names(AT).count() == 0);
    harness.key_press(Key::Escape);
    harness.run_steps(3);
    assert!(harness.state().dock.naming.is_none());
}

#[test]
fn they_are_kept_for_the_next_start() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut app = App::new(session(STACK.clone()));
    app.keep(folder.path(), false);
    app.dock.toggle(AT, PanelId::SCENE);
    assert!(app.dock.save_as(AT, "curves only"));
    let mut kept: Autosave = app.autosave.take().expect("kept");
    kept.end(&app.session, &app.dock, true);
    drop((kept, app));
    let mut next = App::new(super::empty());
    next.keep(folder.path(), false);
    next.dock.reset(AT);
    assert!(next.dock.has(AT, PanelId::SCENE));
    assert!(next.dock.choose(AT, "curves only") && !next.dock.has(AT, PanelId::SCENE));
}
