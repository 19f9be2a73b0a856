//! From a log to numbers one can sign.
//!
//! This crate diagnoses the base model, and it is the entrance to the crates below: `foundation` (signals, definitions of
//! tasks, types of answers), `logs`, `estimation` and `training`.
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

pub mod diagnose;

pub use estimation::{calibrate, constraint, hmm, identify, online, pipeline, regression, simulate};
#[cfg(feature = "ablation")]
pub use foundation::ablation;
pub use foundation::{cancellation, estimate, signal, words};
pub use training::{self, assistant};

/// Logs, with the gaps of their clocks.
pub mod log {
    pub use foundation::signal::gaps::{gap_above_s, gaps};
    pub use logs::*;
}

/// Segmentation, with the definitions of the tasks that it follows.
pub mod segment {
    pub use estimation::segment::*;
    pub use foundation::tasks::{Sign, SystemState, Thresholds, definition, library, shows};
}
