//! Golden answers: `diagnose`, `fit` and `simulate` say today of a fixed set of recordings what they said when the set was written.
//!
//! A restructuring must leave every answer equal. The set holds the fast blind battery, recordings of every task of [`tests::tasks`], the
//! built-in recordings, and real measurements where they are beside the checkout. One file a group, one line a recording, in
//! `tests/golden/answers`. A change that is meant to alter answers writes them anew, and its commit says which and why:
//! `TOUCHSTONE_WRITE_GOLDEN=1 cargo test -p golden`.

use blind::{Counts, battery};
use estimator::diagnose::{Options, Suspect, diagnose, suspects, validate, worlds};
use estimator::pipeline::{self, analyse};
use estimator::simulate::{Simulation, simulate};
use haptics::recording::{Meta, Recording};
use rayon::prelude::*;
use serde_json::{Map, Value, json};
use std::fmt::Write as _;
use std::path::PathBuf;
use tests::tasks::{Case, barrel, blocks, needle, slide, switch, throw};
use tests::{shared_data, workspace};

/// Seed of the whole set.
const SEED: u64 = 20_261_126;
/// Recordings of every task at least.
const PER_TASK: usize = 8;
/// Every so many cases of the blind battery are also fitted and simulated.
const FITTED_EVERY: usize = 6;
/// Longer arrays of numbers are kept as their length, their norm and the norm of their steps.
const LONGEST_ARRAY: usize = 12;
/// Relative difference of numbers that count as equal: twelve digits are written, and C libraries differ in the last bits of a sine.
const TOLERANCE: f64 = 1e-9;
/// Differences that are printed, of every recording and of a whole group.
const MOST_PRINTED: usize = 5;

/// A recording of the set, by name, with what is asked of it.
struct Asked {
    name: String,
    recordings: Vec<Recording>,
    options: Options,
    /// Fit and simulation, too.
    whole: bool,
}

#[test]
fn blind_battery() {
    let asked = |(k, job): (usize, blind::Job)| {
        let (case, _) = job.make();
        let options = blind::score::options(&case);
        let name = format!("{} {}", job.set.name(), job.seed);
        Asked { name, recordings: case.recordings, options, whole: k % FITTED_EVERY == 0 }
    };
    let jobs: Vec<_> = battery(Counts::FAST, SEED).into_iter().enumerate().collect();
    hold("blind", jobs, asked);
}

#[test]
fn tasks() {
    let mut jobs: Vec<(String, Box<dyn Fn() -> Case + Send + Sync>)> = Vec::new();
    macro_rules! add {
        ($task:ident) => {
            let kinds = $task::Kind::ALL;
            for k in 0..kinds.len().max(PER_TASK) {
                let (name, kind) = kinds[k % kinds.len()];
                let seed = SEED + k as u64;
                let name = format!("{} {name} {seed}", stringify!($task));
                jobs.push((name, Box::new(move || $task::make(kind, seed).0)));
            }
        };
    }
    add!(blocks);
    add!(slide);
    add!(barrel);
    add!(needle);
    add!(switch);
    add!(throw);
    hold("tasks", jobs, |(name, make)| {
        let Case { recordings, options } = make();
        Asked { name, recordings, options, whole: true }
    });
}

#[test]
fn built_in_recordings() {
    hold("built_in", vec!["stack", "crank"], |name| {
        let path = workspace().join(format!("assets/recordings/{name}.csv"));
        let recordings = estimator::log::load(&path, None).expect("a built-in recording");
        Asked { name: name.to_owned(), recordings, options: Options::default(), whole: true }
    });
}

#[test]
fn real_measurements() {
    let columns = r#"{"columns":{"t_s":"time_s","q_m":"position_m","f_N":"force_N"}}"#;
    let cabinet = r#"{"columns":{"x_m":"tip_x_m","y_m":"tip_y_m","z_m":"tip_z_m","fx_N":"fx_wrist_sensor_N","fy_N":"fy_wrist_sensor_N","fz_N":"fz_wrist_sensor_N"}}"#;
    let davinci = r#"{"columns":{"trial":"run","q_rad":"spindle_angle_rad","q_out_rad":"jaw_side_angle_rad","tau_Nm":"spindle_torque_Nm"},"sign":{"q_out_rad":-1}}"#;
    let all = [
        ("emps/emps_identification.csv", columns),
        ("emps/emps_pulses.csv", columns),
        ("cube_toss/tosses.csv", r#"{"columns":{"trial":"toss"},"up":"z","known":{"half_width_m":0.0524}}"#),
        ("cabinet_pull/kitchen_cabinet_run1.csv", cabinet),
        ("davinci_tool/tool_runs.csv", davinci),
    ];
    let there = all.into_iter().filter_map(|(file, meta)| Some((file, shared_data(file)?, meta))).collect();
    hold("real", there, |(file, path, meta): (&str, PathBuf, &str)| {
        let meta: Meta = serde_json::from_str(meta).expect("a sidecar");
        let mut recordings = estimator::log::load_with_meta(&path, &meta).expect("real data load");
        // Several runs of a tool are one object, but each is asked alone elsewhere: one is enough here.
        if file.starts_with("davinci") {
            recordings.truncate(1);
        }
        Asked { name: file.to_owned(), recordings, options: Options::default(), whole: true }
    });
}

/// Asks every case and holds the answers against those in the file of the group, or writes them.
fn hold<Job: Send>(group: &str, jobs: Vec<Job>, asked: impl Fn(Job) -> Asked + Sync) {
    let answer = |job| {
        let asked = asked(job);
        (asked.name.clone(), answers(&asked))
    };
    let now: Vec<(String, Value)> = jobs.into_par_iter().with_max_len(1).map(answer).collect();
    let path = workspace().join(format!("tests/golden/answers/{group}.jsonl"));
    if std::env::var_os("TOUCHSTONE_WRITE_GOLDEN").is_some() {
        let lines = now.iter().map(|(name, answers)| json!({"recording": name, "answers": answers}).to_string() + "\n");
        std::fs::write(&path, lines.collect::<String>()).expect("the answers are written");
        return;
    }
    let text = std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    let stored: Map<String, Value> = text
        .lines()
        .map(|line| {
            let mut line: Value = serde_json::from_str(line).expect("a line of JSON");
            (line["recording"].as_str().expect("a name").to_owned(), line["answers"].take())
        })
        .collect();
    let mut report = String::new();
    let mut differing = 0;
    for (name, now) in &now {
        let Some(was) = stored.get(name) else { panic!("{name} is not in {}", path.display()) };
        let mut found = Vec::new();
        differences("", was, now, &mut found);
        if found.is_empty() {
            continue;
        }
        differing += 1;
        if differing <= MOST_PRINTED {
            let _ = writeln!(report, "{name}: {} differences", found.len());
            for difference in found.iter().take(MOST_PRINTED) {
                let _ = writeln!(report, "  {difference}");
            }
            let _ = writeln!(report, "was: {was}\nis:  {now}\n");
        }
    }
    assert!(differing == 0, "{differing} of {} answers differ from {}:\n{report}", now.len(), path.display());
}

/// Everything that the program says of a case, with numbers to twelve digits.
fn answers(asked: &Asked) -> Value {
    let mut said = Map::new();
    let recordings = &asked.recordings;
    match diagnose(recordings, &asked.options) {
        Ok(diagnosis) => {
            said.insert("diagnosis".to_owned(), serde_json::to_value(&diagnosis.diagnosis).expect("JSON"));
            if asked.whole {
                let others = validate(recordings, &asked.options, &diagnosis);
                said.insert("validation".to_owned(), or_error(others.map(|others| json!(others))));
                let before_and_after = worlds(recordings, &asked.options, &diagnosis);
                said.insert("worlds".to_owned(), or_error(before_and_after.map(|w| json!([w.before, w.after]))));
                let objects = suspects(recordings, &asked.options, &diagnosis);
                let world = |s: Suspect| json!([s.id, s.world, format!("{:?}", s.fault)]);
                said.insert("suspects".to_owned(), or_error(objects.map(|all| all.into_iter().map(world).collect())));
            }
        }
        Err(error) => drop(said.insert("diagnosis".to_owned(), Value::String(error.to_string()))),
    }
    if asked.whole {
        let options = pipeline::Options { task: asked.options.task, ..pipeline::Options::default() };
        match analyse(recordings, &options) {
            Ok(analysis) => {
                said.insert("fit".to_owned(), serde_json::to_value(&analysis.fit).expect("JSON"));
                let simulated = simulate(&analysis.world, &recordings[0]);
                said.insert("simulation".to_owned(), or_error(simulated.as_ref().map(plain)));
                said.insert("world".to_owned(), serde_json::to_value(&analysis.world).expect("JSON"));
            }
            Err(error) => drop(said.insert("fit".to_owned(), Value::String(error.to_string()))),
        }
    }
    let mut said = Value::Object(said);
    shorten(&mut said);
    said
}

/// What was said, or the sentence of the error.
fn or_error(said: Result<Value, impl std::fmt::Display>) -> Value {
    said.unwrap_or_else(|e| Value::String(e.to_string()))
}

/// A simulation as JSON.
fn plain(simulation: &Simulation) -> Value {
    let channels: Map<String, Value> =
        simulation.predicted.iter().map(|c| (c.name.clone(), Value::from(c.values.clone()))).collect();
    json!({
        "predicted": channels,
        "residual_rms": simulation.residual_rms,
        "part": simulation.part,
        "inputs": simulation.inputs,
        "bias_N": simulation.bias_n,
    })
}

/// Rounds every number to twelve digits and replaces long arrays of numbers by three figures of them.
fn shorten(value: &mut Value) {
    match value {
        Value::Number(number) => {
            if let Some(exact) = number.as_f64().filter(|_| number.is_f64()) {
                *value = json!(format!("{exact:.11e}").parse::<f64>().expect("a number that was written"));
            }
        }
        Value::Array(items) if items.len() > LONGEST_ARRAY && items.iter().all(Value::is_number) => {
            let numbers: Vec<f64> = items.iter().filter_map(Value::as_f64).collect();
            let norm = |x: f64, y: &f64| x.hypot(*y);
            let steps: Vec<f64> = numbers.windows(2).map(|pair| pair[1] - pair[0]).collect();
            let mut figures = json!({
                "length": items.len(),
                "norm": numbers.iter().fold(0.0, norm),
                "norm_of_steps": steps.iter().fold(0.0, norm),
            });
            shorten(&mut figures);
            *value = figures;
        }
        Value::Array(items) => items.iter_mut().for_each(shorten),
        Value::Object(fields) => fields.values_mut().for_each(shorten),
        _ => {}
    }
}

/// Paths at which two answers differ, with both values.
fn differences(path: &str, was: &Value, now: &Value, found: &mut Vec<String>) {
    match (was, now) {
        (Value::Object(a), Value::Object(b)) => {
            let names = a.keys().chain(b.keys().filter(|name| !a.contains_key(*name)));
            for name in names {
                let of = |fields: &Map<String, Value>| fields.get(name).cloned().unwrap_or(Value::Null);
                differences(&format!("{path}/{name}"), &of(a), &of(b), found);
            }
        }
        (Value::Array(a), Value::Array(b)) if a.len() == b.len() => {
            for (k, (a, b)) in a.iter().zip(b).enumerate() {
                differences(&format!("{path}/{k}"), a, b, found);
            }
        }
        (Value::Number(a), Value::Number(b)) => {
            let (x, y) = (a.as_f64().unwrap_or(f64::NAN), b.as_f64().unwrap_or(f64::NAN));
            if (x - y).abs() > TOLERANCE * x.abs().max(y.abs()) {
                found.push(format!("{path}: was {a}, is {b}"));
            }
        }
        _ if was == now => {}
        _ => found.push(format!("{path}: was {was}, is {now}")),
    }
}
