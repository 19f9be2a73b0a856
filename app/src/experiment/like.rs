//! The recording that simulated ones resemble.

use haptics::recording::Recording;

/// Properties of the simulated recordings.
#[derive(Clone, Copy, Debug)]
pub struct Like<'a> {
    /// First recording of the real object: the sensors of a simulated mechanism have its noise.
    pub recording: &'a Recording,
    /// Noise of a finger's force sample (1 σ), N.
    pub noise_n: f64,
}
