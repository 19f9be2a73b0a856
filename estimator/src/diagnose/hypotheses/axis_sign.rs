//! A mirrored or swapped axis as a hypothesis, which is found before any regression.

use super::hypothesis::Hypothesis;

pub(crate) const ID: &str = "axis-sign";

pub(crate) struct AxisSign;

impl Hypothesis for AxisSign {
    fn id(&self) -> &'static str {
        ID
    }
}
