//! Logs whose clock runs a billion times too fast or too slow: time and memory go with their samples, never with their seconds.

#![cfg(unix)]

use std::fmt::Write as _;
use std::path::Path;
use std::process::Command;
use tests::touchstone;

/// Rows of a log.
const ROWS: usize = 700;
/// Address space, kB. Memory by the seconds would be 192 GB.
const MOST_KB: usize = 16_000_000;
/// Time of a command on a busy machine, s. Steps by the seconds would take years.
const MOST_S: &str = "120";

/// A clock: seconds of a row.
type Clock = fn(usize) -> f64;

/// Clocks that nobody's hand moved by.
const CLOCKS: [(&str, Clock); 5] = [
    ("leaps", |row| 0.01 * row as f64 + if row < ROWS / 2 { 0.0 } else { 1e9 }),
    ("ends-late", |row| 0.01 * row as f64 + if row < ROWS - 1 { 0.0 } else { 1e9 }),
    ("sparse", |row| 1e6 * row as f64),
    ("milliseconds", |row| 10.0 * row as f64),
    ("nanoseconds", |row| 1e-9 * row as f64),
];

/// A drawer of 1.5 kg with dry and viscous friction, and a temperature beside it.
fn drawer(clock: Clock) -> String {
    let mut text = "t_s,q_m,f_N,temperature_degC\n".to_owned();
    for row in 0..ROWS {
        let t = 0.01 * row as f64;
        let [a, b] = [3.8 * t, 8.2 * t + 0.4];
        let place = 0.08 * a.sin() + 0.03 * b.sin();
        let speed = 0.08 * 3.8 * a.cos() + 0.03 * 8.2 * b.cos();
        let acceleration = -0.08 * 3.8 * 3.8 * a.sin() - 0.03 * 8.2 * 8.2 * b.sin();
        let force = 1.5 * acceleration + 4.0 * speed + 2.0 * (speed / 3e-3).tanh();
        let warmth = 20.0 + 2.0 * (0.3 * t).sin();
        let _ = writeln!(text, "{:.12},{place:.7},{force:.4},{warmth:.3}", clock(row));
    }
    text
}

/// Two fingers that move beside each other.
fn fingers(clock: Clock) -> String {
    let mut text = "t_s,x1_m,y1_m,x2_m,y2_m\n".to_owned();
    for row in 0..ROWS {
        let place = 0.02 * (0.038 * row as f64).sin();
        let _ = writeln!(text, "{:.12},{:.6},0.2,{:.6},0.2", clock(row), place - 0.05, place + 0.05);
    }
    text
}

/// The program ends by itself, and with one sentence if it ends in vain.
fn check(folder: &Path, arguments: &[&str]) {
    let limited = format!("ulimit -v {MOST_KB}; exec timeout {MOST_S} \"$@\"");
    let mut command = Command::new("sh");
    command.args(["-c", &limited, "sh"]).arg(touchstone()).args(arguments).current_dir(folder);
    let output = command.output().expect("a shell");
    let said = String::from_utf8_lossy(&output.stderr);
    let is_sentence = output.status.code() == Some(1) && !said.contains("panicked");
    assert!(output.status.success() || is_sentence, "{arguments:?}: {:?} {said}", output.status);
}

#[test]
fn time_and_memory_go_with_the_samples_and_not_with_the_seconds() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for (name, clock) in CLOCKS {
        let (log, both) = (format!("{name}.csv"), format!("{name}-fingers.csv"));
        std::fs::write(folder.path().join(&log), drawer(clock)).expect("a log");
        std::fs::write(folder.path().join(&both), fingers(clock)).expect("a log");
        for command in ["info", "segment", "fit", "diagnose"] {
            check(folder.path(), &[command, &log, "--task", "mechanism"][..if command == "info" { 2 } else { 4 }]);
        }
        check(folder.path(), &["report", &log, "--out", "report.html"]);
        check(folder.path(), &["simulate", "stack", &both, "--out", "forces.csv"]);
    }
}
