//! The user's statements about parameters on the command line: known values, priors, bounds.

use clap::Args;
use haptics::recording::{Prior, Recording};

/// Statements about parameters; they join those of the sidecars, and replace those of the same name.
#[derive(Args, Debug, Default)]
pub struct Stated {
    /// Take a parameter as known instead of estimating it (cranks and mechanisms), e.g. `weight_N=0.16`
    #[arg(long, value_name = "NAME=VALUE", value_parser = known)]
    known: Vec<(String, f64)>,
    /// What was believed of a parameter before, e.g. `friction_mu=0.05+-0.01` or `block-2.weight_N=0.43±0.02`
    #[arg(long, value_name = "NAME=MEAN+-STD", value_parser = prior)]
    prior: Vec<(String, Prior)>,
    /// Least and largest value of a parameter, either of them left out, e.g. `friction_mu=0..1` or `weight_N=0..`
    #[arg(long, value_name = "NAME=LEAST..LARGEST", value_parser = bounds)]
    bounds: Vec<(String, Bounds)>,
}

type Bounds = [Option<f64>; 2];

impl Stated {
    pub(super) fn put_into(&self, recordings: &mut [Recording]) {
        for recording in recordings {
            recording.meta.known.extend(self.known.iter().cloned());
            recording.meta.prior.extend(self.prior.iter().cloned());
            recording.meta.bounds.extend(self.bounds.iter().cloned());
        }
    }
}

fn named(text: &str, like: &str) -> Result<(String, String), String> {
    let (name, rest) = text.split_once('=').ok_or_else(|| format!("`{text}` has no `=`; write it like {like}"))?;
    Ok((name.trim().to_owned(), rest.trim().to_owned()))
}

fn number(text: &str, whole: &str) -> Result<f64, String> {
    let value = text.trim().parse().ok().filter(|v: &f64| v.is_finite());
    value.ok_or_else(|| format!("`{}` in `{whole}` is no number", text.trim()))
}

fn known(text: &str) -> Result<(String, f64), String> {
    let (name, rest) = named(text, "weight_N=0.16")?;
    Ok((name, number(&rest, text)?))
}

fn prior(text: &str) -> Result<(String, Prior), String> {
    let (name, rest) = named(text, "friction_mu=0.05+-0.01")?;
    let (mean, std) = ["±", "+/-", "+-"]
        .into_iter()
        .find_map(|sign| rest.split_once(sign))
        .ok_or_else(|| format!("`{text}` has no spread; write it like friction_mu=0.05+-0.01"))?;
    let prior = Prior { mean: number(mean, text)?, std: number(std, text)? };
    if prior.std > 0.0 {
        Ok((name, prior))
    } else {
        Err(format!("the spread in `{text}` must be above 0; use --known for a certain value"))
    }
}

fn bounds(text: &str) -> Result<(String, Bounds), String> {
    let (name, rest) = named(text, "friction_mu=0..1")?;
    let (low, high) =
        rest.split_once("..").ok_or_else(|| format!("`{text}` has no `..`; write it like friction_mu=0..1"))?;
    let side = |part: &str| if part.trim().is_empty() { Ok(None) } else { number(part, text).map(Some) };
    let (low, high) = (side(low)?, side(high)?);
    if let (Some(low), Some(high)) = (low, high)
        && low >= high
    {
        return Err(format!("in `{text}` the first bound must be the smaller one"));
    }
    Ok((name, [low, high]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn statements_are_read_and_refused_in_words() {
        assert_eq!(known("weight_N=0.16"), Ok(("weight_N".to_owned(), 0.16)));
        let expected = Prior { mean: 0.05, std: 0.01 };
        for text in ["friction_mu=0.05+-0.01", "friction_mu = 0.05 ± 0.01", "friction_mu=0.05+/-0.01"] {
            assert_eq!(prior(text), Ok(("friction_mu".to_owned(), expected)), "{text}");
        }
        assert_eq!(prior("a=-2e-3+-1e-4").expect("signs and exponents").1, Prior { mean: -2e-3, std: 1e-4 });
        assert_eq!(bounds("weight_N=0.."), Ok(("weight_N".to_owned(), [Some(0.0), None])));
        assert_eq!(bounds("weight_N=-1..2.5"), Ok(("weight_N".to_owned(), [Some(-1.0), Some(2.5)])));
        for bad in ["weight_N", "weight_N=x", "weight_N=nan"] {
            assert!(known(bad).is_err(), "{bad}");
        }
        for bad in ["mu=0.05", "mu=0.05+-0", "mu=0.05+-x"] {
            assert!(prior(bad).is_err(), "{bad}");
        }
        for bad in ["mu=1", "mu=2..1", "mu=a..b"] {
            assert!(bounds(bad).is_err(), "{bad}");
        }
    }
}
