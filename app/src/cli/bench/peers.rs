//! Other programs at the same work in the same run. The scripts in `benches/` build this program's side from the same
//! sources.

use super::table::{Figure, Peer, Wanted};
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Script, with the subject of its measurement and the conversion of its rows to figures.
struct Script {
    file: &'static str,
    figures: fn(&Value) -> Vec<Figure>,
}

const SCRIPTS: [Script; 4] = [
    Script { file: "peers.py", figures: of_scenes },
    Script { file: "logs.py", figures: of_logs },
    Script { file: "hmm.py", figures: of_decoding },
    Script { file: "refit.py", figures: of_refits },
];

/// Folder of the scripts, if the sources still exist.
fn folder() -> Option<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../benches");
    folder.is_dir().then_some(folder)
}

/// Python interpreter: the value of `TOUCHSTONE_PYTHON`, or `python3`.
fn python() -> PathBuf {
    std::env::var_os("TOUCHSTONE_PYTHON").map_or_else(|| "python3".into(), PathBuf::from)
}

/// Runs every script; an unavailable one becomes a sentence among `skipped`.
pub(super) fn all(quick: bool, skipped: &mut Vec<String>) -> Vec<Figure> {
    let Some(folder) = folder() else {
        skipped.push("other programs: the scripts in benches/ are not there; build from the sources".to_owned());
        return Vec::new();
    };
    let mut figures = Vec::new();
    for script in &SCRIPTS {
        match run(&folder.join(script.file), quick) {
            Ok(said) => figures.extend((script.figures)(&said)),
            Err(why) => skipped.push(format!("benches/{}: {why}", script.file)),
        }
    }
    figures
}

/// JSON output of a script; its last line of text as the error if there is none.
fn run(script: &Path, quick: bool) -> Result<Value, String> {
    let out = tempfile::NamedTempFile::new().map_err(|error| error.to_string())?;
    let mut command = Command::new(python());
    command.arg(script).arg("--out").arg(out.path()).args(quick.then_some("--quick"));
    let done = command.output().map_err(|error| format!("{} cannot be started ({error})", python().display()))?;
    let text = std::fs::read_to_string(out.path()).unwrap_or_default();
    serde_json::from_str(&text).map_err(|_| {
        let said = [done.stdout, done.stderr].map(|bytes| String::from_utf8_lossy(&bytes).trim().to_owned()).join("\n");
        said.trim().lines().last().unwrap_or("it said nothing").to_owned()
    })
}

fn rows(said: &Value) -> impl Iterator<Item = &Value> {
    said["rows"].as_array().map_or(&[][..], Vec::as_slice).iter()
}

fn figure(name: String, unit: &str, ours: f64, peer: (&str, f64), times: f64, least: Option<f64>) -> Figure {
    let (name_of_peer, value) = (peer.0.to_owned(), peer.1);
    let peer = Some(Peer { name: name_of_peer, value, times_as_fast: times });
    Figure { wanted: least.map(Wanted::TimesAsFast), peer, ..Figure::new(name, ours, unit) }
}

/// Scenes with a target: minimum speed-up, and maximum duration, µs.
const TICKS: [(&str, Option<f64>, f64); 3] =
    [("pinch", Some(12.0), 0.7), ("crank", Some(10.0), 0.3), ("towers", None, 50.0)];
/// Maximum sinking of a held block in ten minutes, mm.
const CREEP_MM: f64 = 0.1;

fn of_scenes(said: &Value) -> Vec<Figure> {
    let mut made: Vec<Figure> = Vec::new();
    for row in rows(said).filter(|row| row["mujoco_options"] == "default") {
        let number = |key: &str| row[key].as_f64();
        let (Some(label), Some(scene), Some(ours_ns), Some(theirs_ns), Some(times)) = (
            row["label"].as_str(),
            row["scene"].as_str(),
            number("ours_best_ns"),
            number("mujoco_best_ns"),
            row["ratio"]["median"].as_f64(),
        ) else {
            continue;
        };
        let wanted = TICKS.iter().find(|(name, ..)| *name == scene);
        let name = format!("tick: {label}");
        // This program's tick is the same beside each of MuJoCo's models of a scene: its own bound appears once.
        let alone = wanted.map(|(_, _, most)| {
            Figure::new(format!("tick: {}", scene_in_words(scene)), ours_ns * 1e-3, "µs").wanted(Wanted::AtMost(*most))
        });
        made.extend(alone.filter(|one| made.iter().all(|other| other.name != one.name)));
        let least = wanted.and_then(|(_, least, _)| *least);
        made.push(figure(name + ", beside", "µs", ours_ns * 1e-3, ("MuJoCo", theirs_ns * 1e-3), times, least));
    }
    let grips = said["grip"].as_array().map_or(&[][..], Vec::as_slice).iter().filter(|grip| grip["who"] == "ours");
    made.extend(grips.filter_map(|grip| {
        let (creep_m, dt_s, seconds) = (grip["creep_m"].as_f64()?, grip["dt_s"].as_f64()?, grip["seconds"].as_f64()?);
        let name = format!("a held block sinks, {seconds} s at {} kHz", 1e-3 / dt_s);
        Some(Figure::new(name, 1e3 * creep_m.abs(), "mm").wanted(Wanted::AtMost(CREEP_MM)))
    }));
    made
}

fn scene_in_words(scene: &str) -> &str {
    if scene == "towers" { "30 blocks in towers" } else { scene }
}

fn of_logs(said: &Value) -> Vec<Figure> {
    let made = rows(said).filter_map(|row| {
        let (what, peer) = (row["what"].as_str()?, row["peer"].as_str()?);
        // The target is against compiled readers; those in Python are not relevant.
        let least = match peer {
            "polars" => Some(2.0),
            "rerun" => Some(1.0),
            _ => None,
        };
        let (ours, theirs) = (row["ours_s"].as_f64()?, row["peer_s"].as_f64()?);
        Some(figure(format!("load: {what}"), "s", ours, (peer, theirs), row["ratio"].as_f64()?, least))
    });
    made.collect()
}

/// Target of the decoding: millions of samples per second, and minimum speed-up over hmmlearn.
const DECODING: (f64, f64) = (20.0, 20.0);

fn of_decoding(said: &Value) -> Vec<Figure> {
    let made = rows(said).filter_map(|row| {
        let median = |key: &str| -> Option<f64> {
            let mut all: Vec<f64> = row[key].as_array()?.iter().filter_map(Value::as_f64).collect();
            all.sort_by(f64::total_cmp);
            all.get(all.len() / 2).copied()
        };
        let name = format!("decode {} samples, {} covariance", row["samples"], row["covariance"].as_str()?);
        let millions = 1e-6 * row["samples"].as_f64()?;
        let (ours, theirs) = (millions / median("ours_s")?, millions / median("hmmlearn_s")?);
        let beside = figure(
            format!("{name}, beside"),
            "M samples/s",
            ours,
            ("hmmlearn", theirs),
            row["ratio"].as_f64()?,
            Some(DECODING.1),
        );
        Some([Figure::new(name, ours, "M samples/s").wanted(Wanted::AtLeast(DECODING.0)), beside])
    });
    made.flatten().collect()
}

/// Maximum duration of a refit as (minimum number of samples, s). A log of 10 s at 1 kHz has the stricter bound.
const REFIT_S: [(f64, f64); 2] = [(50_000.0, 20e-3), (0.0, 16e-3)];

/// Refit against its own bound, and compared with each method of scipy; the ratio has a target for the large log only.
fn of_refits(said: &Value) -> Vec<Figure> {
    let mut made = Vec::new();
    for row in rows(said) {
        let (Some(samples), Some(ours)) = (row["samples"].as_f64(), row["refit_s"].as_f64()) else { continue };
        let name = format!("refit a crank, {samples} samples");
        let most = REFIT_S.iter().find(|(least, _)| samples >= *least).map(|(_, most)| Wanted::AtMost(*most));
        made.push(Figure { wanted: most, ..Figure::new(name.clone(), ours, "s") });
        let least = (samples >= REFIT_S[0].0).then_some(50.0);
        for (key, peer) in [("lm", "scipy lm"), ("trf", "scipy trf")] {
            let (Some(theirs), Some(times)) = (row[format!("{key}_s")].as_f64(), row[format!("{key}_ratio")].as_f64())
            else {
                continue;
            };
            made.push(figure(format!("{name}, beside {key}"), "s", ours, (peer, theirs), times, least));
        }
    }
    made
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn rows_of_every_script_become_figures() {
        let scenes = json!({ "rows": [
            { "label": "pinch", "scene": "pinch", "mujoco_options": "default", "ours_best_ns": 500.0, "mujoco_best_ns": 8000.0,
              "ratio": { "median": 16.0 } },
            { "label": "pinch, elliptic", "scene": "pinch", "mujoco_options": "cone", "ours_best_ns": 1.0, "mujoco_best_ns": 1.0 },
        ], "grip": [
            { "who": "ours", "dt_s": 1e-4, "seconds": 600, "creep_m": 2e-4 },
            { "who": "MuJoCo, default", "dt_s": 1e-4, "seconds": 10, "creep_m": 2e-1 },
        ] });
        let made = of_scenes(&scenes);
        let rows: Vec<_> = made.iter().map(|f| (f.name.as_str(), f.value, f.is_kept())).collect();
        let wanted = [
            ("tick: pinch", 0.5, Some(true)),
            ("tick: pinch, beside", 0.5, Some(true)),
            ("a held block sinks, 600 s at 10 kHz", 0.2, Some(false)),
        ];
        assert_eq!(rows, wanted, "MuJoCo's other options and its own grip are not asked for");
        let logs = json!({ "rows": [{ "what": "CSV", "peer": "polars", "ours_s": 1.0, "peer_s": 1.5, "ratio": 1.5 }] });
        assert_eq!(of_logs(&logs)[0].is_kept(), Some(false));
        let mcap = json!({ "rows": [{ "what": "MCAP", "peer": "rerun", "ours_s": 1.0, "peer_s": 1.5, "ratio": 1.5 }] });
        assert_eq!(of_logs(&mcap)[0].is_kept(), Some(true));
        let decoding = json!({ "rows": [{ "samples": 5_000_000, "covariance": "full", "ours_s": [0.2, 0.1, 0.3], "hmmlearn_s": [4.0], "ratio": 20.0 }] });
        let rates: Vec<_> = of_decoding(&decoding).iter().map(|f| (f.value.round(), f.is_kept())).collect();
        assert_eq!(rates, [(25.0, Some(true)), (25.0, Some(true))], "millions a second, by the median");
        let refits = json!({ "rows": [
            { "samples": 10_000, "refit_s": 0.017, "lm_s": 0.17, "lm_ratio": 10.0, "trf_s": 1.7, "trf_ratio": 100.0 },
            { "samples": 100_000, "refit_s": 0.017, "lm_s": 0.17, "lm_ratio": 10.0, "trf_s": 1.7, "trf_ratio": 100.0 },
        ] });
        let kept: Vec<Option<bool>> = of_refits(&refits).iter().map(Figure::is_kept).collect();
        let wanted = [Some(false), None, None, Some(true), Some(false), Some(true)];
        assert_eq!(kept, wanted, "16 ms of a log of 10 s; 20 ms and 50 times of a large one");
        assert!(of_refits(&json!({})).is_empty());
    }

    #[test]
    fn every_script_is_there_and_one_that_is_not_is_a_sentence() {
        let folder = folder().expect("the sources are here");
        for script in &SCRIPTS {
            assert!(folder.join(script.file).is_file(), "{}", script.file);
        }
        let why = run(&folder.join("no-such.py"), true).expect_err("it is not there");
        assert!(!why.is_empty() && !why.contains('\n'), "{why}");
    }
}
