//! Several recordings of the same blocks: weights, widths, heights and the pads' give are shared, so all recordings'
//! rows go into one regression each. The zero of the force sensors and the places of the grasps are each recording's
//! own.
//!
//! Averaging the single fits is not the same. A recording that began with the blocks in hand does not show its zero,
//! one with an even grip not its widths, and one without a block on top not the height of the lowest. Beside another
//! recording of the same blocks all do.

use super::heights::{self, Stacked};
use super::signals::{Blocks, MAIN, mean_and_spread, object};
use super::single_fit::describe;
use super::weight::weight_and_mass;
use crate::identify::limits::SIGNIFICANT;
use crate::identify::pads::LEAST_GRIP_VARIATION;
use crate::identify::pads::{Grip, Grips, widths_over_force};
use crate::regression::bootstrap::block_bootstrap_within;
use crate::regression::robust::{RobustFit, robust};
use crate::segment::{Method, Segmentation};
use foundation::estimate::{Correlated, EstimateError, Fit, Parameter};
use foundation::signal::task::half_width;
use foundation::tasks::Thresholds;
use haptics::recording::Recording;
use std::ops::Range;

/// Every recording's own fit and segmentation, and the shared parameters from all of them at once.
pub struct JointFit {
    /// In the order of the recordings.
    pub fits: Vec<Fit>,
    /// In the order of the recordings.
    pub segmentations: Vec<Segmentation>,
    /// Weights, masses, widths, heights and the stiffness of the pads.
    pub shared: Vec<Parameter>,
    /// Covariance of weights and masses.
    pub correlated: Vec<Correlated>,
}

/// Fits several recordings of the same blocks, carried in the same order.
pub fn fit_jointly(
    method: Method,
    recordings: &[Recording],
    thresholds: Option<Thresholds>,
) -> Result<JointFit, EstimateError> {
    let seen = recordings.iter().map(|r| Blocks::of(method, r, thresholds)).collect::<Result<Vec<_>, _>>()?;
    let fits = seen.iter().map(describe).collect::<Result<Vec<_>, _>>()?;
    let mut shared = weights(&seen)?;
    shared.extend(widths(&seen)?);
    shared.extend(heights_of(&seen, &fits)?);
    for parameter in shared.iter_mut().filter(|p| p.identified) {
        parameter.how = format!("{}, {} recordings in one regression", parameter.how, recordings.len());
    }
    let pairs = shared.windows(2).filter(|pair| pair[0].name == "weight_N" && pair[1].name == "mass_kg");
    let correlated = pairs.filter_map(|pair| weight_and_mass(&pair[0], &pair[1])).collect();
    let segmentations = seen.into_iter().map(|s| s.segmentation).collect();
    Ok(JointFit { fits, segmentations, shared, correlated })
}

/// The regression of all lifts. Columns: weight and mass of each block, then the rest of each recording's zero.
#[derive(Default)]
struct Lifts {
    columns: Vec<Vec<f64>>,
    lift: Vec<f64>,
    stretches: Vec<Range<usize>>,
    /// Samples of each block.
    samples: Vec<usize>,
}

impl Lifts {
    fn of(seen: &[Blocks<'_>]) -> Self {
        let count = seen.iter().map(Blocks::count).max().unwrap_or(0);
        let zero = 2 * count;
        let mut all = Self { columns: vec![Vec::new(); zero + seen.len()], samples: vec![0; count], ..Self::default() };
        for (r, blocks) in seen.iter().enumerate() {
            for n in 0..blocks.count() {
                let carried = blocks.shown(MAIN, n + 1);
                all.samples[n] += carried.len();
                let first = all.lift.len();
                for i in blocks.rows(&carried) {
                    all.push(&[(2 * n, 1.0), (2 * n + 1, blocks.acceleration_y[i]), (zero + r, 1.0)], blocks.lift[i]);
                }
                all.stretches.push(first..all.lift.len());
            }
            // Unfiltered, in means as long as the filter: a filter would carry a touch into the free samples beside it.
            let window = 2 * half_width(&blocks.signals.time_s);
            let first = all.lift.len();
            for near in blocks.levels.free.chunk_by(|a, b| b - a == 1).flat_map(|run| run.chunks_exact(window)) {
                let mean = near.iter().map(|i| blocks.lift(*i)).sum::<f64>() / near.len() as f64;
                all.push(&[(zero + r, 1.0)], mean);
            }
            all.stretches.push(first..all.lift.len());
        }
        all
    }

    fn push(&mut self, entries: &[(usize, f64)], lift: f64) {
        self.columns.iter_mut().for_each(|c| c.push(0.0));
        for (column, value) in entries {
            if let Some(last) = self.columns[*column].last_mut() {
                *last = *value;
            }
        }
        self.lift.push(lift);
    }
}

fn weights(seen: &[Blocks<'_>]) -> Result<Vec<Parameter>, EstimateError> {
    let rows = Lifts::of(seen);
    let RobustFit { fit, weights, left_out } = robust(&rows.columns, &rows.lift, None)?;
    let resampled = block_bootstrap_within(&rows.columns, &rows.lift, weights.as_deref(), &fit, &rows.stretches);
    // The same sensors: their steps do not average out between recordings.
    let rounding = std::f64::consts::SQRT_2 * seen.iter().map(|s| s.resolution_n).fold(0.0, f64::max);
    let gravity = seen.first().map_or(0.0, |s| s.recording.meta.gravity());
    let ringing = if left_out > 0.0 { "; samples in which contacts rang do not count" } else { "" };
    let how = format!(
        "summed vertical tip forces while carried, accelerations and each recording's own zero taken out{ringing}"
    );
    let mut found = Vec::new();
    for (n, samples) in rows.samples.iter().enumerate().filter(|(_, samples)| **samples > 0) {
        let column = 2 * n;
        if !fit.identified[column] {
            continue;
        }
        let error = fit.std_errors[column].hypot(rounding);
        let drawn = resampled.as_ref().map(|r| r[column].hypot(rounding));
        let value = fit.values[column];
        found.push(
            Parameter::identified(&object(n + 1), "weight_N", value, error, *samples, &how).with_bootstrap(drawn),
        );
        if gravity > 0.0 {
            let (kg, error) = (value / gravity, error / gravity);
            let mass =
                Parameter::identified(&object(n + 1), "mass_kg", kg, error, *samples, "weight divided by gravity");
            found.push(mass.with_bootstrap(drawn.map(|d| d / gravity)));
        }
    }
    Ok(found)
}

/// Heights of all blocks and the pads' stiffness in shear; nothing where a task's file hides them.
fn heights_of(seen: &[Blocks<'_>], fits: &[Fit]) -> Result<Vec<Parameter>, EstimateError> {
    if seen.iter().any(|blocks| blocks.unshown("height_m").is_some()) {
        return Ok(Vec::new());
    }
    let weight = |fit: &Fit, n: usize| fit.parameter(&object(n), "weight_N").and_then(|p| p.value).unwrap_or(0.0);
    let weights_n: Vec<Vec<f64>> =
        seen.iter().zip(fits).map(|(b, fit)| (1..=b.count()).map(|n| weight(fit, n)).collect()).collect();
    let stacked: Vec<Stacked<'_>> = seen.iter().zip(&weights_n).map(|(b, w)| Stacked::new(b, w)).collect();
    Ok(heights::heights(&stacked)?.into_iter().filter(|p| p.identified).collect())
}

/// Widths of all blocks at no grip, with one give of the pads for all holds.
fn widths(seen: &[Blocks<'_>]) -> Result<Vec<Parameter>, EstimateError> {
    let mut grips = Grips::default();
    let mut numbers: Vec<usize> = Vec::new();
    let (mut spread, mut mean, mut holds) = (0.0, 0.0, 0.0);
    for blocks in seen {
        for number in 1..=blocks.count() {
            let rows = blocks.rows(&blocks.gripped(number));
            if rows.is_empty() {
                continue;
            }
            let column = |series: &[f64]| rows.iter().map(|i| series[*i]).collect::<Vec<f64>>();
            let (width, force, rate) = (column(&blocks.width), column(&blocks.grip), column(&blocks.width_rate));
            let (usual, varies) = mean_and_spread(&force);
            (spread, mean, holds) = (spread + varies * varies, mean + usual, holds + 1.0);
            let group = numbers.iter().position(|n| *n == number).unwrap_or_else(|| {
                numbers.push(number);
                numbers.len() - 1
            });
            grips.add(group, &Grip { width: &width, force: &force, rate: &rate });
        }
    }
    if holds == 0.0 || (spread / holds).sqrt() < LEAST_GRIP_VARIATION * mean / holds {
        return Ok(Vec::new());
    }
    let Some(found) = widths_over_force(&grips)? else { return Ok(Vec::new()) };
    let resolution = std::f64::consts::SQRT_2 * seen.iter().map(|s| s.resolution_m).fold(0.0, f64::max);
    let how =
        "distance of the tips while held, extrapolated to zero grip force with one give of the pads for all holds";
    let mut parameters: Vec<Parameter> = numbers
        .iter()
        .zip(&found.widths)
        .map(|(number, width)| {
            let drawn = width.resampled.map(|r| r.hypot(resolution));
            let error = width.error.hypot(resolution);
            Parameter::identified(&object(*number), "width_m", width.value, error, width.rows, how)
                .with_bootstrap(drawn)
        })
        .collect();
    let give = &found.give;
    if give.value > SIGNIFICANT * give.error {
        let square = give.value * give.value;
        let how = "give of the pads under load, one pad";
        let pad = Parameter::identified("pad", "stiffness_N_m", 1.0 / give.value, give.error / square, give.rows, how);
        parameters.push(pad.with_bootstrap(give.resampled.map(|r| r / square)));
    }
    Ok(parameters)
}
