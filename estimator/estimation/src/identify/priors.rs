//! Prior knowledge that the user states: priors and bounds, from the sidecar or the command line.
//!
//! A known value holds exactly: a fit with the parameter in its regression leaves it out there; every other fit takes
//! it in here. A prior is a measurement that was made elsewhere. It joins the estimates by their covariance (Kalman's
//! update), so that it also sharpens parameters that were inseparable from its own. A bound cuts the distribution off;
//! the result holds mean and spread of the remaining part (moment matching), and correlated parameters follow.

use super::limits::SIGNIFICANT;
use foundation::estimate::{Correlated, Fit, Parameter};
use haptics::recording::{Meta, Prior};
use nalgebra::{DMatrix, DVector};
use statrs::distribution::{Continuous, ContinuousCDF, Normal};

/// Distance of a value outside its bounds, in standard errors, beyond which it simply stands at the bound.
/// Choice: no case of the ablation reads it.
const FAR_OUTSIDE: f64 = 6.0;
/// Distance between bounds, in standard errors, below which a distribution within them is uniform.
/// Choice: no case of the ablation reads it.
const NARROW: f64 = 0.02;
/// Share of a prior's spread above which the result has learnt nothing from the recording.
/// Choice: no case of the ablation reads it.
const LEARNT: f64 = 0.9;

/// Takes the statements of `meta` into a fit. Warnings say where they contradict the recording, or name nothing.
pub fn apply(fit: &mut Fit, meta: &Meta) {
    if meta.known.is_empty() && meta.prior.is_empty() && meta.bounds.is_empty() {
        return;
    }
    let mut groups = std::mem::take(&mut fit.correlated);
    let mut alone: Vec<Correlated> = fit
        .parameters
        .iter()
        .filter(|p| !groups.iter().any(|g| g.parameters.contains(&p.full_name())))
        .filter(|p| p.std_error != Some(0.0))
        .map(by_itself)
        .collect();
    for group in groups.iter_mut().chain(&mut alone) {
        let before = group.clone();
        let said = update(group, meta);
        if said.is_empty() {
            continue;
        }
        fit.warnings.extend(said.iter().filter_map(|s| s.warning.clone()));
        for (index, name) in group.parameters.iter().enumerate() {
            if let Some(parameter) = fit.parameters.iter_mut().find(|p| p.full_name() == *name) {
                write_back(parameter, index, group, &before, &said);
            }
        }
    }
    fit.correlated = groups;
    for name in meta.prior.keys().chain(meta.bounds.keys()) {
        if !fit.parameters.iter().any(|p| names(name, p)) {
            fit.warnings.push(format!(
                "a prior or bound is stated for {name}, which this fit does not have; check its spelling"
            ));
        }
    }
}

fn names(stated: &str, parameter: &Parameter) -> bool {
    stated == parameter.name || stated == parameter.full_name()
}

/// A parameter that goes together with no other. One that the recording does not show can be anything.
fn by_itself(parameter: &Parameter) -> Correlated {
    let variance = parameter.std_error.filter(|_| parameter.identified).map_or(f64::INFINITY, |e| e * e);
    Correlated {
        parameters: vec![parameter.full_name()],
        values: vec![parameter.value.unwrap_or(0.0)],
        covariance: vec![vec![variance]],
        shown_below: vec![f64::INFINITY],
    }
}

/// Action taken on one parameter.
struct Said {
    parameter: usize,
    how: String,
    /// Standard deviation of the statement itself.
    spread: f64,
    warning: Option<String>,
}

fn update(group: &mut Correlated, meta: &Meta) -> Vec<Said> {
    let p = group.parameters.len();
    let mut values = DVector::from_column_slice(&group.values);
    let mut covariance = DMatrix::from_fn(p, p, |i, j| group.covariance[i][j]);
    let mut said = Vec::new();
    for j in 0..p {
        // Parameters that the fit itself took as known have no variance any more.
        if let Some(value) = stated(&meta.known, &group.parameters[j]).filter(|_| covariance[(j, j)] > 0.0) {
            said.push(take_known(&mut values, &mut covariance, j, &group.parameters[j], *value));
        }
    }
    for j in 0..p {
        if let Some(prior) = stated(&meta.prior, &group.parameters[j]) {
            said.push(take_prior(&mut values, &mut covariance, j, &group.parameters[j], *prior));
        }
    }
    for j in 0..p {
        if let Some(bounds) = stated(&meta.bounds, &group.parameters[j]) {
            said.extend(cut_off(&mut values, &mut covariance, j, &group.parameters[j], *bounds));
        }
    }
    group.values = values.iter().copied().collect();
    group.covariance = (0..p).map(|i| (0..p).map(|j| covariance[(i, j)]).collect()).collect();
    said
}

/// The entry for `object.name`, or for `name` of any object.
fn stated<'a, T>(all: &'a std::collections::BTreeMap<String, T>, full: &str) -> Option<&'a T> {
    all.get(full).or_else(|| all.get(full.rsplit('.').next()?))
}

fn take_known(values: &mut DVector<f64>, covariance: &mut DMatrix<f64>, j: usize, name: &str, value: f64) -> Said {
    let own = covariance[(j, j)];
    let how = format!("taken as known: {value}");
    if !own.is_finite() {
        (values[j], covariance[(j, j)]) = (value, 0.0);
        return Said { parameter: j, how, spread: 0.0, warning: None };
    }
    let apart = (value - values[j]).abs() / own.sqrt();
    let warning = (apart > SIGNIFICANT).then(|| {
        format!(
            "the value {value} that {name} is known to have lies {apart:.1} standard errors off what the recording shows ({:.5} ± {:.5}); check both",
            values[j],
            own.sqrt()
        )
    });
    condition(values, covariance, j, value, 0.0);
    // To the last digit.
    values[j] = value;
    covariance.row_mut(j).fill(0.0);
    covariance.column_mut(j).fill(0.0);
    Said { parameter: j, how, spread: 0.0, warning }
}

fn take_prior(values: &mut DVector<f64>, covariance: &mut DMatrix<f64>, j: usize, name: &str, prior: Prior) -> Said {
    let (own, other) = (covariance[(j, j)], prior.std * prior.std);
    let how = format!("with the stated prior {} ± {}", prior.mean, prior.std);
    if !own.is_finite() {
        // Nothing was known of it, nor of how it goes with others.
        (values[j], covariance[(j, j)]) = (prior.mean, other);
        return Said { parameter: j, how, spread: prior.std, warning: None };
    }
    let surprise = prior.mean - values[j];
    let apart = surprise.abs() / (own + other).sqrt();
    let warning = (apart > SIGNIFICANT).then(|| {
        format!(
            "the stated prior of {name}, {} ± {}, lies {apart:.1} standard errors off what the recording shows ({:.5} ± {:.5}); check both",
            prior.mean,
            prior.std,
            values[j],
            own.sqrt()
        )
    });
    condition(values, covariance, j, values[j] + own / (own + other) * surprise, own * other / (own + other));
    Said { parameter: j, how, spread: prior.std, warning }
}

fn cut_off(
    values: &mut DVector<f64>,
    covariance: &mut DMatrix<f64>,
    j: usize,
    name: &str,
    [low, high]: [Option<f64>; 2],
) -> Option<Said> {
    let (mean, variance) = (values[j], covariance[(j, j)]);
    let (low, high) = (low.unwrap_or(f64::NEG_INFINITY), high.unwrap_or(f64::INFINITY));
    let word = |v: f64| if v.is_finite() { v.to_string() } else { "open".to_owned() };
    let how = format!("within the stated bounds {} to {}", word(low), word(high));
    let spread = (high - low) / 12.0_f64.sqrt();
    if !variance.is_finite() {
        if low.is_finite() && high.is_finite() {
            (values[j], covariance[(j, j)]) = (0.5 * (low + high), spread * spread);
            return Some(Said { parameter: j, how, spread, warning: None });
        }
        return None;
    }
    let sigma = variance.sqrt();
    let outside = ((low - mean) / sigma).max((mean - high) / sigma);
    if outside < -FAR_OUTSIDE || sigma <= 0.0 {
        // The bound cuts nothing off.
        return None;
    }
    let (new_mean, new_variance) = truncated(mean, sigma, low, high);
    condition(values, covariance, j, new_mean, new_variance);
    let warning = (outside > SIGNIFICANT).then(|| {
        format!(
            "{name} is {mean:.5} ± {sigma:.5} by the recording, {outside:.1} standard errors outside its stated bounds; check them, or what \
             the model leaves out"
        )
    });
    Some(Said { parameter: j, how, spread, warning })
}

/// Gives parameter `j` a new mean and variance; the others follow as far as they go together with it.
fn condition(values: &mut DVector<f64>, covariance: &mut DMatrix<f64>, j: usize, mean: f64, variance: f64) {
    let own = covariance[(j, j)];
    if own <= 0.0 {
        return;
    }
    let mut gain = covariance.column(j) / own;
    for (i, g) in gain.iter_mut().enumerate() {
        // An unknown parameter has no known correlation with this one.
        if !covariance[(i, i)].is_finite() {
            *g = 0.0;
        }
    }
    let change = mean - values[j];
    *values += &gain * change;
    let less = variance - own;
    for (a, b) in (0..values.len()).flat_map(|a| (0..values.len()).map(move |b| (a, b))) {
        covariance[(a, b)] += gain[a] * gain[b] * less;
    }
}

/// Mean and variance of a normal distribution cut off at `low` and `high`.
fn truncated(mean: f64, sigma: f64, low: f64, high: f64) -> (f64, f64) {
    let Ok(normal) = Normal::new(0.0, 1.0) else { return (mean, sigma * sigma) };
    let (a, b) = ((low - mean) / sigma, (high - mean) / sigma);
    if a > FAR_OUTSIDE || b < -FAR_OUTSIDE {
        // The tail falls off like an exponential of this length.
        let (edge, length) = if a > FAR_OUTSIDE { (low, sigma / a) } else { (high, sigma / b) };
        return (edge, length * length);
    }
    if b - a < NARROW {
        return (0.5 * (low + high), (high - low).powi(2) / 12.0);
    }
    let density = |x: f64| if x.is_finite() { normal.pdf(x) } else { 0.0 };
    let moment = |x: f64| if x.is_finite() { x * normal.pdf(x) } else { 0.0 };
    // In the upper tail the distribution function is 1 to the last digit: count from the other side.
    let mass = if a > 0.0 { normal.sf(a) - normal.sf(b) } else { normal.cdf(b) - normal.cdf(a) }.max(1e-300);
    let shift = (density(a) - density(b)) / mass;
    let variance = 1.0 + (moment(a) - moment(b)) / mass - shift * shift;
    ((mean + sigma * shift).clamp(low, high), sigma * sigma * variance.max(1e-6))
}

fn write_back(parameter: &mut Parameter, index: usize, group: &Correlated, before: &Correlated, said: &[Said]) {
    let error = group.covariance[index][index].sqrt();
    let (old, was_shown) = (before.covariance[index][index].sqrt(), parameter.identified);
    let own = said.iter().filter(|s| s.parameter == index).map(|s| s.how.clone()).collect::<Vec<_>>().join(", ");
    if own.is_empty() && (error - old).abs() <= 1e-9 * old {
        return;
    }
    if !error.is_finite() || (error > group.shown_below[index] && own.is_empty()) {
        return;
    }
    parameter.bootstrap_error = parameter.bootstrap_error.filter(|_| old.is_finite()).map(|b| b * error / old);
    let reason = match (was_shown, own.is_empty()) {
        (true, false) => format!("{}; {own}", parameter.how),
        (true, true) => format!("{}; sharpened by what is stated of {}", parameter.how, others(group, said)),
        (false, true) => format!("told apart with the help of what is stated of {}", others(group, said)),
        (false, false) if said.iter().any(|s| s.parameter == index && error > LEARNT * s.spread) => {
            format!("{own}: the recording alone does not show it ({})", parameter.how)
        }
        (false, false) => own,
    };
    *parameter = Parameter {
        bootstrap_error: parameter.bootstrap_error,
        ..Parameter::identified(
            &parameter.object,
            &parameter.name,
            group.values[index],
            error,
            parameter.samples,
            &reason,
        )
    };
}

fn others(group: &Correlated, said: &[Said]) -> String {
    let name = |s: &Said| group.parameters[s.parameter].rsplit('.').next().unwrap_or_default().to_owned();
    let mut named: Vec<String> = said.iter().map(name).collect();
    named.dedup();
    named.join(" and ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_known_holds_exactly_and_sharpens_what_goes_with_it() {
        let mut fit = merged();
        let meta = Meta { known: [("coulomb_N".to_owned(), 0.3)].into(), ..Meta::default() };
        apply(&mut fit, &meta);
        let coulomb = fit.parameter("crank", "coulomb_N").expect("there");
        assert_eq!((coulomb.value, coulomb.std_error), (Some(0.3), Some(0.0)));
        let other = fit.parameter("crank", "friction_mu").expect("there");
        assert!(other.std_error.is_some_and(|e| e < 0.02), "{other:?}");
        assert!(fit.warnings.is_empty(), "{:?}", fit.warnings);
        // Far off the measured value: a warning.
        let mut fit = Fit {
            parameters: vec![Parameter::identified("block-1", "weight_N", 0.35, 0.01, 10, "")],
            ..Fit::default()
        };
        apply(&mut fit, &Meta { known: [("block-1.weight_N".to_owned(), 0.5)].into(), ..Meta::default() });
        assert_eq!(fit.value("block-1", "weight_N"), Some(0.5));
        assert!(fit.warnings.iter().any(|w| w.contains("15.0 standard errors")), "{:?}", fit.warnings);
    }

    /// Two parameters whose sum is known to 0.01, and neither alone.
    fn merged() -> Fit {
        let covariance = vec![vec![1.0 + 5e-5, -1.0 + 5e-5], vec![-1.0 + 5e-5, 1.0 + 5e-5]];
        let why = "constant speed";
        Fit {
            parameters: vec![
                Parameter::unidentified("crank", "coulomb_N", 100, why),
                Parameter::unidentified("crank", "friction_mu", 100, why),
            ],
            correlated: vec![Correlated {
                parameters: vec!["crank.coulomb_N".to_owned(), "crank.friction_mu".to_owned()],
                values: vec![0.9, -0.6],
                covariance,
                shown_below: vec![0.1, 0.1],
            }],
            ..Fit::default()
        }
    }

    fn meta(prior: &[(&str, f64, f64)], bounds: &[(&str, Option<f64>, Option<f64>)]) -> Meta {
        Meta {
            prior: prior.iter().map(|(n, mean, std)| ((*n).to_owned(), Prior { mean: *mean, std: *std })).collect(),
            bounds: bounds.iter().map(|(n, low, high)| ((*n).to_owned(), [*low, *high])).collect(),
            ..Meta::default()
        }
    }

    #[test]
    fn a_prior_of_one_tells_the_other_apart() {
        let mut fit = merged();
        apply(&mut fit, &meta(&[("friction_mu", 0.05, 0.01)], &[]));
        let coulomb = fit.parameter("crank", "coulomb_N").expect("there");
        // Their sum is 0.3 ± 0.014: less 0.05 ± 0.01 leaves 0.25 ± 0.017.
        assert!((coulomb.value.expect("shown") - 0.25).abs() < 1e-3, "{coulomb:?}");
        assert!((coulomb.std_error.expect("shown") - 3e-4_f64.sqrt()).abs() < 1e-3, "{coulomb:?}");
        assert!(coulomb.how.contains("friction_mu"), "{}", coulomb.how);
        let mu = fit.parameter("crank", "friction_mu").expect("there");
        assert!(mu.identified && mu.how.contains("constant speed"), "the recording taught nothing of it: {}", mu.how);
        assert!(fit.warnings.is_empty());
    }

    #[test]
    fn equal_measurements_average() {
        let mut fit = Fit {
            parameters: vec![Parameter::identified("block-1", "weight_N", 0.30, 0.01, 9, "x")],
            ..Fit::default()
        };
        apply(&mut fit, &meta(&[("block-1.weight_N", 0.32, 0.01)], &[]));
        let p = fit.parameter("block-1", "weight_N").expect("there");
        assert!((p.value.expect("shown") - 0.31).abs() < 1e-12);
        assert!((p.std_error.expect("shown") - 0.01 / 2.0_f64.sqrt()).abs() < 1e-12);
    }

    #[test]
    fn a_prior_that_contradicts_is_pointed_out_and_a_misspelt_one_too() {
        let mut fit = Fit {
            parameters: vec![Parameter::identified("block-1", "weight_N", 0.30, 0.01, 9, "x")],
            ..Fit::default()
        };
        apply(&mut fit, &meta(&[("weight_N", 0.5, 0.01), ("wieght_N", 1.0, 1.0)], &[]));
        assert!(fit.warnings[0].contains("14.1 standard errors"), "{:?}", fit.warnings);
        assert!(fit.warnings[1].contains("wieght_N"));
    }

    #[test]
    fn a_bound_cuts_the_distribution_off() {
        // A half normal: mean σ √(2/π), variance σ² (1 − 2/π).
        let (mean, variance) = truncated(0.0, 2.0, 0.0, f64::INFINITY);
        assert!((mean - 2.0 * (2.0 / std::f64::consts::PI).sqrt()).abs() < 1e-9);
        assert!((variance - 4.0 * (1.0 - 2.0 / std::f64::consts::PI)).abs() < 1e-9);
        // Uniform when the bounds are much closer than the error.
        let (mean, variance) = truncated(0.3, 1e3, -1.0, 1.0);
        assert!(mean.abs() < 1e-3 && (variance - 1.0 / 3.0).abs() < 1e-3);
        let (mean, _) = truncated(-5.0, 0.1, 0.0, 1.0);
        assert_eq!(mean, 0.0);
        let negative = Parameter::identified("crank", "friction_mu", -0.02, 0.01, 9, "x");
        let mut fit = Fit { parameters: vec![negative], ..Fit::default() };
        apply(&mut fit, &meta(&[], &[("friction_mu", Some(0.0), None)]));
        let p = fit.parameter("crank", "friction_mu").expect("there");
        assert!(
            p.value.expect("shown") > 0.0 && p.value.expect("shown") < 0.01 && p.how.contains("0 to open"),
            "{p:?}"
        );
        assert!(fit.warnings.is_empty(), "two standard errors are no contradiction");
    }

    #[test]
    fn a_bound_that_cuts_nothing_changes_nothing() {
        let before =
            Fit { parameters: vec![Parameter::identified("crank", "weight_N", 0.3, 0.01, 9, "x")], ..Fit::default() };
        let mut fit = before.clone();
        apply(&mut fit, &meta(&[], &[("weight_N", Some(0.0), Some(1.0))]));
        assert_eq!(fit, before);
    }
}
