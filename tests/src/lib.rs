//! Generators and helpers of the end-to-end tests.
//!
//! A generator shares no formula with the estimator: it steps the world finely and looks at it through a sensor model. Truth
//! travels apart from the recording; only an assertion opens it.

pub mod generate;
