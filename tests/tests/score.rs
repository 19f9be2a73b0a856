//! `touchstone score` from outside: an attempt is measured from its recording alone, and says what its numbers mean.

use estimator::training::definitions::ALL;
use haptics::device::{Mistake, ScriptedOperator, Skill};
use haptics::servo::recorder::{SensorModel, to_recording};
use haptics::servo::safety::Limits;
use haptics::servo::{Loop, Swap};
use haptics::world::{State, presets};
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use tests::{touchstone, workspace};

fn run(log: &Path, more: &[&str]) -> Output {
    Command::new(touchstone())
        .arg("score")
        .arg(log)
        .args(more)
        .current_dir(workspace())
        .output()
        .expect("the program starts")
}

fn json(log: &Path, more: &[&str]) -> Value {
    let output = run(log, &[more, &["--json"]].concat());
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).expect("one JSON object and nothing else")
}

/// An attempt at stacking, as the trainer writes it: with its world in it.
fn attempt(folder: &Path, mistakes: &[Mistake], with_world: bool) -> PathBuf {
    let world = presets::stacking();
    let state = State::resting(&world);
    let operator = ScriptedOperator::with_mistakes(&world, &state, Skill::default(), mistakes, 4);
    let ticks = (1e3 * (operator.duration_s() + 1.0)) as usize;
    let mut body = Loop::new(Swap::new(world.clone()), Box::new(operator), Limits::default());
    let ticks: Vec<_> = (0..ticks).map(|_| body.tick(1e-3)).collect();
    let recording = to_recording("attempt", &world, &ticks, 1, &SensorModel::TYPICAL, 4);
    let attachment = estimator::log::Attachment {
        name: "world.json".to_owned(),
        media_type: "application/json".to_owned(),
        data: world.to_json().into_bytes(),
    };
    let file = folder.join("attempt.mcap");
    let attachments = if with_world { vec![attachment] } else { Vec::new() };
    estimator::log::write(&[recording], &file, &attachments).expect("written");
    file
}

#[test]
fn the_world_in_the_recording_is_enough_and_the_numbers_are_the_same_each_time() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = attempt(folder.path(), &[], true);
    let first = json(&file, &["--definitions"]);
    assert_eq!(first, json(&file, &["--definitions"]), "to the bit");
    let measures = &first["measures"][0];
    assert_eq!(measures["course"]["blocks"]["drops"].as_array().map(Vec::len), Some(0), "{measures}");
    assert_eq!(measures["course"]["blocks"]["stacks"].as_array().map(Vec::len), Some(1), "{measures}");
    assert!(measures["hand"]["sparc"].as_f64().is_some_and(|s| s < -1.0), "{measures}");
    assert_eq!(first["definitions"].as_array().map(Vec::len), Some(ALL.len()));
    let dropped = json(&attempt(folder.path(), &[Mistake::EarlyRelease], true), &[]);
    assert!(dropped["measures"][0]["course"]["blocks"]["drops"].as_array().is_some_and(|d| !d.is_empty()), "{dropped}");
}

#[test]
fn without_its_world_only_the_hand_is_measured_and_that_is_said() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = attempt(folder.path(), &[], false);
    let output = run(&file, &[]);
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(text.contains("smoothness") && text.contains("--world"), "{text}");
    assert!(json(&file, &[])["measures"][0].get("course").is_none());
    let named = run(&file, &["--world", "stack"]);
    let text = String::from_utf8_lossy(&named.stdout).into_owned();
    assert!(text.contains("block 2 on block 1") || text.contains("block 1 on block 2"), "{text}");
}

#[test]
fn wrong_usage_and_wrong_files_are_told_in_one_sentence() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = attempt(folder.path(), &[], true);
    let refused = run(&file, &["--limit-n", "-1"]);
    assert_eq!(refused.status.code(), Some(2));
    let nothing = run(&folder.path().join("none.mcap"), &[]);
    assert_eq!(nothing.status.code(), Some(1));
    assert_eq!(String::from_utf8_lossy(&nothing.stderr).lines().count(), 1);
}

#[test]
fn the_page_on_training_tells_every_definition() {
    let page = std::fs::read_to_string(workspace().join("docs/training.md")).expect("docs/training.md is there");
    for definition in ALL {
        let row = format!("| `{}` | {} | {} |", definition.key, definition.name, definition.text);
        assert!(page.contains(&row), "docs/training.md lacks: {row}");
    }
}
