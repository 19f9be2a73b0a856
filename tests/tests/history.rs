//! `touchstone history` from outside: what it says is kept survives a kill.

use serde_json::{Value, json};
use std::io::{BufRead as _, BufReader, Write as _};
use std::path::Path;
use std::process::{Command, Stdio};
use tests::touchstone;

fn history(database: &Path) -> Command {
    let mut command = Command::new(touchstone());
    command.arg("history").arg("--database").arg(database);
    command
}

/// One line for `--import`.
fn line(number: usize) -> String {
    let attempt = json!({
        "trainee": if number.is_multiple_of(3) { "Ada" } else { "Grace" },
        "lesson": "pinch",
        "conditions": { "delay_ms": 0.0, "predicted": false },
        "began": format!("2026-11-22T{:02}:{:02}:{:02}Z", number / 3_600, number / 60 % 60, number % 60),
        "duration_s": 20.0 + number as f64,
        "completed": true,
        "score": 90.0 - 40.0 / (1.0 + number as f64),
        "meets_criterion": number > 20,
        "proficient": number > 21,
        "measures": { "hand": { "path_m": 0.1 * number as f64 } },
        "measures_version": 1,
        "grade_version": 1,
    });
    attempt.to_string() + "\n"
}

fn read(database: &Path, more: &[&str]) -> Value {
    let output = history(database).args(more).arg("--json").output().expect("the program starts");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).expect("one JSON object and nothing else")
}

#[test]
fn every_attempt_that_was_said_to_be_kept_is_there_after_a_kill() {
    let folder = tempfile::tempdir().expect("a folder");
    let database = folder.path().join("history.sqlite");
    let mut said = 0;
    // Killed three times, each time in the middle of its work.
    for until in [5, 17, 40] {
        let mut child = history(&database)
            .args(["--import", "-"])
            .stdin(Stdio::piped())
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .expect("the program starts");
        let mut input = child.stdin.take().expect("a pipe");
        let feeder = std::thread::spawn(move || {
            // A killed reader closes the pipe.
            for number in 0.. {
                if input.write_all(line(number).as_bytes()).is_err() {
                    return;
                }
            }
        });
        let output = BufReader::new(child.stderr.take().expect("a pipe"));
        for line in output.lines() {
            let line = line.expect("words");
            let kept = line.strip_prefix("kept ").and_then(|n| n.parse::<usize>().ok());
            said = said.max(kept.unwrap_or_else(|| panic!("{line}")));
            if said >= until {
                break;
            }
        }
        child.kill().expect("killed");
        child.wait().expect("gone");
        feeder.join().expect("ended");
        let all = read(&database, &[]);
        let kept = all["attempts"].as_array().expect("rows").len();
        assert!(kept >= said, "{kept} of {said}");
        for (number, row) in all["attempts"].as_array().expect("rows").iter().enumerate() {
            let meant: Value = serde_json::from_str(&line(number)).expect("JSON");
            for key in ["trainee", "began", "duration_s", "score", "measures"] {
                assert_eq!(row[key], meant[key], "{number} {key}");
            }
        }
    }
}

#[test]
fn learning_and_proficiency_are_told_and_a_table_is_written() {
    let folder = tempfile::tempdir().expect("a folder");
    let (database, lines, table) =
        (folder.path().join("history.sqlite"), folder.path().join("lines"), folder.path().join("table.csv"));
    std::fs::write(&lines, (0..30).map(line).collect::<String>()).expect("written");
    let lines = lines.display().to_string();
    assert_eq!(read(&database, &["--import", &lines])["new"], 30);
    assert_eq!(read(&database, &["--import", &lines])["known"], 30);
    let table = table.display().to_string();
    let ada = read(&database, &["--trainee", "Ada", "--csv", &table]);
    assert_eq!(ada["attempts"].as_array().map(Vec::len), Some(10));
    let progress = &ada["progress"][0];
    // Hers are 0, 3, … 21, 24, …: the second above 20 is her ninth.
    assert_eq!(progress["proficient_after"], 9, "{progress}");
    assert_eq!(progress["sessions"].as_array().map(Vec::len), Some(1));
    assert!(progress["curve"]["is_seen"] == true && progress["curve"]["gain"].as_f64().is_some_and(|g| g < 0.0));
    assert_eq!(std::fs::read_to_string(&table).expect("written").lines().count(), 11);
    assert_eq!(read(&database, &["--lesson", "juggle"])["attempts"].as_array().map(Vec::len), Some(0));
    let wrong = folder.path().join("wrong");
    std::fs::write(&wrong, "{\"trainee\": \"Ada\"}\n").expect("written");
    let output = history(&database).arg("--import").arg(&wrong).output().expect("the program starts");
    let words = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.code() == Some(1) && words.contains("line 1"), "{words}");
}
