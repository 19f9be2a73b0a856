//! Impacts as sound: a short wooden knock, the louder and brighter the faster. Made sample by sample on the sound system's own
//! thread; the window only says how fast something struck.

use cpal::traits::{DeviceTrait, HostTrait, StreamTrait};
use std::sync::mpsc::{Receiver, Sender, channel};

/// Knocks that sound at the same time.
const VOICES: usize = 8;
/// The speed that sounds as loud as it gets, m/s.
const FULL_M_S: f64 = 0.6;
/// Loudness of one knock at that speed, of a full scale of 1.
const LOUDEST: f32 = 0.35;
/// Modes of a small block of wood: Hz, share of the loudness, decay time, s. The high ones come with speed.
const MODES: [(f32, f32, f32); 3] = [(780.0, 0.6, 0.030), (1_730.0, 0.3, 0.016), (3_900.0, 0.25, 0.006)];
/// A knock is over after this long, s: ten times its slowest decay.
const LENGTH_S: f32 = 0.3;

/// The open sound output. Dropping it is silence.
pub struct Sound {
    strikes: Sender<f64>,
    // Plays as long as it lives.
    _stream: cpal::Stream,
}

impl Sound {
    /// Opens the system's output. The error is one sentence.
    pub fn open() -> Result<Self, String> {
        let failed = |e: cpal::Error| format!("There is no sound ({e}); impacts only flash.");
        let device =
            cpal::default_host().default_output_device().ok_or("There is no sound output; impacts only flash.")?;
        let supported = device.default_output_config().map_err(failed)?;
        if supported.sample_format() != cpal::SampleFormat::F32 {
            return Err(format!("The sound output wants {} samples; impacts only flash.", supported.sample_format()));
        }
        let config: cpal::StreamConfig = supported.into();
        let channels = usize::from(config.channels).max(1);
        let (strikes, heard) = channel();
        let mut knocks = Knocks::new(config.sample_rate as f32, heard);
        let play = move |data: &mut [f32], _: &cpal::OutputCallbackInfo| {
            for frame in data.chunks_mut(channels) {
                frame.fill(knocks.next_sample());
            }
        };
        // A stream that fails goes silent; the flash stays.
        let stream = device.build_output_stream(config, play, |_| {}, None).map_err(failed)?;
        stream.play().map_err(failed)?;
        Ok(Self { strikes, _stream: stream })
    }

    /// Something struck something at a speed, m/s.
    pub fn strike(&self, speed_m_s: f64) {
        // A stream that ended takes nothing any more: silence.
        let _ = self.strikes.send(speed_m_s);
    }
}

/// One knock: how strong, how long ago.
#[derive(Clone, Copy, Debug)]
struct Knock {
    strength: f32,
    age_s: f32,
}

/// The knocks that sound now.
struct Knocks {
    step_s: f32,
    strikes: Receiver<f64>,
    sounding: Vec<Knock>,
}

impl Knocks {
    fn new(rate_hz: f32, strikes: Receiver<f64>) -> Self {
        Self { step_s: 1.0 / rate_hz.max(1.0), strikes, sounding: Vec::with_capacity(VOICES) }
    }

    /// The next sample, −1 … 1.
    fn next_sample(&mut self) -> f32 {
        while let Ok(speed) = self.strikes.try_recv() {
            let strength = (speed / FULL_M_S).clamp(0.0, 1.0) as f32;
            if self.sounding.len() < VOICES {
                self.sounding.push(Knock { strength, age_s: 0.0 });
            }
        }
        let sum: f32 = self.sounding.iter().copied().map(Knock::value).sum();
        for knock in &mut self.sounding {
            knock.age_s += self.step_s;
        }
        self.sounding.retain(|knock| knock.age_s < LENGTH_S);
        sum.clamp(-1.0, 1.0)
    }
}

impl Knock {
    fn value(self) -> f32 {
        let mut bright = 1.0;
        let mut sum = 0.0;
        for (hz, share, decay_s) in MODES {
            sum += bright * share * (-self.age_s / decay_s).exp() * (std::f32::consts::TAU * hz * self.age_s).sin();
            bright *= self.strength;
        }
        LOUDEST * self.strength.sqrt() * sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn knock(speed_m_s: f64) -> Vec<f32> {
        let (strikes, heard) = channel();
        let mut knocks = Knocks::new(48_000.0, heard);
        strikes.send(speed_m_s).expect("heard");
        (0..24_000).map(|_| knocks.next_sample()).collect()
    }

    fn loudness(samples: &[f32]) -> f32 {
        (samples.iter().map(|s| s * s).sum::<f32>() / samples.len() as f32).sqrt()
    }

    #[test]
    fn faster_is_louder_and_every_knock_ends() {
        let (soft, hard) = (knock(0.05), knock(0.5));
        assert!(loudness(&hard[..2_400]) > 2.0 * loudness(&soft[..2_400]));
        assert!(loudness(&soft[..2_400]) > 1e-4, "a soft one is heard");
        assert!(hard.iter().chain(&soft).all(|s| s.abs() <= LOUDEST * 1.2));
        assert!(hard[19_200..].iter().all(|s| *s == 0.0), "silence after four tenths of a second");
    }

    #[test]
    fn a_storm_of_impacts_stays_within_range() {
        let (strikes, heard) = channel();
        let mut knocks = Knocks::new(44_100.0, heard);
        for _ in 0..100 {
            strikes.send(f64::INFINITY).expect("heard");
        }
        assert!((0..10_000).all(|_| knocks.next_sample().abs() <= 1.0));
        assert!(knocks.sounding.len() <= VOICES);
    }
}
