//! A stiffness that rises with the load as a hypothesis. Tasks with a contact make its regressor.

use super::hypothesis::Hypothesis;

pub(crate) const ID: &str = "stiffness-hardening";

pub(crate) struct StiffnessHardening;

impl Hypothesis for StiffnessHardening {
    fn id(&self) -> &'static str {
        ID
    }
}
