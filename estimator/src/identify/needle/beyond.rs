//! What a needle shows beyond the loading curve: the force at which it goes through, the drag of the hole, its own weight.

use super::signals::Along;
use super::strokes::Push;
use super::{OBJECT, Sheet};
use crate::estimate::Parameter;
use crate::identify::bootstrap::median_error;
use haptics::recording::Recording;

/// A sheet is pierced between two samples; the force of so many samples before the fall is uncertain.
const FALL_SAMPLES: usize = 1;
/// The place of a puncture on the curve is as uncertain as this share of the force's noise.
const PLACE_NOISE: f64 = 0.5;
/// Drag, and a hole that is not the same both ways, as a share of the friction.
const HOLE_SHARE: f64 = 0.05;
/// The level of the force on the way to the sheet is known to this share of its noise at best.
const LEVEL_NOISE: f64 = 0.08;

/// One going through, all in N: the force, the errors that the curve gives it by covariance and by resampling, and its own.
struct Through {
    force: f64,
    curve: f64,
    resampled: Option<f64>,
    single: f64,
}

impl Sheet {
    pub(super) fn puncture(&self, along: &Along, pushes: &[Push]) -> Parameter {
        let seen: Vec<Through> = pushes.iter().filter_map(|push| self.through(along, push)).collect();
        if seen.is_empty() {
            let why = "the needle never went through: no force fell while it was pushed on";
            return Parameter::unidentified(OBJECT, "puncture_force_N", self.samples, why);
        }
        let n = seen.len() as f64;
        let mean = seen.iter().map(|s| s.force).sum::<f64>() / n;
        // The curve is one for all punctures; the rest is each one's own.
        let root = |of: &dyn Fn(&Through) -> f64| (seen.iter().map(|s| of(s).powi(2)).sum::<f64>() / n).sqrt();
        let own = root(&|s| s.single).max(root(&|s| s.force - mean)) / n.sqrt();
        let error = root(&|s| s.curve).hypot(own);
        let drawn: Option<f64> = seen.iter().map(|s| s.resampled.map(|r| r * r)).sum();
        let how = format!("force on the loading curve where it fell, {} time(s)", seen.len());
        Parameter::identified(OBJECT, "puncture_force_N", mean, error, seen.len(), &how)
            .with_bootstrap(drawn.map(|sum| (sum / n).sqrt().hypot(own)))
    }

    fn through(&self, along: &Along, push: &Push) -> Option<Through> {
        let give = along.give_m_n.0;
        let depth = |i: usize| along.depth_m[i] - give * along.force_n[i];
        let (at, fallen) = (push.puncture?, push.fallen?);
        // A filter that force and place went through delays both: where the force has half fallen the place is that of the fall.
        let half_m = 0.5 * (along.depth_m[fallen] + along.depth_m[fallen - 1]) - give * along.force_n[at];
        let force = self.loading.force_n(half_m.max(depth(at)));
        let before = self.loading.force_n(depth(at.saturating_sub(FALL_SAMPLES).max(push.samples.start)));
        let place = (force - before) / 12.0_f64.sqrt();
        // The curve and the sample itself, which must agree.
        let measured = along.force_n[at] - self.offset(push.hold);
        let single = place.hypot(0.5 * (measured - force)).hypot(PLACE_NOISE * along.noise_n);
        let curve = self.loading.force_error_n(depth(at));
        Some(Through { force, curve, resampled: self.loading.force_resampled_n(depth(at)), single })
    }

    /// Half the difference between going in and drawing out of a hole.
    pub(super) fn friction(&self, along: &Along, pushes: &[Push]) -> Option<Parameter> {
        let [inwards, outwards] = self.in_the_hole(along, pushes);
        let samples = inwards.len() + outwards.len();
        let drawn = median_error(&inwards).zip(median_error(&outwards)).map(|(a, b)| 0.5 * a.hypot(b));
        let (inwards, outwards) = (median(inwards)?, median(outwards)?);
        let value = 0.5 * (inwards - outwards);
        // In and out need not be alike: their mean beside zero is what is not understood.
        let unlike = (0.25 * (inwards + outwards).abs()).hypot(HOLE_SHARE * value);
        let error = unlike.hypot(along.noise_n / (samples as f64).sqrt());
        let how = "half the difference of the forces in the hole on the way in and on the way out";
        let found = Parameter::identified(OBJECT, "shaft_friction_N", value, error, samples, how);
        (value > 0.0).then(|| found.with_bootstrap(drawn.map(|d| d.hypot(unlike))))
    }

    /// Forces in holes on the way in and on the way out, N, in order of time.
    fn in_the_hole(&self, along: &Along, pushes: &[Push]) -> [Vec<f64>; 2] {
        let beyond = self.loading.surface_m + 5e-4;
        let (mut inwards, mut outwards) = (Vec::new(), Vec::new());
        for push in pushes {
            let Some(at) = push.puncture else { continue };
            let hold = along.holds[push.hold].clone();
            let offset = self.offset(push.hold);
            // From one twentieth of a second of samples on, the sheet has sprung back.
            let settled = (at + (push.end - at) / 3).min(push.end);
            inwards.extend((settled..push.end).map(|i| along.force_n[i] - offset));
            let out = (push.end..hold.end).take_while(|&i| along.depth_m[i] > beyond);
            let deepest = along.depth_m[push.end - 1];
            outwards.extend(out.filter(|&i| along.depth_m[i] < deepest - 1e-3).map(|i| along.force_n[i] - offset));
        }
        [inwards, outwards]
    }

    pub(super) fn weight(&self, along: &Along, recording: &Recording) -> Option<Parameter> {
        if !along.two_fingered || along.direction.y.abs() < 0.9 || recording.meta.gravity() <= 0.0 {
            return None;
        }
        let how = "force that holds the needle outside the sheet, less that of empty hands";
        let Some((zero, zero_error)) = along.free_n else {
            let why = "the needle was held all the time: a bias of the force sensors would pass for weight; start with free motion";
            return Some(Parameter::unidentified(OBJECT, "weight_N", self.samples, why));
        };
        // On its way to the sheet: where it is picked up or put down, something else carries a part of it.
        let value = (self.loading.offset_n[0] - zero) / along.direction.y;
        let level = (LEVEL_NOISE * along.noise_n).hypot(zero_error);
        let error = level.hypot(self.loading.around.std_errors[0]);
        let drawn = self.loading.resampled.as_ref().map(|drawn| level.hypot(drawn[0]));
        Some(Parameter::identified(OBJECT, "weight_N", value, error, self.samples, how).with_bootstrap(drawn))
    }
}

fn median(mut values: Vec<f64>) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied()
}
