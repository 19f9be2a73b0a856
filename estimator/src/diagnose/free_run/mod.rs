pub(crate) mod along_coordinate;
pub(crate) mod channel;
pub(crate) mod integrate;
pub(crate) mod windows;

use crate::diagnose::contract::Rollout;
use crate::diagnose::data::regression_data::{Model, Track};
use crate::diagnose::selection::comparison::ChannelFit;
use channel::Forward;

/// Free-run simulation of a compared channel.
#[derive(Clone, Copy)]
pub enum FreeRun<'a> {
    /// Over windows that are left out of the fit in turn.
    Channel(&'a dyn Forward),
    /// Over the locked blocks of a motion along one coordinate.
    Coordinate(&'a Track, &'a Model),
    /// None, for this reason.
    None(&'static str),
}

impl FreeRun<'_> {
    /// Errors without and with the k-th of the chosen causes, all others in, or the reason why there are none.
    pub fn rollout(&self, study: &ChannelFit, k: usize) -> Result<Rollout, String> {
        match self {
            Self::Channel(channel) => channel::in_turn(study, *channel, k),
            Self::Coordinate(track, model) => along_coordinate::rollout(track, model, study, k),
            Self::None(why) => Err((*why).to_owned()),
        }
    }
}
