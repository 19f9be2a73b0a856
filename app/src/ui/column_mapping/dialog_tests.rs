//! The dialog driven by clicks: a foreign table becomes a fitted recording, Cancel changes nothing.

use crate::ui::column_mapping::draft::Role;
use crate::ui::document::opening;
use crate::ui::kit::theme;
use crate::ui::session::Session;
use crate::ui::shell::app::App;
use crate::ui::shell::workspace::Workspace;
use crate::ui::train::trainer::live::Clock;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// A cart of 2 kg with friction, pushed back and forth, as a test rig would write it: odd names and millimetres. The
/// force has the opposite sign, and its header says volts.
fn rig_table(folder: &Path) -> PathBuf {
    let mut text = "# Prüfstand 3\nTakt;Schlitten;Ausgang_V;Öl [°C]\n".to_owned();
    for i in 0..6_000 {
        let t = f64::from(i) * 2e-3;
        let q = 0.1 * (1.3 * t).sin() + 0.04 * (3.1 * t).sin();
        let v = 0.13 * (1.3 * t).cos() + 0.124 * (3.1 * t).cos();
        let a = -0.169 * (1.3 * t).sin() - 0.3844 * (3.1 * t).sin();
        let force = 2.0 * a + 5.0 * v + 0.8 * v.signum();
        let volts = -force / 4.0;
        let line = format!("{};{:.5};{:.6};{:.1}\n", 2 * i, 1e3 * q, volts, 40.0 + 0.1 * t);
        text.push_str(&line.replace('.', ","));
    }
    let path = folder.join("rig.csv");
    std::fs::write(&path, text).expect("writable");
    path
}

fn window() -> Harness<'static, App> {
    let mut session = Session::new();
    session.training.trainer.clock = Clock::Manual;
    let builder = Harness::builder().with_size([1280.0, 720.0]).with_max_steps(8).with_accessibility_check(false);
    let mut harness =
        builder.with_context_setup(theme::install).build_ui_state(|ui, app: &mut App| app.show(ui), App::new(session));
    harness.run_steps(3);
    harness
}

fn wait(harness: &mut Harness<'_, App>, what: &str, until: impl Fn(&Session) -> bool) {
    let begun = Instant::now();
    while !until(&harness.state().session) {
        assert!(begun.elapsed() < Duration::from_mins(1), "{what}: {:?}", harness.state().session.messages.banners);
        std::thread::sleep(Duration::from_millis(5));
        harness.run_steps(1);
    }
    harness.run_steps(3);
}

fn drop_file(harness: &mut Harness<'_, App>, path: &Path) {
    let ctx = harness.ctx.clone();
    opening::open_dropped(&mut harness.state_mut().session, &ctx, &[path.to_path_buf()]);
}

/// Opens a drop-down and selects one of its entries.
fn choose(harness: &mut Harness<'_, App>, list: &str, entry: &str) {
    harness.get_by_role_and_label(egui::Role::ComboBox, list).click();
    harness.run_steps(3);
    // Long lists scroll.
    last(harness, entry).scroll_to_me();
    harness.run_steps(6);
    last(harness, entry).click();
    harness.run_steps(3);
}

fn last<'h>(harness: &'h Harness<'_, App>, label: &'h str) -> egui_kittest::Node<'h> {
    harness.query_all_by_label(label).last().unwrap_or_else(|| panic!("nothing is called {label}"))
}

fn previewed(session: &Session) -> bool {
    session.mapping.as_ref().is_some_and(|m| m.preview.seen.is_some() && !m.preview.is_stale(&session.jobs))
}

#[test]
fn a_rigs_table_becomes_a_fit_by_clicking_only() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = rig_table(folder.path());
    let sidecar = folder.path().join("rig.meta.json");
    std::fs::write(&sidecar, r#"{"operator": "K", "known": {"com_m": 0.2}}"#).expect("writable");
    let mut harness = window();
    drop_file(&mut harness, &path);
    wait(&mut harness, "the dialog opens by itself", |s| s.mapping.is_some());
    wait(&mut harness, "a first preview", previewed);
    assert!(harness.query_by_label("Map columns").is_some());
    {
        let mapping = harness.state().session.mapping.as_ref().expect("open");
        assert_eq!(mapping.draft.rows[1].role, Role::Named("q_m".to_owned()), "the sledge is a position");
        assert_eq!(mapping.draft.rows[1].unit.map(|u| u.shown), Some("mm"), "told from the range");
        assert!(mapping.preview.seen.as_ref().is_some_and(|s| s.as_ref().is_ok_and(|s| s.missing.is_some())));
    }
    choose(&mut harness, "Meaning of Takt", "t_s · time");
    choose(&mut harness, "Meaning of Ausgang_V", "f_N · applied force");
    harness.get_by_label("Sign of Ausgang_V").click();
    harness.run_steps(2);
    // The factor is typed in.
    harness.state_mut().session.mapping.as_mut().expect("open").draft.rows[2].scale = 4.0;
    harness.run_steps(2);
    choose(&mut harness, "Task", "mechanism");
    choose(&mut harness, "Up is", "none: it lies flat");
    wait(&mut harness, "the preview follows", previewed);
    assert!(harness.query_by_label("Nothing is missing: the log can be fitted.").is_some());
    harness.get_by_label("Save sidecar and open").click();
    wait(&mut harness, "fitted", |s| s.mapping.is_none() && s.calibration.analysis.is_some());
    let session = &harness.state().session;
    let mass = session.calibration.analysis.as_ref().and_then(|a| a.fit.value("mechanism", "mass_kg")).expect("a mass");
    assert!((mass / 2.0 - 1.0).abs() < 0.02, "{mass}");
    let saved = std::fs::read_to_string(&sidecar).expect("saved");
    let saved: serde_json::Value = serde_json::from_str(&saved).expect("JSON");
    assert_eq!((&saved["operator"], &saved["known"]["com_m"]), (&"K".into(), &0.2.into()), "nothing is lost");
    assert_eq!(saved["columns"]["t_ms"], "Takt");
}

#[test]
fn cancel_changes_nothing() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("half.csv");
    std::fs::write(&path, "t_s,x_m,comment\n0,1,a\n1,2,b\n2,3,c\n").expect("writable");
    let mut harness = window();
    drop_file(&mut harness, &path);
    wait(&mut harness, "a missing column opens the dialog", |s| s.mapping.is_some());
    wait(&mut harness, "a first preview", previewed);
    harness.key_press(egui::Key::Escape);
    harness.run_steps(3);
    let session = &harness.state().session;
    assert!(session.mapping.is_none() && session.document.recordings.is_empty());
    assert!(
        session.messages.banners[0].text.contains("`y_m` is missing"),
        "the reason is said: {:?}",
        session.messages.banners
    );
    assert!(!folder.path().join("half.meta.json").exists());
}

#[test]
fn known_columns_open_no_dialog_and_a_button_does() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("cart.csv");
    let mut text = "t_s,q_m,f_N\n".to_owned();
    for i in 0..400 {
        let t = f64::from(i) * 0.01;
        let _ = writeln!(text, "{t},{},{}", 0.1 * (2.0 * t).sin(), -0.8 * (2.0 * t).sin());
    }
    std::fs::write(&path, text).expect("writable");
    let mut harness = window();
    drop_file(&mut harness, &path);
    wait(&mut harness, "loaded", |s| !s.document.recordings.is_empty());
    assert!(harness.state().session.mapping.is_none());
    assert_eq!(harness.state().session.workspace, Workspace::Calibrate);
    harness.get_by_label("Map columns …").click();
    wait(&mut harness, "the dialog", |s| s.mapping.is_some());
    let mapping = harness.state().session.mapping.as_ref().expect("open");
    assert!(mapping.why.is_none() && mapping.draft.sidecar() == haptics::recording::Meta::default());
}

#[test]
fn two_columns_of_one_meaning_cannot_be_saved() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = rig_table(folder.path());
    let mut harness = window();
    drop_file(&mut harness, &path);
    wait(&mut harness, "the dialog", |s| s.mapping.is_some());
    wait(&mut harness, "a first preview", previewed);
    choose(&mut harness, "Meaning of Takt", "q_m · coordinate, length");
    wait(&mut harness, "the preview follows", previewed);
    let seen = harness.state().session.mapping.as_ref().and_then(|m| m.preview.seen.as_ref());
    assert!(seen.is_some_and(|s| s.as_ref().is_err_and(|e| e.contains("q_m"))));
    harness.get_by_label("Save sidecar and open").click();
    harness.run_steps(3);
    assert!(harness.state().session.mapping.is_some() && !folder.path().join("rig.meta.json").exists());
}
