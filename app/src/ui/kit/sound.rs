//! Contacts as sound: a short wooden knock for an impact, the louder and brighter the faster; a scrape while something slips in the
//! fingers; two short tones while a force is larger than allowed. Made sample by sample on the sound system's own thread; the window
//! only says what happens.

use cpal::traits::{DeviceTrait, HostTrait, StreamTrait};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};

/// Knocks that sound at the same time.
const VOICES: usize = 8;
/// The speed that sounds as loud as it gets, m/s.
const FULL_M_S: f64 = 0.6;
/// Loudness of one knock at that speed, of a full scale of 1.
const LOUDEST: f32 = 0.35;
/// Modes of a small block of wood: Hz, share of the loudness, decay time, s. The high ones come with speed.
const MODES: [(f32, f32, f32); 3] = [(780.0, 0.6, 0.030), (1_730.0, 0.3, 0.016), (3_900.0, 0.25, 0.006)];
/// The slip that scrapes as loud as it gets, m/s, and how loud.
const FULL_SLIP_M_S: f64 = 0.15;
const SCRAPE: f32 = 0.12;
/// Loudness follows in this time, s: no clicks.
const FOLLOWS_S: f32 = 0.02;
/// The warning: Hz, loudness, length of a tone and of a round, s.
const WARNING: (f32, f32, f32, f32) = (660.0, 0.16, 0.09, 0.5);
/// A knock is over after this long, s: ten times its slowest decay.
const LENGTH_S: f32 = 0.3;

/// The open sound output. Dropping it is silence.
pub struct Sound {
    strikes: Sender<f64>,
    now: Arc<Now>,
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
        let now = Arc::new(Now::default());
        let mut voices = Voices::new(config.sample_rate as f32, heard, Arc::clone(&now));
        let play = move |data: &mut [f32], _: &cpal::OutputCallbackInfo| {
            for frame in data.chunks_mut(channels) {
                frame.fill(voices.next_sample());
            }
        };
        // A stream that fails goes silent; the flash stays.
        let stream = device.build_output_stream(config, play, |_| {}, None).map_err(failed)?;
        stream.play().map_err(failed)?;
        Ok(Self { strikes, now, _stream: stream })
    }

    /// Sets the loudness, 0 to 1, the slip speed in the fingers, m/s, and `excess`: true if a force is larger than
    /// allowed.
    pub fn follow(&self, loudness: f32, slip_m_s: f64, excess: bool) {
        self.now.loudness.store(loudness.clamp(0.0, 1.0).to_bits(), Ordering::Relaxed);
        self.now.slip_m_s.store((slip_m_s as f32).to_bits(), Ordering::Relaxed);
        self.now.excess.store(excess, Ordering::Relaxed);
    }

    /// Something struck something at a speed, m/s.
    pub fn strike(&self, speed_m_s: f64) {
        // A stream that ended takes nothing any more: silence.
        let _ = self.strikes.send(speed_m_s);
    }
}

/// Current state of the sound, as the window sets it.
#[derive(Debug, Default)]
struct Now {
    loudness: AtomicU32,
    slip_m_s: AtomicU32,
    excess: AtomicBool,
}

/// Everything that sounds.
struct Voices {
    knocks: Knocks,
    now: Arc<Now>,
    loudness: f32,
    scrape: f32,
    /// State of the noise, and what is left of its last sample: the scrape is dull.
    noise: u32,
    dull: f32,
    warned_s: f32,
}

impl Voices {
    fn new(rate_hz: f32, strikes: Receiver<f64>, now: Arc<Now>) -> Self {
        let knocks = Knocks::new(rate_hz, strikes);
        Self { knocks, now, loudness: 0.0, scrape: 0.0, noise: 1, dull: 0.0, warned_s: 0.0 }
    }

    /// The next sample, −1 … 1.
    fn next_sample(&mut self) -> f32 {
        let step_s = self.knocks.step_s;
        let follow = (step_s / FOLLOWS_S).min(1.0);
        self.loudness += follow * (f32::from_bits(self.now.loudness.load(Ordering::Relaxed)) - self.loudness);
        let slip = f64::from(f32::from_bits(self.now.slip_m_s.load(Ordering::Relaxed)));
        let wanted = SCRAPE * (slip / FULL_SLIP_M_S).clamp(0.0, 1.0).sqrt() as f32;
        self.scrape += follow * (wanted - self.scrape);
        // A generator of Lehmer's (1951) does for noise.
        self.noise = (u64::from(self.noise) * 48_271 % 0x7FFF_FFFF) as u32;
        let white = 2.0 * (self.noise as f32 / 0x7FFF_FFFF_u32 as f32) - 1.0;
        self.dull += 0.25 * (white - self.dull);
        let sum = self.knocks.next_sample() + 2.0 * self.scrape * self.dull + self.warning(step_s);
        (self.loudness * sum).clamp(-1.0, 1.0)
    }

    /// Two tones, then silence, again and again; a round that has begun is played to its end.
    fn warning(&mut self, step_s: f32) -> f32 {
        let (hz, loud, tone_s, round_s) = WARNING;
        if self.warned_s == 0.0 && !self.now.excess.load(Ordering::Relaxed) {
            return 0.0;
        }
        let at_s = self.warned_s;
        self.warned_s = if at_s + step_s < round_s { at_s + step_s } else { 0.0 };
        let within = at_s % (2.0 * tone_s);
        if at_s >= 4.0 * tone_s || within >= tone_s {
            return 0.0;
        }
        // Comes and goes with half a wave: no clicks.
        loud * (std::f32::consts::PI * within / tone_s).sin() * (std::f32::consts::TAU * hz * at_s).sin()
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

    /// A second of what the window says, without knocks.
    fn second(loudness: f32, slip_m_s: f64, excess: bool) -> Vec<f32> {
        let (_strikes, heard) = channel();
        let now = Arc::new(Now::default());
        now.loudness.store(loudness.to_bits(), Ordering::Relaxed);
        now.slip_m_s.store((slip_m_s as f32).to_bits(), Ordering::Relaxed);
        now.excess.store(excess, Ordering::Relaxed);
        let mut voices = Voices::new(48_000.0, heard, now);
        (0..48_000).map(|_| voices.next_sample()).collect()
    }

    #[test]
    fn a_slip_scrapes_by_its_speed_and_an_excess_warns_in_short_tones() {
        assert!(second(1.0, 0.0, false).iter().all(|s| *s == 0.0), "nothing happens: silence");
        let (slow, fast) = (second(1.0, 0.01, false), second(1.0, 0.15, false));
        assert!(loudness(&fast) > 2.0 * loudness(&slow) && loudness(&slow) > 1e-3);
        let warned = second(1.0, 0.0, true);
        let part = |from_s: f32, to_s: f32| loudness(&warned[(48_000.0 * from_s) as usize..(48_000.0 * to_s) as usize]);
        assert!(part(0.18, 0.27) > 0.03, "the second tone");
        assert!(part(0.10, 0.17) < 1e-3 && part(0.38, 0.49) < 1e-3, "silence between tones and rounds");
        assert!(fast.iter().chain(&warned).all(|s| s.abs() <= 1.0));
    }

    #[test]
    fn volume_scales_everything_and_mute_is_silence() {
        let loud = loudness(&second(1.0, 0.1, true)[4_800..]);
        let half = loudness(&second(0.5, 0.1, true)[4_800..]);
        assert!((half / loud - 0.5).abs() < 0.01, "{half} of {loud}");
        assert!(second(0.0, 0.1, true).iter().all(|s| *s == 0.0));
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
