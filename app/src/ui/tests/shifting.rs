//! A recording that lies over another is shifted by its curve, with the pointer.

use super::plots::{again, log, two};
use super::{CRANK, session, until};
use crate::ui::document::overlays;
use crate::ui::document::overlays::ALIGN;
use crate::ui::document::undo_actions;
use crate::ui::session::Session;
use egui::{CursorIcon, Key, Modifiers, Pos2, pos2};
use egui_kittest::Harness;

/// The other recording is later by so much.
const LATER_S: f64 = 1.5;

fn over_each_other() -> Harness<'static, Session> {
    let mut session = two(&CRANK, again(&CRANK, "crank again", LATER_S, 0));
    overlays::toggle_overlay(&mut session.plots, 1);
    log(session)
}

fn icon(harness: &Harness<'_, Session>) -> CursorIcon {
    harness.output().platform_output.cursor_icon
}

fn offset_s(harness: &Harness<'_, Session>) -> f64 {
    harness.state().plots.overlaid[0].offset_s
}

/// Highest position at `x` where the hand cursor appears: over the other recording's curve.
fn grip(harness: &mut Harness<'_, Session>, x: f32) -> Pos2 {
    for y in 100..500_u16 {
        let at = pos2(x, f32::from(y));
        harness.hover_at(at);
        harness.run_steps(1);
        if icon(harness) == CursorIcon::Grab {
            return at;
        }
    }
    panic!("no curve can be taken hold of at {x}");
}

/// The time at which a click puts the cursor, away from the curve.
fn time_at(harness: &mut Harness<'_, Session>, at: Pos2) -> f64 {
    for y in [at.y, at.y + 12.0, at.y - 12.0, at.y + 24.0, at.y - 24.0] {
        let at = pos2(at.x, y);
        harness.hover_at(at);
        harness.run_steps(1);
        if icon(harness) != CursorIcon::Grab {
            harness.drag_at(at);
            harness.run_steps(1);
            harness.drop_at(at);
            harness.run_steps(2);
            return harness.state().document.cursor_s;
        }
    }
    panic!("curves are everywhere");
}

fn drag(harness: &mut Harness<'_, Session>, from: Pos2, to_x: f32) {
    harness.hover_at(from);
    harness.run_steps(1);
    harness.drag_at(from);
    harness.run_steps(1);
    for part in 1..=6_u8 {
        harness.hover_at(pos2(from.x + (to_x - from.x) * f32::from(part) / 6.0, from.y + 3.0));
        harness.run_steps(1);
    }
}

#[test]
fn a_drag_of_the_curve_shifts_its_recording_and_undo_takes_it_back() {
    let mut harness = over_each_other();
    harness.run_steps(60);
    let (x, to_x) = (600.0, 690.0);
    let from = grip(&mut harness, x);
    let wished_s = time_at(&mut harness, pos2(to_x, from.y)) - time_at(&mut harness, from);
    let cursor_s = harness.state().document.cursor_s;
    drag(&mut harness, from, to_x);
    assert_eq!(icon(&harness), CursorIcon::Grabbing);
    harness.drop_at(pos2(to_x, from.y + 3.0));
    harness.run_steps(2);
    let shifted_s = offset_s(&harness);
    assert!((shifted_s - wished_s).abs() < 1e-6 && shifted_s > 0.3, "{shifted_s} of {wished_s} s");
    assert_eq!(harness.state().document.cursor_s, cursor_s, "the time cursor stays");
    assert_ne!(icon(&harness), CursorIcon::Grabbing);
    // More than half a second of pictures: the change is done with.
    harness.run_steps(60);
    assert!(undo_actions::can_undo(&harness.state().document, &harness.state().calibration, &harness.state().plots));
    let session = harness.state_mut();
    undo_actions::undo(&mut session.document, &mut session.calibration, &mut session.plots, &mut session.messages);
    assert_eq!(offset_s(&harness), 0.0);
    let session = harness.state_mut();
    undo_actions::redo(&mut session.document, &mut session.calibration, &mut session.plots, &mut session.messages);
    assert_eq!(offset_s(&harness), shifted_s);
}

#[test]
fn it_comes_to_rest_where_both_are_most_alike_unless_alt_is_held() {
    let mut harness = over_each_other();
    let from = grip(&mut harness, 700.0);
    drag(&mut harness, from, 690.0);
    until(&mut harness, "the likeliest place", |s| s.plots.likeliest.get(&(0, 1)).is_some_and(Option::is_some));
    let likeliest_s = harness.state().plots.likeliest[&(0, 1)].expect("found");
    assert!((likeliest_s + LATER_S).abs() < 5e-3, "{likeliest_s} s");
    // Points a second, from what the drag has done so far.
    let s_per_point = offset_s(&harness) / -10.0;
    let target = from.x + (likeliest_s / s_per_point) as f32 + 4.0;
    harness.hover_at(pos2(target, from.y));
    harness.run_steps(2);
    assert_eq!(offset_s(&harness), likeliest_s);
    assert!(harness.state().plots.held.is_some_and(|h| h.snapped));
    harness.event(egui::Event::ModifiersChanged(Modifiers::ALT));
    harness.run_steps(2);
    let freely_s = offset_s(&harness);
    assert!(freely_s != likeliest_s && (freely_s - likeliest_s).abs() < 6.0 * s_per_point, "{freely_s} s");
}

#[test]
fn a_search_for_its_place_that_was_cancelled_is_begun_again_by_the_next_hand_on_it() {
    let mut harness = over_each_other();
    let from = grip(&mut harness, 700.0);
    harness.drag_at(from);
    harness.run_steps(1);
    assert!(harness.state().jobs.is_running(ALIGN), "the hand on the curve begins the search");
    let ctx = harness.ctx.clone();
    harness.state_mut().give_up(&ctx, ALIGN);
    harness.drop_at(from);
    harness.run_steps(2);
    assert!(harness.state().plots.likeliest.is_empty() && !harness.state().jobs.is_running(ALIGN));
    let from = grip(&mut harness, 700.0);
    drag(&mut harness, from, 690.0);
    until(&mut harness, "the likeliest place", |s| s.plots.likeliest.get(&(0, 1)).is_some_and(Option::is_some));
}

#[test]
fn escape_takes_it_back_and_a_click_moves_the_time_cursor() {
    let mut harness = over_each_other();
    let from = grip(&mut harness, 600.0);
    drag(&mut harness, from, 690.0);
    assert!(offset_s(&harness) > 0.3);
    harness.key_press(Key::Escape);
    harness.run_steps(2);
    assert_eq!(offset_s(&harness), 0.0);
    harness.hover_at(pos2(720.0, from.y));
    harness.run_steps(1);
    assert_eq!(offset_s(&harness), 0.0, "the button is still down, and holds nothing");
    harness.drop_at(pos2(720.0, from.y));
    harness.run_steps(2);
    assert!(harness.state().plots.held.is_none());
    let expected_s = time_at(&mut harness, from);
    harness.state_mut().document.seek(0.0);
    harness.drag_at(from);
    harness.run_steps(1);
    harness.drop_at(from);
    harness.run_steps(2);
    assert!((harness.state().document.cursor_s - expected_s).abs() < 1e-6, "{} s", harness.state().document.cursor_s);
    assert_eq!(offset_s(&harness), 0.0);
}

#[test]
fn without_other_recordings_nothing_can_be_taken_hold_of() {
    let mut harness = log(session(CRANK.clone()));
    for y in 100..500_u16 {
        harness.hover_at(pos2(600.0, f32::from(y)));
        harness.run_steps(1);
        assert_ne!(icon(&harness), CursorIcon::Grab, "{y}");
    }
}
