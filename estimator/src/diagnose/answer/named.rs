//! Entries of an answer before its verdict.

use crate::diagnose::contract::{Alternative, Cause, NextExperiment, NotExcited, PassedOver};

/// Causes that the comparisons name, and the experiment that would settle the open questions. The task corrects them by
/// its own knowledge.
pub struct Named {
    /// Named causes, then unnamed terms.
    pub causes: Vec<Cause>,
    pub alternatives: Vec<Alternative>,
    pub not_excited: Vec<NotExcited>,
    pub passed_over: Vec<PassedOver>,
    pub next: Option<NextExperiment>,
}
