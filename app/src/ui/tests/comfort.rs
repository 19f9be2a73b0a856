//! Comfort in Train: a pause when the window loses the focus, everything anew by one key, a left hand, what is remembered.

use super::{empty, in_train, keep, no_driver, train_window};
use crate::ui::headless::screenshot;
use crate::ui::shell::app::App;
use crate::ui::tests::picture;
use crate::ui::train::lessons::practising;
use crate::ui::train::lessons::state::Phase;
use crate::ui::train::trainer::live::{Operator, Trainer};
use crate::ui::train::trainer::pause::{Cause as HoldCause, PAUSED};
use crate::ui::train::trainer::world_choice::WorldChoice;
use egui::accesskit::Role;
use egui::{Key, Modifiers, PointerButton};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;

const LOST: &str = "Paused: the window lost the focus. Click here or press Space to go on.";

fn focus(harness: &mut Harness<'_, App>, has: bool) {
    harness.input_mut().focused = has;
    harness.run_steps(3);
}

fn time_s(harness: &Harness<'_, App>) -> f64 {
    harness.state().session.training.trainer.scene().expect("running").0.state.time_s
}

fn trainer<'a>(harness: &'a mut Harness<'_, App>) -> &'a mut Trainer {
    &mut harness.state_mut().session.training.trainer
}

#[test]
fn a_window_without_focus_holds_the_world_until_one_goes_on_and_the_recording_says_so() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut harness = train_window(in_train(folder.path()));
    focus(&mut harness, true);
    trainer(&mut harness).start_recording().expect("begins");
    trainer(&mut harness).advance(0.5);
    focus(&mut harness, false);
    assert_eq!(harness.state().session.training.trainer.held(), Some(HoldCause::Focus));
    assert!(harness.query_by_role_and_label(Role::Button, LOST).is_some());
    let before_s = time_s(&harness);
    trainer(&mut harness).advance(1.0);
    assert!((time_s(&harness) - before_s).abs() < 1e-12, "no time passes");
    // The focus alone does not go on: whoever comes back takes hold first.
    focus(&mut harness, true);
    assert!(harness.state().session.training.trainer.held().is_some());
    harness.key_press(Key::Space);
    harness.run_steps(3);
    assert_eq!(harness.state().session.training.trainer.held(), None);
    assert!(!harness.state().session.training.trainer.pinch.latched, "the key went on, it did not pinch");
    assert!(harness.query_by_role_and_label(Role::Button, LOST).is_none());
    trainer(&mut harness).advance(0.5);
    assert!(time_s(&harness) > before_s + 0.4);
    harness.key_press(Key::Space);
    harness.run_steps(2);
    assert!(harness.state().session.training.trainer.pinch.latched, "now it pinches");
    let finished = trainer(&mut harness).stop_recording().expect("recorded").wait().expect("written");
    let recording = estimator::log::load(&finished.path, None).expect("opens").remove(0);
    assert_eq!(recording.meta.other[PAUSED]["times"], 1, "{:?}", recording.meta.other.get(PAUSED));
    let times = recording.time_s.as_ref().expect("a clock");
    assert!(times.windows(2).all(|w| w[1] > w[0] && w[1] - w[0] < 0.01), "no sample is of the pause, and no hole");
    assert!((times[times.len() - 1] - times[0] - 1.0).abs() < 0.1);
}

#[test]
fn nothing_is_held_for_the_scripted_operator_nor_where_it_is_not_wanted() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut harness = train_window(in_train(folder.path()));
    focus(&mut harness, true);
    trainer(&mut harness).hand_to(Operator::Scripted).expect("works");
    focus(&mut harness, false);
    assert_eq!(harness.state().session.training.trainer.held(), None, "nobody's hand is gone");
    trainer(&mut harness).hand_to(Operator::You).expect("works");
    focus(&mut harness, true);
    harness.state_mut().session.training.comfort.pauses = false;
    focus(&mut harness, false);
    assert_eq!(harness.state().session.training.trainer.held(), None);
    // Another world ends a pause with the servo that was held.
    harness.state_mut().session.training.comfort.pauses = true;
    focus(&mut harness, true);
    focus(&mut harness, false);
    assert!(harness.state().session.training.trainer.held().is_some());
    trainer(&mut harness).restart().expect("works");
    assert_eq!(harness.state().session.training.trainer.held(), None);
}

#[test]
fn one_key_starts_over_and_a_test_begins_anew_with_a_word() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut harness = train_window(in_train(folder.path()));
    trainer(&mut harness).choose(WorldChoice::Blocks).expect("works");
    harness.run_steps(2);
    trainer(&mut harness).advance(2.0);
    assert!(time_s(&harness) > 1.9);
    harness.key_press(Key::N);
    harness.run_steps(3);
    trainer(&mut harness).advance(0.02);
    assert!(time_s(&harness) < 0.5, "everything is where it started");
    // A lesson: a try begins anew, an attempt that counts too, and that is said.
    harness.state_mut().session.training.lessons.load();
    let lesson = harness.state().session.training.lessons.all[0].clone();
    let session = &mut harness.state_mut().session;
    practising::open_lesson_now(&mut session.training, &mut session.messages, &lesson);
    let session = &mut harness.state_mut().session;
    practising::test_lesson(&mut session.training, &mut session.messages);
    trainer(&mut harness).advance(1.0);
    harness.run_steps(2);
    harness.key_press(Key::N);
    harness.run_steps(3);
    let session = &harness.state().session;
    assert_eq!(session.training.lessons.open.as_ref().map(|open| open.phase.clone()), Some(Phase::Testing));
    assert!(session.training.trainer.is_recording() && time_s(&harness) < 0.5);
    assert!(session.messages.banners.iter().any(|b| b.text.contains("begins anew")));
}

#[test]
fn a_left_hand_has_the_controls_on_its_side_and_pinches_with_the_other_button() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut harness = train_window(in_train(folder.path()));
    harness.run_steps(3);
    let right = harness.get_by_label("Comfort").rect().left();
    harness.get_by_label("Left-handed").scroll_to_me();
    harness.run_steps(4);
    harness.get_by_role_and_label(Role::CheckBox, "Left-handed").click();
    harness.run_steps(4);
    assert!(harness.state().session.training.comfort.left_handed);
    let left = harness.get_by_label("Comfort").rect().left();
    assert!(left < 340.0 && right > 900.0, "controls went from {right} to {left}");
    assert!(harness.query_by_label("Left drag").is_some() || harness.query_by_label_contains("Right button").is_some());
    let at = egui::pos2(800.0, 500.0);
    let press = |pressed| egui::Event::PointerButton {
        pos: at,
        button: PointerButton::Secondary,
        pressed,
        modifiers: Modifiers::NONE,
    };
    harness.event(egui::Event::PointerMoved(at));
    harness.run_steps(2);
    harness.event(press(true));
    harness.run_steps(2);
    assert!(harness.state().session.training.trainer.pinch.button, "the right button pinches");
    harness.event(press(false));
    harness.run_steps(2);
    assert!(!harness.state().session.training.trainer.pinch.button);
}

#[test]
fn the_pause_and_the_left_handed_page_are_drawn_in_both_themes() {
    if no_driver() {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    for dark in [false, true] {
        let mut session = in_train(folder.path());
        session.training.trainer.ensure_running().expect("a loop");
        let usual = screenshot::draw(in_train(folder.path()), picture("train"), [1280, 720], dark).expect("drawn");
        let tall = screenshot::draw(in_train(folder.path()), picture("train"), [1280, 1500], dark).expect("drawn");
        keep(&format!("comfort-{dark}"), &tall);
        session.training.comfort.left_handed = true;
        session.training.trainer.lose_focus();
        let picture = screenshot::draw(session, picture("train"), [1280, 720], dark).expect("drawn");
        keep(&format!("paused-{dark}"), &picture);
        assert_ne!(picture, usual);
        let caution = super::theme::Palette::of(dark).caution;
        assert!(super::count_near(&picture, caution) > 300, "the edge of the card, dark {dark}");
    }
}

#[test]
fn what_was_chosen_is_remembered() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut app = App::new(empty());
    app.keep(folder.path(), false);
    app.session.training.comfort.left_handed = true;
    app.session.training.comfort.muted = true;
    app.autosave.as_mut().expect("kept").end(&app.session, &app.dock, true);
    let chosen = app.session.training.comfort;
    drop(app);
    let mut again = App::new(empty());
    again.keep(folder.path(), false);
    assert_eq!(again.session.training.comfort, chosen);
}

/// Several presses come with one picture if pictures are rare.
#[test]
fn keys_that_come_with_one_picture_all_count() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut harness = train_window(in_train(folder.path()));
    focus(&mut harness, true);
    let before_n = trainer(&mut harness).pinch.strength_n();
    let press = |key: Key| {
        [true, false].map(|pressed| {
            let modifiers = Modifiers::NONE;
            egui::Event::Key { key, physical_key: None, pressed, repeat: false, modifiers }
        })
    };
    let keys = [Key::Minus, Key::Minus, Key::Minus, Key::Equals, Key::Space, Key::Space];
    harness.input_mut().events.extend(keys.into_iter().flat_map(press));
    harness.run_steps(2);
    let pinch = &trainer(&mut harness).pinch;
    assert!((before_n - pinch.strength_n() - 0.4).abs() < 1e-9, "{before_n} {}", pinch.strength_n());
    assert!(!pinch.latched, "pressed twice: closed and open again");
}
