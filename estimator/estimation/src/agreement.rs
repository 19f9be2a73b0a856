//! Agreement of several recordings about the parameters of one object.

use foundation::estimate::{Fit, Parameter};
use statrs::distribution::{ChiSquared, ContinuousCDF as _};

/// Probability of a scatter by chance below which recordings disagree: that of three standard errors, Φ(−3)·2.
const BY_CHANCE: f64 = 2.7e-3;
/// A recording with fewer samples than the longest one over this number does not disagree: the error of a fit to few filtered rows
/// is too small.
/// Choice: 30 of 3000 rows disagreed by five errors.
pub const SHORTER: usize = 20;
/// A lower bound is not averaged: the largest one holds for all.
const LOWER_BOUND: &str = "friction_lower_bound";

/// Values of one parameter in several recordings.
#[derive(Clone, Copy, Debug)]
struct Scatter {
    /// Mean by the errors.
    mean: f64,
    /// Its error by the errors, and by the scatter where that is larger: times the Birge ratio (Birge 1932, Phys. Rev. 40, 207).
    error: f64,
    /// The Birge ratio: root of the scatter over the one that the errors say.
    ratio: f64,
    /// Probability of such a scatter by chance.
    by_chance: f64,
    /// Least and largest value.
    ends: (f64, f64),
}

impl Scatter {
    /// Scatter of values with their errors; none of fewer than two.
    fn of(values: &[(f64, f64)]) -> Option<Self> {
        let freedom = values.len().checked_sub(1).filter(|freedom| *freedom > 0)? as f64;
        let weight = |error: f64| error.powi(-2);
        let weights: f64 = values.iter().map(|(_, error)| weight(*error)).sum();
        let mean = values.iter().map(|(value, error)| value * weight(*error)).sum::<f64>() / weights;
        let scatter: f64 = values.iter().map(|(value, error)| (value - mean).powi(2) * weight(*error)).sum();
        let ratio = (scatter / freedom).sqrt();
        let end = |fold: fn(f64, f64) -> f64| values.iter().map(|(value, _)| *value).reduce(fold);
        let ends = (end(f64::min)?, end(f64::max)?);
        let by_chance = ChiSquared::new(freedom).ok()?.sf(scatter);
        Some(Self { mean, error: ratio.max(1.0) / weights.sqrt(), ratio, by_chance, ends })
    }

    /// Sentence about a parameter on which recordings disagree, one of so many.
    fn said(&self, parameter: &Parameter, of: usize) -> Option<String> {
        let (low, high) = self.ends;
        (self.by_chance * (of as f64) < BY_CHANCE).then(|| {
            format!(
                "{} {low:.4} to {high:.4}, {:.1} times as far apart as their errors say: the objects differ, the zero of the sensor \
                 moved, or the model misses something",
                disagreement_about(&parameter.full_name()),
                self.ratio
            )
        })
    }
}

/// Beginning of the warning about a parameter on which recordings disagree.
pub fn disagreement_about(full_name: &str) -> String {
    format!("the recordings disagree about {}:", full_name.replacen('.', " ", 1))
}

/// Names the parameters of a joint fit on which the recordings disagree, each fitted `alone`, and gives them the error of the
/// scatter.
pub fn check(fit: &mut Fit, alone: &[Fit]) {
    let count = fit.parameters.len();
    for parameter in &mut fit.parameters {
        let mut same: Vec<&Parameter> = identified(alone, parameter);
        let longest = same.iter().map(|p| p.samples).max().unwrap_or_default();
        same.retain(|p| SHORTER * p.samples >= longest);
        let Some(scatter) = Scatter::of(&values(&same)) else { continue };
        if let Some(said) = scatter.said(parameter, count) {
            fit.warnings.push(said);
            for known in [&mut parameter.std_error, &mut parameter.bootstrap_error].into_iter().flatten() {
                *known = known.max(scatter.error);
            }
        }
    }
}

/// Averages equal parameters of several fits by their errors. Constraints, warnings and other parameters are listed one after the other.
pub fn average(fits: &[Fit]) -> Fit {
    let [first, others @ ..] = fits else { return Fit::default() };
    let mut total = first.clone();
    for fit in others {
        total.constraints.extend(fit.constraints.iter().cloned());
        for warning in &fit.warnings {
            if !total.warnings.contains(warning) {
                total.warnings.push(warning.clone());
            }
        }
        for parameter in &fit.parameters {
            if total.parameter(&parameter.object, &parameter.name).is_none() {
                total.parameters.push(parameter.clone());
            }
        }
    }
    if others.is_empty() {
        return total;
    }
    let count = total.parameters.len();
    for parameter in &mut total.parameters {
        let same = identified(fits, parameter);
        total.warnings.extend(put_mean(parameter, &same, count));
    }
    // They belonged to the first recording only.
    total.quality = None;
    total.correlated.clear();
    total
}

/// Identified values of a parameter in several fits. An error of zero is unknown: it has no weight.
fn identified<'a>(fits: &'a [Fit], parameter: &Parameter) -> Vec<&'a Parameter> {
    let same = fits.iter().filter_map(|fit| fit.parameter(&parameter.object, &parameter.name));
    same.filter(|p| p.value.is_some() && p.std_error.is_some_and(|error| error > 0.0)).collect()
}

fn values(same: &[&Parameter]) -> Vec<(f64, f64)> {
    same.iter().filter_map(|p| p.value.zip(p.std_error)).collect()
}

/// Puts the mean of several values of a parameter in its place; a sentence if they disagree.
fn put_mean(parameter: &mut Parameter, same: &[&Parameter], count: usize) -> Option<String> {
    let of_value = |p: &&&Parameter| p.value.unwrap_or(f64::NEG_INFINITY);
    let first = match same {
        _ if parameter.name == LOWER_BOUND => same.iter().max_by(|a, b| of_value(a).total_cmp(&of_value(b)))?,
        [first, ..] => first,
        [] => return None,
    };
    parameter.clone_from(first);
    if parameter.name == LOWER_BOUND {
        return None;
    }
    let scatter = Scatter::of(&values(same))?;
    parameter.value = Some(scatter.mean);
    parameter.std_error = Some(scatter.error);
    // The error by resampling shrinks as the other one does, and keeps at least its share of it.
    let parts: Option<Vec<(f64, f64)>> = same.iter().map(|p| p.bootstrap_error.zip(p.std_error)).collect();
    parameter.bootstrap_error = parts.map(|parts| {
        let mean = parts.iter().map(|(error, _)| error.powi(-2)).sum::<f64>().sqrt().recip();
        let share = parts.iter().map(|(resampled, error)| resampled / error).fold(f64::INFINITY, f64::min);
        mean.max(scatter.error * share)
    });
    parameter.samples = same.iter().map(|p| p.samples).sum();
    scatter.said(parameter, count)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fit(value: f64, error: f64) -> Fit {
        Fit { parameters: vec![Parameter::identified("mechanism", "mass_kg", value, error, 10, "")], ..Fit::default() }
    }

    #[test]
    fn recordings_of_two_objects_disagree() {
        let alone = [fit(1.0, 0.01), fit(2.0, 0.01)];
        let mut total = fit(1.5, 0.007);
        check(&mut total, &alone);
        for found in [total, average(&alone)] {
            assert!(found.warnings[0].contains("disagree about mechanism mass_kg: 1.0000 to 2.0000"), "{found:?}");
            let error = found.parameters[0].std_error.expect("an error");
            assert!((error - 0.5).abs() < 1e-9, "half the distance, not {error}");
        }
    }

    #[test]
    fn recordings_of_one_object_do_not() {
        let mut total = fit(1.0, 0.007);
        check(&mut total, &[fit(0.99, 0.01), fit(1.01, 0.01), fit(1.02, 0.01), fit(7.0, 0.0)]);
        assert_eq!(total, fit(1.0, 0.007));
    }

    #[test]
    fn equal_errors_average_and_shrink() {
        let total = average(&[fit(1.0, 0.1), fit(1.1, 0.1)]);
        let p = &total.parameters[0];
        assert!((p.value.expect("a value") - 1.05).abs() < 1e-12 && total.warnings.is_empty());
        assert!((p.std_error.expect("an error") - 0.1 / 2.0_f64.sqrt()).abs() < 1e-12);
        assert_eq!(p.samples, 20);
    }

    #[test]
    fn an_average_does_not_depend_on_the_order() {
        let mut fits = [fit(1.0, 0.1), fit(1.3, 0.05), fit(1.1, 0.2), Fit::default()];
        let error = |fits: &[Fit]| average(fits).parameters[0].std_error.expect("an error");
        let one = error(&fits);
        fits.reverse();
        assert!((error(&fits) - one).abs() < 1e-12);
    }
}
