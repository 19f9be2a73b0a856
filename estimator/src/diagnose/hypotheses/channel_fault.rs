//! A faulty channel as a hypothesis. The raw samples show it, no regressor does.

use super::hypothesis::Hypothesis;

pub(crate) const ID: &str = "channel-fault";

pub(crate) struct ChannelFault;

impl Hypothesis for ChannelFault {
    fn id(&self) -> &'static str {
        ID
    }
}
