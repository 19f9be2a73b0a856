//! `touchstone bench frames`: processor time of a frame of each panel, with a long log.

use super::super::{Output, parse_size};
use crate::ui::headless::frame_costs::{Costs, Loaded, SUBJECTS, Subject};
use crate::ui::headless::gallery::samples::askew_world;
use clap::Args;
use haptics::device::{Device, ScriptedOperator, Skill};
use haptics::recording::Recording;
use haptics::servo::recorder::{SensorModel, to_recording};
use haptics::servo::safety::Limits;
use haptics::servo::{Loop, Swap};
use haptics::world::{State, World, presets};
use schemars::JsonSchema;
use serde::Serialize;
use std::fmt::Write;

/// Servo period, s.
const DT: f64 = 1e-3;
/// Maximum processor time of a frame, s: half of the frame period at 60 Hz.
const BUDGET_S: f64 = 8e-3;

/// Arguments of `bench frames`.
#[derive(Args)]
pub struct FramesBench {
    /// Samples of the log: the scripted operator's, over and over
    #[arg(long, default_value_t = 1_000_000)]
    pub(super) samples: usize,
    /// Size of the window in pixels
    #[arg(long, default_value = "1920x1080", value_parser = parse_size)]
    pub(super) size: [u32; 2],
    /// Pictures that are drawn of each panel and movement
    #[arg(long, default_value_t = 60)]
    pub(super) pictures: usize,
    /// Only the log's panels, without a fit and a replay: for logs that take minutes to replay
    #[arg(long)]
    pub(super) no_fit: bool,
}

/// What `bench frames --json` prints.
#[derive(JsonSchema, Serialize)]
pub(crate) struct Said {
    /// Samples of the log.
    samples: usize,
    /// Size of the window in pixels.
    size: [u32; 2],
    /// Processor time that a picture may take, s.
    budget_s: f64,
    /// Each panel's.
    frames: Vec<OfPanel>,
}

/// Processor times of a panel's pictures, s: medians, and what 95 of 100 keep to.
#[derive(JsonSchema, Serialize)]
struct OfPanel {
    /// Its name.
    panel: &'static str,
    /// While the recording plays.
    playing_s: f64,
    /// The same.
    playing_p95_s: f64,
    /// While a plot is zoomed.
    zooming_s: f64,
    /// The same.
    zooming_p95_s: f64,
    /// Triangles of a picture.
    triangles: usize,
}

impl OfPanel {
    fn of(panel: &'static str, c: &Costs) -> Self {
        Self {
            panel,
            playing_s: c.playing.median_s,
            playing_p95_s: c.playing.p95_s,
            zooming_s: c.zooming.median_s,
            zooming_p95_s: c.zooming.p95_s,
            triangles: c.playing.triangles,
        }
    }
}

impl FramesBench {
    pub(super) fn run(&self) -> anyhow::Result<Output> {
        anyhow::ensure!(
            (1_000..=50_000_000).contains(&self.samples),
            "a log of {} samples is not possible; choose 1000 to 50000000",
            self.samples
        );
        anyhow::ensure!(
            (2..=10_000).contains(&self.pictures),
            "{} pictures are not possible; choose 2 to 10000",
            self.pictures
        );
        let samples = self.samples;
        let once = performance("stack, over and over", &presets::stacking());
        let (loaded, subjects) = if self.no_fit {
            (Loaded::unfitted(&once, samples), &SUBJECTS[..2])
        } else {
            (Loaded::over_and_over(once, samples).map_err(anyhow::Error::msg)?, &SUBJECTS[..])
        };
        let measure = |loaded: &Loaded, s: &Subject| (s.name, loaded.measure(*s, self.size, self.pictures));
        let (asked, plain): (Vec<&Subject>, Vec<&Subject>) = subjects.iter().partition(|s| s.needs_answer());
        let mut measured: Vec<(&'static str, Costs)> = plain.into_iter().map(|s| measure(&loaded, s)).collect();
        if !asked.is_empty() {
            let once = performance("crank, over and over", &askew_world());
            let loaded = Loaded::diagnosed(once, samples).map_err(anyhow::Error::msg)?;
            measured.extend(asked.into_iter().map(|s| measure(&loaded, s)));
        }
        self.report(samples, &measured)
    }

    fn report(&self, samples: usize, measured: &[(&'static str, Costs)]) -> anyhow::Result<Output> {
        let mut text = format!(
            "{samples} samples, {} × {} pixels, processor time of a picture in ms (budget {:.0})\n{:<16} {:>16} {:>16} {:>14} {:>10}\n",
            self.size[0],
            self.size[1],
            1e3 * BUDGET_S,
            "",
            "playing",
            "zooming",
            "triangles",
            "cutting"
        );
        for (name, costs) in measured {
            let of = |median: f64, p95: f64| format!("{:.2} (95 %: {:.2})", 1e3 * median, 1e3 * p95);
            let over = costs.playing.p95_s.max(costs.zooming.p95_s) > BUDGET_S;
            let _ = writeln!(
                text,
                "{name:<16} {:>16} {:>16} {:>11} k {:>8.0} %{}",
                of(costs.playing.median_s, costs.playing.p95_s),
                of(costs.zooming.median_s, costs.zooming.p95_s),
                costs.playing.triangles / 1000,
                100.0 * costs.playing.tessellation,
                if over { "  over" } else { "" }
            );
        }
        let frames = measured.iter().map(|(name, costs)| OfPanel::of(name, costs)).collect();
        let said = Said { samples, size: self.size, budget_s: BUDGET_S, frames };
        Ok(Output { text, json: serde_json::to_value(&said)? })
    }
}

/// Recording of the scripted operator at the world's task.
pub(super) fn performance(name: &str, world: &World) -> Recording {
    let state = State::resting(world);
    let operator = ScriptedOperator::new(world, &state, Skill::default(), 1);
    let limits = Limits { max_force_n: operator.spec().max_force_n, ..Limits::default() };
    let mut servo = Loop::new(Swap::at(world.clone(), state), Box::new(operator), limits);
    let mut ticks = Vec::new();
    while !servo.finished() {
        ticks.push(servo.tick(DT));
    }
    to_recording(name, world, &ticks, 1, &SensorModel::TYPICAL, 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_short_bench_tells_every_panel() {
        let bench = FramesBench { samples: 20_000, size: [640, 480], pictures: 2, no_fit: false };
        let output = bench.run().expect("it runs");
        for subject in SUBJECTS {
            assert!(output.text.contains(subject.name), "{}: {}", subject.name, output.text);
        }
        assert_eq!(output.json["samples"], 20_000);
        assert!(output.json["frames"][0]["triangles"].as_u64().is_some_and(|n| n > 500), "{}", output.json);
        let wrong = FramesBench { samples: 1, ..bench };
        assert!(wrong.run().is_err_and(|e| e.to_string().contains("not possible")));
    }
}
