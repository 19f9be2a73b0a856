//! Thresholds above the noise, chosen from the recording itself.

use foundation::signal::noise::white_noise;
use foundation::signal::task::TaskSignals;
use foundation::tasks::Thresholds;
use haptics::Vec2;

/// Multiple of the noise that a threshold keeps off it: one false crossing in 1.7 million white samples.
const NOISE_MULTIPLE: f64 = 5.0;
/// Least threshold, as a share of the signal's usual size while something happens: friction, tremor and leaning are not
/// noise, and not the event either.
const SIGNAL_SHARE: f64 = 0.06;

/// Resting values and noise of the forces in free motion.
#[derive(Clone, Debug, PartialEq)]
pub struct Levels {
    /// Mean force of each finger while nothing is touched, N: the sensors' bias.
    pub bias_n: [Vec2; 2],
    /// Standard deviation of the force channels in free motion, N.
    pub force_noise_n: f64,
    /// Samples that were taken as free motion.
    pub free: Vec<usize>,
    /// 95th percentile of the grip force, N.
    pub usual_grip_n: f64,
}

impl Levels {
    /// Finds the samples without contact (where the total force magnitude is lowest) and measures bias and noise there.
    ///
    /// The bias is found in two passes: the first centre is that of the least loaded tenth of the samples, the final
    /// one that of everything within four robust deviations of it.
    pub fn of(signals: &TaskSignals) -> Self {
        let forces: [&[Vec2]; 2] = [0, 1].map(|f| signals.tips[f].force.as_deref().unwrap_or(&[]));
        let n = signals.len();
        let mut bias = [Vec2::zeros(); 2];
        let mut free: Vec<usize> = (0..n).collect();
        for pass in 0..3 {
            let load = |i: usize| (forces[0][i] - bias[0]).norm() + (forces[1][i] - bias[1]).norm();
            let mut loads: Vec<f64> = (0..n).map(load).collect();
            let limit = if pass == 0 {
                percentile(&mut loads, 0.10)
            } else {
                // The load of pure noise is a sum of two Rayleigh variables: three times its median is seven deviations. The
                // first pass only saw the least loaded tenth, whose median is about half of that.
                (if pass == 1 { 5.0 } else { 3.0 })
                    * percentile(&mut free.iter().map(|i| load(*i)).collect::<Vec<_>>(), 0.5).max(1e-12)
            };
            free = (0..n).filter(|i| load(*i) <= limit).collect();
            for finger in 0..2 {
                let middle = |pick: fn(&Vec2) -> f64| {
                    let mut values: Vec<f64> = free.iter().map(|i| pick(&forces[finger][*i])).collect();
                    // A median of rounded forces is itself rounded: the last pass, free of outliers, takes the mean.
                    if pass < 2 { percentile(&mut values, 0.5) } else { mean(&values) }
                };
                bias[finger] = Vec2::new(middle(|f| f.x), middle(|f| f.y));
            }
        }
        let usual_load =
            percentile(&mut (0..n).map(|i| forces[0][i].norm() + forces[1][i].norm()).collect::<Vec<_>>(), 0.95);
        if !is_free_phase(&free, signals, bias, usual_load) {
            bias = [Vec2::zeros(); 2];
            free.clear();
        }
        let spread = |finger: usize, pick: fn(&Vec2) -> f64| {
            let center = pick(&bias[finger]);
            let sum: f64 = free.iter().map(|i| (pick(&forces[finger][*i]) - center).powi(2)).sum();
            (sum / free.len().max(1) as f64).sqrt()
        };
        let noise = if free.is_empty() {
            white_noises(forces)
        } else {
            [spread(0, |f| f.x), spread(0, |f| f.y), spread(1, |f| f.x), spread(1, |f| f.y)]
        };
        Self {
            bias_n: bias,
            force_noise_n: noise.into_iter().fold(0.0, f64::max),
            free,
            usual_grip_n: percentile(&mut signals.grip_force_n.clone(), 0.95),
        }
    }

    /// Flags of samples in which the hand is open: the tips are farther apart than at any time at which both press against
    /// each other with `least_n`, N, and all forces stay within it of their medians. A zero that moved is no contact there.
    pub fn opened(&self, signals: &TaskSignals, least_n: f64) -> Vec<bool> {
        let forces: [&[Vec2]; 2] = [0, 1].map(|f| signals.tips[f].force.as_deref().unwrap_or(&[]));
        let presses = |i: usize| (forces[0][i] - self.bias_n[0]).x.min((self.bias_n[1] - forces[1][i]).x) > least_n;
        let n = forces[0].len().min(forces[1].len());
        let widest_m = (0..n).filter(|i| presses(*i)).map(|i| signals.grip_width_m[i]).max_by(f64::total_cmp);
        let mut open: Vec<bool> =
            signals.grip_width_m.iter().map(|width_m| widest_m.is_some_and(|widest_m| *width_m > widest_m)).collect();
        let mut end = 0;
        while let Some(first) = open[end..].iter().position(|open| *open).map(|k| end + k) {
            end = open[first..].iter().position(|open| !open).map_or(n, |k| first + k);
            for force in forces {
                for axis in 0..2 {
                    let level_n = percentile(&mut force[first..end].iter().map(|f| f[axis]).collect::<Vec<_>>(), 0.5);
                    let calm = force[first..end].iter().map(|f| (f[axis] - level_n).abs() <= least_n);
                    open[first..end].iter_mut().zip(calm).for_each(|(open, calm)| *open &= calm);
                }
            }
        }
        open
    }

    /// Warnings about the forces at rest.
    pub fn warnings(&self) -> Vec<String> {
        let mut warnings = Vec::new();
        if self.free.is_empty() {
            warnings.push(
                "nothing was ever let go in this recording: a bias of the force sensors cannot be told from a load; \
                 start and end with a second of free motion"
                    .to_owned(),
            );
        }
        for (finger, bias) in self.bias_n.iter().enumerate() {
            if bias.norm() > (2.0 * self.force_noise_n).max(0.005) {
                warnings.push(format!(
                    "the force of finger {} rests at ({:.3}, {:.3}) N in free motion; this bias is subtracted",
                    finger + 1,
                    bias.x,
                    bias.y
                ));
            }
        }
        warnings
    }
}

/// True if the least loaded samples are a phase without contact: they stay together for a while, and their mean is
/// small against the other forces of the hand.
fn is_free_phase(free: &[usize], signals: &TaskSignals, bias_n: [Vec2; 2], usual_load_n: f64) -> bool {
    const LEAST_S: f64 = 0.25;
    const LARGEST_BIAS: f64 = 0.35;
    let mut longest_s: f64 = 0.0;
    let mut start = 0;
    for k in 1..=free.len() {
        if k == free.len() || free[k] != free[k - 1] + 1 {
            longest_s = longest_s.max(signals.time_s[free[k - 1]] - signals.time_s[free[start]]);
            start = k;
        }
    }
    let total_s = signals.time_s[signals.len() - 1] - signals.time_s[0];
    longest_s >= LEAST_S.min(0.02 * total_s) && bias_n[0].norm() + bias_n[1].norm() <= LARGEST_BIAS * usual_load_n
}

/// Noise of the four force channels from their fast changes, where there is no free phase to see it in.
fn white_noises(forces: [&[Vec2]; 2]) -> [f64; 4] {
    let noise =
        |finger: usize, pick: fn(&Vec2) -> f64| white_noise(&forces[finger].iter().map(pick).collect::<Vec<_>>());
    [noise(0, |f| f.x), noise(0, |f| f.y), noise(1, |f| f.x), noise(1, |f| f.y)]
}

/// Thresholds above the noise and above anything that is not the event.
pub fn choose(signals: &TaskSignals, levels: &Levels) -> Thresholds {
    let usual_net = percentile(
        &mut (0..signals.len())
            .map(|i| (signals.net_force_n[i] - levels.bias_n[0] - levels.bias_n[1]).y.abs())
            .collect::<Vec<_>>(),
        0.9,
    );
    let mut speeds: Vec<f64> = signals.velocity.iter().map(Vec2::norm).collect();
    Usual {
        force_noise_n: levels.force_noise_n,
        net_n: usual_net,
        grip_n: levels.usual_grip_n,
        velocity_noise_m_s: velocity_noise(signals),
        speed_m_s: percentile(&mut speeds, 0.95),
    }
    .thresholds()
}

/// Usual size of signals while something happens, and their noise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Usual {
    /// Standard deviation of a force channel in free motion, N.
    pub force_noise_n: f64,
    /// 90th percentile of the size of the net vertical force, N.
    pub net_n: f64,
    /// 95th percentile of the grip force, N.
    pub grip_n: f64,
    /// Standard deviation of a velocity channel, m/s.
    pub velocity_noise_m_s: f64,
    /// 95th percentile of the speed, m/s.
    pub speed_m_s: f64,
}

impl Usual {
    /// Thresholds above the noise and above anything that is not the event.
    pub fn thresholds(&self) -> Thresholds {
        // Net force is the sum of two channels: its noise is √2 higher.
        let by_noise = NOISE_MULTIPLE * std::f64::consts::SQRT_2 * self.force_noise_n;
        let force_n = by_noise
            .max(SIGNAL_SHARE * self.net_n)
            .max(SIGNAL_SHARE * 0.5 * self.grip_n)
            .min(0.45 * self.net_n.max(by_noise));
        Thresholds { velocity_m_s: (NOISE_MULTIPLE * self.velocity_noise_m_s).max(0.15 * self.speed_m_s), force_n }
    }
}

/// White part of the velocity noise, from second differences (they remove any smooth motion), m/s.
fn velocity_noise(signals: &TaskSignals) -> f64 {
    let mut bends: Vec<f64> = signals.velocity.windows(3).map(|w| (w[0].y - 2.0 * w[1].y + w[2].y).abs()).collect();
    if bends.is_empty() {
        return 0.0;
    }
    // |N(0, 6σ²)| has its median at 0.6745 √6 σ.
    percentile(&mut bends, 0.5) / (0.6745 * 6.0_f64.sqrt())
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len().max(1) as f64
}

/// The value below which a share of the numbers lies; 0 for none. Reorders its argument.
pub fn percentile(values: &mut [f64], share: f64) -> f64 {
    if values.is_empty() {
        return 0.0;
    }
    let index = ((values.len() - 1) as f64 * share).round() as usize;
    *values.select_nth_unstable_by(index, f64::total_cmp).1
}
