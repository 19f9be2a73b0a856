//! `touchstone lessons` and the grade of an attempt, from outside.

use estimator::log::Attachment;
use estimator::training::lesson::perform::perform;
use estimator::training::lesson::{Attempted, Lesson, grade, library};
use haptics::device::Skill;
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use tests::{touchstone, workspace};

fn run(arguments: &[&str], data: &Path) -> Output {
    // The user's own lessons do not belong here.
    Command::new(touchstone()).args(arguments).env("XDG_DATA_HOME", data).output().expect("the program starts")
}

fn json(arguments: &[&str], data: &Path) -> Value {
    let output = run(&[arguments, &["--json"]].concat(), data);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).expect("one JSON object and nothing else")
}

fn lesson(id: &str) -> Lesson {
    library::built_in().expect("they are read").into_iter().find(|l| l.id == id).expect("there is such a lesson")
}

/// An attempt by a level of skill, as the trainer writes it.
fn attempt(lesson: &Lesson, level: &str, folder: &Path) -> PathBuf {
    let performance = perform(lesson, 0, Skill::from_name(level).expect("a level"), 11).expect("performed");
    let mut recording = performance.recording("attempt");
    let definition = Some(Box::new(lesson.clone()));
    Attempted { definition, ..Attempted::at(lesson, 0) }.give_to(&mut recording);
    let world = Attachment {
        name: "world.json".to_owned(),
        media_type: "application/json".to_owned(),
        data: performance.world.to_json().into_bytes(),
    };
    let file = folder.join(format!("{level}.mcap"));
    estimator::log::write(&[recording], &file, &[world]).expect("written");
    file
}

#[test]
fn an_attempts_grade_from_its_file_is_that_of_the_library_to_the_bit() {
    let folder = tempfile::tempdir().expect("a folder");
    let lesson = lesson("stack-two");
    let mut scores = Vec::new();
    for level in ["novice", "expert"] {
        let file = attempt(&lesson, level, folder.path());
        let told = json(&["score", &file.display().to_string()], folder.path());
        let recording = estimator::log::load(&file, None).expect("read").remove(0);
        let attempted = Attempted::of(&recording).expect("readable").expect("an attempt");
        let world = lesson.world(0).expect("a world");
        let own = grade(&lesson, &attempted, &world, &recording).expect("graded");
        let own: Value = serde_json::from_str(&serde_json::to_string(&own).expect("JSON")).expect("JSON");
        assert_eq!(told["measures"][0]["grade"], own, "{level}");
        let (_, schema) = app::schema::all().into_iter().find(|(name, _)| *name == "score").expect("a schema");
        assert_eq!(tests::schema::faults(&schema, &told), Vec::<String>::new());
        scores.push(own["score"].as_f64().expect("completed"));
        let text =
            String::from_utf8_lossy(&run(&["score", &file.display().to_string()], folder.path()).stdout).into_owned();
        assert!(text.contains("lesson stack-two") && text.contains("experts"), "{text}");
    }
    assert!(scores[1] > scores[0] + 20.0, "{scores:?}");
}

#[test]
fn lessons_are_listed_and_a_users_own_one_gets_its_experts() {
    let folder = tempfile::tempdir().expect("a folder");
    let listed = json(&["lessons"], folder.path());
    assert_eq!(listed["lessons"].as_array().map(Vec::len), Some(11), "{listed}");
    let mine = folder.path().join("mine.json");
    let written = std::fs::read_to_string(workspace().join("assets/lessons/switch.json")).expect("read");
    let mut value: Value = serde_json::from_str(&written).expect("JSON");
    value["id"] = "mine".into();
    value.as_object_mut().expect("an object").remove("expert");
    std::fs::write(&mine, value.to_string()).expect("written");
    let name = mine.display().to_string();
    assert!(json(&["lessons", &name], folder.path()).get("expert").is_none());
    let measured = json(&["lessons", &name, "--measure-expert"], folder.path());
    assert_eq!(
        measured["expert"],
        lesson("switch").expert.map(|e| serde_json::to_value(e).expect("JSON")).expect("measured")
    );
    assert!(Lesson::load(&mine).expect("still a lesson").expert.is_some());
    // In the user's folder it is on offer.
    let own = folder.path().join("touchstone/lessons");
    std::fs::create_dir_all(&own).expect("a folder");
    std::fs::copy(&mine, own.join("mine.json")).expect("copied");
    std::fs::write(own.join("broken.json"), "{").expect("written");
    let listed = json(&["lessons"], folder.path());
    assert_eq!(listed["lessons"].as_array().map(Vec::len), Some(12), "{listed}");
    assert!(listed["problems"][0].as_str().is_some_and(|p| p.contains("broken.json")), "{listed}");
}

#[test]
fn wrong_lessons_are_told_in_one_sentence() {
    let folder = tempfile::tempdir().expect("a folder");
    let broken = folder.path().join("broken.json");
    std::fs::write(&broken, "{\"schema\": 1}").expect("written");
    let broken = broken.display().to_string();
    for (arguments, says) in [
        (vec!["lessons", "juggling"], "first-touch"),
        (vec!["lessons", broken.as_str()], "this is no lesson"),
        (vec!["lessons", "needle", "--measure-expert"], "copy the lesson"),
    ] {
        let output = run(&arguments, folder.path());
        let text = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(1), "{text}");
        assert!(text.contains(says) && text.trim_end().lines().count() == 1, "{text}");
    }
}
