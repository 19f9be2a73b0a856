//! The motion that would settle what is open: candidates' columns on motions that were not made yet.

use super::candidate::Candidate;
use super::dictionary::Dictionary;
use super::force::{Model, column};
use super::geometry::Study;
use super::grid::Grid;
use super::report::{Alternative, NextExperiment};
use super::track::{Place, Row, Span, Track};
use haptics::Vec2;
use haptics::law::Motion;
use nalgebra::{DMatrix, DVector};
use statrs::distribution::{ContinuousCDF, Normal};
use std::f64::consts::TAU;

/// Length of a proposed recording, s, and the rate it is thought through at, Hz.
const LENGTH_S: f64 = 20.0;
const RATE_HZ: f64 = 100.0;
/// Evidence that settles a question, as a log likelihood ratio.
const SETTLED: f64 = 5.0;

/// A motion that a person (or the scripted operator) can make: coordinate in shares of the usual range, force across in N.
struct Excitation {
    words: &'static str,
    /// Position over time.
    place: fn(f64) -> f64,
    /// Force across the motion, in units of the usual one.
    across: fn(f64) -> f64,
    /// Seconds of letting go at either end.
    free_s: f64,
}

/// Strokes, faster and faster.
fn sweep(t: f64) -> f64 {
    0.5 * (TAU * (0.1 * t + 0.03 * t * t)).sin()
}

static LIBRARY: [Excitation; 7] = [
    Excitation {
        words: "turn to and fro over the whole range, slowly and fast, now pulling and now pushing across the motion",
        place: sweep,
        across: |t| (TAU * 0.17 * t).sin(),
        free_s: 0.0,
    },
    Excitation {
        words: "turn to and fro over the whole range, slowly and fast, and let go for two seconds before and after",
        place: sweep,
        across: |t| 1.0 + 0.5 * (TAU * 0.17 * t).sin(),
        free_s: 2.0,
    },
    Excitation {
        words: "go to and fro in short strokes at several places",
        place: |t| 0.4 * (TAU * 0.05 * t).sin() + 0.04 * (TAU * 1.3 * t).sin(),
        across: |t| 1.0 + 0.5 * (TAU * 0.3 * t).sin(),
        free_s: 0.0,
    },
    Excitation {
        words: "start and stop hard: short, fast bursts both ways",
        place: |t| 0.4 * (TAU * 0.8 * t).sin().powi(3),
        across: |t| 1.0 + 0.3 * (TAU * 0.2 * t).sin(),
        free_s: 0.0,
    },
    Excitation {
        words: "go on in one direction over several turns or the whole range, first very slowly, then fast",
        place: |t| 0.02 * t * t / 4.0,
        across: |t| 1.0 + 0.5 * (TAU * 0.23 * t).sin(),
        free_s: 0.0,
    },
    Excitation {
        words: "make slow full strokes with a rest at each end, and squeeze harder in every other one",
        place: |t| 0.5 * (TAU * 0.12 * t).sin().clamp(-0.8, 0.8),
        across: |t| if (0.12 * t).fract() < 0.5 { 0.5 } else { 1.5 },
        free_s: 0.0,
    },
    Excitation {
        words: "repeat the motion for twice as long, with two seconds of free motion before and after",
        place: |t| 0.5 * (TAU * 0.25 * t).sin() + 0.2 * (TAU * 0.61 * t).sin(),
        across: |t| (TAU * 0.11 * t).cos(),
        free_s: 2.0,
    },
];

/// What to record next so that `open` alternatives are told apart from what was found; `None` when nothing is open.
pub fn propose(track: &Track, model: &Model, study: &Study, open: &[Alternative]) -> Option<NextExperiment> {
    let solved = study.solved.as_ref()?;
    let pairs: Vec<(&str, &str)> = open.iter().map(|a| (a.instead_of.as_str(), a.id.as_str())).collect();
    let first = pairs.first()?;
    if let Some(words) = beyond_motion(first) {
        return Some(NextExperiment {
            motion: words.to_owned(),
            separates: vec![first.0.to_owned(), first.1.to_owned()],
            expected_power: 0.95,
        });
    }
    let mut best: Option<(f64, &Excitation)> = None;
    for excitation in LIBRARY.iter().filter(|e| track.planar || e.free_s == 0.0) {
        let imagined = imagine(track, model, &solved.values, excitation);
        let least = pairs
            .iter()
            .filter_map(|pair| separation(&imagined, model, study, &solved.values, *pair))
            .fold(f64::INFINITY, f64::min);
        if least.is_finite() && best.is_none_or(|(most, _)| least > most) {
            best = Some((least, excitation));
        }
    }
    let (lambda, excitation) = best?;
    let mut separates: Vec<String> = vec![first.0.to_owned()];
    separates.extend(pairs.iter().map(|p| p.1.to_owned()));
    Some(NextExperiment { motion: excitation.words.to_owned(), separates, expected_power: power(lambda) })
}

/// Pairs that no motion of the same object separates.
fn beyond_motion(pair: &(&str, &str)) -> Option<&'static str> {
    match *pair {
        ("eccentric-mass", "gravity-tilt") | ("gravity-tilt", "eccentric-mass") => Some(
            "turn the object's base by a quarter turn (or hang up a known weight) and record the same motion again",
        ),
        ("mass-change", "force-drift") | ("force-drift", "mass-change") => {
            Some("let go for two seconds before and after: a drift of the sensor stays, a lost weight does not")
        }
        _ => None,
    }
}

/// Probability that a log likelihood ratio of mean λ/2 and variance λ settles it.
fn power(lambda: f64) -> f64 {
    let sure = (0.5 * lambda - SETTLED) / lambda.max(1e-9).sqrt();
    Normal::new(0.0, 1.0).map_or(0.0, |n| n.cdf(sure))
}

/// Rows of a motion that was not made: the model's own forces on it.
fn imagine(track: &Track, model: &Model, values: &[f64], excitation: &Excitation) -> Track {
    let (low, high) = (track.quantile(0.02, |r| r.motion.position), track.quantile(0.98, |r| r.motion.position));
    let (middle, range) = (0.5 * (low + high), high - low);
    let usual_n = track.quantile(0.7, |r| r.motion.normal_force_n.abs());
    let step = 1.0 / RATE_HZ;
    let place = |t: f64| middle + range * (excitation.place)(t);
    let held = (LENGTH_S * RATE_HZ) as usize;
    let mut rows: Vec<Row> = (0..held)
        .map(|i| {
            let t = i as f64 * step;
            let position = place(t);
            let angle_rad = track.radius_m.map_or(position, |r| position / r);
            let along = if track.planar { Vec2::new(-angle_rad.sin(), angle_rad.cos()) } else { Vec2::x() };
            let velocity = (place(t + step) - place(t - step)) / (2.0 * step);
            let motion = Motion {
                time_s: t + excitation.free_s,
                position,
                velocity,
                acceleration: (place(t + step) - 2.0 * position + place(t - step)) / (step * step),
                direction: 0.0,
                normal_force_n: if track.planar { usual_n * (excitation.across)(t) } else { 0.0 },
                up_along: if track.planar { along.y } else { 0.0 },
            };
            let (force, force_rate) = (Vec2::zeros(), Vec2::zeros());
            let (span, open) = (Span::default(), 0.0);
            Row {
                recording: 0,
                stretch: 0,
                place: Place::Along,
                motion,
                angle_rad,
                along,
                force,
                force_rate,
                y: 0.0,
                span,
                open,
            }
        })
        .collect();
    let mut imagined = Track {
        rows: Vec::new(),
        fine: Vec::new(),
        span_s: LENGTH_S + 2.0 * excitation.free_s,
        period_s: step,
        ..track.clone()
    };
    imagined.rows.append(&mut rows);
    super::force::blur(&mut imagined);
    let base: Vec<Vec<f64>> = model.iter().map(|e| column(&imagined, e)).collect();
    for i in 0..imagined.rows.len() {
        let y: f64 = base.iter().zip(values).map(|(c, v)| c[i] * v).sum();
        let row = &mut imagined.rows[i];
        let outward = Vec2::new(row.along.y, -row.along.x);
        row.y = y;
        row.force = if track.planar { row.along * y + outward * row.motion.normal_force_n } else { Vec2::new(y, 0.0) };
    }
    for i in 1..imagined.rows.len().saturating_sub(1) {
        let rate = (imagined.rows[i + 1].force - imagined.rows[i - 1].force) / (2.0 * step);
        imagined.rows[i].force_rate = rate;
    }
    add_free(&mut imagined, excitation.free_s);
    imagined
}

fn add_free(track: &mut Track, free_s: f64) {
    let count = (free_s * RATE_HZ) as usize;
    for (k, (axis, place)) in [(Vec2::x(), Place::FreeX), (Vec2::y(), Place::FreeY)].into_iter().enumerate() {
        for end in 0..2 {
            let start_s = if end == 0 { 0.0 } else { track.span_s - free_s };
            track.rows.extend((0..count).map(|i| Row {
                recording: 0,
                stretch: 1 + 2 * k + end,
                place,
                motion: Motion { time_s: start_s + i as f64 / RATE_HZ, ..Motion::default() },
                angle_rad: 0.0,
                along: axis,
                force: Vec2::zeros(),
                force_rate: Vec2::zeros(),
                y: 0.0,
                span: Span::default(),
                open: 0.0,
            }));
        }
    }
}

/// λ: what of the found cause the model and the rival together could not imitate on this motion, over the noise.
fn separation(imagined: &Track, model: &Model, study: &Study, values: &[f64], pair: (&str, &str)) -> Option<f64> {
    let base: Vec<Vec<f64>> = model.iter().map(|e| column(imagined, e)).collect();
    let predicted: Vec<f64> = imagined.rows.iter().map(|r| r.y).collect();
    let taken: Vec<&str> = model.iter().map(|e| e.law().id()).collect();
    let grid = Grid::coarse(imagined);
    let dictionary = Dictionary {
        track: imagined,
        predicted: &predicted,
        resisting: &predicted,
        fixed: &[],
        without: &taken,
        grid: &grid,
    };
    let candidates = dictionary.candidates();
    let found = study.chosen.iter().position(|c| study.candidates[c.candidate].id == pair.0)?;
    let own = &study.candidates[study.chosen[found].candidate];
    let at = study.base.len()
        + study.chosen[..found].iter().map(|c| study.candidates[c.candidate].columns.len()).sum::<usize>();
    let effect: Vec<f64> = {
        let like = nearest(&candidates, own)?;
        let parts = like.columns.iter().zip(&values[at..at + own.columns.len()]);
        parts.fold(vec![0.0; predicted.len()], |mut sum, (c, v)| {
            sum.iter_mut().zip(c).for_each(|(s, x)| *s += v * x);
            sum
        })
    };
    let noise = imagined.force_noise.max(1e-12);
    candidates
        .iter()
        .filter(|c| c.id == pair.1)
        .map(|rival| unexplained(&effect, base.iter().chain(&rival.columns)) / (noise * noise))
        .min_by(f64::total_cmp)
}

/// The instance of the same cause whose searched values are nearest.
fn nearest<'a>(candidates: &'a [Candidate], own: &Candidate) -> Option<&'a Candidate> {
    let apart = |c: &Candidate| -> f64 {
        c.searched.iter().zip(&own.searched).map(|(a, b)| ((a.value - b.value) / b.value.abs().max(1e-9)).powi(2)).sum()
    };
    let same = |c: &&Candidate| c.id == own.id && c.linear == own.linear && c.searched.len() == own.searched.len();
    candidates.iter().filter(same).min_by(|a, b| apart(a).total_cmp(&apart(b)))
}

/// Sum of squares of what the columns leave of a series.
fn unexplained<'a>(series: &[f64], columns: impl Iterator<Item = &'a Vec<f64>>) -> f64 {
    let columns: Vec<&Vec<f64>> = columns.filter(|c| c.iter().any(|v| *v != 0.0)).collect();
    let matrix = DMatrix::from_fn(series.len(), columns.len(), |i, j| columns[j][i]);
    let target = DVector::from_column_slice(series);
    let gram = matrix.tr_mul(&matrix);
    let scale: Vec<f64> = (0..gram.ncols()).map(|j| gram[(j, j)].sqrt().max(1e-300)).collect();
    let scaled = DMatrix::from_fn(gram.nrows(), gram.ncols(), |i, j| {
        gram[(i, j)] / (scale[i] * scale[j]) + if i == j { 1e-10 } else { 0.0 }
    });
    let right = matrix.tr_mul(&target).component_div(&DVector::from_column_slice(&scale));
    let Some(cholesky) = scaled.cholesky() else { return 0.0 };
    let solved = cholesky.solve(&right).component_div(&DVector::from_column_slice(&scale));
    (target - matrix * solved).norm_squared()
}
