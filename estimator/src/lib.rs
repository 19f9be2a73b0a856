//! From a log to numbers one can sign.
//!
//! `log` reads, `signal` derives, `segment` finds the states and their times, `identify` and `constraint` estimate,
//! `calibrate` writes a world, `simulate` runs the measured motion through it. Every stage is a plain function between
//! plain types.
//!
//! From a log to parameters with errors, and to the defects of the model:
//!
//! ```
//! use estimator::{diagnose, log, pipeline, simulate};
//! use std::path::Path;
//!
//! let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../assets/recordings");
//! let recordings = log::load(&folder.join("crank.csv"), None)?;
//! let analysis = pipeline::analyse(&recordings, &pipeline::Options::default())?;
//! let radius = analysis.fit.parameters.iter().find(|p| p.name == "radius_m").expect("a crank has one");
//! assert!(radius.identified && radius.std_error.is_some_and(|error| error < 1e-4));
//!
//! // The measured motion through the calibrated world: the forces that would have been felt.
//! let replayed = simulate::simulate(&analysis.world, &recordings[0])?;
//! assert!(replayed.residual_rms.iter().all(|(_, left_n)| *left_n < 0.1));
//!
//! let found = diagnose::diagnose(&recordings, &diagnose::Options::default())?;
//! assert!(found.causes.iter().any(|cause| cause.id == "coulomb-friction"));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

#[cfg(feature = "ablation")]
pub mod ablation;
pub mod assistant;
pub mod calibrate;
pub mod cancellation;
pub mod constraint;
pub mod diagnose;
pub mod estimate;
pub mod hmm;
pub mod identify;
pub mod log;
pub mod online;
pub mod pipeline;
pub mod segment;
pub mod signal;
pub mod simulate;
pub mod training;
pub mod words;
