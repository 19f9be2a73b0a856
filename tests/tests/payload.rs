//! Payload of a force/torque sensor from outside: fit, diagnosis, compensation, and refusals on the command line.

use serde_json::Value;
use std::fmt::Write as _;
use std::path::Path;
use std::process::{Command, Output};
use tests::{shared_recordings, touchstone};

fn run(arguments: &[&str]) -> Output {
    Command::new(touchstone()).args(arguments).output().expect("the program starts")
}

fn json(arguments: &[&str]) -> Value {
    let output = run(&[arguments, &["--json"]].concat());
    assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).expect("one JSON object and nothing else")
}

fn sentence(arguments: &[&str]) -> String {
    let output = run(arguments);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!((output.status.code(), said.trim().lines().count()), (Some(1), 1), "{said}");
    said
}

/// A weight of 8 N at (0, 0, 0.1) m and a bias of (1, -2, 3) N, in poses that turn about x and about y by `degrees`.
///
/// Turned by a about x, the sensor sees gravity along (0, -sin a, -cos a); about y along (sin a, 0, -cos a).
fn poses(names: &str, degrees: &[f64], push_n: f64) -> String {
    let mut text = format!("{names}\n");
    for (axis, degrees) in [0, 1].into_iter().flat_map(|axis| degrees.iter().map(move |d| (axis, *d))) {
        let (sine, cosine) = degrees.to_radians().sin_cos();
        let (half, w) = (0.5 * degrees.to_radians()).sin_cos();
        let (q, down) =
            if axis == 0 { ([half, 0.0], [0.0, -sine, -cosine]) } else { ([0.0, half], [sine, 0.0, -cosine]) };
        let [x, y, z] = down.map(|d| 8.0 * d);
        // (0, 0, 0.1) × weight.
        let torque = [-0.1 * y, 0.1 * x, 0.0];
        let row = [q[0], q[1], 0.0, w, x + 1.0 + push_n, y - 2.0, z + 3.0, torque[0], torque[1], torque[2]];
        text.push_str(&row.map(|v| format!("{v:.6}")).join(","));
        text.push('\n');
    }
    text
}

const NAMES: &str =
    "ori_x,ori_y,ori_z,ori_w,fx_sensor_N,fy_sensor_N,fz_sensor_N,tx_sensor_Nm,ty_sensor_Nm,tz_sensor_Nm";
const ROUND: [f64; 5] = [0.0, 80.0, -75.0, 130.0, 170.0];

fn written(folder: &Path, name: &str, text: &str) -> String {
    let path = folder.join(name);
    std::fs::write(&path, text).expect("written");
    path.to_string_lossy().into_owned()
}

fn value(fit: &Value, name: &str) -> f64 {
    let all = fit["parameters"].as_array().expect("parameters");
    all.iter().find(|p| p["name"] == name).and_then(|p| p["value"].as_f64()).unwrap_or_else(|| panic!("{name}"))
}

#[test]
fn poses_are_told_fitted_and_removed_once() {
    let folder = tempfile::tempdir().expect("a folder");
    let log = written(folder.path(), "poses.csv", &poses(NAMES, &ROUND, 0.0));
    let fit = json(&["fit", &log]);
    assert_eq!(fit["task"], "payload");
    for (name, wanted) in [("weight_N", 8.0), ("com_z_m", 0.1), ("force_bias_y_N", -2.0), ("torque_bias_x_Nm", 0.0)] {
        assert!((value(&fit, name) - wanted).abs() < 1e-5, "{name}: {}", value(&fit, name));
    }
    let touched = written(folder.path(), "touched.csv", &poses(NAMES, &ROUND, 4.0));
    let out = folder.path().join("contact.csv").to_string_lossy().into_owned();
    let said = json(&["convert", &touched, &out, &format!("--compensate={log}")]);
    assert!((said["compensated"]["payload.weight_N"].as_f64().expect("a weight") - 8.0).abs() < 1e-5);
    let left = estimator::log::load(Path::new(&out), None).expect("a log").remove(0);
    for (name, wanted) in [("fx_sensor_N", 4.0), ("fy_sensor_N", 0.0), ("fz_sensor_N", 0.0), ("ty_sensor_Nm", 0.0)] {
        assert!(left.channel(name).expect("a column").iter().all(|v| (v - wanted).abs() < 1e-4), "{name}");
    }
    let again = folder.path().join("again.csv").to_string_lossy().into_owned();
    assert!(sentence(&["convert", &out, &again, "--compensate"]).contains("already"));
    assert!(!Path::new(&again).exists());
}

/// Rests of 0.6 s in the poses, with a noise of 6 mN and 0.6 mN m. `spoil`: changes the three forces and torques of a sample.
fn rests(spoil: impl Fn(&mut [f64])) -> String {
    let poses = poses(NAMES, &ROUND, 0.0);
    let mut text = format!("t_s,{NAMES}\n");
    for (pose, line) in poses.lines().skip(1).enumerate() {
        let cells: Vec<f64> = line.split(',').map(|cell| cell.parse().expect("a number")).collect();
        for sample in 0..60 {
            let mut row = cells.clone();
            for (axis, value) in row[4..].iter_mut().enumerate() {
                let wobble = ((37 * sample + 5 * axis) % 11) as f64 - 5.0;
                *value += if axis < 3 { 2e-3 } else { 2e-4 } * wobble;
            }
            spoil(&mut row[4..]);
            let row: Vec<String> = row.iter().map(|v| format!("{v:.6}")).collect();
            let _ = writeln!(text, "{:.2},{}", 0.01 * (60 * pose + sample) as f64, row.join(","));
        }
    }
    text
}

#[test]
fn torques_that_do_not_belong_to_the_load_are_told_and_forces_at_a_limit_are_left_out() {
    let folder = tempfile::tempdir().expect("a folder");
    let fit = |name: &str, text: String| json(&["fit", &written(folder.path(), name, &text)]);
    let is_told = |fit: &Value| fit["warnings"].to_string().contains("of the torque");
    let sound = fit("sound.csv", rests(|_| {}));
    assert!(!is_told(&sound) && (value(&sound, "weight_N") - 8.0).abs() < 0.01, "{sound}");
    let swapped = fit("swapped.csv", rests(|wrench| wrench.swap(3, 4)));
    assert!(is_told(&swapped), "{}", swapped["warnings"]);
    let limited = fit("limited.csv", rests(|wrench| wrench[2] = wrench[2].min(10.0)));
    assert!((value(&limited, "weight_N") - 8.0).abs() < 0.01, "{limited}");
}

#[test]
fn two_orientations_show_no_error_and_no_weight() {
    let folder = tempfile::tempdir().expect("a folder");
    let log = written(folder.path(), "two.csv", &poses(NAMES, &[30.0], 0.01));
    let fit = json(&["fit", &log]);
    let weight = fit["parameters"].as_array().expect("parameters").iter().find(|p| p["name"] == "weight_N");
    assert_eq!(weight.expect("reported")["identified"], false, "{fit}");
}

/// The entries that a doubt about the orientation states lead to the weight.
#[test]
fn a_transposed_matrix_is_told_with_the_entries_that_mend_it() {
    let names = "r11,r12,r13,r21,r22,r23,r31,r32,r33,fx_sensor_N,fy_sensor_N,fz_sensor_N";
    let mut text = format!("{names}\n");
    for row in poses(NAMES, &ROUND, 0.0).lines().skip(1) {
        let v: Vec<f64> = row.split(',').map(|cell| cell.parse().expect("a number")).collect();
        let [x, y, w] = [v[0], v[1], v[3]];
        // Of a turn about x or y; from the base to the sensor.
        let matrix = [
            [1.0 - 2.0 * y * y, 0.0, -2.0 * y * w],
            [0.0, 1.0 - 2.0 * x * x, 2.0 * x * w],
            [2.0 * y * w, -2.0 * x * w, 1.0 - 2.0 * (x * x + y * y)],
        ];
        let cells = matrix.concat().into_iter().chain(v[4..7].iter().copied());
        text.push_str(&cells.map(|v| format!("{v:.6}")).collect::<Vec<_>>().join(","));
        text.push('\n');
    }
    let folder = tempfile::tempdir().expect("a folder");
    let log = written(folder.path(), "poses.csv", &text);
    let said = json(&["fit", &log])["warnings"][0].as_str().expect("a doubt").to_owned();
    let entries = said.split_once("(\"columns\": ").and_then(|(_, rest)| rest.split_once(')')).expect("entries").0;
    written(folder.path(), "poses.meta.json", &format!("{{\"columns\": {entries}}}"));
    let fit = json(&["fit", &log]);
    assert!((value(&fit, "weight_N") - 8.0).abs() < 1e-4, "{fit}");
}

/// A sensor that states the opposite of force and torque.
#[test]
fn a_reversed_sensor_is_told_with_all_of_its_columns() {
    let folder = tempfile::tempdir().expect("a folder");
    let log = written(folder.path(), "poses.csv", &poses(NAMES, &ROUND, 0.0));
    let signs = |sign: i8| {
        let names = NAMES.split(',').skip(4).map(|name| format!("\"{name}\": {sign}"));
        format!("{{\"sign\": {{{}}}}}", names.collect::<Vec<_>>().join(", "))
    };
    written(folder.path(), "poses.meta.json", &signs(-1));
    let fit = json(&["fit", &log]);
    assert!(value(&fit, "weight_N") < -7.0 && fit["warnings"].to_string().contains("its six columns"), "{fit}");
}

#[test]
fn what_changed_is_named_and_one_orientation_leaves_it_open() {
    let folder = tempfile::tempdir().expect("a folder");
    let first = written(folder.path(), "first.csv", &poses(NAMES, &ROUND, 0.0));
    let moved = written(folder.path(), "moved.csv", &poses(NAMES, &[10.0, 70.0, -60.0, 120.0, 160.0], 1.5));
    let found = json(&["diagnose", &first, &moved]);
    assert_eq!((&found["verdict"], &found["causes"][0]["id"]), (&"causes".into(), &"force-bias".into()));
    assert_eq!(found["causes"].as_array().map(Vec::len), Some(1), "{found}");
    let shown = found["causes"][0]["parameters"][0].clone();
    assert!(shown["name"] == "force_bias_x_N" && (shown["value"].as_f64().expect("a change") - 1.5).abs() < 1e-4);
    let one = written(folder.path(), "one.csv", &poses(NAMES, &[0.0], 0.0));
    assert_eq!(json(&["diagnose", &one])["verdict"], "ambiguous");
}

#[test]
fn statements_that_cannot_be_are_refused_or_doubted() {
    let folder = tempfile::tempdir().expect("a folder");
    let log = written(folder.path(), "poses.csv", &poses(NAMES, &ROUND, 0.0));
    let out = folder.path().join("out.csv").to_string_lossy().into_owned();
    let meta = |text: &str| written(folder.path(), "poses.meta.json", text);
    meta(r#"{"wrench_frame": "tool"}"#);
    assert!(sentence(&["fit", &log]).contains("wrench_frame is the text \"tool\""));
    meta(r#"{"wrench_frame": "base"}"#);
    assert!(sentence(&["fit", &log]).contains("fx_sensor_N"));
    meta(r#"{"task": "crank"}"#);
    assert!(!run(&["fit", &log]).status.success());
    meta("{}");
    assert!(
        sentence(&["record", "--task", "payload", "--operator", "scripted", "--seconds", "1", "--out", &out])
            .contains("no world to record it in")
    );
    let slide = written(folder.path(), "slide.csv", "t_s,q_m,f_N\n0,0,1\n0.1,0.1,1\n0.2,0.3,1\n");
    assert!(sentence(&["convert", &slide, &out, "--compensate"]).contains("has no orientation"));
    let long = poses(NAMES, &ROUND, 0.0).replacen("0.000000,0.000000,0.000000,1.000000", "0.5,0,0,1", 1);
    let said = json(&["info", &written(folder.path(), "long.csv", &long)]);
    assert!(said["warnings"].to_string().contains("instead of 1"), "{said}");
}

#[test]
fn a_tool_that_wipes_is_no_payload_by_its_columns() {
    let sidecar = r#"{"columns":{"trial":"demo","t_s":"time_s"}}"#;
    let Some(wiping) = shared_recordings("wiping_segments/demos.csv", sidecar) else {
        println!("skipped: the wiping recordings are not here");
        return;
    };
    for recording in &wiping {
        let task = estimator::segment::task_of(recording, None).expect("a task");
        assert_eq!(task, haptics::recording::Task::Mechanism, "{}", recording.name);
        // Stated all the same, it is doubted.
        let fit = estimator::identify::payload::fit(recording).expect("a fit");
        assert!(
            fit.warnings.iter().any(|w| w.contains("doubtful") || w.contains("do not follow")),
            "{:?}",
            fit.warnings
        );
    }
    let cubes = shared_recordings("cube_toss/tosses.csv", r#"{"columns":{"trial":"toss"},"up":"z"}"#).expect("cubes");
    assert!(cubes.iter().all(|cube| !estimator::signal::wrench::is_payload(cube)));
}
