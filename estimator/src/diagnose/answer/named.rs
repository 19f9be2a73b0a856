//! Entries of an answer before its verdict.

use crate::diagnose::contract::{Alternative, Cause, NextExperiment, NotExcited, PassedOver};

/// What the comparisons name, and the experiment that would settle what they leave open. The task reads it by what it
/// knows beside them.
pub struct Named {
    /// Named causes, then unnamed terms.
    pub causes: Vec<Cause>,
    pub alternatives: Vec<Alternative>,
    pub not_excited: Vec<NotExcited>,
    pub passed_over: Vec<PassedOver>,
    pub next: Option<NextExperiment>,
}
