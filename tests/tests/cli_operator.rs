//! `touchstone record` from outside: who does it, how well, what goes wrong, and in which world.

use serde_json::Value;
use std::path::Path;
use std::process::{Command, Output};
use tests::{touchstone, workspace};

fn run(arguments: &[&str]) -> Output {
    Command::new(touchstone()).args(arguments).output().expect("the program starts")
}

/// Exit 1 and one sentence on standard error that has all the words.
fn refused(arguments: &[&str], wanted: &[&str]) {
    let output = run(arguments);
    let error = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{arguments:?}: {error}");
    assert_eq!(error.trim().lines().count(), 1, "one sentence: {error}");
    for word in wanted {
        assert!(error.contains(word), "{arguments:?} should speak of `{word}`: {error}");
    }
}

/// Records some seconds and gives the bytes of table and sidecar.
fn recorded(folder: &Path, name: &str, more: &[&str]) -> (Vec<u8>, Vec<u8>) {
    let out = folder.join(format!("{name}.csv"));
    let out = out.to_string_lossy();
    let mut all = vec!["record", "--task", "crank", "--seconds", "4", "--every", "10", "--out", &out];
    all.extend(more);
    let output = run(&all);
    assert!(output.status.success(), "{more:?}: {}", String::from_utf8_lossy(&output.stderr));
    let meta = folder.join(format!("{name}.meta.json"));
    (std::fs::read(&*out).expect("a table"), std::fs::read(meta).expect("a sidecar"))
}

#[test]
fn skill_and_mistakes_change_the_recording_and_naming_the_usual_changes_no_bit() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let record = |name: &str, more: &[&str]| recorded(folder.path(), name, more);
    let usual = record("a", &[]);
    assert_eq!(record("a", &["--skill", "steady"]), usual, "steady is the usual");
    let world = workspace().join("assets/worlds/crank.json");
    assert_eq!(record("a", &["--world", &world.to_string_lossy()]), usual, "the file is the built-in world");
    assert_eq!(record("a", &["--world", "crank"]), usual);
    let novice = record("n", &["--skill", "novice"]);
    let crushing = record("c", &["--mistake", "crush"]);
    assert!(novice.0 != usual.0 && crushing.0 != usual.0 && novice.0 != crushing.0);
    let about = |sidecar: &[u8]| {
        let meta: Value = serde_json::from_slice(sidecar).expect("JSON");
        meta.get("operator").cloned()
    };
    assert_eq!(about(&usual.1), None);
    assert_eq!(about(&novice.1).map(|o| o["skill"].clone()), Some("novice".into()));
    assert_eq!(about(&crushing.1).map(|o| o["mistakes"][0].clone()), Some("crush".into()));
}

#[test]
fn what_cannot_be_recorded_is_refused_in_one_sentence() {
    let record = |more: &[&'static str]| {
        let mut all = vec!["record", "--task", "crank", "--out", "/nowhere/x.csv"];
        all.extend(more);
        all
    };
    let levels = ["genius", "steady", "novice", "intermediate", "advanced", "expert"];
    refused(&record(&["--skill", "genius"]), &levels);
    let mistakes =
        ["sneeze", "weak-pinch", "crush", "misaligned-stack", "early-release", "wrong-direction", "overshoot"];
    refused(&record(&["--mistake", "sneeze"]), &mistakes);
    refused(&record(&["--mistake", "misaligned-stack"]), &["no occasion", "misaligned-stack", "wrong-direction"]);
    let log = workspace().join("assets/recordings/crank.csv");
    let replay = format!("replay:{}", log.to_string_lossy());
    refused(
        &["record", "--task", "crank", "--out", "/nowhere/x.csv", "--operator", &replay, "--skill", "novice"],
        &["--skill", "scripted"],
    );
    refused(&record(&["--world", "stack"]), &["stack", "no crank", "task"]);
    refused(&record(&["--world", "moon"]), &["moon", "needle"]);
    let world = workspace().join("assets/worlds/needle.json").to_string_lossy().into_owned();
    for (task, what) in
        [("block-stack", "blocks"), ("barrel", "barrel"), ("switch", "switch"), ("mechanism", "mechanism")]
    {
        refused(&["record", "--task", task, "--world", &world, "--out", "/nowhere/x.csv"], &["needle.json", what]);
    }
}
