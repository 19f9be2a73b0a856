//! The devices page and the devices behind the trainer, without a window.

use crate::ui::headless::screenshot;
use crate::ui::kit::theme;
use crate::ui::session::Session;
use crate::ui::shell::app::App;
use crate::ui::shell::workspace::Workspace;
use crate::ui::tests::picture;
use crate::ui::train::trainer::hand::{HandDevice, Steering};
use crate::ui::train::trainer::live::{Clock, Operator, Trainer};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use haptics::Vec2;
use std::io::Write;

fn session() -> Session {
    let mut session = Session::new();
    session.training.trainer.clock = Clock::Manual;
    session.workspace = Workspace::Devices;
    session
}

fn manual() -> Trainer {
    Trainer { clock: Clock::Manual, ..Trainer::default() }
}

fn harness(session: Session) -> Harness<'static, App> {
    let builder = Harness::builder().with_size([1280.0, 900.0]).with_max_steps(8).with_accessibility_check(false);
    let mut harness =
        builder.with_context_setup(theme::install).build_ui_state(|ui, app: &mut App| app.show(ui), App::new(session));
    harness.run_steps(3);
    harness
}

/// A file with a key, and a session whose device answers on a port of its own.
fn remote() -> (tempfile::NamedTempFile, Session) {
    let mut file = tempfile::NamedTempFile::new().expect("a file");
    writeln!(file, "{}", "5a".repeat(32)).expect("written");
    let mut session = session();
    session.training.trainer.settings.remote.key = file.path().display().to_string();
    // Any port that is free.
    session.training.trainer.settings.remote.address = "127.0.0.1:0".to_owned();
    (file, session)
}

#[test]
fn the_page_lists_every_kind_of_device_and_takes_the_one_that_is_clicked() {
    let mut harness = harness(session());
    for title in ["Mouse", "Touch screen", "Keyboard", "Scripted operator", "Replay of the open log"] {
        assert!(harness.query_all_by_label(title).next().is_some(), "{title}");
    }
    harness.get_by_role_and_label(egui::Role::RadioButton, "Keyboard").click();
    harness.run_steps(3);
    let trainer = &harness.state().session.training.trainer;
    assert_eq!(trainer.hand, HandDevice::Keyboard);
    assert!(matches!(trainer.steering, Steering::Keyboard(_)));
    assert_eq!(trainer.spec().map(|s| s.name.as_str()), Some("Keyboard"));
    harness.get_by_role_and_label(egui::Role::RadioButton, "Scripted operator").click();
    harness.run_steps(3);
    assert_eq!(harness.state().session.training.trainer.operator, Operator::Scripted);
    // Without a log there is nothing to replay: the line is grey and does nothing.
    harness.get_by_role_and_label(egui::Role::RadioButton, "Replay of the open log").click();
    harness.run_steps(3);
    assert_eq!(harness.state().session.training.trainer.operator, Operator::Scripted);
    assert!(harness.state().session.messages.banners.is_empty(), "{:?}", harness.state().session.messages.banners);
}

#[test]
fn a_device_that_cannot_be_used_is_said_and_the_mouse_takes_over() {
    let mut trainer = manual();
    trainer.ensure_running().expect("a loop");
    let nowhere = HandDevice::Haply("/nowhere/left".to_owned(), "/nowhere/right".to_owned());
    let problem = trainer.take_up(nowhere).expect_err("there is no such port");
    assert!(problem.contains("/nowhere/left") && problem.contains("plugged in"), "{problem}");
    assert_eq!(trainer.hand, HandDevice::Mouse);
    assert!(trainer.spec().is_some() && matches!(trainer.steering, Steering::Mouse(_)));
    assert!(trainer.take_up(HandDevice::Udp).is_err_and(|e| e.contains("key")));
    assert!(trainer.take_up(HandDevice::Replay).is_err_and(|e| e.contains("no log")));
}

#[test]
fn the_world_stays_when_the_device_changes() {
    let mut trainer = manual();
    trainer.ensure_running().expect("a loop");
    trainer.advance(0.5);
    let before = trainer.scene().expect("running").0.state.time_s;
    trainer.take_up(HandDevice::Touch).expect("a touch screen needs nothing");
    assert!(trainer.scene().expect("running").0.state.time_s >= before);
}

#[test]
fn a_force_test_pushes_softly_and_stops_at_once_when_asked() {
    let (_file, session) = remote();
    let mut harness = harness(session);
    harness.get_by_role_and_label(egui::Role::RadioButton, "Remote device over UDP").click();
    harness.run_steps(3);
    assert!(harness.state().session.messages.banners.is_empty(), "{:?}", harness.state().session.messages.banners);
    assert!(harness.state().session.training.trainer.spec().is_some_and(|s| s.force_feedback));
    harness.get_by_label("Push").click();
    harness.run_steps(2);
    assert!(harness.state().session.training.trainer.trial.is_running());
    harness.get_by_label("Stop").click();
    harness.run_steps(2);
    assert!(!harness.state().session.training.trainer.trial.is_running());
    // Esc and leaving the page do the same.
    for leave in [false, true] {
        harness.get_by_label("Push").click();
        harness.run_steps(2);
        assert!(harness.state().session.training.trainer.trial.is_running());
        if leave {
            harness.key_press_modifiers(egui::Modifiers::COMMAND, egui::Key::Num1);
        } else {
            harness.key_press(egui::Key::Escape);
        }
        harness.run_steps(2);
        assert!(!harness.state().session.training.trainer.trial.is_running());
    }
}

#[test]
fn two_touches_in_the_picture_are_the_two_fingertips() {
    let mut session = session();
    session.workspace = Workspace::Train;
    let mut harness = harness(session);
    let touch = |harness: &mut Harness<'static, App>, id: u64, phase: egui::TouchPhase, at: egui::Pos2| {
        let (id, device_id) = (egui::TouchId(id), egui::TouchDeviceId(0));
        harness.event(egui::Event::Touch { device_id, id, phase, pos: at, force: None });
    };
    touch(&mut harness, 1, egui::TouchPhase::Start, egui::pos2(380.0, 400.0));
    harness.run_steps(2);
    assert_eq!(harness.state().session.training.trainer.hand, HandDevice::Touch, "who touches means the touch screen");
    touch(&mut harness, 2, egui::TouchPhase::Start, egui::pos2(520.0, 400.0));
    harness.run_steps(1);
    let Steering::Touch(handle) = &harness.state().session.training.trainer.steering else { panic!("a touch screen") };
    assert_eq!(handle.count(), 2);
    for step in 0..120 {
        harness.state_mut().session.training.trainer.advance(1.0 / 60.0);
        if step % 10 == 0 {
            harness.run_steps(1);
        }
    }
    let tips = harness.state().session.training.trainer.scene().expect("running").0.state.input.tip_in_world;
    let apart = tips[1] - tips[0];
    assert!(apart.x > 0.01 && apart.y.abs() < 0.2 * apart.x, "left and right of each other, as on the glass: {tips:?}");
    touch(&mut harness, 1, egui::TouchPhase::End, egui::pos2(380.0, 400.0));
    touch(&mut harness, 2, egui::TouchPhase::End, egui::pos2(520.0, 400.0));
    harness.run_steps(1);
    let Steering::Touch(handle) = &harness.state().session.training.trainer.steering else { panic!("a touch screen") };
    assert_eq!(handle.count(), 0);
}

#[test]
fn held_keys_move_the_keyboard_device() {
    let mut session = session();
    session.workspace = Workspace::Train;
    session.training.trainer.take_up(HandDevice::Keyboard).expect("a keyboard needs nothing");
    let mut harness = harness(session);
    let middle = |harness: &Harness<'static, App>| {
        let tips = harness.state().session.training.trainer.scene().expect("running").0.state.input.tip_in_world;
        0.5 * (tips[0] + tips[1])
    };
    let before: Vec2 = middle(&harness);
    harness.key_down(egui::Key::ArrowRight);
    harness.run_steps(2);
    for _ in 0..20 {
        harness.state_mut().session.training.trainer.advance(1.0 / 60.0);
    }
    harness.key_up(egui::Key::ArrowRight);
    harness.run_steps(1);
    let moved = middle(&harness) - before;
    assert!(moved.x > 0.005 && moved.y.abs() < 2e-3, "{moved}");
}

#[test]
fn a_dropped_block_flashes_where_it_lands() {
    let mut trainer = manual();
    let mut world = haptics::world::presets::stacking();
    // The upper one of the two: nothing stands above it.
    let upper =
        world.blocks.iter_mut().max_by(|a, b| a.start.center_m.y.total_cmp(&b.start.center_m.y)).expect("two blocks");
    upper.start.center_m.y += 0.008;
    let lands_at = upper.start.center_m.x;
    (trainer.file, trainer.choice) = (Some(world), crate::ui::train::trainer::world_choice::WorldChoice::File);
    trainer.ensure_running().expect("a loop");
    let mut seen = None;
    for _ in 0..60 {
        trainer.advance(1.0 / 60.0);
        seen = seen.or(trainer.impacts.flashes().first().copied());
    }
    let flash = seen.expect("8 mm of fall end in an impact");
    assert!((flash.at_in_world.x - lands_at).abs() < 0.02, "{flash:?}");
    // v = √(2 g h) = 0.396 m/s.
    assert!((flash.speed_m_s - 0.396).abs() < 0.02, "{flash:?}");
    assert!(!trainer.impacts.any(), "and it fades");
}

#[test]
fn the_page_is_drawn_in_both_themes() {
    if render::Headless::new().is_err() {
        let _ = writeln!(std::io::stderr(), "skipped: no graphics driver");
        return;
    }
    for dark in [false, true] {
        let picture = screenshot::draw(session(), picture("devices"), [1280, 720], dark).expect("drawn");
        let [r, g, b, _] = theme::Palette::of(dark).accent.to_array();
        let near = |p: &&image::Rgba<u8>| p.0[0].abs_diff(r) < 4 && p.0[1].abs_diff(g) < 4 && p.0[2].abs_diff(b) < 4;
        assert!(picture.pixels().filter(near).count() > 300, "the chosen device is marked, dark {dark}");
    }
}

#[test]
fn fields_of_a_remote_device_are_checked_where_they_stand() {
    let (file, mut session) = remote();
    std::fs::write(file.path(), "7".repeat(64)).expect("written");
    session.training.trainer.settings.remote.damping = "much".to_owned();
    let mut harness = harness(session);
    let row = "Remote device over UDP";
    harness.get_by_role_and_label(egui::Role::RadioButton, row).click();
    harness.run_steps(3);
    assert_eq!(harness.state().session.training.trainer.hand, HandDevice::Mouse, "a wrong field opens nothing");
    assert!(harness.query_by_label_contains("`much` is no damping").is_some());
    harness.state_mut().session.training.trainer.settings.remote.damping = "0.5".to_owned();
    harness.state_mut().session.training.trainer.settings.remote.round_trip = "20".to_owned();
    harness.run_steps(3);
    harness.get_by_role_and_label(egui::Role::RadioButton, row).click();
    harness.run_steps(3);
    harness.state_mut().session.training.trainer.advance(0.02);
    let trainer = &harness.state().session.training.trainer;
    assert!(trainer.spec().is_some_and(|spec| spec.damping_n_s_m == 0.5));
    assert!(trainer.scene().expect("running").0.coupling.is_some(), "felt through a spring, for the round trip");
    // The key is one digit over and over: that is said.
    assert!(harness.query_by_label_contains("anybody can guess").is_some());
    harness.state_mut().session.training.trainer.settings.remote.damping = "0.9".to_owned();
    harness.run_steps(2);
    harness.get_by_label("Open again with these").click();
    harness.run_steps(3);
    assert!(harness.state().session.training.trainer.spec().is_some_and(|spec| spec.damping_n_s_m == 0.9));
    assert!(harness.query_by_label("Open again with these").is_none(), "they are in use now");
    drop(file);
}

#[test]
fn the_page_fits_small_windows() {
    for size in [[1000.0, 620.0], [1600.0, 1000.0]] {
        let (_file, session) = remote();
        let mut harness = harness(session);
        harness.set_size(egui::Vec2::from(size));
        harness.run_steps(4);
        for label in ["Now", "Timing", "Passivity", "Over the network"] {
            // Labels below the edge can be scrolled to; nothing stands beyond the right edge.
            let rect = harness.get_by_label(label).rect();
            assert!(rect.left() >= 0.0 && rect.right() <= size[0], "{label} at {rect:?} in {size:?}");
        }
        let right = harness.get_by_label("Right finger").rect();
        assert!(right.right() <= size[0], "{right:?} in {size:?}");
    }
}

#[test]
fn answers_of_boards_are_told_by_reason() {
    use crate::boards::Answers;
    let both = [Answers { asked: 3000, faults: [3, 0, 0] }, Answers { asked: 3000, faults: [0, 900, 20] }];
    let show = move |ui: &mut egui::Ui, (): &mut ()| crate::ui::devices::panels::device_log::boards(ui, both);
    let mut harness = Harness::builder().with_context_setup(theme::install).build_ui_state(show, ());
    harness.run_steps(2);
    for part in ["Left: 3 of 3000", "900 with the wrong id", "20 where no hand can be", "Check its cable"] {
        assert!(harness.query_by_label_contains(part).is_some(), "{part}");
    }
}

#[test]
fn a_board_whose_cable_was_pulled_is_set_up_when_a_person_says_that_its_arm_rests() {
    let tallies = [haptics::device::haply::Tally::default(), haptics::device::haply::Tally::default()];
    let shown = tallies.clone();
    let show = move |ui: &mut egui::Ui, (): &mut ()| crate::ui::devices::panels::device_log::unplugged(ui, &shown);
    let mut harness = Harness::builder().with_context_setup(theme::install).build_ui_state(show, ());
    harness.run_steps(2);
    let (card, button) = ("A cable was pulled", "The arm rests: set it up");
    assert!(harness.query_by_label(card).is_none(), "both are in");
    tallies[1].note_unplugged(true);
    harness.run_steps(2);
    assert!(harness.query_by_label_contains("Right: plug it in").is_some() && !tallies[1].is_looked_for());
    harness.get_by_label(button).click();
    harness.run_steps(2);
    assert!(tallies[1].is_looked_for() && !tallies[0].is_looked_for());
    assert!(harness.query_by_label(button).is_none() && harness.query_by_label_contains("Looking for").is_some());
    tallies[1].note_unplugged(false);
    harness.run_steps(2);
    assert!(harness.query_by_label(card).is_none());
}
