//! The program from outside: commands, JSON, exit codes, bad input.

use serde_json::Value;
use std::path::Path;
use std::process::{Command, Output};
use std::time::Instant;
use tests::{touchstone, workspace};

fn run(arguments: &[&str]) -> Output {
    Command::new(touchstone()).args(arguments).output().expect("the program starts")
}

/// The JSON object that a command prints, and nothing else.
fn json(arguments: &[&str]) -> Value {
    let mut all = arguments.to_vec();
    all.push("--json");
    let output = run(&all);
    let error = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{arguments:?}: {error}");
    serde_json::from_slice(&output.stdout).expect("one JSON object and nothing else")
}

fn asset(name: &str) -> String {
    workspace().join("assets/recordings").join(name).to_string_lossy().into_owned()
}

fn text(path: &Path) -> String {
    path.to_string_lossy().into_owned()
}

#[test]
fn info_lists_columns_and_rate() {
    let info = json(&["info", &asset("stack.csv")]);
    assert_eq!(info["rate_hz"].as_f64().map(f64::round), Some(200.0));
    let names: Vec<&str> =
        info["columns"].as_array().expect("columns").iter().filter_map(|c| c["name"].as_str()).collect();
    assert!(names.contains(&"fx1_N") && names.contains(&"vy2_m_s"), "{names:?}");
}

#[test]
fn segment_finds_the_thesis_sequence() {
    let result = json(&["segment", &asset("stack.csv")]);
    assert_eq!(result["method"], "threshold");
    let states = result["states"].as_array().expect("states");
    let names: Vec<&str> =
        states.iter().filter(|s| !s["subtask"].is_null()).filter_map(|s| s["state"].as_str()).collect();
    let (free, ground, air) = ("free-motion", "hold-on-ground", "hold-above-ground");
    assert_eq!(names, [free, ground, air, ground, free, ground, air, ground, free]);
    assert!(states.windows(2).all(|w| w[0]["t1"] == w[1]["t0"]), "intervals follow each other");
}

#[test]
fn segment_by_a_hidden_markov_model_finds_the_same_states_in_words_and_json() {
    let result = json(&["segment", &asset("stack.csv"), "--method", "hmm"]);
    assert_eq!(result["method"], "hmm");
    let states = result["states"].as_array().expect("states");
    let names: Vec<&str> =
        states.iter().filter(|s| !s["subtask"].is_null()).filter_map(|s| s["state"].as_str()).collect();
    let (free, ground, air) = ("free-motion", "hold-on-ground", "hold-above-ground");
    assert_eq!(names, [free, ground, air, ground, free, ground, air, ground, free]);
    assert!(states.windows(2).all(|w| w[0]["t1"] == w[1]["t0"]), "intervals follow each other");
    for state in states {
        let probability = state["probability"].as_f64().expect("a number");
        assert!((0.5..=1.0).contains(&probability), "{state}");
    }
    let words = run(&["segment", &asset("stack.csv"), "--method", "hmm"]);
    let words = String::from_utf8_lossy(&words.stdout).into_owned();
    assert!(words.contains("by a hidden Markov model") && words.contains("sequence: 132313231"), "{words}");
    let crank = json(&["segment", &asset("crank.csv"), "--method", "hmm"]);
    assert!(crank["states"].as_array().is_some_and(|s| s.iter().any(|s| s["state"] == "turning")));
}

#[test]
fn fit_simulate_and_the_world_in_between() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let (world, csv) = (text(&folder.path().join("w.json")), text(&folder.path().join("s.csv")));
    let fit = json(&["fit", &asset("crank.csv"), "--out", &world]);
    let radius =
        fit["parameters"].as_array().expect("parameters").iter().find(|p| p["name"] == "radius_m").expect("a radius");
    assert!((radius["value"].as_f64().expect("a value") - 0.0212).abs() < 1e-4);
    assert_eq!(radius["identified"], true);
    assert_eq!(fit["constraints"][0]["kind"], "revolute");

    let simulated = json(&["simulate", &world, &asset("crank.csv"), "--out", &csv]);
    let rms = simulated["residual_rms"]["fx1_N"].as_f64().expect("a residual");
    assert!(rms < 0.3, "the calibrated crank reproduces the force: {rms} N RMS");
    let info = json(&["info", &csv]);
    assert!(info["columns"].as_array().is_some_and(|c| c.iter().any(|c| c["name"] == "fx1_N")));
}

#[test]
fn record_is_repeatable_and_can_be_replayed() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = |name: &str| text(&folder.path().join(name));
    let record = |out: &str, operator: &str| {
        json(&[
            "record",
            "--task",
            "block-stack",
            "--operator",
            operator,
            "--seconds",
            "6",
            "--out",
            out,
            "--sensors",
            "ideal",
        ])
    };
    let (a, b, again) = (file("a.csv"), file("b.csv"), file("replay.csv"));
    assert_eq!(record(&a, "scripted")["samples"], 6000);
    record(&b, "scripted");
    assert_eq!(std::fs::read(&a).expect("a"), std::fs::read(&b).expect("b"), "the same seed gives the same bytes");
    record(&again, &format!("replay:{a}"));
    assert!(folder.path().join("a.meta.json").is_file());
    let grip = |path: &str| {
        let log = estimator::log::load(Path::new(path), None).expect("a recording");
        log[0].channel("fx1_N").expect("a force")[4500]
    };
    assert!((grip(&a) - grip(&again)).abs() < 0.1 * grip(&a).abs(), "{} against {}", grip(&a), grip(&again));
}

#[test]
fn demo_runs_the_whole_chain() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let started = Instant::now();
    let result = json(&["demo", "--out", &text(folder.path())]);
    println!("demo took {:.1} s in this profile", started.elapsed().as_secs_f64());
    for recording in result["recordings"].as_array().expect("recordings") {
        let within = &recording["within_two_errors"];
        let (hits, of) = (within["hits"].as_u64().expect("hits"), within["of"].as_u64().expect("of"));
        assert!(of >= 6 && hits + 1 >= of, "{}: {hits} of {of}", recording["name"]);
        // The thesis's model misses the give of the pads on blocks, and Coulomb friction on this crank: the world it was made in has both.
        let missed = if recording["name"] == "stack" { "pad-compliance" } else { "coulomb-friction" };
        assert_eq!(recording["diagnosis"]["causes"][0]["id"], missed, "{}", recording["name"]);
    }
    for file in ["stack.world.json", "crank.simulated.csv", "stack.extended.json", "crank.extended.json", "report.html"]
    {
        assert!(folder.path().join(file).is_file(), "{file}");
    }
    if result["pictures"].as_array().is_none_or(Vec::is_empty) {
        tests::skipped("no Vulkan driver for pictures");
    }
}

#[test]
fn screenshot_draws_the_scene() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let out = text(&folder.path().join("scene.png"));
    let output = run(&["screenshot", "--scene", "stack", "--size", "320x200", "--out", &out]);
    if String::from_utf8_lossy(&output.stderr).contains("mesa-vulkan-drivers") {
        tests::skipped("no Vulkan driver");
        return;
    }
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let picture = image::open(&out).expect("a PNG").to_rgba8();
    assert_eq!(picture.dimensions(), (320, 200));
    let colors: std::collections::BTreeSet<[u8; 4]> = picture.pixels().map(|p| p.0).collect();
    assert!(colors.len() > 200, "a picture has more than {} colours", colors.len());
}

#[test]
fn device_lists_and_tests_itself() {
    let list = json(&["device", "list"]);
    assert!(list["devices"].as_array().is_some_and(|d| d.iter().any(|d| d["id"] == "mouse")));
    let slow =
        |rate| json(&["device", "list", "--rate", rate])["devices"][3]["limits"]["passive_stiffness_N_m"].as_f64();
    assert!(slow("1000").zip(slow("500")).is_some_and(|(one, half)| (one / half - 2.0).abs() < 1e-9), "computed");
    let late = json(&["device", "test", "mouse", "--seconds", "0.5", "--delay", "50", "--loss", "0.1", "--waves"]);
    assert!(late["checks"].as_array().is_some_and(|checks| checks.len() == 3), "{late}");
    refused(&["device", "test", "mouse", "--loss", "2"], "loss");
    refused(&["device", "test", "udp:127.0.0.1,/nowhere"], "/nowhere");
    let test = json(&["device", "test", "--seconds", "1"]);
    assert!(test["ticks"].as_u64().is_some_and(|n| n > 300), "{test}");
    assert!(test["timing"]["compute"]["p50_s"].as_f64().is_some_and(|t| t > 0.0));
    refused(&["device", "test", "--device", "haply:/dev/nowhere,/dev/nowhere"], "/dev/nowhere");
}

/// Exit 1, one sentence on standard error, nothing on standard output.
fn refused(arguments: &[&str], wanted: &str) {
    let mut all = arguments.to_vec();
    all.push("--json");
    let output = run(&all);
    let error = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{arguments:?}: {error}");
    assert!(output.stdout.is_empty(), "{arguments:?} printed {}", String::from_utf8_lossy(&output.stdout));
    assert_eq!(error.trim().lines().count(), 1, "one sentence: {error}");
    assert!(error.contains(wanted), "{arguments:?} should speak of `{wanted}`: {error}");
}

#[test]
fn malformed_logs_answer_with_one_sentence() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let cases: [(&str, &str, &str); 8] = [
        ("empty.csv", "", "empty"),
        ("header.csv", "t_s,q_m,f_N\n", "header"),
        ("text.csv", "t_s,q_m,f_N\n0,1,2\n1,zwei,3\n", "q_m"),
        ("nan.csv", "t_s,q_m,f_N\n0,1,2\n1,NaN,3\n", "q_m"),
        ("back.csv", "t_s,q_m,f_N\n0,1,2\n1,1,3\n0.5,1,3\n", "time"),
        ("ragged.csv", "t_s,q_m,f_N\n0,1,2\n1,1\n", "row"),
        ("unit.csv", "t_s,q_m,f_stone\n0,1,2\n1,1,2\n", "f_stone"),
        ("clock.csv", "t_s,q_m,f_N\n0,1,2\n0,1,3\n", "time"),
    ];
    for (name, content, wanted) in cases {
        let path = folder.path().join(name);
        std::fs::write(&path, content).expect("written");
        refused(&["info", &text(&path)], wanted);
    }
    refused(&["info", &text(&folder.path().join("missing.csv"))], "missing.csv");
    refused(&["info", &text(folder.path())], "folder");
    refused(&["fit", &text(&folder.path().join("missing.csv"))], "missing.csv");
    let world = folder.path().join("w.json");
    std::fs::write(&world, "{\"name\": 3}").expect("written");
    refused(&["simulate", &text(&world), &asset("stack.csv"), "--out", "/dev/null"], "world");
}

#[test]
fn wrong_usage_is_exit_two() {
    for arguments in [&["fit"][..], &["nonsense"], &["info"], &["segment", "x.csv", "--method", "magic"]] {
        assert_eq!(run(arguments).status.code(), Some(2), "{arguments:?}");
    }
}

#[test]
fn diagnose_answers_as_the_contract_says_and_writes_a_world_that_can_be_felt() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("extended.json");
    let other = asset("crank.csv");
    let result = json(&["diagnose", &asset("crank.csv"), "--out", out.to_str().expect("a path"), "--validate", &other]);
    let validation = result["validation"].as_array().expect("one a log");
    assert_eq!(validation.len(), 1);
    assert!(validation[0]["rms_after"].as_f64() <= validation[0]["rms_before"].as_f64(), "{validation:?}");
    let verdict = result["verdict"].as_str().expect("a verdict");
    assert!(["causes", "none", "ambiguous", "unexplained"].contains(&verdict), "{verdict}");
    let said = run(&["diagnose", &asset("crank.csv")]);
    let words = String::from_utf8_lossy(&said.stdout).into_owned();
    assert!(words.starts_with(&format!("verdict: {verdict}: ")), "the words say what the JSON says: {words}");
    for key in ["model", "rms_N", "heldout_rms_N", "whiteness_p"] {
        assert!(!result["baseline"][key].is_null(), "{key}");
    }
    assert!(result["noise_floor_N"].as_f64().is_some_and(|floor| floor > 0.0));
    for cause in result["causes"].as_array().expect("causes") {
        for key in ["id", "kind", "parameters", "p_value", "posterior", "gain", "evidence"] {
            assert!(!cause[key].is_null(), "{key} of {cause}");
        }
    }
    for key in ["alternatives", "not_excited"] {
        assert!(result[key].is_array(), "{key}");
    }
    assert!(result["final"]["heldout_rms_N"].as_f64() <= result["baseline"]["heldout_rms_N"].as_f64());
    let world = std::fs::read_to_string(out).expect("the world is written");
    let world = haptics::world::World::from_json(&world).expect("a world");
    assert!(world.crank.expect("a crank").effects.len() >= 3);
}
