//! Reference of a simulated recording: the measured one whose rate, noise and channels it repeats.

use estimator::signal::noise::white_noise_under_fast_motion;
use haptics::recording::{Recording, Task};

/// Maximum sampling rate of a simulated recording, Hz.
pub(crate) const FASTEST_HZ: f64 = 1_000.0;

/// Sampling rate of the first recording, Hz.
pub(crate) fn rate_hz(recording: &Recording) -> Result<f64, String> {
    let times = recording.time_s.as_deref().unwrap_or_default();
    let mut steps: Vec<f64> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
    steps.sort_by(f64::total_cmp);
    let usual = steps.get(steps.len() / 2).copied().filter(|step| *step > 0.0);
    let usual = usual.ok_or("The recording has no clock, so no motion can be planned after it.")?;
    Ok((1.0 / usual).min(FASTEST_HZ))
}

/// Properties of the simulated recordings.
#[derive(Clone, Copy, Debug)]
pub struct Like<'a> {
    /// First recording of the real object: the sensors of a simulated mechanism have its noise.
    pub recording: &'a Recording,
    /// Noise of a finger's force sample (1 σ), N.
    pub noise_n: f64,
}

impl Like<'_> {
    /// Noise of one sample of a finger, N: the diagnosis of needles and switches states that of means.
    pub(super) fn sample_noise_n(&self) -> f64 {
        let is_captured = matches!(self.recording.meta.task, Some(Task::Needle | Task::Switch));
        let own = self.recording.channel("fx1_N").filter(|_| is_captured).map(white_noise_under_fast_motion);
        own.unwrap_or(self.noise_n)
    }
}
