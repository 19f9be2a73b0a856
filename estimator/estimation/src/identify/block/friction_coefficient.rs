//! True static friction, if fingers were seen to slip on a block.
//!
//! A ratio of forces is only a lower bound of the friction coefficient, unless the fingers slip. A slip has three
//! signs. The block is not carried by the fingers any more (the lift is less than weight and acceleration need). Shear
//! and normal force of both fingers keep one ratio. Something happens at that ratio: the pinch changes, or the tips
//! move farther than pads yield. A block that is put down shows the first without the second, a steadily carried one
//! the second without the first. And no ratio below one that was held without a slip is friction.
//!
//! The equality of the ratios must be shown, not only be possible. A grip that is released while the block stands has a
//! falling pinch beside a constant shear, and in a short window the noise allows for that, too.

use super::signals::{Blocks, MAIN, mean_and_spread, object};
use crate::identify::limits::CONTACT_NOISES;
use crate::identify::pads::SOFTEST;
use crate::regression::bootstrap::block_bootstrap;
use crate::regression::linear::least_squares;
use crate::segment::threshold::percentile;
use foundation::estimate::Parameter;
use haptics::Vec2;

/// Length of the windows that are looked at, s.
/// Choice: no case of the ablation reads it.
const SLIP_WINDOW_S: f64 = 0.05;
/// Distance between these windows, s.
/// Choice: no case of the ablation reads it.
const WINDOW_STEP_S: f64 = 0.01;
/// Least deficit of the lift, as a share of the force that the block needs.
/// Choice: no case of the ablation reads it.
const MISSING: f64 = 0.06;
/// Least change of the pinch within a window, as a share of it.
/// Choice: no case of the ablation reads it.
const PINCH_CHANGES: f64 = 0.08;
/// Least motion of the tips in a window beyond the give of the softest pads, as a share of
/// the object's size.
/// Choice: no case of the ablation reads it.
const SLIDES: f64 = 0.015;
/// Least ratio of a slip, as a share of the largest ratio that was certainly held.
/// Choice: no case of the ablation reads it.
const OF_THE_BOUND: f64 = 0.9;
/// Largest difference of the two fingers' ratios, as a share: one that only leans has another ratio.
/// Choice: no case of the ablation reads it.
const FINGERS_AGREE: f64 = 0.15;
/// Largest change of the ratio from the first to the second half of a window, as a share of itself, beyond doubt.
/// Choice: no case of the ablation reads it.
const KEEPS: f64 = 0.2;
/// Largest change of the ratio as a share of that of the pinch, if the pinch changes: a constant shear would change it
/// by the whole.
/// Choice: no case of the ablation reads it.
const OF_THE_PINCH: f64 = 0.5;
/// Number of standard errors beyond doubt.
/// Choice: no case of the ablation reads it.
const DOUBT: f64 = 2.0;
/// Duration of a slip's onset, s; later the friction is that of motion.
/// Choice: no case of the ablation reads it.
const ONSET_S: f64 = 0.1;

impl Blocks<'_> {
    /// Largest ratio of tangential to normal tip force while grasped: a lower bound of the friction coefficient.
    pub(super) fn friction(&self, number: usize) -> [Parameter; 2] {
        let name = object(number);
        if let Some(why) = self.unshown("friction_lower_bound") {
            return ["friction_lower_bound", "friction"].map(|f| Parameter::unidentified(&name, f, 0, &why));
        }
        let samples = self.shown("friction_lower_bound", number);
        let (mean_grip, _) = mean_and_spread(&samples.iter().map(|i| self.grip[*i]).collect::<Vec<_>>());
        let noise = self.levels.force_noise_n;
        // Below this grip the ratio is noise.
        let least = (10.0 * noise).max(0.25 * mean_grip);
        let mut best: Option<(f64, f64)> = None;
        for finger in 0..2 {
            for i in &samples {
                let force = self.mean_force(finger, *i);
                let normal = if finger == 0 { force.x } else { -force.x };
                if normal > least {
                    let ratio = force.y.abs() / normal;
                    let error = noise * ratio.hypot(1.0) / normal;
                    // Only the certain part counts: the largest of many noisy ratios would overshoot.
                    if best.is_none_or(|(r, e)| ratio - 2.0 * error > r - 2.0 * e) {
                        best = Some((ratio, error));
                    }
                }
            }
        }
        let held = best.map_or(0.0, |(ratio, error)| ratio - 2.0 * error);
        let slip = match self.slip(number, held) {
            Some(slip) => {
                let how = format!(
                    "shear over normal force of both fingers at the onset of a slip, the first at {:.2} s",
                    slip.at_s
                );
                Parameter::identified(&name, "friction", slip.coefficient, slip.error, slip.samples, &how)
                    .with_bootstrap(slip.resampled)
            }
            None => Parameter::unidentified(
                &name,
                "friction",
                samples.len(),
                "the fingers never slipped: only a lower bound is given; loosen the pinch until the block slides",
            ),
        };
        let bound = match best {
            Some((ratio, error)) => Parameter::identified(
                &name,
                "friction_lower_bound",
                // The largest of many noisy ratios lies about one error too high.
                (ratio - error).max(0.0),
                error,
                samples.len(),
                "largest ratio of vertical to horizontal tip force while grasped; true friction is at least this",
            ),
            None => Parameter::unidentified(&name, "friction_lower_bound", 0, "the grip was never firm enough to tell"),
        };
        [bound, slip]
    }

    /// Friction where the fingers slipped on a block, from gripping it to shortly after it was put down or lost.
    fn slip(&self, number: usize, ratio: f64) -> Option<Slip> {
        /// Time after the end of a grasp in which slips still count, s.
        /// Choice: no case of the ablation reads it.
        const AFTER_S: f64 = 0.3;
        let carried = self.shown(MAIN, number);
        let mut lifts: Vec<f64> = carried.iter().map(|i| self.lift[*i]).collect();
        // The middle one: a slip at the end of the carry does not count.
        let weight_n = percentile(&mut lifts, 0.5);
        let grasp = self.shown("friction", number);
        let time = &self.signals.time_s;
        let end = time.partition_point(|t| *t < grasp.last().map_or(0.0, |i| time[*i]) + AFTER_S);
        let least_grip_n = CONTACT_NOISES * self.levels.force_noise_n;
        slip(self, *grasp.first()?, end, Held { weight_n, least_grip_n, ratio })
    }

    /// Tip force averaged over 60 ms about a sample, N: sensor noise falls, friction does not change that fast.
    pub(super) fn mean_force(&self, finger: usize, i: usize) -> Vec2 {
        /// Half of the window over which a tip force is averaged, s.
        /// Choice: no case of the ablation reads it.
        const MEAN_FORCE_HALF_S: f64 = 0.03;
        let time = &self.signals.time_s;
        let first = time[..i].partition_point(|t| *t < time[i] - MEAN_FORCE_HALF_S);
        let mut end = i + 1;
        while end < time.len() && time[end] <= time[i] + MEAN_FORCE_HALF_S {
            end += 1;
        }
        (first..end).map(|j| self.force(finger, j)).sum::<Vec2>() / (end - first) as f64
    }
}

/// Friction at the onset of slips.
pub(super) struct Slip {
    pub(super) coefficient: f64,
    pub(super) error: f64,
    /// The error by resampling; `None` where the onset is too short.
    pub(super) resampled: Option<f64>,
    pub(super) samples: usize,
    /// Beginning of the first one, s.
    pub(super) at_s: f64,
}

/// Conditions for judging a slip.
#[derive(Clone, Copy)]
pub(super) struct Held {
    /// Weight of the block, N.
    pub(super) weight_n: f64,
    /// Below this pinch a ratio is noise, N.
    pub(super) least_grip_n: f64,
    /// Ratio that was held for certain.
    pub(super) ratio: f64,
}

/// Slips among the samples `first..end` of one block.
pub(super) fn slip(blocks: &Blocks<'_>, first: usize, end: usize, held: Held) -> Option<Slip> {
    let time = &blocks.signals.time_s;
    let mut onsets: Vec<(usize, usize)> = Vec::new();
    let mut at = first;
    let mut quiet_until = f64::NEG_INFINITY;
    while at < end {
        let stop = time[..end].partition_point(|t| *t < time[at] + SLIP_WINDOW_S);
        let window = (at, stop.max(at + 1));
        if time[at] >= quiet_until && slides(blocks, window, held) {
            // The first window that slides may still begin before it does.
            let begin = time[..end].partition_point(|t| *t < time[at] + 0.5 * SLIP_WINDOW_S);
            let onset_end = time[..end].partition_point(|t| *t < time[at] + ONSET_S);
            onsets.push((begin, onset_end.max(begin + 1)));
            // One slip has one onset.
            quiet_until = time[at] + 1.0;
        }
        at = time[..end].partition_point(|t| *t < time[at] + WINDOW_STEP_S).max(at + 1);
    }
    let at_s = time[onsets.first()?.0];
    let (mut shear, mut normal) = (Vec::new(), Vec::new());
    for i in onsets.iter().flat_map(|(from, to)| *from..*to) {
        for finger in 0..2 {
            let (along, across) = pair(blocks, finger, i);
            if across > held.least_grip_n {
                shear.push(along);
                normal.push(across);
            }
        }
    }
    let fit = least_squares(std::slice::from_ref(&normal), &shear, None).ok()?;
    let usual_n = normal.iter().sum::<f64>() / normal.len().max(1) as f64;
    // A bias that is known to b shifts the ratio by b over the pinch.
    let bias = blocks.bias_error() * fit.values[0].hypot(1.0) / usual_n;
    let samples = shear.len();
    let drawn = block_bootstrap(std::slice::from_ref(&normal), &shear, None, &fit);
    Some(Slip {
        coefficient: fit.values[0],
        error: fit.std_errors[0].hypot(bias),
        resampled: drawn.map(|drawn| drawn[0].hypot(bias)),
        samples,
        at_s,
    })
}

/// Size of the shear and normal force of a finger, N.
fn pair(blocks: &Blocks<'_>, finger: usize, i: usize) -> (f64, f64) {
    let force = blocks.force(finger, i);
    (force.y.abs(), if finger == 0 { force.x } else { -force.x })
}

fn slides(blocks: &Blocks<'_>, (from, to): (usize, usize), held: Held) -> bool {
    let Held { weight_n, least_grip_n, ratio: held } = held;
    let n = (to - from) as f64;
    if n < 3.0 {
        return false;
    }
    let mean =
        |value: &dyn Fn(usize) -> f64, from: usize, to: usize| (from..to).map(value).sum::<f64>() / (to - from) as f64;
    let noise = blocks.levels.force_noise_n;
    // Tips that are thrown up at lift-off need more force than the block behind its pads: only a fall needs less.
    let gravity = blocks.recording.meta.gravity();
    let asked = mean(&|i| weight_n * (1.0 + blocks.acceleration_y[i].min(0.0) / gravity), from, to);
    let lift = mean(&|i| blocks.lift(i), from, to);
    if asked - lift < (MISSING * weight_n).max(5.0 * noise * (2.0 / n).sqrt()) {
        return false;
    }
    let middle = from + (to - from) / 2;
    let ratios = [0, 1].map(|finger| {
        let sums = (from..to).map(|i| pair(blocks, finger, i)).fold((0.0, 0.0), |s, (a, b)| (s.0 + a * b, s.1 + b * b));
        let ratio = sums.0 / sums.1.max(1e-12);
        let least = (from..to).map(|i| pair(blocks, finger, i).1).fold(f64::INFINITY, f64::min);
        // Proportional in both halves, within the noise of their means.
        let off = |a: usize, b: usize| mean(&|i| pair(blocks, finger, i).0 - ratio * pair(blocks, finger, i).1, a, b);
        let allowed = 4.0 * noise * ratio.hypot(1.0) / (0.5 * n).sqrt();
        let even = off(from, middle).abs() < allowed && off(middle, to).abs() < allowed;
        (ratio, even && least > least_grip_n)
    });
    let agree = (ratios[0].0 - ratios[1].0).abs() < FINGERS_AGREE * ratios[0].0.max(ratios[1].0);
    if !(ratios[0].1 && ratios[1].1 && agree && 0.5 * (ratios[0].0 + ratios[1].0) > OF_THE_BOUND * held) {
        return false;
    }
    let change = ratio_changes(blocks, (from, middle, to)) / (0.5 * (ratios[0].0 + ratios[1].0));
    let grip = |a: usize, b: usize| mean(&|i| blocks.grip[i], a, b);
    let (before, after) = (grip(from, middle), grip(middle, to));
    let pinch = (before - after).abs() / before.max(after);
    let way = (blocks.height[to - 1] - blocks.height[from]).abs();
    let object_m = blocks.signals.object_m();
    let elastic = SOFTEST * object_m * (blocks.lift[to - 1] - blocks.lift[from]).abs() / before.max(after);
    pinch > PINCH_CHANGES && change < KEEPS.min(OF_THE_PINCH * pinch)
        || way > SLIDES * object_m + elastic && change < KEEPS
}

/// By how much the ratio of both fingers' shear to their pinch may have changed from the first half of a window to the second, at most.
fn ratio_changes(blocks: &Blocks<'_>, (from, middle, to): (usize, usize, usize)) -> f64 {
    let noise_n = blocks.levels.force_noise_n;
    let half = |from: usize, to: usize| {
        let pairs = (from..to).flat_map(|i| [pair(blocks, 0, i), pair(blocks, 1, i)]);
        let (both, square) = pairs.fold((0.0, 0.0), |(both, square), (a, b)| (both + a * b, square + b * b));
        let ratio: f64 = both / f64::max(square, 1e-12);
        (ratio, noise_n * ratio.hypot(1.0) / f64::max(square, 1e-12).sqrt())
    };
    let (before, after) = (half(from, middle), half(middle, to));
    (before.0 - after.0).abs() + DOUBT * before.1.hypot(after.1)
}
