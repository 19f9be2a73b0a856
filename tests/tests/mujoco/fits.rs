//! Logs of things with known parameters, made in MuJoCo: what is fitted beside what they were made of, and what the fitted world
//! answers to the same motion.

use super::table::{Row, Table, figure};
use estimator::estimate::Fit;
use estimator::log;
use estimator::pipeline::{Analysis, Options, analyse};
use estimator::simulate::{Simulation, simulate};
use haptics::recording::Recording;
use haptics::world::World;
use serde_json::Value;
use std::path::Path;
use tempfile::TempDir;

/// Logs and, in a folder of its own, what they were made of.
pub struct Made {
    logs: TempDir,
    truth: TempDir,
}

/// What MuJoCo's own contacts do to a width or a height beyond the error that a fit can know, m: its surfaces sink into each
/// other by some micrometres under a finger's force, ours are rigid beside the pads.
const SINKING_M: f64 = 20e-6;
/// A found value is met within so many of its standard errors: with some twenty values, 3 would be missed in one run of twenty.
const ERRORS: f64 = 3.5;

/// Makes the logs; `None` where MuJoCo is missing.
pub fn made() -> Option<Made> {
    let made = Made { logs: tempfile::tempdir().expect("a folder"), truth: tempfile::tempdir().expect("a folder") };
    let text = |folder: &TempDir| folder.path().to_str().expect("a plain path").to_owned();
    tests::python::output_of("tests/mujoco/make_logs.py", &[&text(&made.logs), &text(&made.truth)])?;
    Some(made)
}

fn analysed(folder: &Path, name: &str) -> (Vec<Recording>, Analysis) {
    let recordings = log::load(&folder.join(format!("{name}.csv")), None).expect("MuJoCo's log is read");
    let analysis = analyse(&recordings, &Options::default()).expect("and fitted");
    (recordings, analysis)
}

/// What the logs were made of: only this assertion reads it.
fn truth(made: &Made) -> Value {
    let text = std::fs::read_to_string(made.truth.path().join("truth.json")).expect("the truth was written");
    serde_json::from_str(&text).expect("it is JSON")
}

/// Every parameter that MuJoCo was given, beside what was found.
pub fn found(made: &Made) -> Table {
    let truth = truth(made);
    let mut rows = Vec::new();
    for (log, objects) in truth.as_object().expect("logs").iter().filter(|(_, objects)| objects.is_object()) {
        let (_, analysis) = analysed(made.logs.path(), log);
        let parameters = objects.as_object().expect("objects").iter();
        for (object, values) in parameters.filter(|(object, _)| *object != "constraint") {
            for (name, value) in values.as_object().expect("parameters") {
                rows.push(compared(&analysis.fit, (log, object, name), value.as_f64().expect("a number")));
            }
        }
        if let Some(direction) = objects.get("constraint") {
            rows.push(along(&analysis.fit, log, direction));
        }
    }
    Table { head: vec!["log", "object", "parameter", "made with", "found", "off by"], rows }
}

fn compared(fit: &Fit, (log, object, name): (&str, &str, &str), made_with: f64) -> Row {
    let found = fit.parameter(object, name).and_then(|p| p.value.zip(p.std_error));
    let (value, error) = found.unwrap_or((f64::NAN, 0.0));
    // Which way along the slope counts as positive is the fit's choice.
    let value = if name == "offset_N" { value.abs() } else { value };
    let sinking = if name.ends_with("width_m") || name.ends_with("height_m") { SINKING_M } else { 0.0 };
    let unknown =
        format!("**not found**: {}", fit.parameter(object, name).map_or("no such parameter", |p| p.how.as_str()));
    let shown = match found {
        Some(_) => vec![
            figure(made_with, error),
            format!("{} ± {}", figure(value, error), figure(error, error)),
            format!("{:.1} errors", (value - made_with) / error),
        ],
        None => vec![made_with.to_string(), unknown, "–".to_owned()],
    };
    Row {
        labels: [log, object, name].map(str::to_owned).to_vec(),
        shown,
        found: value,
        wanted: made_with,
        tolerance: ERRORS * error + sinking,
    }
}

/// The direction of a line, as the angle between that and the one it was made with.
fn along(fit: &Fit, log: &str, direction: &Value) -> Row {
    let made_with = ["direction_x", "direction_y"].map(|name| direction[name].as_f64().expect("a number"));
    let found = fit.constraints.first().and_then(|c| c.direction.clone()).unwrap_or_default();
    let [x, y] = [0, 1].map(|k| found.get(k).copied().unwrap_or(f64::NAN));
    let off_rad = (made_with[0] * y - made_with[1] * x).asin();
    Row {
        labels: [log, "constraint", "direction"].map(str::to_owned).to_vec(),
        shown: vec![
            "a line".to_owned(),
            fit.constraints.first().map_or("none", |_| "a line").to_owned(),
            format!("{:.1e} rad", off_rad.abs()),
        ],
        found: off_rad,
        wanted: 0.0,
        tolerance: 1e-3,
    }
}

/// How far the worlds' answer to the recorded motion may be from the recorded force, N, RMS of a channel; why, in the document.
const REPLAYS: [(&str, f64); 4] = [("blocks", 0.06), ("crank", 0.02), ("pinch", 0.10), ("slope", 0.30)];
/// The same of the forces that press on what slips, which do not depend on how far it slips.
const PRESSED: (&str, f64) = ("pinch", 0.06);

/// The measured motion of every log through the world that was fitted to it.
///
/// How far a block slips shows when it is put down, and hangs on micrometres of its width: the world of MuJoCo's own width and friction leaves 0.13 N
/// there, and the sensors' noise moves that between 0.05 and 0.13 N. What slips is therefore replayed within the width's stated error as well.
pub fn replayed(made: &Made) -> Table {
    let mut rows = Vec::new();
    for (name, tolerance) in REPLAYS {
        let (recordings, analysis) = analysed(made.logs.path(), name);
        let replay = |world: &World| simulate(world, &recordings[0]).expect("it is replayed");
        let fitted = replay(&analysis.world);
        let slips = (name == PRESSED.0).then(|| within_error(&analysis).into_iter().map(|world| replay(&world)));
        let all = slips.into_iter().flatten().chain([fitted.clone()]);
        let best = all.map(|s| worst(&s, "")).fold(f64::INFINITY, f64::min);
        rows.push(row(name, &format!("{} channels", fitted.residual_rms.len()), &fitted, (best, tolerance)));
        if name == PRESSED.0 {
            rows.push(row(name, "what presses", &fitted, (worst(&fitted, "fx"), PRESSED.1)));
        }
    }
    let head = vec!["log", "replayed", "largest force, N", "worst channel off by, N RMS", "may be, N RMS"];
    Table { head, rows }
}

/// Worlds whose first block is as much narrower and wider as its width may be off.
fn within_error(analysis: &Analysis) -> [World; 2] {
    let error = analysis.fit.parameter("block-1", "width_m").and_then(|p| p.std_error).expect("a width with its error");
    [-error, error].map(|more| {
        let mut world = analysis.world.clone();
        world.blocks[0].width_m += more;
        world
    })
}

/// Of the channels whose names begin so, the worst one's residual; not a number where there is none.
fn worst(simulation: &Simulation, begins: &str) -> f64 {
    let of = simulation.residual_rms.iter().filter(|(name, _)| name.starts_with(begins)).map(|(_, rms)| *rms);
    of.fold(f64::NAN, f64::max)
}

fn row(log: &str, what: &str, simulation: &Simulation, (found, tolerance): (f64, f64)) -> Row {
    let values = simulation.predicted.iter().flat_map(|channel| channel.values.iter());
    let most = values.fold(0.0_f64, |most, value| most.max(value.abs()));
    Row {
        labels: vec![log.to_owned(), what.to_owned()],
        shown: vec![format!("{most:.2}"), format!("{found:.4}"), format!("{tolerance}")],
        found,
        wanted: 0.0,
        tolerance,
    }
}
