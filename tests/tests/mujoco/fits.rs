//! Logs of things with known parameters, made in MuJoCo: what is fitted beside what they were made of, and what the fitted world
//! answers to the same motion.

use super::table::{Row, Table, figure};
use estimator::estimate::Fit;
use estimator::log;
use estimator::pipeline::{Analysis, Options, analyse};
use estimator::simulate::{Simulation, simulate};
use haptics::recording::Recording;
use serde_json::Value;
use tempfile::TempDir;

/// Logs and, in a folder of its own, what they were made of.
pub struct Made {
    logs: TempDir,
    truth: TempDir,
}

/// What MuJoCo's own contacts do to a width or a height beyond the error that a fit can know, m: its surfaces sink into each
/// other by some micrometres under a finger's force, ours are rigid beside the pads.
const SINKING_M: f64 = 20e-6;
/// Share of a coefficient by which MuJoCo's cubes slide more easily than it says: its contacts give while they hold, and a cube that
/// slaps down slides before they hold fully.
const SLIDES_EASIER: f64 = 0.03;
/// A found value is met within so many of its standard errors.
#[derive(Clone, Copy)]
pub struct Within {
    /// Standard errors of what is fitted.
    errors: f64,
    /// How many times the bounds of replays.
    replays: f64,
}

/// On the seed of the tables, which is always the same.
pub const KNOWN: Within = Within { errors: 3.5, replays: 1.0 };
/// On a seed that nobody has seen, of some that come every day: no test may fail by luck.
pub const UNSEEN: Within = Within { errors: 5.0, replays: 1.5 };

/// The seed of the tables.
pub const SEED: u64 = 20_261_122;

/// Makes the logs of a seed; `None` where MuJoCo is missing.
pub fn made(seed: u64) -> Option<Made> {
    let made = Made { logs: tempfile::tempdir().expect("a folder"), truth: tempfile::tempdir().expect("a folder") };
    let text = |folder: &TempDir| folder.path().to_str().expect("a plain path").to_owned();
    let seed = ("TOUCHSTONE_MUJOCO_SEED", seed.to_string());
    tests::python::output_with("tests/mujoco/make_logs.py", &[&text(&made.logs), &text(&made.truth)], &[seed])?;
    Some(made)
}

/// A log and what was fitted to it.
pub fn analysed(made: &Made, name: &str) -> (Vec<Recording>, Analysis) {
    let path = made.logs.path().join(format!("{name}.csv"));
    let recordings = log::load(&path, None).expect("MuJoCo's log is read");
    let analysis = analyse(&recordings, &Options::default()).expect("and fitted");
    (recordings, analysis)
}

/// What the logs were made of: only this assertion reads it.
fn truth(made: &Made) -> Value {
    let text = std::fs::read_to_string(made.truth.path().join("truth.json")).expect("the truth was written");
    serde_json::from_str(&text).expect("it is JSON")
}

/// Every parameter that MuJoCo was given, beside what was found.
pub fn found(made: &Made, within: Within) -> Table {
    let truth = truth(made);
    let mut rows = Vec::new();
    for (log, objects) in truth.as_object().expect("logs").iter().filter(|(_, objects)| objects.is_object()) {
        let (_, analysis) = analysed(made, log);
        let parameters = objects.as_object().expect("objects").iter();
        for (object, values) in parameters.filter(|(object, _)| *object != "constraint") {
            for (name, value) in values.as_object().expect("parameters") {
                let made_with = value.as_f64().expect("a number");
                rows.push(compared(&analysis.fit, (log, object, name), (made_with, within)));
            }
        }
        if let Some(direction) = objects.get("constraint") {
            rows.push(along(&analysis.fit, log, direction));
        }
    }
    Table { head: vec!["log", "object", "parameter", "made with", "found", "off by"], rows }
}

fn compared(fit: &Fit, (log, object, name): (&str, &str, &str), (made_with, within): (f64, Within)) -> Row {
    let found = fit.parameter(object, name).and_then(|p| p.value.zip(p.std_error));
    let (value, error) = found.unwrap_or((f64::NAN, 0.0));
    // Which way along the slope counts as positive is the fit's choice.
    let value = if name == "offset_N" { value.abs() } else { value };
    let margin = match name {
        "width_m" | "height_m" => SINKING_M,
        "friction" if object == "body" => SLIDES_EASIER * made_with,
        _ => 0.0,
    };
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
        tolerance: within.errors * error + margin,
        per: error,
        places: 1,
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
        per: 1.0,
        places: 6,
    }
}

/// What a replay is judged by.
#[derive(Clone, Copy)]
enum Judged {
    /// Channels whose names begin so, N RMS of the worst one.
    Channels(&'static str),
    /// Where a law says what the force is: without standing still, where friction may be anything up to its limit. As a share of the dry
    /// friction, which is what a reversal turns over.
    Determined,
}

/// How far the fitted worlds' answer to the recorded motion may be from the recorded force; why, in the document.
const REPLAYS: [(&str, &str, Judged, f64); 5] = [
    ("blocks", "4 channels", Judged::Channels(""), 0.07),
    ("crank", "4 channels", Judged::Channels(""), 0.02),
    ("pinch", "what presses", Judged::Channels("fx"), 0.08),
    ("pinch", "what slips", Judged::Channels("fy"), 0.20),
    ("slope", "while it moves, share of the dry friction", Judged::Determined, 0.20),
];

/// The measured motion of every log through the world that was fitted to it.
pub fn replayed(made: &Made, within: Within) -> Table {
    let mut rows = Vec::new();
    for (name, what, judged, tolerance) in REPLAYS {
        let (recordings, analysis) = analysed(made, name);
        let simulation = simulate(&analysis.world, &recordings[0]).expect("it is replayed");
        let found = match judged {
            Judged::Channels(begins) => worst(&simulation, begins),
            Judged::Determined => {
                let part = simulation.part.as_ref().and_then(|part| part.rms_n).unwrap_or(f64::NAN);
                let dry = analysis.fit.parameter("mechanism", "coulomb_N").and_then(|p| p.value);
                part / dry.expect("its friction was found")
            }
        };
        rows.push(row((name, what), &simulation, (found, within.replays * tolerance)));
    }
    let head = vec!["log", "judged by", "largest force, N", "off by, N RMS", "may be"];
    Table { head, rows }
}

/// Of the channels whose names begin so, the worst one's residual; not a number where there is none.
fn worst(simulation: &Simulation, begins: &str) -> f64 {
    let of = simulation.residual_rms.iter().filter(|(name, _)| name.starts_with(begins)).map(|(_, rms)| *rms);
    of.fold(f64::NAN, f64::max)
}

fn row((log, what): (&str, &str), simulation: &Simulation, (found, tolerance): (f64, f64)) -> Row {
    let values = simulation.predicted.iter().flat_map(|channel| channel.values.iter());
    let most = values.fold(0.0_f64, |most, value| most.max(value.abs()));
    Row {
        labels: vec![log.to_owned(), what.to_owned()],
        shown: vec![format!("{most:.2}"), format!("{found:.4}"), format!("{tolerance}")],
        found,
        wanted: 0.0,
        tolerance,
        per: 1.0,
        places: 3,
    }
}
