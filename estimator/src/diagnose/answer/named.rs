//! Entries of an answer before its verdict.

use crate::diagnose::contract::{Alternative, Cause, NextExperiment, NotExcited, PassedOver, is_certain};

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

impl Named {
    /// Moves the certain causes to the front.
    pub fn certain_first(&mut self) {
        let alternatives = &self.alternatives;
        self.causes.sort_by_key(|c| !is_certain(c, alternatives));
    }

    /// True if a certain cause has an alternative above this probability.
    pub fn is_open(&self, limit: f64) -> bool {
        let certain = self.causes.iter().filter(|c| is_certain(c, &self.alternatives));
        let ids: Vec<&str> = certain.map(|c| c.id.as_str()).collect();
        let is_of_certain = |a: &Alternative| a.instead_of.is_empty() || ids.contains(&a.instead_of.as_str());
        self.alternatives.iter().any(|a| a.posterior > limit && is_of_certain(a))
    }
}
