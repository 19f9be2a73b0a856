//! Clocks of instruments: stamps that tremble, a force that is read a little before the motion, clocks that run apart.
//!
//! What is called a delay is left to the effect of that name: a force that comes late by more than a tenth of a millisecond.

use super::chance::Chance;
use super::simulate::Sample;

/// Share of the cases whose clocks are like that.
const SHARE: f64 = 0.4;
/// Most that a force is late without being called so, s, and most that it is ahead: half a sample, and no more than this.
const LATE_S: f64 = 1e-4;
const AHEAD_S: f64 = 1e-3;
/// Clocks run apart by this much a second at most.
const APART: f64 = 1e-5;
/// Tremble of the stamps, in samples.
const TREMBLE: f64 = 0.03;

/// The clocks of one recording.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Clock {
    /// How much earlier than the motion the force is read, s.
    pub ahead_s: f64,
    /// How much that grows, a second.
    pub apart: f64,
    /// Standard deviation of a stamp, s.
    pub tremble_s: f64,
}

impl Clock {
    /// Usual clocks, or (more often) perfect ones; from a source of their own.
    pub fn draw(rate_hz: f64, seed: u64) -> Self {
        let mut chance = Chance::new(seed, 9);
        if !chance.happens(SHARE) {
            return Self::default();
        }
        Self {
            ahead_s: chance.between(-LATE_S, AHEAD_S.min(0.5 / rate_hz)),
            apart: chance.between(-APART, APART),
            tremble_s: TREMBLE / rate_hz,
        }
    }

    /// The samples with the forces (and what they are made of) that this clock reads beside their motion.
    pub fn read(&self, samples: &[Sample]) -> Vec<Sample> {
        if *self == Self::default() || samples.len() < 2 {
            return samples.to_vec();
        }
        let step_s = (samples[samples.len() - 1].time_s - samples[0].time_s) / (samples.len() - 1) as f64;
        let mut read = samples.to_vec();
        for (k, sample) in read.iter_mut().enumerate() {
            // Ahead: the force of a while later stands beside this motion.
            let place = k as f64 + (self.ahead_s + self.apart * sample.time_s) / step_s;
            let at = place.clamp(0.0, (samples.len() - 1) as f64);
            let (whole, part) =
                ((at as usize).min(samples.len() - 2), at - (at as usize).min(samples.len() - 2) as f64);
            let (near, far) = (&samples[whole], &samples[whole + 1]);
            let between = |pick: fn(&Sample) -> [f64; 2]| {
                let (a, b) = (pick(near), pick(far));
                [a[0] + part * (b[0] - a[0]), a[1] + part * (b[1] - a[1])]
            };
            (sample.force_n, sample.late_n) = (between(|s| s.force_n), between(|s| s.late_n));
        }
        read
    }

    /// A stamp as this clock writes it; stamps stay in order.
    pub fn stamp(&self, time_s: f64, chance: &mut Chance) -> f64 {
        time_s + self.tremble_s * chance.normal().clamp(-3.0, 3.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_force_that_is_read_ahead_is_that_of_later() {
        let samples: Vec<Sample> = (0..100)
            .map(|k| {
                let time_s = 0.01 * f64::from(k);
                Sample { time_s, force_n: [3.0 * time_s, -time_s], tip_m: [time_s, 0.0], ..Sample::default() }
            })
            .collect();
        let clock = Clock { ahead_s: 0.004, apart: 1e-3, tremble_s: 0.0 };
        let read = clock.read(&samples);
        for (read, sample) in read.iter().zip(&samples).take(98) {
            let later = sample.time_s + 0.004 + 1e-3 * sample.time_s;
            assert!((read.force_n[0] - 3.0 * later).abs() < 1e-9 && read.tip_m == sample.tip_m);
        }
        assert_eq!(Clock::default().read(&samples)[7].force_n, samples[7].force_n);
    }

    #[test]
    fn a_part_of_the_cases_has_such_clocks_and_stamps_stay_in_order() {
        let odd = (0..400).filter(|seed| Clock::draw(500.0, *seed) != Clock::default()).count();
        assert!((110..210).contains(&odd), "{odd}");
        let clock = Clock { tremble_s: TREMBLE / 500.0, ..Clock::default() };
        let mut chance = Chance::new(1, 1);
        let stamps: Vec<f64> = (0..2000).map(|k| clock.stamp(f64::from(k) / 500.0, &mut chance)).collect();
        assert!(stamps.windows(2).all(|w| w[1] > w[0]));
    }
}
