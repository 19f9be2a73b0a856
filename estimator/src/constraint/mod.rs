//! Geometric constraints.

use crate::estimate::{Constraint, ConstraintKind};
use haptics::recording::Recording;

/// The constraint of a recording with a tool path; `None` without one.
pub fn detect_in(recording: &Recording) -> Option<Constraint> {
    recording.channel("x_m")?;
    Some(Constraint {
        kind: ConstraintKind::Undecided,
        recording: Some(recording.name.clone()),
        center_m: None,
        radius_m: None,
        radius_interval_m: None,
        direction: None,
        rigid: None,
        std_error: std::collections::BTreeMap::new(),
        coverage_rad: None,
        coverage_m: None,
        residual_m: None,
        constraint_force_n: None,
        evidence: "not looked at yet".to_owned(),
    })
}

mod normals;

pub use normals::{THESIS_SAMPLES, normals_center};
