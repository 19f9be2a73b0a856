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
mod model;
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
pub use model::Model;
pub use train::{Prior, Trained, Training, baum_welch};
pub use viterbi::{path_log_probability, viterbi};
