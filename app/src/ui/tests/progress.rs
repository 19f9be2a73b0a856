//! *Progress*: trainees are added, their attempts kept and shown, a table saved; and the curve says what the numbers say.

use super::thresholds::LAYER;
use super::{harness, no_driver, until};
use crate::history::attempt::{Attempt, Conditions};
use crate::ui::document::files;
use crate::ui::headless::gallery::practice::practice;
use crate::ui::headless::screenshot;
use crate::ui::kit::theme;
use crate::ui::session::Session;
use crate::ui::shell::app::App;
use crate::ui::shell::dialogs;
use crate::ui::shell::panel_id::PanelId;
use crate::ui::shell::workspace::Workspace;
use crate::ui::tests::picture;
use crate::ui::train::learning::Practised;
use crate::ui::train::trainees;
use crate::ui::train::trainer::live::Clock;
use egui::Role;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use std::path::Path;

/// The window with the panel in front, over a history of its own.
fn window<'a>(database: &Path) -> Harness<'a, App> {
    let mut session = Session::new();
    session.training.trainer.clock = Clock::Manual;
    session.workspace = Workspace::Train;
    let mut app = App::new(session);
    app.dock.bring(Workspace::Train, PanelId::PROGRESS);
    let mut harness = harness(app, [1280.0, 1000.0], |ui, app: &mut App| app.show(ui));
    let ctx = harness.ctx.clone();
    let session = &mut harness.state_mut().session;
    trainees::open_history(&mut session.training.learning, &mut session.messages, &ctx, database.to_path_buf());
    harness.run_steps(2);
    harness
}

fn type_into(harness: &mut Harness<'_, App>, field: &str, text: &str) {
    harness.get_by_role_and_label(Role::TextInput, field).focus();
    harness.run_steps(2);
    harness.get_by_role_and_label(Role::TextInput, field).type_text(text);
    harness.run_steps(2);
}

#[test]
fn trainees_are_added_and_their_attempts_kept_shown_and_saved() {
    let folder = tempfile::tempdir().expect("a folder");
    let database = folder.path().join("history.sqlite");
    let mut harness = window(&database);
    assert!(harness.query_by_label("No attempts yet").is_some());
    type_into(&mut harness, "Name of a new trainee", "Grace");
    harness.get_by_role_and_label(Role::Button, "Add").click();
    harness.run_steps(2);
    until(&mut harness, "the trainee", |app| app.session.training.learning.trainees == ["Grace"]);
    assert_eq!(harness.state().session.training.learning.trainee.as_deref(), Some("Grace"));
    assert!(harness.query_by_label_contains("Grace has not attempted").is_some());
    for attempt in practice() {
        assert!(trainees::keep_attempt(
            &harness.state_mut().session.training.learning,
            Attempt { trainee: "Grace".to_owned(), ..attempt }
        ));
    }
    until(&mut harness, "the attempts", |app| app.session.training.learning.attempts.len() == 23);
    assert!(harness.query_by_label("23 attempts.").is_some());
    assert!(harness.query_by_label_contains("Power law of practice").is_some());
    let learned = harness.state().session.training.learning.learned.clone();
    assert_eq!((learned.attempts.len(), learned.tries.len(), learned.sessions.len()), (23, 22, 4), "one has no score");
    let proficient = learned.proficient_at.expect("in the end");
    assert!(harness.query_by_label_contains(&format!("Proficient after attempt {proficient}:")).is_some());
    // Another lesson, under other conditions, is looked at by itself.
    let delayed = Conditions { delay_ms: 150.0, predicted: true };
    let other = Attempt {
        lesson: "stack".to_owned(),
        conditions: delayed,
        trainee: "Grace".to_owned(),
        ..practice().remove(3)
    };
    trainees::keep_attempt(&harness.state_mut().session.training.learning, other);
    until(&mut harness, "the other lesson", |app| app.session.training.learning.attempts.len() == 24);
    let shown = Practised { lesson: "stack".to_owned(), conditions: delayed };
    assert_eq!(harness.state().session.training.learning.practised()[1], shown);
    harness.state_mut().session.training.learning.look_at(Some(shown));
    harness.run_steps(2);
    assert!(
        harness.query_by_label("One attempt.").is_some() && harness.query_by_label_contains("Six scores").is_some()
    );
    // A table of everything, where the dialog says.
    let table = folder.path().join("grace.csv");
    let ctx = harness.ctx.clone();
    let answer = files::answered(dialogs::SAVE_HISTORY, table.clone());
    harness.state_mut().session.jobs.start(&ctx, files::SAVE, "", move |_| answer);
    until(&mut harness, "the table", |app| app.session.messages.banners.iter().any(|b| b.text == "Saved grace.csv."));
    assert_eq!(std::fs::read_to_string(&table).expect("written").lines().count(), 25);
    drop(harness);
    // The next start knows her, and shows what she has done.
    let mut harness = window(&database);
    until(&mut harness, "what was kept", |app| app.session.training.learning.attempts.len() == 24);
    assert_eq!(harness.state().session.training.learning.trainee.as_deref(), Some("Grace"));
}

#[test]
fn an_attempt_of_another_trainee_does_not_get_among_those_that_are_shown() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut harness = window(&folder.path().join("history.sqlite"));
    let session = &mut harness.state_mut().session;
    session.training.learning.name_field = "Ada".to_owned();
    session.training.learning.add_trainee();
    let mut mine = practice();
    mine.truncate(2);
    trainees::keep_attempt(&session.training.learning, Attempt { trainee: "Grace".to_owned(), ..mine[0].clone() });
    trainees::keep_attempt(&session.training.learning, mine[1].clone());
    until(&mut harness, "both", |app| {
        app.session.training.learning.trainees.contains(&"Grace".to_owned())
            && !app.session.training.learning.attempts.is_empty()
    });
    assert_eq!(harness.state().session.training.learning.attempts, mine[1..]);
    harness.state_mut().session.training.learning.choose("Grace");
    until(&mut harness, "hers", |app| {
        app.session.training.learning.attempts.first().is_some_and(|a| a.trainee == "Grace")
    });
    assert_eq!(harness.state().session.training.learning.attempts.len(), 1);
}

#[test]
fn the_curve_has_its_band_its_sessions_and_the_experts_level_in_both_themes() {
    if no_driver() {
        return;
    }
    for dark in [false, true] {
        let p = theme::Palette::of(dark);
        let picture = |expert: bool| {
            let mut session = Session::new();
            session.training.learning.take(practice());
            if expert {
                session.training.learning.experts.insert("pinch".to_owned(), 92.0);
            }
            screenshot::draw(session, picture("progress"), [720, 760], dark).expect("drawn")
        };
        let (with, without) = (picture(true), picture(false));
        let count = |image, color| super::count_near(image, color);
        assert!(count(&with, p.accent) > LAYER, "the law, dark {dark}");
        assert!(count(&with, p.good) > count(&without, p.good) + LAYER, "the expert, dark {dark}");
    }
}
