//! Agreement of several recordings about the parameters of one object.

use foundation::estimate::Fit;
use statrs::distribution::{ChiSquared, ContinuousCDF as _};

/// Probability of a scatter by chance below which recordings disagree: that of three standard errors, Φ(−3)·2.
const BY_CHANCE: f64 = 2.7e-3;

/// Beginning of the warning about a parameter on which recordings disagree.
pub fn disagreement_about(full_name: &str) -> String {
    format!("the recordings disagree about {}:", full_name.replacen('.', " ", 1))
}

/// Names the parameters on which the recordings disagree, each fitted `alone`, and widens their errors by the Birge ratio
/// (Birge 1932, Phys. Rev. 40, 207).
pub fn check(fit: &mut Fit, alone: &[Fit]) {
    let tests = fit.parameters.len().max(1) as f64;
    for parameter in &mut fit.parameters {
        let values = || {
            let same = alone.iter().filter_map(|one| one.parameter(&parameter.object, &parameter.name));
            same.filter_map(|p| p.value.zip(p.std_error.filter(|error| *error > 0.0)))
        };
        let Some((ratio, error)) = scatter(values(), tests) else { continue };
        let ends = |fold: fn(f64, f64) -> f64| values().map(|(value, _)| value).reduce(fold).unwrap_or_default();
        fit.warnings.push(format!(
            "{} {:.4} to {:.4}, {ratio:.1} times as far apart as their errors say: the objects differ, the zero of the sensor moved, or the model misses something",
            disagreement_about(&parameter.full_name()),
            ends(f64::min),
            ends(f64::max)
        ));
        for known in [&mut parameter.std_error, &mut parameter.bootstrap_error].into_iter().flatten() {
            *known = known.max(error);
        }
    }
}

/// Root of the scatter of values about their mean over the one that their errors say, and the error of the mean by the scatter;
/// none if chance makes it so large.
fn scatter(values: impl Iterator<Item = (f64, f64)> + Clone, tests: f64) -> Option<(f64, f64)> {
    let weight = |error: f64| error.powi(-2);
    let (sum, weights) = values.clone().fold((0.0, 0.0), |(s, w), (v, e)| (s + v * weight(e), w + weight(e)));
    let freedom = values.clone().count().checked_sub(1).filter(|freedom| *freedom > 0)? as f64;
    let scatter: f64 = values.map(|(value, error)| ((value - sum / weights) / error).powi(2)).sum();
    let by_chance = ChiSquared::new(freedom).ok()?.sf(scatter) * tests;
    let ratio = (scatter / freedom).sqrt();
    (by_chance < BY_CHANCE).then(|| (ratio, ratio / weights.sqrt()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use foundation::estimate::Parameter;

    fn fit(value: f64, error: f64) -> Fit {
        Fit { parameters: vec![Parameter::identified("mechanism", "mass_kg", value, error, 10, "")], ..Fit::default() }
    }

    #[test]
    fn recordings_of_two_objects_disagree() {
        let mut total = fit(1.5, 0.007);
        check(&mut total, &[fit(1.0, 0.01), fit(2.0, 0.01)]);
        assert!(total.warnings[0].contains("disagree about mechanism mass_kg: 1.0000 to 2.0000"), "{total:?}");
        assert!((total.parameters[0].std_error.expect("an error") - 0.5).abs() < 1e-9, "half the distance");
    }

    #[test]
    fn recordings_of_one_object_do_not() {
        let mut total = fit(1.0, 0.007);
        check(&mut total, &[fit(0.99, 0.01), fit(1.01, 0.01), fit(1.02, 0.01)]);
        assert_eq!(total, fit(1.0, 0.007));
    }
}
