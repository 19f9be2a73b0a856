//! The JSON of the command line is what `docs/schemas` says, and the contract beside the checkout is in it.
//!
//! `TOUCHSTONE_WRITE_SCHEMAS=1 cargo test -p tests --test schemas` writes the schemas anew after a type was changed.

use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;
use tests::schema::faults;
use tests::{touchstone, workspace};

fn schemas() -> BTreeMap<&'static str, Value> {
    app::schema::all().into_iter().collect()
}

fn file_of(name: &str) -> PathBuf {
    workspace().join("docs/schemas").join(format!("{name}.json"))
}

#[test]
fn the_schemas_are_those_of_the_types() {
    for (name, schema) in schemas() {
        let text = serde_json::to_string_pretty(&schema).expect("JSON") + "\n";
        if std::env::var_os("TOUCHSTONE_WRITE_SCHEMAS").is_some() {
            std::fs::write(file_of(name), &text).expect("docs can be written");
        }
        let stands = std::fs::read_to_string(file_of(name)).unwrap_or_default();
        assert!(stands == text, "{}: write it anew, see the head of this test", file_of(name).display());
    }
    let files = std::fs::read_dir(workspace().join("docs/schemas")).expect("the folder").count();
    assert_eq!(files, schemas().len(), "every file in docs/schemas has a command");
}

/// The table of the sidecar's keys: key, meaning, value when absent, example.
fn keys_of_the_sidecar(schema: &Value) -> String {
    let mut table = "| key | meaning | when absent | example |\n|---|---|---|---|\n".to_owned();
    let properties = schema["properties"].as_object().expect("keys");
    for (key, about) in properties {
        let line = |text: &Value| text.as_str().expect("a text").replace('\n', " ");
        let example = json!({ key: about["examples"][0] }).to_string();
        let inside = example.trim_start_matches('{').strip_suffix('}').expect("an object");
        let (meaning, absent) = (line(&about["description"]), line(&about["x-absent"]));
        writeln!(table, "| `{key}` | {meaning} | {absent} | `{inside}` |").expect("memory can be written");
    }
    table
}

#[test]
fn the_page_of_the_sidecar_is_that_of_its_type() {
    let path = workspace().join("docs/use/own-logs.md");
    let page = std::fs::read_to_string(&path).expect("the page");
    let (start, end) = ("<!-- keys -->\n", "<!-- end of keys -->");
    let (before, rest) = page.split_once(start).expect("a start");
    let (_, after) = rest.split_once(end).expect("an end");
    let made = format!("{before}{start}{}{end}{after}", keys_of_the_sidecar(&schemas()["sidecar"]));
    if std::env::var_os("TOUCHSTONE_WRITE_SCHEMAS").is_some() {
        std::fs::write(&path, &made).expect("docs can be written");
    }
    assert!(made == page || std::env::var_os("TOUCHSTONE_WRITE_SCHEMAS").is_some(), "write {} anew", path.display());
    // Every example is read.
    let folder = tempfile::tempdir().expect("a folder");
    for (key, about) in schemas()["sidecar"]["properties"].as_object().expect("keys") {
        let sidecar = json!({ key: about["examples"][0] }).to_string();
        let read = estimator::log::parse_sidecar(&sidecar, &folder.path().join("a.meta.json"));
        assert!(read.is_ok_and(|meta| meta.other.is_empty()), "{sidecar}");
        let wrong = faults(&schemas()["sidecar"], &serde_json::from_str(&sidecar).expect("JSON"));
        assert!(wrong.is_empty(), "{sidecar}: {wrong:?}");
    }
}

/// Runs a command with `--json` and holds what it prints against its schema.
fn holds(name: &str, arguments: &[&str]) -> Value {
    let output = Command::new(touchstone()).args(arguments).arg("--json").output().expect("the program starts");
    assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    let said: Value = serde_json::from_slice(&output.stdout).expect("one JSON object");
    let wrong = faults(&schemas()[name], &said);
    assert!(wrong.is_empty(), "{arguments:?}: {wrong:#?}");
    agreed(name, &said);
    said
}

/// A library in Python says the same, where there is one; a document without something that is required, it refuses.
fn agreed(name: &str, said: &Value) {
    let folder = tempfile::tempdir().expect("a folder");
    let (whole, lacking) = (folder.path().join("whole.json"), folder.path().join("lacking.json"));
    std::fs::write(&whole, said.to_string()).expect("written");
    std::fs::write(&lacking, "{}").expect("written");
    let schema = file_of(name);
    for (document, good) in [(&whole, true), (&lacking, false)] {
        let Some(found) = tests::python::output_of("tests/python/check_schemas.py", &[text(&schema), text(document)])
        else {
            return;
        };
        let found: Vec<String> = serde_json::from_str(&found).expect("a list");
        assert_eq!(found.is_empty(), good, "{name}: {found:?}");
    }
}

fn asset(name: &str) -> String {
    workspace().join("assets/recordings").join(name).display().to_string()
}

fn text(path: &Path) -> &str {
    path.to_str().expect("a plain path")
}

/// A log with two trials of a mass on a slide, pushed to and fro.
fn two_trials(folder: &Path) -> PathBuf {
    let mut rows = String::from("t_s,q_m,f_N,trial\n");
    for (trial, mass_kg) in [(1, 2.0), (2, 2.5)] {
        for i in 0..3000 {
            let t = f64::from(i) * 2e-3;
            let (q, a) = (0.05 * (5.0 * t).sin(), -0.05 * 25.0 * (5.0 * t).sin());
            let f = mass_kg * a + 0.4 * (5.0 * t).cos().signum();
            writeln!(rows, "{t:.3},{q:.6},{f:.5},{trial}").expect("memory can be written");
        }
    }
    let path = folder.join("slide.csv");
    std::fs::write(&path, rows).expect("written");
    std::fs::write(folder.join("slide.meta.json"), r#"{"task": "mechanism"}"#).expect("written");
    path
}

/// Paths of a tool, and what is said of their kind and of whether it is rigid: a door with forces across its path, a drawer without any, a
/// stroke too short to tell.
const PATHS: [(&str, &str, Value); 3] = [
    ("door", "revolute", Value::Bool(true)),
    ("drawer", "prismatic", Value::Null),
    ("stroke", "undecided", Value::Null),
];

fn tool_path(folder: &Path, name: &str) -> PathBuf {
    let mut random = 1_u64;
    let mut noise = || {
        random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        1e-4 * ((random >> 40) as f64 / f64::from(1 << 24) - 0.5)
    };
    let mut rows = String::from(if name == "door" { "t_s,x_m,y_m,fx_N,fy_N\n" } else { "t_s,x_m,y_m\n" });
    for i in 0..3000 {
        let t = f64::from(i) * 2e-3;
        let turn = 0.5 * (1.0 - (2.0 * t).cos());
        let (sin, cos) = turn.sin_cos();
        let (x, y) = match name {
            "door" => (0.3 * cos, 0.3 * sin),
            "drawer" => (0.2 * turn, 0.1 * turn),
            _ => (4e-3 * (0.3 * t).sin(), 1e-3 * (0.3 * t).cos()),
        };
        write!(rows, "{t:.3},{:.7},{:.7}", x + noise(), y + noise()).expect("memory can be written");
        if name == "door" {
            let across = 8.0 * (5.0 * t).sin();
            let force = (across * cos - 2.0 * sin, across * sin + 2.0 * cos);
            write!(rows, ",{:.4},{:.4}", force.0, force.1).expect("memory can be written");
        }
        rows.push('\n');
    }
    let path = folder.join(format!("{name}.csv"));
    std::fs::write(&path, rows).expect("written");
    std::fs::write(folder.join(format!("{name}.meta.json")), r#"{"task": "mechanism"}"#).expect("written");
    path
}

#[test]
fn what_the_commands_print_is_what_the_schemas_say() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = |name: &str| folder.path().join(name).display().to_string();
    let (stack, crank) = (asset("stack.csv"), asset("crank.csv"));
    let trials = two_trials(folder.path());
    let foreign = folder.path().join("foreign.csv");
    std::fs::write(&foreign, "time_ms,Extension [mm],Load (stone)\n0,1,2\n1,2,3\n").expect("written");
    holds("info-suggest", &["info", "--suggest", text(&foreign)]);
    for log in [stack.as_str(), crank.as_str(), text(&trials)] {
        holds("info", &["info", log]);
        holds("fit", &["fit", log, "--out", &file("world.json")]);
        holds("diagnose", &["diagnose", log]);
    }
    for (name, kind, rigid) in PATHS {
        let said = holds("fit", &["fit", text(&tool_path(folder.path(), name))]);
        let constraint = &said["constraints"][0];
        assert_eq!((constraint["kind"].as_str(), &constraint["rigid"]), (Some(kind), &rigid), "{constraint}");
        assert!(constraint["std_error"].is_object() && constraint.get("rigid").is_some(), "{constraint}");
    }
    for method in ["threshold", "hmm"] {
        holds("segment", &["segment", &stack, "--method", method]);
    }
    let fit = holds("fit", &["fit", &crank, "--out", &file("crank.json")]);
    assert!(fit["enough"].as_array().is_some_and(|enough| !enough.is_empty()));
    holds("simulate", &["simulate", &file("crank.json"), &crank, "--out", &file("simulated.csv")]);
    holds("convert", &["convert", &stack, &file("stack.mcap")]);
    for to in ["mjcf", "urdf", "sdf"] {
        holds("export", &["export", &file("crank.json"), "--to", to, "--out", &file("exported.xml")]);
    }
    let record = ["record", "--task", "crank", "--operator", "scripted", "--seconds", "1", "--out", &file("made.csv")];
    holds("record", &record);
    holds("screenshot", &["screenshot", "--scene", "crank", "--size", "160x120", "--out", &file("scene.png")]);
}

#[test]
fn so_it_is_with_what_trainees_are_told() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = |name: &str| folder.path().join(name).display().to_string();
    let (stack, crank, needle) = (asset("stack.csv"), asset("crank.csv"), file("needle.csv"));
    let listed = holds("lessons", &["lessons"]);
    let ids: Vec<&str> =
        listed["lessons"].as_array().expect("lessons").iter().filter_map(|l| l["id"].as_str()).collect();
    assert!(ids.len() >= 11, "{listed}");
    for id in ids {
        let lesson = holds("lesson", &["lessons", id]);
        assert!(lesson["goals"].as_array().is_some_and(|goals| !goals.is_empty()), "{lesson}");
    }
    holds("record", &["record", "--task", "needle", "--out", &needle]);
    for (log, world) in [(&stack, "stack"), (&crank, "crank"), (&needle, "needle")] {
        let score = holds("score", &["score", log, "--world", world, "--definitions"]);
        assert!(score["definitions"].as_array().is_some_and(|all| all.len() > 10), "{score}");
    }
    holds("score", &["score", &stack]);
    // Enough attempts for a curve of practice, in two sittings.
    let attempts: String = (0..12).map(attempt).collect();
    let (lines, database) = (folder.path().join("attempts.jsonl"), file("history.sqlite"));
    std::fs::write(&lines, attempts).expect("written");
    let imported = holds("history-import", &["history", "--database", &database, "--import", text(&lines)]);
    assert_eq!(imported["new"], 12);
    let history = holds("history", &["history", "--database", &database]);
    assert!(history["progress"][0]["curve"]["is_seen"] == true, "{history}");
    holds("history", &["history", "--database", &database, "--trainee", "nobody"]);
}

/// A line for `history --import`, on one of two days.
fn attempt(number: u32) -> String {
    let n = f64::from(number);
    let attempt = json!({
        "trainee": "Ada", "lesson": "pinch", "conditions": { "delay_ms": 150.0, "predicted": true },
        "began": format!("2026-11-{:02}T10:{:02}:00Z", 20 + number / 6, number % 6),
        "duration_s": 20.0 + n, "completed": true, "score": 90.0 - 40.0 / (1.0 + n) + 0.1 * (5.0 * n).sin(),
        "meets_criterion": number > 7, "proficient": number > 8,
        "measures": { "hand": { "path_m": 0.1 * n } }, "measures_version": 1, "grade_version": 1,
    });
    attempt.to_string() + "\n"
}

#[test]
fn so_it_is_with_devices_reports_and_pictures() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = |name: &str| folder.path().join(name).display().to_string();
    let listed = holds("device-list", &["device", "list"]);
    assert!(listed["devices"].as_array().is_some_and(|all| all.iter().any(|d| d["id"] == "mouse")), "{listed}");
    let tested = holds("device-test", &["device", "test", "scripted", "--seconds", "0.5", "--rate", "500"]);
    assert!(tested["checks"].as_array().is_some_and(|all| all.len() >= 3), "{tested}");
    let (page, missing) = (file("report.html"), file("missing.csv"));
    holds("report", &["report", &asset("crank.csv"), "--out", &page]);
    // A log that cannot be read is a line of the answer, and the program says so in the end.
    let mixed = ["report", &asset("crank.csv"), &missing, "--out", &page, "--json"];
    let output = Command::new(touchstone()).args(mixed).output().expect("the program starts");
    assert_eq!(output.status.code(), Some(1));
    let said: Value = serde_json::from_slice(&output.stdout).expect("one JSON object");
    let wrong = faults(&schemas()["report"], &said);
    assert!(wrong.is_empty() && said["logs"][1].get("recordings").is_none(), "{wrong:#?} {said}");
    holds("gallery", &["gallery", "--only", "parameters", "--out", &file("gallery")]);
    let demo = holds("demo", &["demo", "--out", &file("demo")]);
    assert_eq!(demo["recordings"].as_array().map(Vec::len), Some(2), "{demo}");
}

#[test]
fn so_it_is_with_what_is_measured() {
    holds("bench-servo", &["bench", "servo", "--seconds", "0.5", "--rate", "500", "--no-real-time"]);
    holds("bench-frames", &["bench", "frames", "--samples", "20000", "--size", "640x480", "--pictures", "2"]);
    holds("bench-online", &["bench", "online", "--rounds", "1"]);
    holds("bench", &["bench", "diagnosis", "--quick"]);
    holds("bench-delay", &["bench", "delay", "--seeds", "1", "--round-trips-ms", "0,500"]);
    let blind = holds("bench-blind", &["bench", "blind", "--seed", "3", "--cases", "4"]);
    assert_eq!(blind["cases"], 4, "{blind}");
    let scale = holds("bench-scale", &["bench", "scale", "--quick"]);
    assert!(scale["scale"].as_array().is_some_and(|all| all.len() == 12), "{scale}");
}

#[test]
fn a_fleet_prints_lines_as_the_schema_says_and_goes_on_where_it_was() {
    let folder = tempfile::tempdir().expect("a folder");
    let (bad, lines) = (folder.path().join("bad.csv"), folder.path().join("lines.jsonl"));
    std::fs::write(&bad, "t_s,q_m\n0,nothing\n").expect("written");
    let logs = [asset("stack.csv"), text(&bad).to_owned(), asset("crank.csv")];
    let run = |logs: &[String]| {
        let mut command = Command::new(touchstone());
        command.arg("diagnose").args(logs).args(["--json-lines", "--jobs", "2", "--resume", text(&lines)]);
        let output = command.output().expect("the program starts");
        assert!(output.stdout.is_empty(), "the lines are in the file");
        (output.status.code(), String::from_utf8_lossy(&output.stderr).into_owned())
    };
    let (code, said) = run(&logs);
    assert!(code == Some(1) && said.contains("1 of 3 logs could not be diagnosed"), "{said}");
    let read = || std::fs::read_to_string(&lines).expect("lines");
    for line in read().lines() {
        let line: Value = serde_json::from_str(line).expect("one JSON object a line");
        let wrong = faults(&schemas()["diagnose-lines"], &line);
        assert!(wrong.is_empty(), "{wrong:#?}");
        assert_eq!(line.get("error").is_some(), line["file"] == text(&bad), "{line}");
    }
    let before = read();
    let (code, said) = run(&logs);
    assert!(said.contains("3 stood there already (1 of them failed then)") && read() == before, "{said}");
    assert_eq!(code, Some(1), "what failed then has not been put right");
    // What was cut off when a run was killed is done again.
    std::fs::write(&lines, &before[..before.len() - 40]).expect("written");
    assert!(run(&logs).1.contains("2 stood there already"));
    assert_eq!(read().lines().count(), 4);
    let to_output = Command::new(touchstone()).args(["diagnose", &logs[0], "--json-lines"]).output().expect("runs");
    assert!(to_output.status.success() && to_output.stdout.ends_with(b"\n"));
    serde_json::from_slice::<Value>(&to_output.stdout).expect("one line");
}

#[test]
fn wrong_documents_are_refused() {
    let schemas = schemas();
    let mut said = holds("diagnose", &["diagnose", &asset("crank.csv")]);
    said["verdict"] = "perhaps".into();
    assert!(!faults(&schemas["diagnose"], &said).is_empty());
    said.as_object_mut().expect("an object").remove("verdict");
    assert!(!faults(&schemas["diagnose"], &said).is_empty());
}

/// Every name that the contract gives in an example of a command is one that its schema knows.
#[test]
fn the_contract_s_names_are_in_the_schemas() {
    let Ok(contract) = std::fs::read_to_string(workspace().join("../shared/spec/command-line.md")) else {
        tests::skipped("../shared/spec/command-line.md is not here");
        return;
    };
    let schemas = schemas();
    for name in ["segment", "fit", "diagnose"] {
        let (_, section) = contract.split_once(&format!("## `{name} --json`")).expect("a section of the contract");
        let section = section.split("\n## ").next().unwrap_or_default();
        let said = schemas[name].to_string();
        let mut names = 0;
        for (end, _) in section.match_indices("\":") {
            let key = section[..end].rsplit('"').next().expect("a name in quotes");
            // `std_error:{…}` and the like hold names of parameters.
            let is_known = said.contains(&format!("\"{key}\""));
            assert!(is_known, "{name}: `{key}` is not known to the schema");
            names += 1;
        }
        assert!(names > 5, "{name}: {names} names");
    }
    // Every kind of a constraint and every verdict that the contract knows is one of the schema's.
    for (name, key) in [("fit", "\"kind\":\""), ("diagnose", "\"verdict\": \"")] {
        let (_, words) = contract.split_once(key).expect("a choice of words");
        let words = words.split('"').next().unwrap_or_default();
        for word in words.split('|') {
            let known = format!("\"const\":\"{}\"", word.trim());
            assert!(schemas[name].to_string().contains(&known), "{name}: the schema does not know `{word}`");
        }
    }
}
