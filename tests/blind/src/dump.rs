//! Cases as files: a table and its sidecar for whoever looks for the effect, and the truth in another folder.

use super::case::{Case, Truth};
use super::sets::Job;
use haptics::recording::Recording;
use std::fmt::Write as _;
use std::fs;
use std::io;
use std::path::Path;

/// A recording as a table.
pub fn csv(recording: &Recording) -> String {
    let mut text = String::from("t_s");
    for channel in &recording.channels {
        text.push(',');
        text.push_str(&channel.name);
    }
    text.push('\n');
    let time = recording.time_s.as_deref().unwrap_or(&[]);
    for (row, t) in time.iter().enumerate() {
        let _ = write!(text, "{t}");
        for channel in &recording.channels {
            let _ = write!(text, ",{:.9}", channel.values[row]);
        }
        text.push('\n');
    }
    text
}

/// What only a scorer opens, as JSON.
pub fn truth_json(job: &Job, truth: &Truth) -> serde_json::Value {
    let hidden: Vec<_> = truth
        .hidden
        .iter()
        .enumerate()
        .map(|(k, h)| {
            serde_json::json!({
                "id": h.effect.id(), "form": h.effect.form(h.form), "size": h.size, "shape": h.shape,
                "effect_over_noise": truth.ratio[k], "wanted_effect_over_noise": truth.wanted_ratio[k], "effect_rms": truth.effect_rms[k],
            })
        })
        .collect();
    serde_json::json!({
        "set": job.set.name(), "bench": job.spec.bench.name(), "log": job.spec.log.name(), "seed": job.seed,
        "rate_hz": job.spec.rate_hz, "seconds": job.spec.seconds, "wanted_effect_over_noise": job.spec.ratio,
        "hidden": hidden, "noise_N": truth.noise_n, "angle_noise": truth.angle_noise, "equals": truth.equals, "correlation": truth.correlation,
        "visible_inertia": truth.visible_inertia, "noise_free_N": truth.noise_free_n,
    })
}

/// Writes a case to `logs/<name>.csv` and `.meta.json`, and its truth to `truth/<name>.json`.
pub fn write(folder: &Path, name: &str, job: &Job, case: &Case, truth: &Truth) -> io::Result<()> {
    let (logs, truths) = (folder.join("logs"), folder.join("truth"));
    fs::create_dir_all(&logs)?;
    fs::create_dir_all(&truths)?;
    for (k, recording) in case.recordings.iter().enumerate() {
        let stem = if k == 0 { name.to_owned() } else { format!("{name}-{}", k + 1) };
        fs::write(logs.join(format!("{stem}.csv")), csv(recording))?;
        let meta = serde_json::to_string_pretty(&recording.meta).map_err(io::Error::other)?;
        fs::write(logs.join(format!("{stem}.meta.json")), meta)?;
    }
    fs::write(
        truths.join(format!("{name}.json")),
        serde_json::to_string(&truth_json(job, truth)).map_err(io::Error::other)?,
    )
}
