//! `touchstone bench` alone: all figures in one table.

use super::blind::{self, BlindBench};
use super::diagnosis::DiagnosisBench;
use super::frames::{FramesBench, performance};
use super::online::OnlineBench;
use super::table::{Figure, Said, Wanted};
use super::{ServoBench, opening, peers, window};
use crate::cli::{ControlArgs, Output, progress};
use crate::ui::headless::gallery::samples::askew_world;
use clap::Args;
use estimator::diagnose::{self, diagnose};
use estimator::pipeline::{Options, Prepared, analyse_prepared};
use estimator::simulate::simulate;
use haptics::recording::Recording;
use haptics::servo::rate::RateChoice;
use haptics::world::presets;
use std::time::Instant;

/// Arguments of `bench` without a word, and of `bench all`.
#[derive(Args, Clone, Copy, Default)]
pub struct WholeBench {
    /// Shorter runs and smaller files: some two minutes instead of half an hour, once the programs beside it are built
    #[arg(long)]
    pub(super) quick: bool,
    /// Only what this program measures by itself, without the programs beside it
    #[arg(long)]
    no_peers: bool,
}

/// A part of the table.
type Part = fn(WholeBench) -> anyhow::Result<Vec<Figure>>;

/// Shortest duration among some rounds, s: interruptions only make a round longer.
pub(super) fn best_s<T>(rounds: usize, mut work: impl FnMut() -> anyhow::Result<T>) -> anyhow::Result<f64> {
    let mut best = f64::INFINITY;
    for _ in 0..rounds.max(1) {
        let begun = Instant::now();
        work()?;
        best = best.min(begun.elapsed().as_secs_f64());
    }
    Ok(best)
}

/// Recording of at least so many samples: a performance repeated, with a continuous clock.
pub(super) fn long(once: &Recording, samples: usize) -> Recording {
    let rounds = samples.div_ceil(once.len().max(1));
    let time = once.time_s.as_deref().unwrap_or(&[]);
    let round_s = time.last().copied().unwrap_or(0.0) + 1e-3;
    let mut whole = once.clone();
    whole.labels = None;
    whole.time_s =
        Some((0..rounds).flat_map(|k| time.iter().map(move |t| t + k as f64 * round_s)).take(samples).collect());
    for channel in &mut whole.channels {
        channel.values = channel.values.iter().copied().cycle().take(samples).collect();
    }
    whole
}

impl WholeBench {
    pub(super) fn run(self) -> anyhow::Result<Output> {
        let mut said = Said::of(self.quick, Vec::new());
        let parts: [(&str, Part); 9] = [
            ("the servo", |wish| servo(wish, false)),
            ("the servo while pictures are drawn", |wish| servo(wish, true)),
            ("what runs beside it", online),
            ("the window's start", window::first_pictures),
            ("its pictures", frames),
            ("how long logs open", opening::first_curves),
            ("the estimator", estimator),
            ("diagnoses of a minute", diagnoses),
            ("what diagnoses find", blind),
        ];
        for (what, part) in parts {
            // A part that cannot be measured here omits only its own rows.
            match progress::during(&format!("measuring {what}"), |_| part(self)) {
                Ok(figures) => said.figures.extend(figures),
                Err(error) => said.skipped.push(format!("{what}: {error}")),
            }
        }
        if self.no_peers {
            said.skipped.push("other programs: --no-peers".to_owned());
        } else {
            let skipped = &mut said.skipped;
            said.figures
                .extend(progress::during("measuring beside other programs", |_| peers::all(self.quick, skipped)));
        }
        let text = said.in_words();
        Ok(Output { text, json: serde_json::to_value(&said)? })
    }
}

fn servo(wish: WholeBench, render: bool) -> anyhow::Result<Vec<Figure>> {
    let seconds = if wish.quick { 3.0 } else { 60.0 };
    let beside = if render { ", pictures beside it" } else { "" };
    let mut figures = Vec::new();
    for (rate_hz, p99_us, p999_us) in [(1000.0, 100.0, 500.0), (4000.0, 50.0, 250.0)] {
        let control = ControlArgs { passivity_control: None };
        let rate = RateChoice::Fixed(rate_hz);
        let json = ServoBench { seconds, rate, render, no_real_time: false, control }.run()?.json;
        let lateness = |key: &str| json["timing"]["lateness"][key].as_f64().map(|s| 1e6 * s);
        for (key, name, most) in [("p99_s", "99 %", p99_us), ("p999_s", "99.9 %", p999_us)] {
            let Some(value) = lateness(key) else { continue };
            let name = format!("servo at {rate_hz} Hz{beside}: {name} of ticks are late by");
            figures.push(Figure::new(name, value, "µs").wanted(Wanted::AtMost(most)));
        }
    }
    Ok(figures)
}

fn online(wish: WholeBench) -> anyhow::Result<Vec<Figure>> {
    let json = OnlineBench { rounds: if wish.quick { 2 } else { 20 } }.run()?.json;
    let mut figures = Vec::new();
    for row in json["online"].as_array().map_or(&[][..], Vec::as_slice) {
        let (Some(world), Some(sample_s), Some(tick_s)) =
            (row["world"].as_str(), row["sample_s"].as_f64(), row["tick_s"].as_f64())
        else {
            continue;
        };
        figures.push(Figure::new(format!("tick with the scripted hand, {world}"), 1e6 * tick_s, "µs"));
        figures.push(Figure::new(format!("sample of the estimator beside it, {world}"), 1e6 * sample_s, "µs"));
    }
    Ok(figures)
}

fn frames(wish: WholeBench) -> anyhow::Result<Vec<Figure>> {
    let (samples, pictures) = if wish.quick { (50_000, 6) } else { (1_000_000, 60) };
    let bench = FramesBench { samples, size: [1920, 1080], pictures, no_fit: false };
    let json = bench.run()?.json;
    let rows = json["frames"].as_array().map_or(&[][..], Vec::as_slice);
    let figures = rows.iter().filter_map(|row| {
        let p95_s = |key: &str| row[key].as_f64();
        let (panel, worst_s) = (row["panel"].as_str()?, p95_s("playing_p95_s")?.max(p95_s("zooming_p95_s")?));
        let name = format!("picture of {panel}, {samples} samples, 95 % while playing or zooming");
        Some(Figure::new(name, 1e3 * worst_s, "ms").wanted(Wanted::AtMost(8.0)))
    });
    Ok(figures.collect())
}

fn estimator(wish: WholeBench) -> anyhow::Result<Vec<Figure>> {
    let rounds = if wish.quick { 1 } else { 5 };
    let once = performance("crank", &presets::crank());
    let mut figures = Vec::new();
    for samples in if wish.quick { vec![10_000] } else { vec![10_000, 100_000] } {
        let recordings = [long(&once, samples)];
        let options = Options::default();
        let first = best_s(rounds, || Ok(analyse_prepared(&recordings, &Prepared::default(), &options)?))?;
        let prepared = Prepared::default();
        let analysis = analyse_prepared(&recordings, &prepared, &options)?;
        let again = best_s(rounds, || Ok(analyse_prepared(&recordings, &prepared, &options)?))?;
        let replay = best_s(rounds, || Ok(simulate(&analysis.world, &recordings[0])?))?;
        let name = |what: &str| format!("{what}, crank, {samples} samples");
        figures.push(Figure::new(name("states, fit and world, the first time"), 1e3 * first, "ms"));
        figures.push(Figure::new(name("the same again, signals kept"), 1e3 * again, "ms"));
        figures.push(Figure::new(name("replay"), 1e3 * replay, "ms"));
    }
    let asked = [performance("askew", &askew_world())];
    let took = best_s(rounds, || Ok(diagnose(&asked, &diagnose::Options::default())?))?;
    figures.push(Figure::new(format!("diagnosis, {} samples", asked[0].len()), 1e3 * took, "ms"));
    Ok(figures)
}

fn diagnoses(wish: WholeBench) -> anyhow::Result<Vec<Figure>> {
    DiagnosisBench { quick: wish.quick, seed: 1 }.figures(|_| ())
}

fn blind(wish: WholeBench) -> anyhow::Result<Vec<Figure>> {
    let json = BlindBench::of_table(wish.quick.then_some(20)).run()?.json;
    let figures = blind::figures(&json);
    // With few cases, shares of a hundredth are not significant.
    Ok(figures.into_iter().map(|figure| if wish.quick { Figure { wanted: None, ..figure } } else { figure }).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quick_run_alone_has_every_part_and_says_what_it_left_out() {
        let output = WholeBench { quick: true, no_peers: true }.run().expect("it runs");
        for part in [
            "servo at 1000 Hz",
            "servo at 4000 Hz, pictures beside it",
            "first picture of the window",
            "first curves of a log of",
            "sample of the estimator",
            "picture of Diagnose, atlas",
            "states, fit and world, the first time, crank, 10000 samples",
            "diagnosis",
            "diagnosis of 60 s at 1 kHz: crank, nothing hidden",
            "nothing hidden and something named",
        ] {
            // Parts that a machine cannot run have a sentence with the reason.
            let skipped = part == "first picture of the window" && output.text.contains("skipped: the window's start");
            assert!(skipped || output.text.contains(part), "{part}: {}", output.text);
        }
        assert!(output.text.contains("skipped: other programs"), "{}", output.text);
        let figures = output.json["figures"].as_array().expect("rows");
        assert!(figures.iter().all(|f| f["value"].as_f64().is_some_and(|v| v >= 0.0)), "{figures:?}");
    }

    #[test]
    fn a_long_recording_has_one_clock() {
        let once = performance("crank", &presets::crank());
        let whole = long(&once, 2 * once.len() + 7);
        let time = whole.time_s.as_ref().expect("a clock");
        assert!(whole.len() == 2 * once.len() + 7 && time.windows(2).all(|w| w[1] > w[0]));
        assert!(whole.channels.iter().all(|c| c.values.len() == whole.len()));
    }
}
