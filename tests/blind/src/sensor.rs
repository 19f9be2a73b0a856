//! The instruments: what they do to ideal samples, wrongly on purpose or as every instrument does.

use super::arm::Arm;
use super::chance::{Chance, Coloured};
use super::effect::Effect;
use super::plant::Hidden;
use super::simulate::Sample;

/// Share of the noise's variance that has a memory.
const COLOURED: f64 = 0.3;

/// How well the instruments see.
#[derive(Clone, Copy, Debug)]
pub struct Sensor {
    /// Noise of a force, N.
    pub noise_n: f64,
    /// How long the coloured part of it remembers, s.
    pub memory_s: f64,
    /// How fast that part swings, Hz; 0: does not.
    pub swing_hz: f64,
    /// Resolution of a force, N.
    pub step_n: f64,
    /// Noise of an angle (of a mechanism's coordinate), rad or m.
    pub angle_noise: f64,
    /// Its resolution.
    pub angle_step: f64,
    /// Noise of a speed, rad/s or m/s.
    pub rate_noise: f64,
}

impl Sensor {
    /// Standard deviation of a force reading, N.
    pub fn floor_n(&self) -> f64 {
        self.noise_n.hypot(self.step_n / 12_f64.sqrt())
    }

    /// Standard deviation of an angle reading.
    pub fn angle_floor(&self) -> f64 {
        self.angle_noise.hypot(self.angle_step / 12_f64.sqrt())
    }

    /// A force sensor's noise, sampled at `rate_hz`, as a share `part` of the whole.
    pub fn noise(&self, rate_hz: f64, part: f64, chance: &mut Chance) -> Noise {
        Noise {
            white_n: part * self.noise_n * (1.0 - COLOURED).sqrt(),
            coloured_n: part * self.noise_n * COLOURED.sqrt(),
            coloured: Coloured::running(self.memory_s, self.swing_hz, 1.0 / rate_hz, chance),
        }
    }
}

/// Noise of one channel.
pub struct Noise {
    white_n: f64,
    coloured_n: f64,
    coloured: Coloured,
}

impl Noise {
    /// The next value.
    pub fn next(&mut self, chance: &mut Chance) -> f64 {
        self.white_n * chance.normal() + self.coloured_n * self.coloured.next(chance)
    }
}

/// To the nearest multiple of `step`.
pub fn quantised(value: f64, step: f64) -> f64 {
    if step > 0.0 { (value / step).round() * step } else { value }
}

/// The force that the instrument would tell without noise, with all that is wrong with it but the effect `without`.
pub fn force(hidden: &[Hidden], without: Option<usize>, sample: &Sample, seconds: f64) -> [f64; 2] {
    let wrong = || hidden.iter().enumerate().filter(|(k, _)| Some(*k) != without).map(|(_, h)| h);
    let mut f = if wrong().any(|h| h.effect == Effect::Delay) { sample.late_n } else { sample.force_n };
    let share = sample.time_s / seconds;
    for h in wrong() {
        let [a, b, _] = h.shape;
        match h.effect {
            Effect::Gain => f = f.map(|v| v * (1.0 + h.size)),
            Effect::CrossAxis => f[0] += h.size * f[1],
            Effect::Bias => f = [f[0] + h.size * a.cos(), f[1] + h.size * a.sin()],
            Effect::Drift => {
                let way = if h.form == 0 { share } else { (1.0 - (-3.0 * share).exp()) / 0.95 };
                f = [f[0] + h.size * a.cos() * way, f[1] + h.size * a.sin() * way];
            }
            Effect::AxisSign => {
                f = match h.form {
                    0 => [f[0], -f[1]],
                    1 => [-f[0], f[1]],
                    _ => [f[1], f[0]],
                };
            }
            Effect::Saturation => {
                let level = b / (1.0 + h.size);
                f = f.map(|v| v.clamp(-level, level));
            }
            effect if effect.is_structure() => f = h.told(f, sample),
            _ => {}
        }
    }
    f
}

/// The angles that the encoders would tell without noise, and their speeds.
pub fn joints(arm: &Arm, hidden: &[Hidden], tip: [f64; 2], speed: [f64; 2]) -> ([f64; 2], [f64; 2]) {
    let mut real = *arm;
    let mut offset = [0.0; 2];
    for h in hidden {
        match h.effect {
            Effect::LengthScale => real.link_m[usize::from(h.form == 1)] *= 1.0 + h.size,
            Effect::JointOffset => offset[usize::from(h.form == 0)] += h.size,
            _ => {}
        }
    }
    let angles = real.angles(tip, 1.0);
    let rates = real.rates(angles, speed);
    ([angles[0] + offset[0], angles[1] + offset[1]], rates)
}

/// Spoils whole columns the way that cables and converters do, and says which rows are left.
pub fn spoil(hidden: &[Hidden], columns: &mut [Vec<f64>], force_at: usize, rate_hz: f64) -> Vec<bool> {
    let rows = columns.first().map_or(0, Vec::len);
    let mut kept = vec![true; rows];
    for h in hidden.iter().filter(|h| h.effect == Effect::ChannelFault) {
        let from = (h.shape[0] * rows as f64) as usize;
        let until = (from + (h.shape[1] * rate_hz) as usize).min(rows);
        match h.form {
            0 | 3 => {
                let column = &mut columns[if h.form == 0 { force_at } else { 0 }];
                let held = column[from.min(rows - 1)];
                column[from..until].fill(held);
            }
            1 => {
                for part in 0..3 {
                    let start = (from + part * rows / 7) % rows;
                    let end = (start + (h.shape[1] * rate_hz / 3.0) as usize).min(rows - 1);
                    kept[start.max(1)..end.max(1)].fill(false);
                }
            }
            _ => {
                for column in &mut columns[force_at..] {
                    let largest = column.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
                    for value in column.iter_mut() {
                        *value = quantised(*value, largest / 4.0);
                    }
                }
            }
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn readings_are_multiples_of_the_resolution_and_noise_has_its_size_and_colour() {
        assert_eq!(quantised(0.123, 0.05), 0.1);
        assert!((quantised(-0.13, 0.05) + 0.15).abs() < 1e-12);
        assert_eq!(quantised(0.123, 0.0), 0.123);
        let sensor = Sensor {
            noise_n: 0.02,
            memory_s: 0.02,
            swing_hz: 0.0,
            step_n: 0.0,
            angle_noise: 0.0,
            angle_step: 0.0,
            rate_noise: 0.0,
        };
        let mut chance = Chance::new(5, 5);
        let mut noise = sensor.noise(500.0, 1.0, &mut chance);
        let values: Vec<f64> = (0..200_000).map(|_| noise.next(&mut chance)).collect();
        let lag = |k: usize| values.iter().zip(&values[k..]).map(|(a, b)| a * b).sum::<f64>() / values.len() as f64;
        assert!((lag(0).sqrt() - 0.02).abs() < 4e-4, "{}", lag(0).sqrt());
        // 30 % of the variance is remembered with exp(-2 ms / 20 ms).
        let expected = 0.3 * (-0.1_f64).exp();
        assert!((lag(1) / lag(0) - expected).abs() < 0.02, "{} {expected}", lag(1) / lag(0));
    }
}
