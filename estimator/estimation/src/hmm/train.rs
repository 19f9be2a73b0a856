//! Baum–Welch: the model that explains a sequence best, near a prior.

use super::chain::{Chain, HmmError};
use super::forward::{Expectation, forward_backward};
use super::gaussian::{Covariance, Gaussian};
use super::model::Model;
use foundation::cancellation;
use nalgebra::DMatrix;

/// Prior of the model, as if it had been seen in so many samples.
#[derive(Clone, Debug, PartialEq)]
pub struct Prior {
    /// Distributions that the emissions are drawn towards.
    pub emissions: Vec<Gaussian>,
    /// In how many (effective) samples each was seen; infinite: it is kept.
    pub emission_samples: Vec<f64>,
    /// Number of times that each transition was seen, row by row. Forbidden transitions stay forbidden.
    pub transitions: Vec<f64>,
}

/// Settings of the training.
#[derive(Clone, Debug, PartialEq)]
pub struct Training {
    /// Most steps.
    pub most_steps: usize,
    /// Ends when a step gains less than this, in units of the logarithm of the likelihood.
    pub least_gain: f64,
    /// Weight of one sample, see [`Model::log_emissions`].
    pub weight: f64,
    /// Least variance of each channel.
    pub floor: Vec<f64>,
    /// Prior; without one the likelihood alone is raised.
    pub prior: Option<Prior>,
}

/// A trained model.
#[derive(Clone, Debug, PartialEq)]
pub struct Trained {
    /// The model after the last step.
    pub model: Model,
    /// Logarithm of likelihood (times prior) before every step and after the last one. Never falls.
    pub objective: Vec<f64>,
}

/// Raises the likelihood of a sequence step by step. Every emission keeps its kind of covariance, every forbidden transition
/// stays forbidden.
pub fn baum_welch(start: Model, values: &[f64], training: &Training) -> Result<Trained, HmmError> {
    let mut model = start;
    let mut objective = Vec::new();
    for step in 0..=training.most_steps {
        // The caller looks for the end, too: nothing of it is kept.
        if !cancellation::is_wanted() {
            break;
        }
        let expectation = forward_backward(&model.chain, &model.log_emissions(values, training.weight));
        let now = expectation.log_likelihood + training.prior.as_ref().map_or(0.0, |p| log_prior(&model, p));
        let gain = now - objective.last().copied().unwrap_or(f64::NEG_INFINITY);
        objective.push(now);
        if step == training.most_steps || gain < training.least_gain || values.is_empty() {
            break;
        }
        model = maximised(&model, values, &expectation, training)?;
    }
    Ok(Trained { model, objective })
}

/// Logarithm of the prior at a model, up to a constant.
fn log_prior(model: &Model, prior: &Prior) -> f64 {
    let emissions = model.emissions.iter().zip(&prior.emissions).zip(&prior.emission_samples);
    let of_emissions: f64 =
        emissions.filter(|(_, n)| n.is_finite()).map(|((now, before), n)| n * now.mean_log_density(before)).sum();
    let links = model.chain.transition().iter().zip(&prior.transitions);
    let of_links: f64 = links.filter(|(p, count)| **p > 0.0 && **count > 0.0).map(|(p, count)| count * p.ln()).sum();
    of_emissions + of_links
}

fn maximised(model: &Model, values: &[f64], expectation: &Expectation, training: &Training) -> Result<Model, HmmError> {
    let k = model.chain.states();
    let prior = training.prior.as_ref();
    let mut transition = Vec::with_capacity(k * k);
    for from in 0..k {
        let seen = |i: usize| {
            let believed = prior.and_then(|p| p.transitions.get(i)).copied().unwrap_or(0.0);
            if model.chain.transition()[i] > 0.0 { expectation.transitions[i] + believed } else { 0.0 }
        };
        let total: f64 = (from * k..(from + 1) * k).map(seen).sum();
        let row = from * k..(from + 1) * k;
        if total > f64::MIN_POSITIVE {
            transition.extend(row.map(|i| seen(i) / total));
        } else {
            // Never left in this sequence: nothing to learn.
            transition.extend_from_slice(&model.chain.transition()[row]);
        }
    }
    let start = expectation.posterior[..k].to_vec();
    let emissions = (0..k)
        .map(|state| {
            let believed = prior.and_then(|p| Some((p.emissions.get(state)?, *p.emission_samples.get(state)?)));
            emission(&model.emissions[state], believed, values, (&expectation.posterior[state..], k), training)
        })
        .collect();
    Model::new(Chain::new(start, transition)?, emissions)
}

/// Sums of products about a mean that a prior of `n` samples stands for.
fn prior_products(prior: &Gaussian, n: f64, mean: &[f64]) -> DMatrix<f64> {
    DMatrix::from_fn(mean.len(), mean.len(), |a, b| {
        let spread = match prior.covariance() {
            Covariance::Full(matrix) => matrix[(a, b)],
            Covariance::Diagonal(variances) => f64::from(u8::from(a == b)) * variances[a],
        };
        n * (spread + (prior.mean()[a] - mean[a]) * (prior.mean()[b] - mean[b]))
    })
}

/// Mean and covariance of the samples of one state together with those of the prior. `posterior`: the state's probability at every
/// `step`-th entry.
fn emission(
    now: &Gaussian,
    believed: Option<(&Gaussian, f64)>,
    values: &[f64],
    (posterior, step): (&[f64], usize),
    training: &Training,
) -> Gaussian {
    let d = now.channels();
    if let Some((kept, _)) = believed.filter(|(_, samples)| samples.is_infinite()) {
        return kept.clone();
    }
    let shares = || {
        let known =
            values.chunks_exact(d).zip(posterior.iter().step_by(step)).filter(|(x, _)| x.iter().all(|v| v.is_finite()));
        known.map(|(x, p)| (x, p * training.weight))
    };
    let mut total = 0.0;
    let mut sum = vec![0.0; d];
    for (x, share) in shares() {
        total += share;
        sum.iter_mut().zip(x).for_each(|(s, v)| *s += share * v);
    }
    let extra = believed.map_or(0.0, |(_, samples)| samples);
    if total + extra <= f64::MIN_POSITIVE {
        return now.clone();
    }
    let old_mean = |c: usize| believed.map_or(0.0, |(g, _)| g.mean()[c]);
    let mean: Vec<f64> = (0..d).map(|c| (sum[c] + extra * old_mean(c)) / (total + extra)).collect();
    let covariance = match now.covariance() {
        Covariance::Diagonal(_) => {
            let mut squares: Vec<f64> = (0..d)
                .map(|c| believed.map_or(0.0, |(g, n)| n * (g.variance(c) + (g.mean()[c] - mean[c]).powi(2))))
                .collect();
            for (x, share) in shares() {
                for (square, (v, m)) in squares.iter_mut().zip(x.iter().zip(&mean)) {
                    *square += share * (v - m).powi(2);
                }
            }
            Covariance::Diagonal(squares.iter().map(|s| s / (total + extra)).collect())
        }
        Covariance::Full(_) => {
            let mut products = DMatrix::zeros(d, d);
            if let Some((g, n)) = believed {
                products += prior_products(g, n, &mean);
            }
            for (x, share) in shares() {
                for a in 0..d {
                    for b in 0..d {
                        products[(a, b)] += share * (x[a] - mean[a]) * (x[b] - mean[b]);
                    }
                }
            }
            Covariance::Full(products / (total + extra))
        }
    };
    Gaussian::new(mean, covariance, &training.floor)
}
