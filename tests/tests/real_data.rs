//! Real measurements: published values must come back. The data are not part of this repository; they are looked for in
//! `../shared/data` beside the workspace, and each test says so when they are absent.

use estimator::estimate::Fit;
use estimator::identify::mechanism;
use estimator::log;
use haptics::recording::{Meta, Recording};
use std::path::PathBuf;

/// The file, or `None` with a visible word.
fn data(path: &str) -> Option<PathBuf> {
    let file = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../shared/data").join(path);
    if file.is_file() {
        return Some(file);
    }
    println!("skipped: {path} is not beside the workspace");
    None
}

fn load(path: &str, meta: &str) -> Option<Vec<Recording>> {
    let meta: Meta = serde_json::from_str(meta).expect("a sidecar");
    Some(log::load_with_meta(&data(path)?, &meta).expect("real data load"))
}

fn value(fit: &Fit, name: &str) -> f64 {
    let parameter = fit.parameter("mechanism", name).expect("listed");
    println!("{name}: {:?} ± {:?}", parameter.value, parameter.std_error);
    parameter.value.expect("identified")
}

fn near(got: f64, published: f64, relative: f64) {
    assert!((got / published - 1.0).abs() < relative, "{got} against the published {published}");
}

const EMPS: &str = r#"{"columns":{"t_s":"time_s","q_m":"position_m","f_N":"force_N"}}"#;

/// Janot, Gautier, Brunot 2019: M 95.1089 kg, Fv 203.5034 N s/m, Fc 20.3935 N, offset −3.1648 N, relative error 4.08 %.
#[test]
fn emps_gives_the_published_parameters_from_positions_only() {
    let Some(recordings) = load("emps/emps_identification.csv", EMPS) else { return };
    assert!(recordings[0].warnings.is_empty(), "{:?}", recordings[0].warnings);
    let fit = mechanism::fit(&recordings).expect("fits");
    near(value(&fit, "mass_kg"), 95.1089, 0.01);
    near(value(&fit, "viscous_N_s_m"), 203.5034, 0.01);
    near(value(&fit, "coulomb_N"), 20.3935, 0.01);
    near(value(&fit, "offset_N"), -3.1648, 0.05);
    let quality = fit.quality.expect("a held-out figure");
    println!("{quality:?} {:?}", fit.warnings);
    assert!(quality.heldout_relative < 0.05, "{quality:?}");
}

#[test]
fn real_recordings_raise_no_false_warnings() {
    let sidecars = [
        ("cube_toss/tosses.csv", r#"{"columns":{"trial":"toss"}}"#),
        (
            "davinci_tool/tool_runs.csv",
            r#"{"columns":{"trial":"run","q_rad":"spindle_angle_rad","tau_Nm":"spindle_torque_Nm"}}"#,
        ),
        (
            "double_pendulum/excitation_C1.csv",
            r#"{"columns":{"trial":"run","q_rad":"q1_rad","tau_Nm":"torque1_measured_Nm"}}"#,
        ),
        ("articulated_paths/paths.csv", r#"{"select":{"mechanism":"drawer"}}"#),
        (
            "cabinet_pull/kitchen_cabinet_run1.csv",
            r#"{"columns":{"x_m":"tip_x_m","y_m":"tip_y_m","z_m":"tip_z_m","fx_N":"fx_wrist_sensor_N","fy_N":"fy_wrist_sensor_N","fz_N":"fz_wrist_sensor_N"}}"#,
        ),
    ];
    for (path, meta) in sidecars {
        let Some(recordings) = load(path, meta) else { continue };
        for recording in &recordings {
            let doubtful: Vec<_> = recording
                .warnings
                .iter()
                .filter(|w| !["no-clock", "columns", "text-column"].contains(&w.kind.as_str()))
                .collect();
            assert!(doubtful.is_empty(), "{}: {doubtful:?}", recording.name);
        }
    }
}
