//! Width of held objects and give of the pads, from the distance of the tips over the grip force.
//!
//! The thesis took the mean distance for the width, and its blocks were 7 % too narrow: each pad yields by F/k. Here
//! the distance is extrapolated to no grip at all, by the laws of a pad: a linear spring, a foam that hardens, a foam
//! that comes to its end. One recording rarely tells for certain which law holds, and how strongly. They are therefore
//! averaged by their likelihoods (Bayesian model averaging, Hoeting et al. 1999), and their disagreement is part of the
//! error.

use crate::regression::bootstrap::{Resampled, block_bootstrap_within};
use crate::regression::linear::{LinearFit, Values, least_squares_values};
use crate::regression::long_run_variance::HALF_INTERVAL;
use crate::segment::threshold::percentile;
use foundation::estimate::EstimateError;
use haptics::law::contact::{Cushion, Densification, ONSET, StiffnessHardening};
use std::ops::Range;

/// Distance of the tips, grip force and rate of the distance at independent samples of one grasp.
pub(super) struct Grip<'a> {
    /// Distance of the tips, m.
    pub(super) width: &'a [f64],
    /// Mean normal force of the two fingers, N.
    pub(super) force: &'a [f64],
    /// Rate of the distance, m/s: pads damp.
    pub(super) rate: &'a [f64],
}

/// Rows of several holds of several objects, all by the same pads.
#[derive(Clone, Debug, Default)]
pub(super) struct Grips {
    width: Vec<f64>,
    force: Vec<f64>,
    rate: Vec<f64>,
    /// Number of the held object, from 0.
    held: Vec<usize>,
    /// Segments of rows of which every draw of a bootstrap must have a part.
    stretches: Vec<Range<usize>>,
}

impl Grips {
    /// Adds a hold of the object with this number; objects are numbered without gaps.
    pub(super) fn add(&mut self, object: usize, grip: &Grip<'_>) {
        let first = self.width.len();
        self.width.extend_from_slice(grip.width);
        self.force.extend_from_slice(grip.force);
        self.rate.extend_from_slice(grip.rate);
        self.held.extend(std::iter::repeat_n(object, grip.width.len()));
        self.stretches.extend(squeezes(grip.force).into_iter().map(|s| first + s.start..first + s.end));
    }

    fn objects(&self) -> usize {
        self.held.iter().max().map_or(0, |most| most + 1)
    }

    /// Columns: width of each object at no force, depth of a pad of 1 N/m, damping.
    fn columns(&self, depth: Vec<f64>) -> Vec<Vec<f64>> {
        let held = |object: usize| self.held.iter().map(|h| f64::from(u8::from(*h == object))).collect();
        (0..self.objects()).map(held).chain([depth, self.rate.clone()]).collect()
    }

    /// Compression of a pad of 1 N/m with the give of `cushion` (none: a linear spring).
    fn depth(&self, cushion: Option<&Cushion>) -> Vec<f64> {
        cushion.map_or_else(|| self.force.clone(), |c| self.force.iter().map(|f| c.depth_m(*f)).collect())
    }

    /// Fit of pads with the give of `cushion`, and its regressors.
    fn regress(&self, cushion: Option<&Cushion>) -> Result<(Values, Vec<Vec<f64>>), EstimateError> {
        let columns = self.columns(self.depth(cushion));
        Ok((least_squares_values(&columns, &self.width, None)?, columns))
    }
}

/// A value with its standard error by covariance and by resampling.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Estimate {
    pub(super) value: f64,
    pub(super) error: f64,
    pub(super) resampled: Option<f64>,
    pub(super) rows: usize,
}

/// Estimates from several holds together.
#[derive(Clone, Debug)]
pub(super) struct Pressed {
    /// Width of each object at no force, m.
    pub(super) widths: Vec<Estimate>,
    /// Give of one pad at no force, m/N.
    pub(super) give: Estimate,
    bent: f64,
    /// Widths and slope of linear pads.
    line: Vec<f64>,
}

/// Estimates from one grasp.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct PadFit {
    /// Distance of the tips at no force, m, and its standard error.
    pub(super) width_m: f64,
    pub(super) width_error_m: f64,
    /// Give of one pad at no force, m/N, and its standard error.
    pub(super) give_m_per_n: f64,
    pub(super) give_error: f64,
    /// Both errors by a block bootstrap of the rows; `None` where they are too few.
    pub(super) resampled: Option<(f64, f64)>,
    /// Probability that the give is not the same at every force.
    pub(super) bent: f64,
    /// Samples.
    pub(super) rows: usize,
    /// Distance at no force and give of linear pads.
    pub(super) line: (f64, f64),
}

/// Standard error of an even distribution of half width 1: 1.96 of it hold 95 %.
/// Derived: 0.95 over 1.96.
pub(super) const EVEN: f64 = 0.95 / HALF_INTERVAL;
/// Give of a pad in shear over that under pressure, if nothing shows it, with its error. The shear stiffness is taken
/// as evenly distributed between 0.3 and 1.1 of the normal one, for soft pads of foam and rubber. The far side is the
/// soft one: half the width of the even distribution itself would leave the softest pads five errors away.
/// Derived: the mean of the inverse ratio, ln(1.1/0.3)/0.8, and the error that holds 95 % of it.
pub(super) const SHEAR_GIVE: (f64, f64) = (1.62, 0.67);
/// Least variation of a grip, as a share of its mean, that tells the pads' give from the width.
/// Choice: no case of the ablation reads it.
pub(super) const LEAST_GRIP_VARIATION: f64 = 0.05;
/// Share of its usual force from which a grip counts as closed; less is the way to it or from it.
/// Choice: no case of the ablation reads it.
pub(super) const CLOSED_GRIP_SHARE: f64 = 0.5;
/// Relative error of a width whose pad compression could not be measured.
/// Source: docs/parameters.md: the thesis's plain means of the widths are 7 % too narrow.
pub(super) const UNKNOWN_COMPRESSION: f64 = 0.07;
/// Stiffness of a hand whose pads' give the recording does not show, N/m. The thesis's fingers gave 1.1 mm under a few
/// newtons.
/// Choice: halved or doubled, none of 55 answers changes.
pub(super) const HAND_N_M: f64 = 1000.0;
/// Give of the softest pad in shear under a force as large as the grip, as a share of the object's size: 500 N/m under
/// 2.3 N, at a block of 2 cm.
/// Choice: no case of the ablation reads it.
pub(super) const SOFTEST: f64 = 0.22;

/// Prior odds of a linear spring against either way to bend.
/// Choice: halved, 0 of 3 answers change; doubled, 1 of 3 answers change.
const SIMPLER: f64 = 12.0;
/// Share of the largest difference from the usual grip from which a grip is a squeeze.
/// Choice: halved or doubled, none of 3 answers changes.
const SQUEEZED: f64 = 0.5;
/// Largest number of squeezes. With more, the grip varies all the time, and any part of the recording is like the
/// others.
/// Choice: halved or doubled, none of 3 answers changes.
const MOST_SQUEEZES: usize = 6;
/// Number of values of a bend that are tried first, and then between the neighbours of the best one.
/// Choice: halved or doubled, none of 3 answers changes.
const TRIALS: usize = 16;

/// A way of giving that is not the same at every force; one number says how strongly or where.
#[derive(Clone, Copy)]
enum Bend {
    /// `F = k (d + r k² d³)`: foam that hardens; r in 1/N².
    Hardening,
    /// Foam that comes to its end at a force, N.
    End,
}

impl Bend {
    /// Depth over force of a pad of 1 N/m; any other one yields in proportion.
    fn cushion(self, number: f64) -> Cushion {
        let linear = Cushion::linear(1.0);
        match self {
            Self::Hardening => Cushion { spring: StiffnessHardening { k3: number, ..linear.spring }, ..linear },
            Self::End => Cushion { end: Densification::of(number / ONSET, 1.0), ..linear },
        }
    }

    /// Between hardly any bend and a strong one at the forces of a grip, N. An end below all of them could not be told from a
    /// linear pad that is stiffer: it must lie within.
    fn range(self, least_n: f64, largest_n: f64) -> (f64, f64) {
        match self {
            Self::Hardening => (0.003 / largest_n.powi(2), 3.0 / largest_n.powi(2)),
            Self::End => (least_n + 0.3 * (largest_n - least_n), largest_n),
        }
    }
}

/// One way in which pads may yield, with its likelihood.
struct Model {
    fit: Values,
    columns: Vec<Vec<f64>>,
    /// Logarithm of its probability before the recording, up to a constant.
    before: f64,
    bic: f64,
    bent: bool,
}

impl Model {
    /// Logarithm of its probability, up to a constant.
    fn score(&self) -> f64 {
        self.before - 0.5 * self.bic
    }
}

/// Relative likelihood below which a model changes no digit of an average.
/// Derived: below the relative resolution of an f64, 1e-16.
const NO_DIGIT: f64 = 1e-20;

/// Width and give of one hold; `None` when the force does not tell the give from the width.
pub(super) fn width_over_force(grip: &Grip<'_>) -> Result<Option<PadFit>, EstimateError> {
    let mut grips = Grips::default();
    grips.add(0, grip);
    let one = |found: Pressed| {
        let (width, give) = (*found.widths.first()?, found.give);
        Some(PadFit {
            width_m: width.value,
            width_error_m: width.error,
            give_m_per_n: give.value,
            give_error: give.error,
            resampled: width.resampled.zip(give.resampled),
            bent: found.bent,
            rows: give.rows,
            line: (*found.line.first()?, -0.5 * *found.line.get(1)?),
        })
    };
    Ok(widths_over_force(&grips)?.and_then(one))
}

/// The weighted answer of all models, with one give for all holds; `None` when the force does not tell the give from the widths.
pub(super) fn widths_over_force(grips: &Grips) -> Result<Option<Pressed>, EstimateError> {
    let (fit, columns) = grips.regress(None)?;
    let line = fit.clone().with_errors(&columns, None);
    if !line.identified.iter().take(grips.objects() + 1).all(|i| *i) {
        return Ok(None);
    }
    let independent = line.effective_samples.max(2.0);
    let resampled = block_bootstrap_within(&columns, &grips.width, None, &line, &grips.stretches);
    let mut models = vec![Model { bic: bic(fit.rms, independent), fit, columns, before: SIMPLER.ln(), bent: false }];
    let (least_n, largest_n) =
        grips.force.iter().fold((f64::INFINITY, 0.0_f64), |(low, high), f| (low.min(f.max(0.0)), high.max(*f)));
    if largest_n > 0.0 {
        for bend in [Bend::Hardening, Bend::End] {
            models.extend(bent_models(grips, bend, bend.range(least_n, largest_n), independent)?);
        }
    }
    Ok(Some(average(models, grips, &line, resampled.as_ref().map(Resampled::errors))))
}

/// Segments of about the usual grip and of squeezes beside it: if few squeezes show all of the give, every draw must
/// have them.
fn squeezes(force: &[f64]) -> Vec<Range<usize>> {
    let mut sorted = force.to_vec();
    let usual = percentile(&mut sorted, 0.5);
    let most = force.iter().fold(0.0_f64, |most, f| most.max((f - usual).abs()));
    let squeezed = |f: f64| (f - usual).abs() > SQUEEZED * most;
    let mut stretches: Vec<Range<usize>> = Vec::new();
    for (i, f) in force.iter().enumerate() {
        match stretches.last_mut() {
            Some(last) if squeezed(*f) == squeezed(force[last.start]) => last.end = i + 1,
            _ => stretches.push(i..i + 1),
        }
    }
    if stretches.len() > MOST_SQUEEZES { std::iter::once(0..force.len()).collect() } else { stretches }
}

/// The models of one way to bend: a coarse row of values, then a fine one about the best. Each value's share of the
/// probability is the part of the range that it stands for, so that the open part of the bend is averaged over.
fn bent_models(
    grips: &Grips,
    bend: Bend,
    (low, high): (f64, f64),
    independent: f64,
) -> Result<Vec<Model>, EstimateError> {
    let place = |from: f64, to: f64, k: usize| from * (to / from).powf((k as f64 + 0.5) / TRIALS as f64);
    let whole = (high / low).ln();
    let row = |from: f64, to: f64| -> Result<Vec<(f64, Model)>, EstimateError> {
        let share = ((to / from).ln() / (whole * TRIALS as f64)).ln();
        let trial = |k: usize| {
            let number = place(from, to, k);
            let (fit, columns) = grips.regress(Some(&bend.cushion(number)))?;
            Ok((number, Model { bic: bic(fit.rms, independent), fit, columns, before: share, bent: true }))
        };
        (0..TRIALS).map(trial).collect()
    };
    let coarse = row(low, high)?;
    let step = (high / low).powf(1.0 / TRIALS as f64);
    let best = coarse.iter().min_by(|a, b| a.1.bic.total_cmp(&b.1.bic)).map_or(low, |c| c.0);
    let (from, to) = ((best / step.powf(1.5)).max(low), (best * step.powf(1.5)).min(high));
    let outside = coarse.into_iter().filter(|(number, _)| *number < from || *number > to);
    Ok(outside.chain(row(from, to)?).map(|(_, model)| model).collect())
}

/// `line`: the linear spring's fit, and `resampled`: errors of its parameters by resampling. The larger scatter of bent
/// pads applies to these errors, too.
fn average(models: Vec<Model>, grips: &Grips, line: &LinearFit, resampled: Option<&[f64]>) -> Pressed {
    let likely = likely(models);
    let total: f64 = likely.iter().map(|m| m.weight).sum();
    let part = |f: &dyn Fn(&Likely) -> f64| likely.iter().map(|m| m.weight * f(m)).sum::<f64>() / total;
    let of = |column: usize| {
        let mean = part(&|m| m.fit.values[column]);
        let variance = part(&|m| m.fit.std_errors[column].powi(2) + (m.fit.values[column] - mean).powi(2));
        let apart = part(&|m| (m.fit.values[column] - mean).powi(2));
        let scatter = part(&|m| m.fit.std_errors[column].powi(2)).sqrt();
        let drawn = resampled.map(|r| (r[column] * scatter / line.std_errors[column]).hypot(apart.sqrt()));
        (mean, variance.sqrt(), drawn)
    };
    let rows = |object: usize| grips.held.iter().filter(|h| **h == object).count();
    let width = |object: usize| {
        let (value, error, resampled) = of(object);
        Estimate { value, error, resampled, rows: rows(object) }
    };
    let (slope, error, resampled) = of(grips.objects());
    // Both pads give.
    let give = Estimate {
        value: -0.5 * slope,
        error: 0.5 * error,
        resampled: resampled.map(|r| 0.5 * r),
        rows: grips.width.len(),
    };
    let widths = (0..grips.objects()).map(width).collect();
    Pressed { widths, give, bent: part(&|m| f64::from(u8::from(m.bent))), line: line.values.clone() }
}

/// A model that counts.
struct Likely {
    /// Its probability, up to a factor.
    weight: f64,
    fit: LinearFit,
    bent: bool,
}

/// The models that change a digit of an average. Errors cost more than values: only these are asked for theirs.
fn likely(models: Vec<Model>) -> Vec<Likely> {
    let most = models.iter().map(Model::score).fold(f64::NEG_INFINITY, f64::max);
    let weighed = models.into_iter().map(|m| ((m.score() - most).exp(), m));
    let of = |(weight, m): (f64, Model)| Likely { weight, fit: m.fit.with_errors(&m.columns, None), bent: m.bent };
    weighed.filter(|(weight, _)| *weight > NO_DIGIT).map(of).collect()
}

/// BIC counted in independent samples: neighbours that repeat each other are no new evidence. The bend itself is averaged over,
/// not counted.
fn bic(rms: f64, independent: f64) -> f64 {
    independent * (rms * rms).max(1e-300).ln()
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt as _, SeedableRng as _, rngs::StdRng};
    use rand_distr::StandardNormal;

    /// Fit of a grip that varies between 1.5 and 3.5 N on pads with the give of `cushion`.
    fn fitted(cushion: &Cushion, seed: u64, noise_m: f64) -> PadFit {
        let mut rng = StdRng::seed_from_u64(seed);
        let force: Vec<f64> = (0..150).map(|i| 2.5 + (0.13 * f64::from(i)).sin()).collect();
        let mut noisy = |f: &f64| 0.016 - 2.0 * cushion.depth_m(*f) + noise_m * rng.sample::<f64, _>(StandardNormal);
        let width: Vec<f64> = force.iter().map(&mut noisy).collect();
        let rate: Vec<f64> = (0..150).map(|i| 1e-3 * (0.29 * f64::from(i)).cos()).collect();
        let grip = Grip { width: &width, force: &force, rate: &rate };
        width_over_force(&grip).expect("solves").expect("the force varies")
    }

    #[test]
    fn width_and_give_are_found_with_true_errors_for_linear_hardening_and_ending_pads() {
        let linear = Cushion::linear(2000.0);
        let hardening = Cushion { spring: StiffnessHardening { k1: 2000.0, k3: 5e8, hertz: 0.0 }, ..linear };
        let ending = Cushion { end: Densification::of(1.5e-3, 2000.0), ..linear };
        for (name, cushion) in [("linear", linear), ("hardening", hardening), ("ending", ending)] {
            let fits: Vec<PadFit> = (0..200).map(|seed| fitted(&cushion, seed, 3e-6)).collect();
            let held = |covers: &dyn Fn(&PadFit) -> bool| fits.iter().filter(|f| covers(f)).count();
            let width = held(&|f| (f.width_m - 0.016).abs() < 1.96 * f.width_error_m);
            let bent = fits.iter().map(|f| f.bent).sum::<f64>() / 200.0;
            let error = fits.iter().map(|f| f.width_error_m).sum::<f64>() / 200.0;
            println!("{name}: width held {width} of 200, error {error:.2e}, bent {bent:.3}");
            let least = if name == "linear" { 5e-6 } else { 150e-6 };
            assert!(width >= 180 && error < least, "{name}: {width} of 200, {error}");
            assert!(if name == "linear" { bent < 0.3 } else { bent > 0.9 }, "{name}: {bent}");
        }
    }

    #[test]
    fn an_even_grip_of_one_object_is_understood_beside_a_squeeze_of_another() {
        let (mut rng, noise_m) = (StdRng::seed_from_u64(8), 3e-6);
        let (truth, stiffness) = ([0.016, 0.023], 2400.0);
        let mut grips = Grips::default();
        for (object, width_m) in truth.into_iter().enumerate() {
            let squeeze = if object == 0 { 0.0 } else { 1.0 };
            let force: Vec<f64> = (0..120).map(|i| 2.5 + squeeze * (0.13 * f64::from(i)).sin()).collect();
            let mut seen = |f: &f64| width_m - 2.0 * f / stiffness + noise_m * rng.sample::<f64, _>(StandardNormal);
            let width: Vec<f64> = force.iter().map(&mut seen).collect();
            let rate: Vec<f64> = (0..120).map(|i| 1e-3 * (0.29 * f64::from(i)).cos()).collect();
            grips.add(object, &Grip { width: &width, force: &force, rate: &rate });
        }
        let found = widths_over_force(&grips).expect("solves").expect("one of them varies");
        for (width, truth) in found.widths.iter().zip(truth) {
            assert!((width.value - truth).abs() < 3.0 * width.error && width.error < 2e-5, "{width:?} of {truth}");
        }
        assert!((found.give.value * stiffness - 1.0).abs() < 3.0 * found.give.error * stiffness, "{:?}", found.give);
    }

    #[test]
    fn the_give_in_shear_holds_95_percent_of_what_is_assumed() {
        let shares = (0..10_000).map(|i| 1.0 / (0.3 + 0.8 * (f64::from(i) + 0.5) / 10_000.0));
        let gives: Vec<f64> = shares.collect();
        let mean = gives.iter().sum::<f64>() / 10_000.0;
        let held = gives.iter().filter(|g| (*g - SHEAR_GIVE.0).abs() < 1.96 * SHEAR_GIVE.1).count();
        assert!((mean - SHEAR_GIVE.0).abs() < 0.01 && (9_450..=9_550).contains(&held), "{mean} {held}");
    }

    #[test]
    fn an_even_grip_tells_nothing() {
        let grip = Grip { width: &[0.01; 20], force: &[2.0; 20], rate: &[0.0; 20] };
        assert!(width_over_force(&grip).expect("solves").is_none());
    }
}
