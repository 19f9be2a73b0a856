//! Every panel on an empty session, on blocks, on a crank, on a mechanism; what is shown and what buttons do.

use super::{CRANK, STACK, cart, clockless_path, count_near, empty, harness, no_driver, session, until};
use crate::text::format;
use crate::ui::calibrate::panels::parameters::ParametersPanel;
use crate::ui::calibrate::panels::recording::RecordingPanel;
use crate::ui::calibrate::panels::results::ResultsPanel;
use crate::ui::calibrate::refits::FIT;
use crate::ui::headless::screenshot;
use crate::ui::kit::theme;
use crate::ui::session::Session;
use crate::ui::shell::dispatch;
use crate::ui::shell::panel::Panel;
use crate::ui::shell::panel_list::panels;
use crate::ui::tests::picture;
use egui_kittest::kittest::Queryable;
use estimator::segment::SystemState;
use haptics::recording::Recording;

#[test]
fn every_panel_draws_every_kind_of_session() {
    let sessions: [fn() -> Session; 5] =
        [empty, || session(STACK.clone()), || session(CRANK.clone()), || session(cart()), || session(clockless_path())];
    for make in sessions {
        for registration in panels() {
            let (title, mut panel) = (registration.title, (registration.new)());
            let mut harness = harness(make(), [420.0, 700.0], move |ui, session: &mut Session| panel.ui(ui, session));
            // Tiny windows too.
            harness.set_size(egui::vec2(60.0, 40.0));
            harness.run_steps(2);
            assert!(harness.state().messages.banners.is_empty(), "{title}: {:?}", harness.state().messages.banners);
        }
    }
}

#[test]
fn the_table_shows_the_values_and_greys_what_is_unknown() {
    let session = session(STACK.clone());
    let fit = session.calibration.analysis.as_ref().expect("fitted").fit.clone();
    let harness = harness(session, [420.0, 800.0], |ui, session| ParametersPanel.ui(ui, session));
    let weight = fit.parameter("block-1", "weight_N").expect("carried");
    let (value, error) = format::with_error(weight.value.expect("a value"), weight.std_error);
    assert!(harness.query_all_by_label(&value).next().is_some(), "{value}");
    assert!(harness.query_all_by_label(&error.expect("an error")).next().is_some());
    let unknown = fit.parameters.iter().filter(|p| !p.identified).count();
    assert_eq!(harness.query_all_by_label("not shown").count(), unknown);
}

#[test]
fn refit_starts_a_job_and_brings_a_fit() {
    let mut session = session(STACK.clone());
    session.calibration.analysis = None;
    let mut harness = harness(session, [300.0, 800.0], |ui, session| {
        let ctx = ui.ctx().clone();
        dispatch::poll(session, &ctx);
        RecordingPanel::default().ui(ui, session);
    });
    harness.get_by_role_and_label(egui::Role::Button, "Fit").click();
    harness.run_steps(1);
    assert!(harness.state().jobs.is_running(FIT) || harness.state().calibration.analysis.is_some());
    until(&mut harness, "the fit", |session| session.calibration.analysis.is_some());
}

#[test]
fn the_replay_lifts_the_block_as_it_was_lifted() {
    let session = session(STACK.clone());
    let segmentation = session.calibration.segmentation(session.document.current).expect("segmented");
    let carry = segmentation.states.iter().find(|i| i.state == SystemState::HoldAboveGround).expect("carried");
    let film = session.calibration.replay(session.document.current).and_then(|r| r.film.clone()).expect("played");
    let height = |t: f64| film.body_at(0, t).expect("block 1").y;
    assert!(height(0.5 * (carry.t0 + carry.t1)) - height(0.0) > 0.005);
    assert!(
        !session.calibration.replay(session.document.current).expect("played").curves.is_empty(),
        "simulated forces"
    );
}

#[test]
fn doubtful_spans_are_shaded_and_listed() {
    let mut recording = cart();
    let spans = [(1_000, 1_200), (4_000, 4_001)].map(|(first, end)| haptics::recording::Span { first, end });
    recording.warnings.push(haptics::recording::Warning {
        kind: "stuck-channel".to_owned(),
        column: Some("f_N".to_owned()),
        spans: spans.to_vec(),
        text: "f_N is stuck".to_owned(),
        ..haptics::recording::Warning::default()
    });
    let mut harness =
        harness(session(recording.clone()), [420.0, 900.0], |ui, session| ResultsPanel::default().ui(ui, session));
    harness.get_by_label("Go to 2.00 s (1 of 2)").click();
    harness.run_steps(3);
    let (from, to) = harness.state().document.view_s;
    assert!(harness.state().document.cursor_s == 2.0 && from < 2.0 && to > 2.4 && to - from < 3.0);
    harness.get_by_label("Go to 8.00 s (2 of 2)").click();
    harness.run_steps(3);
    assert_eq!(harness.state().document.cursor_s, 8.0);
    if no_driver() {
        return;
    }
    for dark in [false, true] {
        let marks = |recording: &Recording| {
            let picture = screenshot::draw(session(recording.clone()), picture("log"), [900, 560], dark);
            count_near(&picture.expect("drawn"), theme::Palette::of(dark).caution)
        };
        let (with, without) = (marks(&recording), marks(&cart()));
        assert!(with > without + 30, "{with} and {without} pixels, dark {dark}");
    }
}
