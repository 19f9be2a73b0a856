//! Formats end to end: `convert`, a recorder that is killed, and what other programs read.

use estimator::log::{self, McapStream};
use haptics::recording::{Channel, Meta, Recording};
use serde_json::Value;
use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};
use tests::drawer::{Sample, drawer, is_the_drawer};

const ROWS: usize = 300;
const MAPPED: &str = r#"{"task": "mechanism", "columns": {"t_s": "Time", "q_m": "Pos", "f_N": "Force"}}"#;

fn recording() -> Recording {
    let channel = |name: &str, unit: &str, k: f64| Channel {
        name: name.to_owned(),
        unit: unit.to_owned(),
        values: (0..ROWS).map(|i| (i as f64 * k).sin() / 3.0).collect(),
    };
    Recording {
        name: "a".to_owned(),
        time_s: Some((0..ROWS).map(|i| i as f64 * 0.001).collect()),
        channels: vec![channel("q_m", "m", 0.1), channel("f_N", "N", -0.3), channel("load percent", "", 0.2)],
        labels: Some((0..ROWS).map(|i| if i < 100 { "free-motion" } else { "turning" }).collect()),
        meta: serde_json::from_str::<Meta>(r#"{"task": "mechanism", "known": {"mass_kg": 1.5}}"#).expect("a sidecar"),
        ..Recording::default()
    }
}

fn touchstone(arguments: &[&str]) -> Output {
    Command::new(tests::touchstone()).args(arguments).output().expect("the program runs")
}

fn text(path: &Path) -> &str {
    path.to_str().expect("a plain path")
}

#[test]
fn convert_goes_round_through_every_format_to_the_bit() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = |name: &str| folder.path().join(name);
    let original = recording();
    log::write(std::slice::from_ref(&original), &file("a.csv"), &[]).expect("writes");
    for (from, to) in [("a.csv", "b.mcap"), ("b.mcap", "c.parquet"), ("c.parquet", "d.csv"), ("d.csv", "e.parquet")] {
        let output = touchstone(&["convert", text(&file(from)), text(&file(to)), "--json"]);
        assert!(output.status.success(), "{from} to {to}: {}", String::from_utf8_lossy(&output.stderr));
        let said: Value = serde_json::from_slice(&output.stdout).expect("one JSON object");
        assert_eq!(said["samples"], ROWS, "{said}");
        let back = log::load(&file(to), None).expect("reads").remove(0);
        assert_eq!(back.channels, original.channels, "{to}");
        assert_eq!(
            (back.time_s, back.labels, back.meta),
            (original.time_s.clone(), original.labels.clone(), original.meta.clone())
        );
    }
}

#[test]
fn convert_spares_what_it_reads_and_refuses_in_one_sentence() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = |name: &str| folder.path().join(name);
    log::write(&[recording()], &file("a.csv"), &[]).expect("writes");
    log::write(&[recording()], &file("a.mcap"), &[]).expect("writes");
    let whole = std::fs::read(file("a.mcap")).expect("reads");
    std::fs::write(file("cut.mcap"), &whole[..whole.len() / 2]).expect("writes");
    std::fs::write(file("broken.parquet"), b"PAR1 and no more").expect("writes");
    let before = std::fs::read(file("a.csv")).expect("reads");
    for (from, to, words) in [
        ("a.csv", "a.csv", "the output is the input"),
        ("a.csv", "b.txt", "ending names no format"),
        ("cut.mcap", "b.csv", "ends in the middle"),
        ("broken.parquet", "b.csv", "Parquet file is damaged"),
        ("none.mcap", "b.csv", "none.mcap"),
    ] {
        let output = touchstone(&["convert", text(&file(from)), text(&file(to)), "--json"]);
        let error = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(1), "{from}: {error}");
        assert!(error.contains(words) && error.trim().lines().count() == 1, "{from}: {error}");
        assert!(output.stdout.is_empty() && !file("b.csv").exists() && !file("b.txt").exists(), "{from}");
    }
    assert_eq!(std::fs::read(file("a.csv")).expect("reads"), before);
}

const STREAM: &str = "TOUCHSTONE_TEST_STREAM";

/// The child of [`a_killed_recorder_leaves_a_file_up_to_its_last_second`]: records at 1 kHz until it is killed.
fn record_forever(path: &Path) -> ! {
    let columns = ["x1_m", "y1_m", "x2_m", "y2_m"].map(str::to_owned);
    let mut stream = McapStream::create(path, &columns, &Meta::default(), &[]).expect("creates");
    let start = Instant::now();
    let mut row = 0_u32;
    loop {
        while f64::from(row) * 1e-3 <= start.elapsed().as_secs_f64() {
            let t = f64::from(row) * 1e-3;
            stream.push(t, &[t, -t, 0.5, 0.25]).expect("pushes");
            row += 1;
        }
        // Read by the parent: what has been recorded until now.
        println!("{}", f64::from(row - 1) * 1e-3);
        std::thread::sleep(Duration::from_millis(2));
    }
}

#[test]
fn a_killed_recorder_leaves_a_file_up_to_its_last_second() {
    use std::io::{BufRead as _, BufReader};
    if let Some(path) = std::env::var_os(STREAM) {
        record_forever(Path::new(&path));
    }
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("live.mcap");
    let me = std::env::current_exe().expect("a test knows its own path");
    let name = "a_killed_recorder_leaves_a_file_up_to_its_last_second";
    let mut command = Command::new(me);
    command.args(["--exact", name, "--nocapture"]).env(STREAM, &path).stdout(Stdio::piped()).stderr(Stdio::null());
    let mut child = command.spawn().expect("starts");
    let mut last = 0.0;
    for line in BufReader::new(child.stdout.take().expect("piped")).lines() {
        last = line.expect("readable").trim().parse().unwrap_or(last);
        if last >= 2.5 {
            break;
        }
    }
    child.kill().expect("SIGKILL");
    child.wait().expect("ends");
    assert!(last >= 2.5, "the child recorded until {last} s");
    let log = log::load(&path, None).expect("opens").remove(0);
    let time = log.time_s.as_ref().expect("a clock");
    let end = time[time.len() - 1];
    assert!(end >= last - 1.0, "recorded until {last} s, read until {end} s");
    assert_eq!(log.channel("x1_m"), Some(time.as_slice()));
    assert!(log.warnings.iter().any(|w| w.kind == "cut-off"), "{:?}", log.warnings);
}

/// What a script of `tests/python` says of a file; `None` when it has to be skipped, with a visible word.
fn python(script: &str, file: &Path) -> Option<Value> {
    let said = tests::python::output_of(&format!("tests/python/{script}"), &[text(file)])?;
    Some(serde_json::from_str(&said).expect("one JSON object"))
}

/// A number as Python writes it (`float.hex`): −0x1.8p-1.
fn from_hex(text: &str) -> f64 {
    let (sign, digits) = text.strip_prefix('-').map_or((1.0, text), |rest| (-1.0, rest));
    let (mantissa, exponent) = digits.trim_start_matches("0x").split_once('p').expect("a hexadecimal float");
    let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, "0"));
    let fraction_bits = u64::from_str_radix(fraction, 16).expect("digits") as f64
        / 16_f64.powi(i32::try_from(fraction.len()).expect("few digits"));
    let whole: f64 = whole.parse().expect("a digit");
    sign * (whole + fraction_bits) * 2_f64.powi(exponent.parse().expect("an exponent"))
}

fn check_rows(found: &Value, original: &Recording) {
    assert_eq!(found["columns"], serde_json::json!(["t_s", "q_m", "f_N", "load percent", "label"]));
    let rows = found["rows"].as_array().expect("rows");
    assert_eq!(rows.len(), ROWS);
    for (i, row) in rows.iter().enumerate() {
        let number = |column: usize| from_hex(row[column].as_str().expect("a float"));
        assert_eq!(number(0), original.time_s.as_ref().expect("a clock")[i]);
        for (k, channel) in original.channels.iter().enumerate() {
            assert_eq!(number(k + 1), channel.values[i], "row {i} of {}", channel.name);
        }
        assert_eq!(row[4].as_str(), original.labels.as_ref().map(|l| &l[i]));
    }
}

#[test]
fn python_reads_our_mcap() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("a.mcap");
    let original = recording();
    let world = log::Attachment {
        name: "world.json".to_owned(),
        media_type: "application/json".to_owned(),
        data: b"{\"a\": 1}".to_vec(),
    };
    log::write(std::slice::from_ref(&original), &path, &[world]).expect("writes");
    let Some(found) = python("read_mcap.py", &path) else { return };
    check_rows(&found, &original);
    assert_eq!(found["metadata"]["touchstone"]["known.mass_kg"], "1.5");
    assert_eq!(found["metadata"]["touchstone"]["task"], "mechanism");
    assert_eq!(found["attachments"]["world.json"], "{\"a\": 1}");
    assert_eq!((&found["log_times"][1], &found["topics"][0]), (&Value::from(1_000_000), &Value::from("/recording")));
}

#[test]
fn python_reads_our_parquet() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("a.parquet");
    let original = recording();
    log::write(std::slice::from_ref(&original), &path, &[]).expect("writes");
    let Some(found) = python("read_parquet.py", &path) else { return };
    check_rows(&found, &original);
    let units: Value = serde_json::from_str(found["metadata"]["units"].as_str().expect("units")).expect("JSON");
    assert_eq!(units, serde_json::json!({"t_s": "s", "q_m": "m", "f_N": "N"}));
    assert!(found["metadata"]["touchstone.sidecar"].as_str().is_some_and(|s| s.contains("mass_kg")));
}

#[test]
fn rerun_imports_our_mcap() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("a.mcap");
    log::write(&[recording()], &path, &[]).expect("writes");
    let Some(found) = python("read_rerun.py", &path) else { return };
    assert!(found["paths"].as_array().is_some_and(|p| p.iter().any(|p| p == "/recording")), "{found}");
    assert!(found["rows"].as_u64().is_some_and(|n| n >= ROWS as u64), "{found}");
}

/// Rows of the drawer below a head.
fn below(head: &str, row: impl Fn(Sample) -> String) -> String {
    std::iter::once(head.to_owned()).chain(drawer(1500, 100.0).into_iter().map(row)).collect::<Vec<_>>().join("\n")
}

/// Two signals of `TwinCAT` Scope, with the clocks of both in milliseconds.
#[test]
fn exports_of_twincat_scope_are_read() {
    let head = "Name\tdrawer\nFile\tC:\\drawer.csv\nStarttime of export\t132959733843760000\tMontag, 2. Mai 2022\n\n\
        Name\tPos\tName\tForce\nData-Type\tLREAL\tData-Type\tREAL32\nSampleTime[ms]\t10\tSampleTime[ms]\t10\n\
        Unit\tmm (Length)\tUnit\tmN (Force)\n";
    let row = |[t, place, push]: Sample| format!("{:.0}\t{:.4}\t{0:.0}\t{:.2}", 1e3 * t, 1e3 * place, 1e3 * push);
    is_the_drawer(
        "TwinCAT",
        below(head, |sample| row(sample).replace('.', ",")),
        &MAPPED.replace("\"Time\"", "\"time\""),
    );
}

/// A unit in the next cell, and one in a line above the names; a conversion of counts there is told.
#[test]
fn units_beside_and_above_a_table_are_used() {
    let beside = below("Time,Force,Force_unit,Pos,Pos_unit", |[t, place, push]| {
        format!("{t:.2},{:.4},mN,{:.3},mm", 1e3 * push, 1e3 * place)
    });
    is_the_drawer("beside", beside, MAPPED);
    let above = "Force units: mN\nCounts per Unit Torque: 16000\nPos unit,mm\nTime,Pos,Force";
    let above = below(above, |[t, place, push]| format!("{t:.2},{:.3},{:.4}", 1e3 * place, 1e3 * push));
    let read = is_the_drawer("above", above, MAPPED);
    let said = |words: &str| read.warnings.iter().any(|warning| warning.text.contains(words));
    assert!(said("the unit of `Force` is that of the line") && said("conversion of counts"), "{:?}", read.warnings);
}
