//! A part of a recording that is marked in the plot, fitted alone, and kept in the sidecar.

use super::experiment::{quiet, saved};
use super::{CRANK, harness, until};
use crate::ui::document::opening;
use crate::ui::session::Session;
use crate::ui::shell::app::App;
use crate::ui::shell::workspace::Workspace;
use egui::{Event, Modifiers, pos2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;

fn length_s(app: &App) -> f64 {
    app.session.document.prepared().and_then(|p| p.recording.duration_s()).unwrap_or(0.0)
}

/// Marks from one place to another with Shift held.
fn mark(harness: &mut Harness<'_, App>, from_x: f32, to_x: f32) {
    let y = harness.get_by_label("Position menu").rect().bottom() + 40.0;
    harness.event(Event::ModifiersChanged(Modifiers::SHIFT));
    harness.hover_at(pos2(from_x, y));
    harness.run_steps(1);
    harness.drag_at(pos2(from_x, y));
    harness.run_steps(1);
    for step in 1..=6_u8 {
        harness.hover_at(pos2(from_x + (to_x - from_x) * f32::from(step) / 6.0, y));
        harness.run_steps(1);
    }
    harness.drop_at(pos2(to_x, y));
    harness.run_steps(2);
    harness.event(Event::ModifiersChanged(Modifiers::NONE));
}

#[test]
fn a_marked_part_is_fitted_and_kept_in_the_sidecar() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut harness = harness(App::new(Session::new()), [1480.0, 920.0], |ui, app: &mut App| app.show(ui));
    let (ctx, path) = (harness.ctx.clone(), saved(&CRANK, folder.path()));
    let session = &mut harness.state_mut().session;
    session.workspace = Workspace::Calibrate;
    opening::open(&mut session.document, &mut session.jobs, &ctx, &path);
    let opened = |app: &App| app.session.calibration.analysis.is_some() && quiet(&app.session.jobs);
    until(&mut harness, "the fit", opened);
    let whole_s = length_s(harness.state());
    mark(&mut harness, 600.0, 800.0);
    let (from_s, to_s) = harness.state().session.calibration.choice.only_s.expect("a part");
    assert!(from_s > 0.0 && to_s > from_s + 0.5 && to_s < whole_s, "{from_s} to {to_s} of {whole_s} s");
    harness.get_by_label("Read only this part").click();
    harness.run_steps(2);
    until(&mut harness, "the part", |app| opened(app) && length_s(app) < 0.9 * whole_s);
    assert!((length_s(harness.state()) - (to_s - from_s)).abs() < 0.05);
    let sidecar = estimator::log::sidecar_path(&path);
    assert!(std::fs::read_to_string(&sidecar).expect("a sidecar").contains("from_s"));
    harness.get_by_label("Read the whole log").click();
    harness.run_steps(2);
    until(&mut harness, "all of it", |app| opened(app) && (length_s(app) - whole_s).abs() < 1e-6);
    assert!(!std::fs::read_to_string(&sidecar).expect("a sidecar").contains("from_s"));
}
