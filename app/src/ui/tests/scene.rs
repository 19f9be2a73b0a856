//! The recording in space: layers, legend, constraints, real beside virtual.

use super::thresholds::LAYER;
use super::{CRANK, STACK, cart, clockless_path, harness, no_driver, session};
use crate::ui::calibrate::panels::scene::ScenePanel;
use crate::ui::calibrate::refits::replay_all;
use crate::ui::headless::screenshot;
use crate::ui::kit::theme;
use crate::ui::scene::layers::SceneLayers;
use crate::ui::scene::overlay::{options_for, scene_world};
use crate::ui::scene::similarity::Likeness;
use crate::ui::session::Session;
use crate::ui::shell::panel::Panel;
use crate::ui::tests::picture;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use estimator::estimate::{Constraint, ConstraintKind, Guide, Touched};
use render::{ColorRole, ConstraintMarker};
use std::sync::Arc;

fn panel(session: Session) -> Harness<'static, Session> {
    let mut panel = ScenePanel::default();
    harness(session, [760.0, 560.0], move |ui, session: &mut Session| panel.ui(ui, session))
}

/// A fit in which the open path has this constraint.
fn with_constraint(constraint: Constraint) -> Session {
    let mut session = session(clockless_path());
    let mut analysis = (**session.calibration.analysis.as_ref().expect("fitted")).clone();
    analysis.fit.constraints = vec![constraint];
    session.calibration.analysis = Some(Arc::new(analysis));
    session
}

fn markers(session: &Session) -> Vec<ConstraintMarker> {
    let prepared = session.document.prepared().expect("shown").clone();
    options_for(session, &prepared, &scene_world(&session.calibration, &prepared)).1.constraints
}

#[test]
fn the_legend_says_what_was_found_and_can_be_switched_off() {
    let mut harness = panel(session(CRANK.clone()));
    assert!(harness.query_by_label_contains("Circle found, radius").is_some());
    assert!(harness.query_by_label_contains("95 % ellipse").is_some());
    assert!(harness.query_by_label("Path of the hand").is_some());
    harness.get_by_label("Path").click();
    harness.run_steps(2);
    assert!(harness.query_by_label("Path of the hand").is_none());
    harness.get_by_label("Legend").click();
    harness.run_steps(2);
    assert!(harness.query_by_label_contains("Circle found").is_none());
}

#[test]
fn the_legend_stands_below_the_picture_and_covers_nothing_of_it() {
    for size in [[650.0, 223.0], [450.0, 320.0], [1000.0, 700.0]] {
        let mut session = session(CRANK.clone());
        let all = SceneLayers { forces_on_path: true, unexplained: true, replay: true, ..SceneLayers::default() };
        session.layers = all;
        let mut panel = ScenePanel::default();
        let harness = harness(session, size, move |ui, session: &mut Session| panel.ui(ui, session));
        let picture = harness.get_by_role(egui::Role::Image).rect();
        assert!(picture.height() > 0.5 * size[1], "{size:?}: {picture}");
        for words in
            ["Path of the hand", "Force of the hand", "Circle found", "Contact of the replay", "Virtual object"]
        {
            let entry = harness.get_by_label_contains(words).rect();
            assert!(entry.top() >= picture.bottom() && entry.bottom() <= size[1], "{size:?}, {words}: {entry}");
        }
    }
}

#[test]
fn real_beside_virtual_is_measured() {
    let mut harness = panel(session(CRANK.clone()));
    assert!(harness.query_by_label_contains("Virtual force").is_none());
    harness.get_by_label("Real and virtual").click();
    harness.run_steps(2);
    assert!(harness.query_by_label_contains("Virtual force").is_some());
    assert!(harness.query_by_label_contains("Virtual object").is_some());
    let mut without = panel(session(cart()));
    without.run_steps(2);
    let mut tool = panel(session(clockless_path()));
    tool.get_by_label("Real and virtual").click();
    tool.run_steps(2);
    assert!(tool.query_by_label_contains("No replay").is_some(), "a tool's path has no hand to play with");
}

#[test]
fn a_wrong_world_is_less_like_the_recording() {
    let session = session(CRANK.clone());
    let prepared = session.document.prepared().expect("shown").clone();
    let analysis = session.calibration.analysis.clone().expect("fitted");
    let like = |world: &haptics::world::World| {
        let replay = replay_all(world, &session.document.recordings).remove(0).expect("played");
        Likeness::of(&replay, world, &prepared)
    };
    let fitted = like(&analysis.world);
    assert!(fitted.force_n.expect("forces") < 0.5 * fitted.of_force_n, "{fitted:?}");
    assert!(fitted.place_m.expect("held") < 0.001 && fitted.of_way_m > 0.01, "{fitted:?}");
    let mut wrong = analysis.world.clone();
    wrong.crank.as_mut().expect("a crank").radius_m *= 1.1;
    let off = like(&wrong);
    assert!(off.place_m.expect("held") > 2.0 * fitted.place_m.expect("held"), "{off:?} and {fitted:?}");
}

#[test]
fn every_kind_of_constraint_has_its_mark_and_its_line() {
    let blank = |kind| Constraint { kind, ..Constraint::blank(None, "") };
    let surface = Constraint {
        surface: Some(Touched {
            point_m: vec![0.0, 0.1],
            normal: vec![0.0, 1.0],
            offset_std_error_m: 2e-4,
            tilt_std_error_rad: 0.01,
            friction: Some(0.3),
            friction_std_error: None,
            touched_from_m: vec![-0.1, 0.1],
            touched_to_m: vec![0.1, 0.1],
        }),
        ..blank(ConstraintKind::Unilateral)
    };
    let guide = Guide {
        points_m: vec![vec![0.0, 0.0], vec![0.1, 0.2], vec![0.3, 0.2]],
        closed: false,
        length_m: 0.4,
        rms_m: 3e-4,
        largest_m: 1e-3,
    };
    let spline = Constraint { guide: Some(guide), ..blank(ConstraintKind::Spline) };
    let line =
        Constraint { direction: Some(vec![1.0, 1.0]), residual_m: Some(1e-4), ..blank(ConstraintKind::Prismatic) };
    let cases = [(surface, "Surface found"), (spline, "Curve found: 3 control points"), (line, "Line found")];
    for (constraint, words) in cases {
        let session = with_constraint(constraint);
        let found = markers(&session);
        match &found[..] {
            [ConstraintMarker::Path { points_m }] => {
                let last = points_m.last().expect("points");
                assert!((last - haptics::Vec2::new(0.3, 0.2)).norm() < 1e-9 && words.starts_with("Curve"));
            }
            [ConstraintMarker::Surface { .. } | ConstraintMarker::Prismatic { .. }] => {}
            other => panic!("{words}: {other:?}"),
        }
        assert!(panel(session).query_by_label_contains(words).is_some(), "{words}");
    }
}

#[test]
fn the_force_that_a_crank_bears_points_along_its_radius() {
    let mut session = session(CRANK.clone());
    session.layers = SceneLayers { unexplained: true, ..session.layers };
    let prepared = session.document.prepared().expect("shown").clone();
    let world = scene_world(&session.calibration, &prepared);
    let options = options_for(&session, &prepared, &world).1;
    let center = world.crank.as_ref().expect("a crank").center_m;
    assert!(options.force_vectors.len() > 20);
    for vector in &options.force_vectors {
        let out = (vector.at_m - center).normalize();
        let across = vector.force_n - out * out.dot(&vector.force_n);
        assert!(across.norm() < 0.05 * vector.force_n.norm() + 1e-3, "{vector:?}");
    }
}

#[test]
fn every_layer_is_seen_in_its_colour() {
    if no_driver() {
        return;
    }
    let none = SceneLayers {
        path: false,
        forces_on_path: false,
        unexplained: false,
        constraints: false,
        contacts: false,
        replay: false,
        legend: false,
    };
    for dark in [false, true] {
        let draw = |layers| {
            let mut session = session(CRANK.clone());
            session.layers = layers;
            let (first, last) = session.document.view_s;
            session.document.seek(0.5 * (first + last));
            screenshot::draw(session, picture("scene"), [640, 420], dark).expect("drawn")
        };
        let bare = draw(none);
        let added = |layers, color| {
            let like = theme::role(dark, color).to_array();
            let near = |p: &image::Rgba<u8>| (0..3).all(|i| p[i].abs_diff(like[i]) < 28);
            let picture = draw(layers);
            picture.pixels().zip(bare.pixels()).filter(|(now, before)| now != before && near(now)).count()
        };
        let cases = [
            ("path", SceneLayers { path: true, ..none }, ColorRole::Measured),
            ("forces", SceneLayers { forces_on_path: true, ..none }, ColorRole::Measured),
            ("unexplained", SceneLayers { unexplained: true, ..none }, ColorRole::Constraint),
            ("constraints", SceneLayers { constraints: true, ..none }, ColorRole::Constraint),
            ("replay", SceneLayers { replay: true, ..none }, ColorRole::Simulated),
        ];
        for (name, layers, color) in cases {
            let pixels = added(layers, color);
            assert!(pixels > LAYER, "{name}, dark {dark}: {pixels} pixels");
        }
    }
}

#[test]
fn keys_turn_the_view_while_the_pointer_is_over_it_and_zero_brings_it_back() {
    let mut harness = panel(session(STACK.clone()));
    assert!(harness.query_by_label("Reset view").is_none());
    harness.key_down(egui::Key::D);
    harness.run_steps(4);
    assert!(harness.query_by_label("Reset view").is_none(), "the pointer is elsewhere");
    harness.hover_at(egui::pos2(400.0, 300.0));
    harness.run_steps(4);
    harness.key_up(egui::Key::D);
    harness.run_steps(2);
    assert!(harness.query_by_label("Reset view").is_some(), "it was turned");
    harness.key_press(egui::Key::Num0);
    harness.run_steps(3);
    assert!(harness.query_by_label("Reset view").is_none());
}

#[test]
fn the_picture_says_what_its_keys_do_and_takes_the_focus() {
    let mut harness = panel(session(STACK.clone()));
    harness.get_by_label_contains("Scene in space").focus();
    harness.run_steps(2);
    harness.key_down(egui::Key::W);
    harness.run_steps(4);
    harness.key_up(egui::Key::W);
    harness.run_steps(2);
    assert!(harness.query_by_label("Reset view").is_some(), "it was turned without a pointer");
}
