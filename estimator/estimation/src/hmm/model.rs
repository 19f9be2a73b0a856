//! λ: a hidden Markov model with Gaussian emissions.

use super::chain::{Chain, HmmError};
use super::gaussian::Gaussian;

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
}
