//! Two loggers of one run: a drawer whose position is in one file and whose force is in another, on another clock.
//!
//! The drawer is 1.5 kg with 4 N s/m and 2 N of dry friction. Both loggers have the voltage of the handle. Its motion is a sum
//! of waves with exact derivatives; no formula is the estimator's.

use rand::rngs::StdRng;
use rand::{RngExt as _, SeedableRng as _};
use serde_json::Value;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use tests::{shared_data, touchstone};

const MASS_KG: f64 = 1.5;
/// Reading of the second logger's clock at the start of the first one's, s, and its seconds a second.
const CLOCK: (f64, f64) = (0.437, 1.0 + 300e-6);

/// Position, force, and acceleration of the handle at a time.
fn drawer(t: f64) -> [f64; 3] {
    let waves = [(0.055, 1.9, 0.3), (0.03, 4.4, 1.1), (0.012, 8.3, 2.0), (0.02, 2.963, 0.7)];
    let sum = |of: &dyn Fn(f64, f64, f64) -> f64| waves.iter().map(|(a, w, p)| of(*a, *w, w * t + p)).sum::<f64>();
    let velocity = sum(&|a, w, x| a * w * x.cos());
    let acceleration = sum(&|a, w, x| -a * w * w * x.sin());
    let force = MASS_KG * acceleration + 4.0 * velocity + 2.0 * (velocity / 1e-3).tanh();
    [sum(&|a, _, x| a * x.sin()), force, acceleration]
}

/// A folder with both files.
struct Run(tempfile::TempDir);

impl Run {
    fn new() -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        let random = &mut StdRng::seed_from_u64(31);
        let mut noise = |size: f64| size * (random.random_range(-1.0..1.0) + random.random_range(-1.0..1.0_f64));
        let mut log = "t_s,q_m,handle_V\n".to_owned();
        for k in 0..4000 {
            let t = 0.005 * f64::from(k);
            let [q, _, a] = drawer(t);
            writeln!(log, "{t:.4},{:.6},{:.4}", q + noise(2e-6), 0.3 * a + noise(0.01)).expect("memory");
        }
        let mut force = "t_s,f_N,handle_V\n".to_owned();
        for k in 0..19_000 {
            let t = 0.5 + 0.001 * f64::from(k);
            let [_, f, a] = drawer(t);
            let reading = CLOCK.0 + CLOCK.1 * t;
            writeln!(force, "{reading:.6},{:.5},{:.4}", f + noise(0.02), 0.1 - 2.0 * a + noise(0.05)).expect("memory");
        }
        for (name, text) in [("log.csv", log), ("force.csv", force)] {
            std::fs::write(folder.path().join(name), text).expect("written");
        }
        std::fs::write(folder.path().join("log.meta.json"), r#"{"task": "mechanism"}"#).expect("written");
        Self(folder)
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn run(&self, arguments: &[&str]) -> Output {
        Command::new(touchstone()).args(arguments).current_dir(&self.0).output().expect("the program starts")
    }

    fn json(&self, arguments: &[&str]) -> Value {
        let output = self.run(&[arguments, &["--json"]].concat());
        let error = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{arguments:?}: {error}");
        serde_json::from_slice(&output.stdout).expect("one JSON object")
    }
}

/// The mass of a fit; none if it is not identifiable.
fn mass(fit: &Value) -> Option<f64> {
    let parameters = fit["parameters"].as_array().expect("parameters");
    parameters.iter().find(|p| p["name"].as_str().is_some_and(|n| n.starts_with("mass")))?["value"].as_f64()
}

fn off(fit: &Value) -> f64 {
    mass(fit).map_or(f64::INFINITY, |mass| (mass / MASS_KG - 1.0).abs())
}

#[test]
fn the_mass_comes_from_a_force_in_another_file() {
    let run = Run::new();
    let joined = run.json(&["fit", "log.csv", "--join", "force.csv"]);
    println!("joined: {:?} kg", mass(&joined));
    assert!(off(&joined) < 0.02, "{:?} kg", mass(&joined));
    // Without the offset the force belongs to another moment.
    let as_it_stands = run.json(&["fit", "log.csv", "--join", "force.csv", "--offset-s", "0"]);
    println!("as it stands: {:?} kg", mass(&as_it_stands));
    assert!(off(&as_it_stands) > 0.1, "{:?} kg", mass(&as_it_stands));
    let info = run.json(&["info", "log.csv", "--join", "force.csv"]);
    let said = info["warnings"].as_array().expect("warnings").iter().find(|w| w["kind"] == "joined").expect("a word");
    let said = said["text"].as_str().expect("a text");
    assert!(said.contains("-0.440") && said.contains("`handle_V`") && said.contains("ppm"), "{said}");
    // The sidecar says the same.
    let sidecar = r#"{"task": "mechanism", "join": [{"file": "force.csv", "by": "handle_V"}]}"#;
    std::fs::write(run.path("log.meta.json"), sidecar).expect("written");
    assert_eq!(mass(&run.json(&["fit", "log.csv"])), mass(&joined));
}

#[test]
fn a_joined_recording_is_converted_to_one_file() {
    let run = Run::new();
    run.json(&["convert", "log.csv", "whole.csv", "--join", "force.csv"]);
    let sidecar = std::fs::read_to_string(run.path("whole.meta.json")).expect("a sidecar");
    assert!(sidecar.contains("mechanism") && !sidecar.contains("join"), "{sidecar}");
    let fits = [run.json(&["fit", "whole.csv"]), run.json(&["fit", "log.csv", "--join", "force.csv"])];
    assert_eq!(mass(&fits[0]), mass(&fits[1]));
    assert!(off(&fits[0]) < 0.02);
}

#[test]
fn a_join_that_cannot_be_is_one_sentence() {
    let run = Run::new();
    let no = |arguments: &[&str], words: &str| {
        let output = run.run(arguments);
        let error = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(!output.status.success() && error.contains(words) && error.trim().lines().count() == 1, "{error}");
    };
    no(&["info", "log.csv", "--join", "absent.csv"], "absent.csv");
    no(&["info", "log.csv", "--join", "log.csv"], "the log itself");
    let text = std::fs::read_to_string(run.path("force.csv")).expect("text").replace("handle_V", "other_V");
    std::fs::write(run.path("force.csv"), text).expect("written");
    no(&["info", "log.csv", "--join", "force.csv"], "no channel is in both files");
}

fn written(path: &Path) -> Value {
    serde_json::from_str(&std::fs::read_to_string(path).expect("a sidecar")).expect("JSON")
}

#[test]
fn two_clocks_of_one_table_are_suggested_and_settled() {
    let run = Run::new();
    let mut table = "time_position_s,position_mm,time_force_s,force_N\n".to_owned();
    for k in 0..4000 {
        let (t, s) = (0.005 * f64::from(k), 0.043 + 0.0049 * f64::from(k));
        writeln!(table, "{t:.4},{:.5},{s:.4},{:.5}", 1e3 * drawer(t)[0], drawer(s)[1]).expect("memory");
    }
    std::fs::write(run.path("pairs.csv"), table).expect("written");
    run.json(&["info", "--suggest", "pairs.csv"]);
    let sidecar = written(&run.path("pairs.meta.json"));
    assert_eq!(sidecar["clocks"], serde_json::json!({ "force_N": "time_force_s" }), "{sidecar}");
    let fit = run.json(&["fit", "pairs.csv"]);
    assert!(off(&fit) < 0.02, "{:?} kg", mass(&fit));
    // The rows as they stand are no instants.
    let mut alone = sidecar;
    alone.as_object_mut().expect("an object").remove("clocks");
    std::fs::write(run.path("pairs.meta.json"), alone.to_string()).expect("written");
    let fit = run.json(&["fit", "pairs.csv"]);
    assert!(off(&fit) > 0.05, "{:?} kg", mass(&fit));
}

/// Mass by hand: an ordinary regression of the whole stroke, with the force later by what the authors state.
const RACK_KG: [f64; 2] = [24.7, 25.9];

#[test]
fn a_rack_weighs_the_same_from_two_files() {
    let Some(speed) = shared_data("rack_pinion/velocity_1500Hz.csv") else { return };
    let force = speed.with_file_name("force_2kHz.csv");
    let folder = tempfile::tempdir().expect("a folder");
    let files = [
        (&speed, "speed", r#"{"task": "mechanism", "columns": {"dq_m_s": "velocity_m_s"}}"#),
        (&force, "force", r#"{"columns": {"f_N": "force_N"}}"#),
    ];
    for (source, name, sidecar) in files {
        std::fs::copy(source, folder.path().join(format!("{name}.csv"))).expect("copied");
        std::fs::write(folder.path().join(format!("{name}.meta.json")), sidecar).expect("written");
    }
    let fit = |more: &[&str]| {
        let arguments = [&["fit", "speed.csv", "--join", "force.csv", "--json"], more].concat();
        Command::new(touchstone()).args(arguments).current_dir(folder.path()).output().expect("it runs")
    };
    let refused = fit(&[]);
    assert!(!refused.status.success() && String::from_utf8_lossy(&refused.stderr).contains("\"offset_s\": 0"));
    let fitted: Value = serde_json::from_slice(&fit(&["--offset-s", "0.004"]).stdout).expect("JSON");
    let mass = mass(&fitted).expect("a mass");
    assert!((RACK_KG[0]..RACK_KG[1]).contains(&mass), "{mass} kg");
}
