//! Real measurements: published values must come back. The data are not part of this repository; they are looked for in
//! `../shared/data` beside the workspace, and each test says so when they are absent.

use estimator::constraint;
use estimator::estimate::{ConstraintKind, Fit};
use estimator::identify::mechanism;
use estimator::log;
use haptics::recording::{Meta, Recording, Span, Warning};
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
                .filter(|w| !is_true(recording, w))
                .collect();
            assert!(doubtful.is_empty(), "{}: {doubtful:?}", recording.name);
        }
    }
}

/// What real recordings do have, seen without the program's own criteria: the torque of the double pendulum moves in steps of
/// 5.86 mNm; the tracker of the drawers and the sensors of the cabinet gave some rows twice, in three and in six noisy channels.
fn is_true(recording: &Recording, warning: &Warning) -> bool {
    const PROGRAM: [&str; 6] = ["x_m", "y_m", "z_m", "fx_N", "fy_N", "fz_N"];
    let repeated = |span: &Span| {
        let channels = || recording.channels.iter().filter(|c| PROGRAM.contains(&c.name.as_str()));
        let moves_around = |values: &[f64]| {
            let around = &values[span.first.saturating_sub(6)..(span.end + 5).min(values.len())];
            around.windows(2).filter(|w| w[0] != w[1]).count() * 2 > around.len()
        };
        channels().count() >= 3
            && channels().all(|c| (span.first..span.end).all(|i| c.values[i] == c.values[i - 1]))
            && channels().filter(|c| moves_around(&c.values)).count() >= 3
    };
    match warning.kind.as_str() {
        "quantised" => {
            let values = warning.column.as_deref().and_then(|name| recording.channel(name)).unwrap_or_default();
            let mut sorted = values.to_vec();
            sorted.sort_unstable_by(f64::total_cmp);
            let mut usual = sorted[sorted.len() / 20..sorted.len() - sorted.len() / 20].to_vec();
            usual.dedup();
            (2..32).contains(&usual.len())
        }
        "duplicate-samples" => warning.spans.iter().all(repeated),
        _ => false,
    }
}

const CABINET: &str = r#"{"columns":{"x_m":"tip_x_m","y_m":"tip_y_m","z_m":"tip_z_m","fx_N":"fx_wrist_sensor_N","fy_N":"fy_wrist_sensor_N","fz_N":"fz_wrist_sensor_N"}}"#;

/// The radius over the whole run, m: what the halves and quarters must not contradict.
const CABINET_RADIUS_M: f64 = 0.3005;

fn cabinet() -> Option<Recording> {
    load("cabinet_pull/kitchen_cabinet_run1.csv", CABINET).map(|mut r| r.remove(0))
}

#[test]
fn the_cabinet_is_a_door_and_its_radius_comes_with_an_interval() {
    let Some(run) = cabinet() else { return };
    let found = constraint::detect_in(&run).expect("a tool path");
    println!("{found:#?}");
    assert_eq!(found.kind, ConstraintKind::Revolute);
    assert!((found.radius_m.expect("a radius") - CABINET_RADIUS_M).abs() < 0.003);
    let (low, high) = found.radius_interval_m.expect("an interval");
    assert!(low < CABINET_RADIUS_M && high.is_some_and(|h| h > CABINET_RADIUS_M));
    let fit = mechanism::fit(std::slice::from_ref(&run)).expect("a clockless log still shows its constraint");
    assert!(fit.constraints.len() == 1 && fit.parameters.iter().all(|p| !p.identified));
}

#[test]
fn intervals_on_parts_of_the_cabinet_run_hold_the_radius() {
    let Some(run) = cabinet() else { return };
    let n = run.len();
    let mut parts = vec![("first quarter".to_owned(), run.slice(Span { first: 0, end: n / 4 }))];
    for (name, a, b) in [
        ("first third", 0.0, 0.333),
        ("first half", 0.0, 0.5),
        ("second half", 0.5, 1.0),
        ("middle third", 0.333, 0.667),
        ("middle half", 0.25, 0.75),
        ("second quarter", 0.25, 0.5),
        ("third quarter", 0.5, 0.75),
        ("last quarter", 0.75, 1.0),
        ("last third", 0.667, 1.0),
    ] {
        let span = Span { first: (a * n as f64) as usize, end: (b * n as f64) as usize };
        parts.push((name.to_owned(), run.slice(span)));
    }
    for every in [2, 5, 10, 20] {
        let mut thin = run.clone();
        for channel in &mut thin.channels {
            channel.values = channel.values.iter().copied().step_by(every).collect();
        }
        parts.push((format!("every {every}th"), thin));
    }
    for (name, part) in parts {
        let found = constraint::detect_in(&part).expect("a tool path");
        println!("{name}: {:?} R {:?} in {:?}", found.kind, found.radius_m, found.radius_interval_m);
        assert!(matches!(found.kind, ConstraintKind::Revolute | ConstraintKind::Undecided), "{name}");
        let (low, high) = found.radius_interval_m.expect("an interval");
        assert!(low <= CABINET_RADIUS_M && high.is_none_or(|h| h >= CABINET_RADIUS_M), "{name}");
    }
}

#[test]
fn doors_turn_and_drawers_slide() {
    let known = [
        ("dishwasher", ConstraintKind::Revolute),
        ("left_door", ConstraintKind::Revolute),
        ("right_door", ConstraintKind::Revolute),
        ("cabinet_one", ConstraintKind::Revolute),
        ("drawer", ConstraintKind::Prismatic),
        ("drawer_one", ConstraintKind::Prismatic),
        ("sliding_cabinet", ConstraintKind::Prismatic),
    ];
    for (name, kind) in known {
        let meta = format!(r#"{{"select":{{"mechanism":"{name}"}}}}"#);
        let meta: Meta = serde_json::from_str(&meta).expect("a sidecar");
        let Some(path) = data("articulated_paths/paths.csv") else { return };
        let Ok(trials) = log::load_with_meta(&path, &meta) else {
            println!("skipped: {name} is not in this copy of the data");
            continue;
        };
        let (mut decided, mut parts_decided, mut parts) = (0, 0, 0);
        for trial in &trials {
            let found = constraint::detect_in(trial).expect("a tool path");
            println!(
                "{}: {:?} R {:?} {:?} {}",
                trial.name, found.kind, found.radius_m, found.radius_interval_m, found.evidence
            );
            assert!(found.kind == kind || found.kind == ConstraintKind::Undecided, "{name} {:?}", trial.trial);
            decided += usize::from(found.kind == kind);
            let n = trial.len();
            for (first, end) in
                [(0, n / 2), (n / 2, n), (0, n / 4), (n / 4, n / 2), (n / 2, 3 * n / 4), (3 * n / 4, n), (0, n / 8)]
            {
                let part = constraint::detect_in(&trial.slice(Span { first, end })).expect("a tool path");
                let fine = part.kind == kind || part.kind == ConstraintKind::Undecided;
                assert!(fine, "{name} {:?} {first}..{end}: {part:?}", trial.trial);
                parts += 1;
                parts_decided += usize::from(part.kind == kind);
            }
        }
        println!("{name}: {parts_decided} of {parts} parts decided");
        println!("{name}: {decided} of {} decided", trials.len());
        assert!(2 * decided > trials.len(), "{name}: {decided} of {}", trials.len());
    }
}

/// The authors of EMPS add friction by direction to inertia, viscous and Coulomb friction, and nothing else.
#[test]
fn emps_is_diagnosed_from_its_mass_alone() {
    let Some(recordings) = load("emps/emps_identification.csv", EMPS) else { return };
    let options = estimator::diagnose::Options { baseline: Some("mass".to_owned()), ..Default::default() };
    let found = estimator::diagnose::diagnose(&recordings, &options).expect("a force along a coordinate");
    let ids: Vec<&str> = found.causes.iter().map(|c| c.id.as_str()).collect();
    println!("{ids:?}, {:.2} N unexplained of {:.2} N", found.end.heldout_rms_n, found.baseline.heldout_rms_n);
    // Coulomb friction explains a little more by itself than viscous friction does; what depends on the direction comes last.
    assert!(ids[..2].contains(&"viscous-friction") && ids[..2].contains(&"coulomb-friction"), "{ids:?}");
    assert_eq!(ids[2], "friction-asymmetry", "{ids:?}");
    assert!(!ids.contains(&"position-ripple") && !ids.contains(&"time-delay"), "{ids:?}");
    for cause in &found.causes[..3] {
        assert!(
            cause.gain.share_of_explainable > 0.9 && cause.gain.interval[0] > 0.5,
            "{}: {:?}",
            cause.id,
            cause.gain
        );
    }
    // Half the difference of the published viscous friction by direction: (166.7 − 240.4)/2.
    let dc = found.causes[2].parameters[0].value;
    assert!((dc + 36.9).abs() < 5.0, "{dc}");
}
