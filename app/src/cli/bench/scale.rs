//! `touchstone bench scale`: growth of the run time with the input: samples of a log, blocks of a world, logs of a
//! fleet.

use super::frames::performance;
use super::loglog::{self, Curve};
use super::table::plain;
use super::whole::{best_s, long};
use crate::cli::{Output, progress};
use crate::ui::headless::frame_costs::{Loaded, SUBJECTS};
use clap::Args;
use estimator::diagnose::{self, diagnose};
use estimator::hmm::{Chain, Covariance, Gaussian, Model};
use estimator::log::pyramid::Pyramid;
use estimator::log::{load, write};
use estimator::pipeline::{Options, analyse};
use estimator::segment::{Method, segment_by};
use haptics::Vec2;
use haptics::recording::Recording;
use haptics::world::{Block, Floor, Input, State, World, presets, step};
use rayon::prelude::*;
use schemars::JsonSchema;
use serde::Serialize;
use std::fmt::Write as _;
use std::path::PathBuf;

/// Storeys of a tower of blocks.
const STOREYS: usize = 5;
/// Number of ticks until blocks are at rest, and of timed ticks.
const SETTLING: usize = 2_000;
const TICKS: usize = 1_000;
/// Duration above which the next size, ten times as large, is skipped, s.
const LONGEST_S: f64 = 3.0;

/// Arguments of `bench scale`.
#[derive(Args)]
pub struct ScaleBench {
    /// Up to 100 000 samples and 16 logs only
    #[arg(long)]
    quick: bool,
    /// Draw the curves on logarithmic axes, as SVG
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
}

/// What `bench scale --json` prints.
#[derive(JsonSchema, Serialize)]
pub(crate) struct Said {
    /// Whether this program was built with optimisation; figures of one without mean little.
    optimised: bool,
    /// How each kind of work grows.
    scale: Vec<Grows>,
}

/// How one kind of work grows.
#[derive(JsonSchema, Serialize)]
struct Grows {
    /// What is done.
    name: &'static str,
    /// What it is done to: `samples`, `blocks` or `logs`.
    of: &'static str,
    /// Seconds grow with this power of the size; null where too few sizes could be timed.
    exponent: Option<f64>,
    /// Sizes and seconds.
    points: Vec<(usize, f64)>,
}

impl From<Curve> for Grows {
    fn from(c: Curve) -> Self {
        let exponent = Some(c.exponent()).filter(|exponent| exponent.is_finite());
        Self { name: c.name, of: c.of, exponent, points: c.points }
    }
}

/// Operation that is timed for growing numbers of samples.
type Work = fn(&Recording) -> anyhow::Result<f64>;

const WORKS: [(&str, Work); 10] = [
    ("load CSV", |r| loading(r, "csv")),
    ("load MCAP", |r| loading(r, "mcap")),
    ("load Parquet", |r| loading(r, "parquet")),
    ("curves of a plot", |r| best_s(3, || Ok(r.channels.iter().map(|c| Pyramid::of(&c.values)).collect::<Vec<_>>()))),
    ("a picture", |r| Ok(Loaded::unfitted(r, r.len()).measure(SUBJECTS[0], [1920, 1080], 20).zooming.median_s)),
    ("segment", |r| best_s(1, || Ok(segment_by(Method::Threshold, r, None, None)?))),
    ("decode states", decoding),
    ("fit", |r| best_s(1, || Ok(analyse(std::slice::from_ref(r), &Options::default())?))),
    ("replay", |r| best_s(1, || Ok(estimator::simulate::simulate(&presets::crank(), r)?))),
    ("diagnose", |r| best_s(1, || Ok(diagnose(std::slice::from_ref(r), &diagnose::Options::default())?))),
];

/// Channels and states of the hidden Markov model.
const MODEL: (usize, usize) = (12, 5);

/// Decodes the most probable states of a model whose means are evenly spaced samples of the recording: the model need
/// not be meaningful to cost the same.
fn decoding(recording: &Recording) -> anyhow::Result<f64> {
    let ((channels, states), n) = (MODEL, recording.len());
    let columns: Vec<&[f64]> = recording.channels.iter().map(|c| c.values.as_slice()).cycle().take(channels).collect();
    let values: Vec<f64> = (0..n).flat_map(|i| columns.iter().map(move |c| c[i])).collect();
    let spread = |c: &[f64]| c.iter().map(|v| v * v).sum::<f64>() / n as f64 + 1e-6;
    let emissions = (0..states).map(|k| {
        let mean = columns.iter().map(|c| c[k * n / states]).collect();
        let covariance =
            nalgebra::DMatrix::from_diagonal(&columns.iter().map(|c| spread(c)).collect::<Vec<_>>().into());
        Gaussian::new(mean, Covariance::Full(covariance), &vec![1e-9; channels])
    });
    let even = vec![1.0 / states as f64; states];
    let model = Model::new(Chain::new(even, vec![1.0 / states as f64; states * states])?, emissions.collect())?;
    best_s(2, || Ok(model.decode(&model.chain, &values, 1.0)?))
}

fn loading(recording: &Recording, ending: &str) -> anyhow::Result<f64> {
    let folder = tempfile::tempdir()?;
    let path = folder.path().join("log").with_extension(ending);
    write(std::slice::from_ref(recording), &path, &[])?;
    best_s(2, || Ok(load(&path, None)?))
}

impl ScaleBench {
    pub(super) fn run(&self) -> anyhow::Result<Output> {
        let most = if self.quick { 5 } else { 7 };
        let sizes: Vec<usize> = (3..=most).map(|power| 10_usize.pow(power)).collect();
        let mut curves = progress::during("measuring samples", |share| by_samples(&sizes, |done| share.tell(done)));
        curves.push(progress::during("measuring blocks", |_| by_blocks()));
        curves.push(progress::during("measuring logs", |_| by_logs(if self.quick { 16 } else { 64 }))?);
        let mut text = String::new();
        for curve in &curves {
            let _ = write!(text, "{:<18} {:<8}", curve.name, curve.of);
            for (size, seconds) in &curve.points {
                let _ = write!(text, " {size:>9}: {:>8} ms", plain(1e3 * seconds));
            }
            let _ = writeln!(text, "   grows as n^{:.2}", curve.exponent());
        }
        if let Some(out) = &self.out {
            crate::write_whole::write_whole(out, &loglog::svg(&curves)).map_err(anyhow::Error::msg)?;
            let _ = writeln!(text, "picture: {}", out.display());
        }
        let said = Said { optimised: !cfg!(debug_assertions), scale: curves.into_iter().map(Grows::from).collect() };
        Ok(Output { text, json: serde_json::to_value(&said)? })
    }
}

fn by_samples(sizes: &[usize], told: impl Fn(f64)) -> Vec<Curve> {
    let once = performance("crank", &presets::crank());
    let mut curves: Vec<Curve> = WORKS.map(|(name, _)| Curve::new(name, "samples")).into();
    for (k, size) in sizes.iter().enumerate() {
        let recording = long(&once, *size);
        for (curve, (_, work)) in curves.iter_mut().zip(&WORKS) {
            if curve.points.last().is_some_and(|(_, seconds)| *seconds > LONGEST_S) {
                continue;
            }
            // A second of a recording may be too short for a fit: then there is no figure.
            if let Ok(seconds) = work(&recording) {
                curve.points.push((*size, seconds));
            }
        }
        told((k + 1) as f64 / sizes.len() as f64);
    }
    curves
}

/// Tick of a world with towers of blocks at rest, the fingers away.
fn by_blocks() -> Curve {
    let mut curve = Curve::new("tick", "blocks");
    for count in [1, 3, 10, 30, 100] {
        let world = towers(count);
        let away = [Vec2::new(-0.02, 0.2), Vec2::new(0.02, 0.2)];
        let input = Input { tip_in_world: away, tip_velocity: [Vec2::zeros(); 2] };
        let mut state = State::new(&world, away);
        let mut ticks = |n: usize| (0..n).for_each(|_| step(&world, &mut state, &input, 1e-3));
        ticks(SETTLING);
        // No error is possible here.
        let took = best_s(3, || {
            ticks(TICKS);
            Ok(())
        })
        .unwrap_or(f64::NAN);
        curve.points.push((count, took / TICKS as f64));
    }
    curve
}

fn towers(count: usize) -> World {
    let mut world = World::empty("Towers");
    world.floor = Some(Floor { height_m: 0.0, ..Floor::default() });
    let place = |i: usize| ((i / STOREYS) as f64, (i % STOREYS) as f64);
    world.blocks = (0..count)
        .map(|i| {
            let (tower, storey) = place(i);
            Block::upright(&format!("block-{}", i + 1), 0.04, 0.02, 0.015, 0.03 * tower, 0.015 * storey)
        })
        .collect();
    world
}

/// Diagnoses of several logs at once, on all processors.
fn by_logs(most: usize) -> anyhow::Result<Curve> {
    let log = performance("crank", &presets::crank());
    let mut curve = Curve::new("diagnose", "logs");
    for count in [1, 2, 4, 8, 16, 32, 64].into_iter().filter(|count| *count <= most) {
        let all = vec![log.clone(); count];
        let took = best_s(1, || {
            let each = all.par_iter().map(|one| diagnose(std::slice::from_ref(one), &diagnose::Options::default()));
            Ok(each.collect::<Result<Vec<_>, _>>()?)
        })?;
        curve.points.push((count, took));
    }
    Ok(curve)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_sizes_come_out_with_what_grows() {
        let curves = by_samples(&[1_000, 10_000], |_| {});
        assert_eq!(curves.len(), WORKS.len());
        let fitted = curves.iter().find(|c| c.name == "fit").expect("a curve");
        assert!(fitted.points.iter().any(|(size, seconds)| *size == 10_000 && *seconds > 0.0), "{fitted:?}");
        let blocks = by_blocks();
        assert_eq!(blocks.points.len(), 5);
        assert!(blocks.points[4].1 > blocks.points[0].1, "a hundred blocks cost more than one: {blocks:?}");
        assert!(by_logs(2).expect("diagnosed").points.len() == 2);
    }
}
