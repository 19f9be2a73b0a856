//! A weight that changes while it is carried: does the object leak, or does the force sensor drift?
//!
//! Both look alike while the object is in the air. A reading without the object tells them apart. The sensors rest at
//! their bias in free motion, so a bias that moved between before and after the carry is drift, and one that did not
//! move is none. Another object that is weighed twice serves as well. Weaker evidence is the sum of the horizontal
//! forces on a carried object, which a leak leaves at zero and a warming pair of sensors may not. The fingers' shares
//! of the change are used only if nothing else is there.
//!
//! Four hypotheses (nothing, leak, drift, both) are compared by the likelihood of the measured rates (Gaussian marginal
//! likelihoods). Rates that exist are of the size of the largest observed one, others are below [`NEGLIGIBLE`] of it. A
//! verdict needs a probability of [`CONFIDENT`]; otherwise it cannot be told, and the answer names the motion that
//! would tell.

mod rates;
#[cfg(test)]
mod tests;
mod verdict;
mod weighing;
mod words;

use foundation::estimate::EstimateError;
use rates::{Rates, rates};
use serde::{Deserialize, Serialize};
use verdict::SIGNIFICANT;
pub use verdict::Verdict;
pub use weighing::{Measured, Series, Weighing};

/// A hypothesis must be as probable as this to be the answer.
pub const CONFIDENT: f64 = 0.95;
/// A rate below this share of the largest one that is seen is as good as none.
pub const NEGLIGIBLE: f64 = 0.03;
/// A drift during the carry may differ by this share from the mean one between the readings before and after.
const UNEVEN: f64 = 0.1;
/// Before anything is seen: nothing, leak, drift, both.
const BEFORE: [f64; 4] = [0.25, 0.36, 0.36, 0.03];

/// The answer of [`leak_or_drift`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LeakAnswer {
    /// Verdict on the change.
    pub verdict: Verdict,
    /// Probability of the verdict; of the likeliest one if it cannot be told.
    pub probability: f64,
    /// Probabilities of nothing, leak, drift, both.
    pub probabilities: [f64; 4],
    /// Rate of the reading while carried, N/s.
    pub reading_n_s: Measured,
    /// Mass lost, kg/s, positive for a loss; absent when there is no reading to tell the bias from.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub leak_kg_s: Option<Measured>,
    /// Drift of the bias, N/s; absent when there is no reading to tell it from.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub drift_n_s: Option<Measured>,
    /// Why, in one sentence.
    pub why: String,
    /// The motion that would tell, where it cannot be told.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub motion: Option<String>,
}

/// Tells a leak from a drift of the force sensors.
///
/// Errors: samples of a series that do not fit together, numbers that are not finite, a gravity that is not positive, or a carry too
/// short to show any rate.
pub fn leak_or_drift(weighing: &Weighing<'_>) -> Result<LeakAnswer, EstimateError> {
    let gravity = weighing.gravity_m_s2;
    if !(gravity > 0.0 && gravity.is_finite()) {
        return Err(EstimateError::Other(format!("a leak cannot be told under a gravity of {gravity} m/s²; state it")));
    }
    let rates = rates(weighing)?;
    let probabilities = posterior(&rates);
    let (verdict, probability) = verdict(&rates, probabilities);
    let leak_kg_s = rates.weight().map(|w| Measured { value: -w.value / gravity, std_error: w.std_error / gravity });
    Ok(LeakAnswer {
        verdict,
        probability,
        probabilities,
        reading_n_s: rates.reading,
        leak_kg_s,
        drift_n_s: rates.drift,
        why: words::why(verdict, &rates, leak_kg_s),
        motion: words::motion(verdict, &rates),
    })
}

fn verdict(rates: &Rates, probabilities: [f64; 4]) -> (Verdict, f64) {
    let drifts = rates.drift.is_some_and(|d| d.is_significant(SIGNIFICANT));
    if !rates.reading.is_significant(SIGNIFICANT) && !drifts {
        return (Verdict::Steady, probabilities[0]);
    }
    let names = [Verdict::Steady, Verdict::Leak, Verdict::SensorDrift, Verdict::Both];
    let (best, probability) =
        probabilities.into_iter().enumerate().fold((0, 0.0), |best, (k, p)| if p > best.1 { (k, p) } else { best });
    if probability >= CONFIDENT { (names[best], probability) } else { (Verdict::CannotTell, probability) }
}

/// Probabilities of nothing, leak, drift and both after the rates were seen.
fn posterior(rates: &Rates) -> [f64; 4] {
    let reading = rates.reading;
    let drift_seen = rates.drift.map_or(0.0, |d| d.value.abs());
    let largest = reading.value.abs().max(drift_seen).max(SIGNIFICANT * reading.std_error).max(f64::MIN_POSITIVE);
    let negligible = NEGLIGIBLE * largest;
    let mut logs: [f64; 4] = std::array::from_fn(|hypothesis| {
        let (leaks, drifts) = (hypothesis == 1 || hypothesis == 3, hypothesis >= 2);
        let of_weight = if leaks { largest } else { negligible }.powi(2);
        let of_bias = if drifts { largest } else { negligible }.powi(2);
        let own = reading.std_error.powi(2) + (UNEVEN * drift_seen).powi(2) + of_weight + of_bias;
        let vertical = match rates.drift {
            Some(drift) => pair(reading.value, drift.value, own, of_bias + drift.std_error.powi(2), of_bias),
            None => normal(reading.value, own) + sharing(rates, leaks, drifts),
        };
        vertical + across(rates, drifts, largest, negligible) + BEFORE[hypothesis].ln()
    });
    let most = logs.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    for l in &mut logs {
        *l = (*l - most).exp();
    }
    let total: f64 = logs.iter().sum();
    logs.map(|l| l / total)
}

/// Logarithm of the normal density of mean zero, up to a constant.
fn normal(value: f64, variance: f64) -> f64 {
    -0.5 * (value * value / variance + variance.ln())
}

/// The same for two values with variances `a` and `b` and covariance `c`.
fn pair(x: f64, y: f64, a: f64, b: f64, c: f64) -> f64 {
    let determinant = (a * b - c * c).max(f64::MIN_POSITIVE);
    -0.5 * ((b * x * x - 2.0 * c * x * y + a * y * y) / determinant + determinant.ln())
}

/// Log likelihood of the sum of the horizontal forces: sensors that drift do so in this channel, too, in one of two
/// cases.
fn across(rates: &Rates, drifts: bool, largest: f64, negligible: f64) -> f64 {
    let Some(across) = rates.across else { return 0.0 };
    let own = across.std_error.powi(2) + negligible.powi(2);
    let quiet = normal(across.value, own);
    if !drifts {
        return quiet;
    }
    let moved = normal(across.value, own + largest * largest);
    let most = quiet.max(moved);
    most + (0.5 * (quiet - most).exp() + 0.5 * (moved - most).exp()).ln()
}

/// Log likelihood of the fingers' shares of the change: a leak takes from both, more or less as they lean; of two
/// sensors one may drift alone.
fn sharing(rates: &Rates, leaks: bool, drifts: bool) -> f64 {
    /// Spread of a finger's share of a change by leaning.
    const LEANING: f64 = 0.25;
    let Some(share) = rates.share else { return 0.0 };
    let density = |mean: f64, spread: f64| {
        let sigma = spread.hypot(share.std_error);
        (-0.5 * ((share.value - mean) / sigma).powi(2)).exp() / sigma
    };
    let of_leak = density(0.5, LEANING);
    let of_drift = 0.25 * density(0.0, 0.0) + 0.25 * density(1.0, 0.0) + 0.5 * density(0.5, 2.0 * LEANING);
    let likelihood = match (leaks, drifts) {
        (true, false) => of_leak,
        (false, true) => of_drift,
        (true, true) => 0.5 * (of_leak + of_drift),
        (false, false) => density(0.5, 4.0 * LEANING),
    };
    likelihood.max(1e-300).ln()
}
