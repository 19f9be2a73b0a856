//! The editor of a task's rules: chips, faults, live states, saving.

use super::{CRANK, STACK, harness, session, until};
use crate::ui::calibrate::panels::rules::RulesPanel;
use crate::ui::calibrate::refits::SEGMENT;
use crate::ui::calibrate::rule_editing;
use crate::ui::calibrate::state::Calibration;
use crate::ui::document::state::Document;
use crate::ui::session::Session;
use crate::ui::shell::dispatch;
use crate::ui::shell::panel::Panel as _;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use estimator::segment::SystemState;

fn open(mut session: Session) -> Harness<'static, Session> {
    session.calibration.rules = rule_editing::open(&session.document, &session.calibration, &mut session.messages);
    harness(session, [820.0, 620.0], |ui, session: &mut Session| {
        let ctx = ui.ctx().clone();
        dispatch::poll(session, &ctx);
        RulesPanel.ui(ui, session);
    })
}

/// Until nothing is told anew any more.
fn settle(harness: &mut Harness<'_, Session>) {
    harness.run_steps(2);
    until(harness, "the states", |session| !session.jobs.is_running(SEGMENT));
}

fn carried_s(document: &Document, calibration: &Calibration) -> f64 {
    let states = calibration.segmentation(document.current).map(|s| s.states.as_slice()).unwrap_or_default();
    states.iter().filter(|i| i.state == SystemState::HoldAboveGround).map(|i| i.t1 - i.t0).sum()
}

#[test]
fn a_changed_rule_is_tried_at_once_and_taken_back() {
    let mut harness = open(session(STACK.clone()));
    let before = carried_s(&harness.state().document, &harness.state().calibration);
    assert!(before > 1.0 && !harness.state().calibration.stale);
    // Carried where it is pressed down instead of lifted.
    for sign in ["Hold above ground Lift +", "Hold above ground Lift -"] {
        harness.get_by_label(sign).click();
        settle(&mut harness);
    }
    let changed = carried_s(&harness.state().document, &harness.state().calibration);
    assert!((changed - before).abs() > 0.5, "{changed} s and {before} s");
    let state = harness.state();
    assert!(
        state.calibration.stale && state.calibration.choice.own.is_some() && state.messages.banners.is_empty(),
        "{:?}",
        state.messages.banners
    );
    harness.get_by_label("Reset").click();
    settle(&mut harness);
    assert!((carried_s(&harness.state().document, &harness.state().calibration) - before).abs() < 1e-9);
}

#[test]
fn what_cannot_be_used_is_said_in_one_sentence_and_changes_nothing() {
    let mut harness = open(session(STACK.clone()));
    let before = carried_s(&harness.state().document, &harness.state().calibration);
    let rules = harness.state_mut().calibration.rules.as_mut().expect("open");
    rules.draft.states.retain(|rule| rule.state != SystemState::HoldAboveGround);
    rules.untried = true;
    settle(&mut harness);
    let fault = harness.state().calibration.rules.as_ref().and_then(|rules| rules.fault.clone()).expect("a fault");
    assert!(fault.contains("carry-block-{n}") && fault.ends_with('.'), "{fault}");
    assert!(harness.query_by_label(&fault).is_some());
    assert_eq!(carried_s(&harness.state().document, &harness.state().calibration), before);
    assert!(harness.state().calibration.choice.own.is_none());
}

#[test]
fn a_built_in_name_is_not_taken_and_every_kind_of_task_is_drawn() {
    let mut harness = open(session(CRANK.clone()));
    harness.state_mut().calibration.rules.as_mut().expect("open").name = "crank".to_owned();
    harness.run_steps(2);
    harness.get_by_label("Save as my task").click();
    harness.run_steps(2);
    let banners = &harness.state().messages.banners;
    assert!(banners.iter().any(|b| b.text.contains("built-in") || b.text.contains("folder")), "{banners:?}");
    harness.get_by_label("Close").click();
    harness.run_steps(2);
    assert!(harness.state().calibration.rules.is_none());
}

#[test]
fn a_recording_of_unknown_task_has_no_rules_and_says_so() {
    let mut session = super::empty();
    assert!(rule_editing::open(&session.document, &session.calibration, &mut session.messages).is_none());
    assert!(session.messages.banners[0].text.contains("choose one"), "{:?}", session.messages.banners);
}
