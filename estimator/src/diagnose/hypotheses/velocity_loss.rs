//! Loss of velocity in an impact as a hypothesis. The thrown body makes its regressor.

use super::hypothesis::Hypothesis;

pub(crate) const ID: &str = "velocity-loss";

pub(crate) struct VelocityLoss;

impl Hypothesis for VelocityLoss {
    fn id(&self) -> &'static str {
        ID
    }
}
