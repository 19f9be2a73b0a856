//! The Markov chain of the hidden states.

/// Most states of a model: paths are kept in one byte a sample.
pub const MOST_STATES: usize = 255;

/// Why a model cannot be.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum HmmError {
    /// Sizes do not agree.
    #[error("the hidden Markov model does not fit together: {what}")]
    Shape {
        /// Sizes that do not match.
        what: String,
    },
    /// Numbers that are no probabilities.
    #[error("{which} of the hidden Markov model is no distribution: it needs numbers from 0 to 1 that add up to 1")]
    Distribution {
        /// E.g. `row 2 of the transitions`.
        which: String,
    },
}

/// Start and transition probabilities. A transition of probability 0 is forbidden and stays so in training: that is how a
/// left–right topology is stated.
#[derive(Clone, Debug, PartialEq)]
pub struct Chain {
    start: Vec<f64>,
    /// Row after row: from, to.
    transition: Vec<f64>,
}

/// Largest deviation of a distribution's sum from 1 by rounding.
const ROUNDING: f64 = 1e-6;

impl Chain {
    /// A chain of `start.len()` states; `transition` row by row (from, to). Both are brought to add up to 1 exactly.
    pub fn new(mut start: Vec<f64>, mut transition: Vec<f64>) -> Result<Self, HmmError> {
        let states = start.len();
        if states == 0 || states > MOST_STATES || transition.len() != states * states {
            return Err(HmmError::Shape {
                what: format!("{states} states (1 to {MOST_STATES}) and {} transitions", transition.len()),
            });
        }
        normalise(&mut start).ok_or_else(|| HmmError::Distribution { which: "the start".to_owned() })?;
        for (from, row) in transition.chunks_exact_mut(states).enumerate() {
            let which = || HmmError::Distribution { which: format!("row {from} of the transitions") };
            normalise(row).ok_or_else(which)?;
        }
        Ok(Self { start, transition })
    }

    /// A chain that stays in a state for `dwell` samples on average (at least 1) and then goes to one of the others by
    /// `affinity` (row by row, only ratios within a row count, the diagonal is ignored). Starts anywhere.
    pub fn sticky(states: usize, dwell: f64, affinity: &[f64]) -> Result<Self, HmmError> {
        if affinity.len() != states * states {
            return Err(HmmError::Shape { what: format!("{states} states and {} affinities", affinity.len()) });
        }
        let leave = (1.0 / dwell.max(1.0)).min(0.5);
        let mut transition = vec![0.0; states * states];
        for from in 0..states {
            let total: f64 = (0..states).filter(|to| *to != from).map(|to| affinity[from * states + to]).sum();
            for to in 0..states {
                transition[from * states + to] = match (from == to, total > 0.0) {
                    (true, true) => 1.0 - leave,
                    (true, false) => 1.0,
                    (false, true) => leave * affinity[from * states + to] / total,
                    (false, false) => 0.0,
                };
            }
        }
        Self::new(vec![1.0 / states as f64; states], transition)
    }

    /// Number of states.
    pub fn states(&self) -> usize {
        self.start.len()
    }

    /// π.
    pub fn start(&self) -> &[f64] {
        &self.start
    }

    /// A, row by row (from, to).
    pub fn transition(&self) -> &[f64] {
        &self.transition
    }
}

/// Brings non-negative numbers that add up to about 1 to exactly 1.
fn normalise(row: &mut [f64]) -> Option<()> {
    let total: f64 = row.iter().sum();
    let fair = row.iter().all(|p| p.is_finite() && *p >= 0.0) && (total - 1.0).abs() <= ROUNDING;
    fair.then(|| row.iter_mut().for_each(|p| *p /= total))
}
