//! Checks of a diagnosis on other recordings; and the residual atlas.

use super::diagnose::{RIPPLED, diagnosed, hiding_so_much};
use super::{count_near, harness, keep, no_driver, until_done};
use crate::ui::diagnose::checked::{Checked, Holds, On, holds};
use crate::ui::diagnose::replays::REPLAY;
use crate::ui::diagnose::validation::{CHECK, check_now};
use crate::ui::document::prepared::Prepared;
use crate::ui::headless::screenshot;
use crate::ui::kit::theme;
use crate::ui::session::Session;
use crate::ui::shell::app::App;
use crate::ui::tests::picture;
use blind::{Bench, Effect};
use egui::Role;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use estimator::diagnose::{Options, Variable, Verdict, validate};
use haptics::recording::Recording;
use std::path::{Path, PathBuf};
use std::sync::Arc;

fn saved(recording: &Recording, name: &str, folder: &Path) -> PathBuf {
    let path = folder.join(format!("{name}.csv"));
    estimator::log::write_csv(recording, &path).expect("written");
    estimator::log::write_meta(recording, &path).expect("written");
    path
}

fn window<'a>(session: Session) -> Harness<'a, App> {
    harness(App::new(session), [1280.0, 1800.0], |ui, app: &mut App| app.show(ui))
}

fn type_path(harness: &mut Harness<'_, App>, path: &str) {
    let label = "Recording to check on";
    harness.get_by_role_and_label(Role::TextInput, label).focus();
    harness.run_steps(2);
    harness.get_by_role_and_label(Role::TextInput, label).type_text(path);
    harness.run_steps(2);
    harness.key_press(egui::Key::Enter);
    harness.run_steps(2);
    until_done(harness, CHECK);
}

#[test]
fn what_was_found_is_checked_on_files_with_an_interval_and_a_verdict() {
    let folder = tempfile::tempdir().expect("a folder");
    let same = saved(&RIPPLED, "same", folder.path());
    // The same object without that ripple.
    let other = saved(&hiding_so_much(Effect::Ripple, Bench::OneFinger, 3, 1e-6), "other", folder.path());
    let mut harness = window(diagnosed(RIPPLED.clone()));
    type_path(&mut harness, &same.display().to_string());
    assert!(harness.query_by_label("It holds here, too.").is_some());
    type_path(&mut harness, &other.display().to_string());
    assert!(harness.query_by_label("It does not hold here: the model alone does better.").is_some());
    type_path(&mut harness, "/nowhere/at-all.csv");
    let session = &harness.state().session;
    let [same_found, other_found, missing] = session.diagnosing.checked.as_slice() else {
        panic!("{:?}", session.diagnosing.checked)
    };
    assert!(missing.found.as_ref().is_err_and(|why| why.ends_with('.')), "{missing:?}");
    // The same figures as those of the command line.
    let answer = session.diagnosing.answer.as_ref().expect("an answer");
    let read = estimator::log::load(&same, None).expect("opens");
    let expected = validate(&read, &Options::default(), &answer.diagnosis).expect("figures");
    assert_eq!(same_found.found.as_ref(), Ok(&expected[0]));
    let [low, high] = expected[0].interval;
    assert!(low < expected[0].share && expected[0].share < high && low > 0.3, "{expected:?}");
    assert_eq!(other_found.found.as_ref().map(holds), Ok(Holds::No));
    // The answer itself says so.
    assert_eq!(answer.diagnosis.verdict, Verdict::Unexplained, "{:?}", answer.diagnosis.causes);
    assert!(answer.diagnosis.certain().is_empty(), "{:?}", answer.diagnosis.causes);
}

#[test]
fn false_alarms_are_counted_in_replays_and_the_card_says_how_many() {
    let mut harness = window(diagnosed(RIPPLED.clone()));
    harness.get_by_role_and_label(Role::Button, "Diagnose 20 replays").click();
    harness.run_steps(2);
    until_done(&mut harness, REPLAY);
    let twins = harness.state().session.diagnosing.twins.clone().expect("an answer").expect("replays of a crank");
    assert_eq!(twins.runs, 20);
    assert!(twins.named <= 3 && twins.interval[1] < 0.4, "{twins:?}");
    assert!(harness.query_by_label_contains("of 20 replays").is_some());
    assert!(harness.query_by_role_and_label(Role::Button, "Diagnose 20 replays").is_none());
}

#[test]
fn an_open_recording_is_left_out_and_the_others_answer_for_it() {
    let mut second = RIPPLED.clone();
    second.name = "again".to_owned();
    let mut session = diagnosed(RIPPLED.clone());
    let answer = session.diagnosing.answer.clone().expect("an answer");
    session.document.recordings.push(Arc::new(Prepared::new(second)));
    let mut harness = window(session);
    harness.get_by_role_and_label(Role::Button, "Leave an open one out …").click();
    harness.run_steps(3);
    harness.get_by_role_and_label(Role::Button, "again").click();
    harness.run_steps(2);
    until_done(&mut harness, CHECK);
    let session = &harness.state().session;
    let checked = session.diagnosing.checked.first().expect("checked");
    assert_eq!((checked.name.as_str(), checked.found.as_ref().map(holds)), ("again", Ok(Holds::Yes)));
    // The first one alone was asked: its answer is the one that is there.
    let again =
        check_now(&session.document.recordings, &session.calibration.choice, &answer, &On::LeftOut(1), &|_| true)
            .expect("not ended");
    assert_eq!(again[0].found, checked.found);
    assert!(
        check_now(&session.document.recordings, &session.calibration.choice, &answer, &On::LeftOut(1), &|_| false)
            .is_none()
    );
}

#[test]
fn the_atlas_has_every_suspect_by_its_evidence_and_shows_one_large() {
    let mut session = diagnosed(RIPPLED.clone());
    session.diagnosing.shows_atlas = true;
    let answer = session.diagnosing.answer.clone().expect("an answer");
    let suspects = &answer.diagnosis.atlas.suspects;
    assert!(suspects.len() >= 10, "{}", suspects.len());
    assert!(suspects.windows(2).all(|w| w[0].score >= w[1].score), "the strongest first");
    assert_eq!((suspects[0].id.as_str(), suspects[0].variable), ("position-ripple", Variable::Place));
    // The cause explains most of the residual's power, more than any other suspect.
    let rows = &answer.diagnosis.course.instants;
    let power = |left: &dyn Fn(usize) -> f64| (0..rows.len()).map(|i| (rows[i].weight * left(i)).powi(2)).sum::<f64>();
    let before = power(&|i| rows[i].left_before);
    let goes = |k: usize| 1.0 - power(&|i| rows[i].left_before - suspects[k].taken[i]) / before;
    let others: Vec<f64> = (1..suspects.len()).map(goes).collect();
    assert!(goes(0) > 0.6 && others.iter().all(|other| *other < goes(0)), "{} {others:?}", goes(0));
    let sheet = &answer.atlas[0];
    assert_eq!(sheet.cells.len(), suspects.len());
    assert!(
        sheet.cells.iter().all(|c| !c.unit.is_empty() && !c.left.iter().all(Vec::is_empty)),
        "every cell has a curve"
    );
    assert!(sheet.cells[0].named && sheet.cells[0].left.len() == 2, "both ways over the place");
    let mut harness = window(session);
    for cell in &sheet.cells[..6] {
        let words = format!("{} against {}", cell.title, cell.variable);
        assert!(harness.query_by_role_and_label(Role::Button, &words).is_some(), "{words}");
    }
    let second = format!("{} against {}", sheet.cells[1].title, sheet.cells[1].variable);
    harness.get_by_role_and_label(Role::Button, &second).click();
    harness.run_steps(3);
    assert_eq!(harness.state().session.diagnosing.atlas_open.as_deref(), Some(sheet.cells[1].id.as_str()));
    assert!(harness.query_by_label_contains("Alone it scores").is_some());
    harness.get_by_role_and_label(Role::Button, "All suspects").click();
    harness.run_steps(3);
    assert!(harness.query_by_role_and_label(Role::Button, &second).is_some());
    harness.get_by_role_and_label(Role::Link, "Curves").click();
    harness.run_steps(3);
    assert!(harness.query_by_label("Force along the motion").is_some());
}

/// The session of a picture: `suspect` large, and the figures of two checks.
fn pictured(suspect: Option<&str>) -> Session {
    let mut session = diagnosed(RIPPLED.clone());
    let answer = session.diagnosing.answer.clone().expect("an answer");
    session.diagnosing.shows_atlas = true;
    session.diagnosing.atlas_open = suspect.map(str::to_owned);
    let mut plain = hiding_so_much(Effect::Ripple, Bench::OneFinger, 3, 1e-6);
    "without-it".clone_into(&mut plain.name);
    for recording in [RIPPLED.clone(), plain] {
        let found = validate(std::slice::from_ref(&recording), &Options::default(), &answer.diagnosis)
            .expect("figures")
            .remove(0);
        let unit = "N".to_owned();
        session.diagnosing.checked.push(Checked { name: recording.name, found: Ok(found), unit });
    }
    session
}

#[test]
fn a_large_suspect_and_the_checks_are_drawn_in_both_themes() {
    if no_driver() {
        return;
    }
    for dark in [false, true] {
        let p = theme::Palette::of(dark);
        let named =
            screenshot::draw(pictured(Some("position-ripple")), picture("atlas"), [1280, 720], dark).expect("drawn");
        let other = screenshot::draw(pictured(Some("force-bias")), picture("atlas"), [1280, 720], dark).expect("drawn");
        keep(&format!("atlas-large-{dark}"), &named);
        // The named cause is green, another suspect has the colour of suspects; the cloud and its means have that of
        // the model.
        let simulated = theme::role(dark, render::ColorRole::Simulated);
        assert!(count_near(&named, p.good) > count_near(&other, p.good) + 300, "dark {dark}");
        assert!(count_near(&other, p.accent) > count_near(&named, p.accent) + 200, "dark {dark}");
        assert!(count_near(&named, simulated) > 300, "dark {dark}");
        let card = screenshot::draw(pictured(None), picture("experiment"), [440, 1300], dark).expect("drawn");
        keep(&format!("checks-{dark}"), &card);
        let green = count_near(&card, p.good);
        assert!(green > 2_000, "the bar of what is left and that of the check that holds, dark {dark}: {green}");
    }
}
