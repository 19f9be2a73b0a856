//! Ground of the estimator's crates: signals of a recording, definitions of tasks, types of answers, and the early end
//! of work that nobody waits for.

#[cfg(feature = "ablation")]
pub mod ablation;
pub mod cancellation;
pub mod estimate;
pub mod signal;
pub mod tasks;
pub mod words;
