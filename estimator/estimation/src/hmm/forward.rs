//! Forward–backward: the likelihood of a sequence and the posterior of the state at every sample.

use super::chain::Chain;

/// Posterior expectations over the whole sequence.
#[derive(Clone, Debug, PartialEq)]
pub struct Expectation {
    /// Logarithm of the probability density of the sequence.
    pub log_likelihood: f64,
    /// γ: probability of every state at every sample, one row a sample.
    pub posterior: Vec<f64>,
    /// Σ ξ: expected number of transitions, row by row (from, to).
    pub transitions: Vec<f64>,
}

/// A sum of scaled exponentials below this has lost its digits and is made again in the logarithm.
const LOST: f64 = 1e-280;

/// The procedure on the logarithms of the densities ([`super::model::Model::log_emissions`]): one row of states a sample, all finite.
///
/// Each step takes one exponential and one logarithm a state. The sum is made exactly if that would lose a path by
/// underflow (left–right chains with a sample that fits badly).
pub fn forward_backward(chain: &Chain, log_emissions: &[f64]) -> Expectation {
    let k = chain.states();
    let samples = log_emissions.len() / k;
    let mut transitions = vec![0.0; k * k];
    if samples == 0 {
        return Expectation { log_likelihood: 0.0, posterior: Vec::new(), transitions };
    }
    let links = Links::new(chain);
    let mut forward = vec![0.0; samples * k];
    for (state, value) in forward[..k].iter_mut().enumerate() {
        *value = chain.start()[state].ln() + log_emissions[state];
    }
    let mut scaled = vec![0.0; k];
    for t in 1..samples {
        let (before, now) = forward[(t - 1) * k..(t + 1) * k].split_at_mut(k);
        let top = exponentials(before, &mut scaled);
        for (to, value) in now.iter_mut().enumerate() {
            *value = links.arriving(to, before, &scaled, top) + log_emissions[t * k + to];
        }
    }
    let log_likelihood = log_sum(forward[(samples - 1) * k..].iter().copied());

    let (mut backward, mut ahead, mut ahead_scaled) = (vec![0.0; k], vec![0.0; k], vec![0.0; k]);
    finish_row(&mut forward[(samples - 1) * k..], &backward);
    for t in (0..samples - 1).rev() {
        for (state, value) in ahead.iter_mut().enumerate() {
            *value = log_emissions[(t + 1) * k + state] + backward[state];
        }
        let top = exponentials(&ahead, &mut ahead_scaled);
        let row = &mut forward[t * k..(t + 1) * k];
        exponentials(row, &mut scaled);
        links.count(row, &scaled, &ahead, &ahead_scaled, &mut transitions);
        for (from, value) in backward.iter_mut().enumerate() {
            *value = links.leaving(from, &ahead, &ahead_scaled, top);
        }
        finish_row(row, &backward);
    }
    Expectation { log_likelihood, posterior: forward, transitions }
}

/// From log α and log β to γ, in place.
fn finish_row(row: &mut [f64], backward: &[f64]) {
    for (value, after) in row.iter_mut().zip(backward) {
        *value += after;
    }
    let top = row.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let mut total = 0.0;
    for value in row.iter_mut() {
        *value = (*value - top).exp();
        total += *value;
    }
    for value in row.iter_mut() {
        *value /= total;
    }
}

/// exp(v − max v); returns the maximum.
fn exponentials(values: &[f64], scaled: &mut [f64]) -> f64 {
    let top = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    for (out, value) in scaled.iter_mut().zip(values) {
        *out = (value - top).exp();
    }
    top
}

/// log Σ exp v, without loss.
fn log_sum(values: impl Iterator<Item = f64> + Clone) -> f64 {
    let top = values.clone().fold(f64::NEG_INFINITY, f64::max);
    if top == f64::NEG_INFINITY {
        return top;
    }
    top + values.map(|v| (v - top).exp()).sum::<f64>().ln()
}

/// Transition probabilities and their logarithms.
struct Links<'a> {
    k: usize,
    plain: &'a [f64],
    log: Vec<f64>,
}

impl<'a> Links<'a> {
    fn new(chain: &'a Chain) -> Self {
        let plain = chain.transition();
        Self { k: chain.states(), plain, log: plain.iter().map(|p| p.ln()).collect() }
    }

    /// log Σ over the states before.
    fn arriving(&self, to: usize, before: &[f64], scaled: &[f64], top: f64) -> f64 {
        let sum: f64 = scaled.iter().enumerate().map(|(from, e)| e * self.plain[from * self.k + to]).sum();
        if sum > LOST {
            return top + sum.ln();
        }
        log_sum(before.iter().enumerate().map(|(from, v)| v + self.log[from * self.k + to]))
    }

    /// log Σ over the states after.
    fn leaving(&self, from: usize, ahead: &[f64], scaled: &[f64], top: f64) -> f64 {
        let row = from * self.k..(from + 1) * self.k;
        let sum: f64 = scaled.iter().zip(&self.plain[row.clone()]).map(|(e, p)| e * p).sum();
        if sum > LOST {
            return top + sum.ln();
        }
        log_sum(ahead.iter().zip(&self.log[row]).map(|(v, p)| v + p))
    }

    /// Adds one step's expected transitions.
    fn count(&self, before: &[f64], before_scaled: &[f64], ahead: &[f64], ahead_scaled: &[f64], counts: &mut [f64]) {
        let k = self.k;
        let share = |i: usize| before_scaled[i / k] * self.plain[i] * ahead_scaled[i % k];
        let total: f64 = (0..k * k).map(share).sum();
        if total > LOST {
            for (i, count) in counts.iter_mut().enumerate() {
                *count += share(i) / total;
            }
            return;
        }
        let exact = |i: usize| before[i / k] + self.log[i] + ahead[i % k];
        let total = log_sum((0..k * k).map(exact));
        for (i, count) in counts.iter_mut().enumerate() {
            *count += (exact(i) - total).exp();
        }
    }
}
