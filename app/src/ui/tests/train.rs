//! The trainer's page: hints, legends, the scripted operator's choices, the passivity controller.

use super::{empty, harness, until_quiet};
use crate::operator;
use crate::ui::document::opening;
use crate::ui::shell::app::App;
use crate::ui::train::trainer::control::USUAL_CONTROL_N_S_M;
use crate::ui::train::trainer::live::Operator;
use crate::ui::train::trainer::task::task_hint;
use crate::ui::train::trainer::world_choice::WorldChoice;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use haptics::device::Mistake;

fn window<'a>() -> Harness<'a, App> {
    harness(App::new(empty()), [1200.0, 1100.0], |ui, app: &mut App| app.show(ui))
}

#[test]
fn every_world_says_in_the_picture_what_to_do_and_the_gauges_are_explained() {
    let mut harness = window();
    for (label, choice) in [
        ("Two blocks", WorldChoice::Blocks),
        ("Crank", WorldChoice::Crank),
        ("Needle", WorldChoice::Needle),
        ("Barrel", WorldChoice::Barrel),
        ("Switch", WorldChoice::Switch),
        ("Empty table", WorldChoice::Table),
    ] {
        harness.get_by_role_and_label(egui::Role::RadioButton, label).click();
        harness.run_steps(3);
        harness.state_mut().session.training.trainer.advance(0.05);
        harness.run_steps(2);
        let trainer = &harness.state().session.training.trainer;
        assert_eq!(trainer.choice, choice);
        let line = task_hint(trainer.scene().expect("running").1);
        assert!(harness.query_by_label(line).is_some(), "{label}: {line}");
    }
    let limit = harness.state().session.training.trainer.config().limits.max_force_n;
    assert!(harness.query_by_label(&format!("largest force that is passed on, {limit:.1} N")).is_some());
    assert!(harness.query_by_label("limit").is_some(), "the dashes of the curve");
}

#[test]
fn a_built_in_world_by_name_is_that_of_the_list_and_another_one_comes_from_its_file() {
    let mut harness = window();
    let ctx = harness.ctx.clone();
    let mut open = |name: &str| {
        opening::open_world(&mut harness.state_mut().session.jobs, &ctx, std::path::Path::new(name));
        until_quiet(&mut harness);
        (harness.state().session.training.trainer.choice, harness.state().session.messages.banners.len())
    };
    assert_eq!(open("needle"), (WorldChoice::Needle, 0));
    assert_eq!(open(concat!(env!("CARGO_MANIFEST_DIR"), "/../assets/worlds/barrel.json")), (WorldChoice::Barrel, 0));
    let other = concat!(env!("CARGO_MANIFEST_DIR"), "/../assets/worlds/demo-crank.json");
    assert_eq!(open(other), (WorldChoice::File, 0));
    assert_eq!(open("moon"), (WorldChoice::File, 1), "and what there is not is said");
}

#[test]
fn skill_and_mistake_are_chosen_and_the_performance_starts_over() {
    let mut harness = window();
    harness.get_by_role_and_label(egui::Role::RadioButton, "Scripted").click();
    harness.run_steps(3);
    harness.state_mut().session.training.trainer.advance(2.0);
    assert!(harness.query_by_label("Watch again").is_some());
    for (shown, wanted) in [("Steady", "Novice"), ("None", "Crushing pinch")] {
        harness.get_by_value(shown).click();
        harness.run_steps(3);
        harness.get_by_label(wanted).click();
        harness.run_steps(3);
    }
    let trainer = &harness.state().session.training.trainer;
    assert_eq!((trainer.script.level, trainer.script.mistake), ("novice", Some(Mistake::Crush)));
    assert!(trainer.scene().expect("running").0.state.time_s < 1.0, "started over");
    // A world without occasion for it: nothing is forgotten, nothing goes wrong.
    harness.state_mut().session.training.trainer.choose(WorldChoice::Switch).expect("the switch");
    harness.run_steps(2);
    let trainer = &harness.state().session.training.trainer;
    let (_, world) = trainer.scene().expect("running");
    assert_eq!((trainer.script.mistake_in(world), operator::mistakes_in(world).len()), (None, 0));
    assert!(harness.query_by_label("none in this world").is_some());
}

/// Scrolls the side to a label before it is clicked: cards above it may need the room.
fn click_in_view(harness: &mut Harness<'_, App>, label: &str) {
    harness.get_by_label(label).scroll_to_me();
    harness.run_steps(4);
    harness.get_by_label(label).click();
}

#[test]
fn the_passivity_controller_is_switched_and_the_world_goes_on() {
    let mut harness = window();
    harness.state_mut().session.training.trainer.advance(0.3);
    let before_s = harness.state().session.training.trainer.scene().expect("running").0.state.time_s;
    let control =
        |harness: &Harness<'_, App>| harness.state().session.training.trainer.config().passivity_control_n_s_m;
    assert_eq!(control(&harness), None, "off unless wanted");
    click_in_view(&mut harness, "Controller");
    harness.run_steps(3);
    assert_eq!(control(&harness), Some(USUAL_CONTROL_N_S_M));
    assert!(harness.state().session.training.trainer.scene().expect("running").0.state.time_s >= before_s);
    click_in_view(&mut harness, "10");
    harness.run_steps(3);
    assert_eq!(control(&harness), Some(10.0));
    // A recording would end with the servo: no switching meanwhile.
    let folder = tempfile::tempdir().expect("a temporary folder");
    harness.state_mut().session.training.trainer.recordings_folder = Some(folder.path().to_path_buf());
    harness.state_mut().session.training.trainer.start_recording().expect("begins");
    harness.run_steps(2);
    click_in_view(&mut harness, "Controller");
    harness.run_steps(2);
    assert_eq!(control(&harness), Some(10.0));
    harness.state_mut().session.training.trainer.discard_recording();
    harness.run_steps(2);
    click_in_view(&mut harness, "Controller");
    harness.run_steps(3);
    assert_eq!(control(&harness), None);
    assert_eq!(harness.state().session.training.trainer.operator, Operator::You);
}

#[test]
fn what_the_hand_has_measured_so_far_is_shown_and_can_be_switched_off() {
    let mut harness = window();
    harness.state_mut().session.training.trainer.hand_to(Operator::Scripted).expect("two blocks");
    harness.state_mut().session.training.trainer.advance(9.0);
    harness.run_steps(2);
    let report = harness.state().session.training.trainer.watch.report().expect("the first block was carried");
    assert!(report.parameters.iter().any(|p| p.name == "weight_N" && p.identified), "{:?}", report.parameters);
    assert!(harness.query_by_label("What the hand has measured so far").is_some());
    assert!(harness.query_by_label("Weight").is_some());
    harness.get_by_role_and_label(egui::Role::CheckBox, "On").click();
    harness.run_steps(2);
    assert!(!harness.state().session.training.trainer.watch.on && harness.query_by_label("Switched off.").is_some());
}

#[test]
fn a_slow_line_is_chosen_and_the_card_says_what_the_picture_shows() {
    let mut harness = window();
    let settle = |harness: &mut Harness<'_, App>, seconds: f64| {
        harness.state_mut().session.training.trainer.advance(seconds);
        harness.run_steps(3);
    };
    click_in_view(&mut harness, "500 ms");
    settle(&mut harness, 0.5);
    let delay = |harness: &Harness<'_, App>| harness.state().session.training.trainer.delay();
    assert_eq!((delay(&harness).round_trip_s, delay(&harness).predicted), (0.5, true));
    let solid = "Solid: the model under your hand, at once. Ghost: the far world as it was 250 ms ago.";
    assert!(harness.query_by_label(solid).is_some());
    click_in_view(&mut harness, "Predictive model");
    settle(&mut harness, 0.5);
    assert!(!delay(&harness).predicted && harness.query_by_label(solid).is_none());
    assert!(harness.query_by_label("You see the far world as it was 250 ms ago. Move, wait, look.").is_some());
    click_in_view(&mut harness, "Unsteady line");
    settle(&mut harness, 0.5);
    assert!(delay(&harness).jitter_s > 0.0 && delay(&harness).loss > 0.0);
    click_in_view(&mut harness, "150 ms");
    settle(&mut harness, 0.5);
    assert!((delay(&harness).round_trip_s, delay(&harness).predicted) == (0.15, false) && delay(&harness).loss > 0.0);
    // A recording would end with the servo: no switching meanwhile.
    let folder = tempfile::tempdir().expect("a temporary folder");
    harness.state_mut().session.training.trainer.recordings_folder = Some(folder.path().to_path_buf());
    harness.state_mut().session.training.trainer.start_recording().expect("begins");
    harness.run_steps(2);
    click_in_view(&mut harness, "None");
    harness.run_steps(2);
    assert_eq!(delay(&harness).round_trip_s, 0.15);
    harness.state_mut().session.training.trainer.discard_recording();
    harness.run_steps(2);
    click_in_view(&mut harness, "None");
    settle(&mut harness, 0.2);
    assert!(delay(&harness).is_none() && harness.state().session.training.trainer.view().is_none());
}

#[test]
fn what_was_carried_over_the_line_is_weighed_in_the_card() {
    let mut harness = window();
    let trainer = &mut harness.state_mut().session.training.trainer;
    trainer.set_delay(haptics::teleop::Delay::of(0.5, true)).expect("a line");
    (trainer.script.level, trainer.operator) = ("expert", Operator::Scripted);
    trainer.restart().expect("two blocks");
    trainer.advance(9.0);
    harness.run_steps(2);
    let weighed =
        harness.state().session.training.trainer.view().and_then(|view| view.weighed).expect("it was carried");
    assert!((weighed.mass_kg * 9.81 - 0.343).abs() < 0.02, "{weighed:?}");
    assert!(harness.query_by_label("Carried last").is_some());
}
