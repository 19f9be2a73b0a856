//! Hidden Markov models with Gaussian emissions: a general tool that knows nothing of tasks.
//!
//! Notation and algorithms after Rabiner (1989), "A tutorial on hidden Markov models", Proc. IEEE 77(2): λ = (A, B, π), the
//! forward–backward procedure, Viterbi's path and Baum–Welch. All recursions run in the logarithm, so that neither a million
//! samples nor a sample that fits no state underflows.
//!
//! Observations are one flat slice, sample after sample, `channels` numbers each. A sample with a number that is not finite is
//! no evidence for any state.

mod chain;
mod emissions;
mod forward;
mod gaussian;
mod train;
mod vector;
mod viterbi;
#[cfg(target_arch = "x86_64")]
mod wide;

#[cfg(test)]
mod tests;

pub use chain::{Chain, HmmError};
pub use forward::{Expectation, forward_backward};
pub use gaussian::{Covariance, Gaussian};
pub use train::{Prior, Trained, Training, baum_welch};
pub use viterbi::{path_log_probability, viterbi};

/// Most states of a model: paths are kept in one byte a sample.
pub const MOST_STATES: usize = 255;

/// λ: the chain of the states, and the emission of each.
#[derive(Clone, Debug, PartialEq)]
pub struct Model {
    /// A and π.
    pub chain: Chain,
    /// B: one distribution a state.
    pub emissions: Vec<Gaussian>,
}

impl Model {
    /// A model; an error when the numbers of states or channels do not agree.
    pub fn new(chain: Chain, emissions: Vec<Gaussian>) -> Result<Self, HmmError> {
        let channels = emissions.first().map_or(0, Gaussian::channels);
        if emissions.len() != chain.states() || channels == 0 || emissions.iter().any(|e| e.channels() != channels) {
            return Err(HmmError::Shape {
                what: format!(
                    "{} emissions of {channels} channels do not fit a chain of {} states",
                    emissions.len(),
                    chain.states()
                ),
            });
        }
        Ok(Self { chain, emissions })
    }

    /// Channels of a sample.
    pub fn channels(&self) -> usize {
        self.emissions.first().map_or(1, Gaussian::channels)
    }

    /// Logarithm of every state's density at every sample, one row a sample, times `weight`.
    ///
    /// A weight below 1 is for samples that come faster than their information: of a channel that is correlated over τ
    /// and sampled every Δt, each sample counts as Δt/τ of an independent one.
    pub fn log_emissions(&self, values: &[f64], weight: f64) -> Vec<f64> {
        let (channels, states) = (self.channels(), self.emissions.len());
        let samples = values.len() / channels;
        let mut rows = vec![0.0; samples * states];
        emissions::Job { model: self, weight, stride: states }.fill_together(&values[..samples * channels], &mut rows);
        rows
    }
}
