//! Linear regression with standard errors that count autocorrelation, and its robust and resampled forms.

pub mod blocks;
pub mod bootstrap;
pub mod influence;
pub mod linear;
pub mod long_run_variance;
pub mod repetition;
pub mod robust;
