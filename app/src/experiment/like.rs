//! The recording that simulated ones resemble.

use haptics::recording::Recording;

/// What simulated recordings have to be like.
#[derive(Clone, Copy, Debug)]
pub struct Like<'a> {
    /// The first recording of the real object: a mechanism's sensors are as noisy as its.
    pub recording: &'a Recording,
    /// Noise of a finger's force sample, N.
    pub noise_n: f64,
}
