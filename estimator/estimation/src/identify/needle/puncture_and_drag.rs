//! Estimates of a needle beyond the loading curve: the force at which it goes through, the drag of the hole, its own
//! weight.

use super::sheet::{HELD, OBJECT, Sheet};
use super::signals::Along;
use super::strokes::Push;
use crate::identify::limits::CLEARLY_SIGNIFICANT;
use crate::regression::bootstrap::median_error;
use foundation::estimate::Parameter;
use haptics::recording::Recording;

/// Largest distance of a force on the loading curve, as a share of it: slow filters bend the curve a little.
/// Choice: halved or doubled, none of 15 answers changes.
const ON_CURVE: f64 = 0.02;
/// Delay of a filter that force and place may have gone through, s: it makes the puncture lead on the curve.
/// Choice: halved or doubled, none of 15 answers changes.
const FILTER_S: f64 = 2e-3;
/// Time before the puncture over which the speed of a push is taken, s; at least one step between samples.
/// Choice: halved or doubled, none of 15 answers changes.
const SPEED_BEFORE_S: f64 = 0.02;
/// Uncertainty of a puncture's place on the curve, as a share of the force's noise.
/// Choice: halved or doubled, none of 15 answers changes.
const PLACE_NOISE: f64 = 0.5;
/// Error of the friction by drag, and by a hole that is not the same both ways, as a share of the friction.
/// Choice: halved or doubled, none of 15 answers changes.
const HOLE_SHARE: f64 = 0.05;
/// Least error of the level of the force on the way to the sheet, as a share of the force's noise.
/// Choice: halved or doubled, none of 15 answers changes.
const LEVEL_NOISE: f64 = 0.08;

/// One puncture, all in N: the force, its errors by the curve (by covariance and by resampling), and its own.
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

    /// A sheet yields between the last sample on the loading curve and the next one, at the place that the needle
    /// reached with its speed. Once it is through, its driving spring lets it run ahead, and the force of that falls by
    /// and by.
    fn through(&self, along: &Along, push: &Push) -> Option<Through> {
        let give = along.give_m_n.0;
        let depth = |i: usize| along.depth_m[i] - give * along.force_n[i];
        let measured = |i: usize| along.force_n[i] - self.offset(push.hold);
        let (peak, fallen) = (push.puncture?, push.fallen?);
        let is_on_curve = |i: &usize| {
            let curve = self.loading.force_n(depth(*i));
            measured(*i) > curve - (CLEARLY_SIGNIFICANT * along.noise_n).max(ON_CURVE * curve)
        };
        let at = (peak..fallen).rev().find(is_on_curve).unwrap_or(peak);
        let back = ((SPEED_BEFORE_S / along.period_s.max(1e-9)) as usize).max(1);
        let first = at.saturating_sub(back).max(push.samples.start).min(at.saturating_sub(1));
        let step_m = ((depth(at) - depth(first)) / (at - first).max(1) as f64).max(0.0);
        let (before, after) = (self.loading.force_n(depth(at)), self.loading.force_n(depth(at) + step_m));
        let force = 0.5 * (before + after);
        let filtered = if along.period_s > 0.0 { (after - before) * FILTER_S / along.period_s } else { 0.0 };
        let place = ((after - before) / 12.0_f64.sqrt()).hypot(filtered);
        // The curve and the sample itself, which must agree.
        let single = place.hypot(0.5 * (measured(at) - before)).hypot(PLACE_NOISE * along.noise_n);
        let curve = self.loading.force_error_n(depth(at));
        Some(Through { force, curve, resampled: self.loading.force_resampled_n(depth(at)), single })
    }

    /// Holding force of a single tool outside the sheet: its weight, if it goes up and down.
    pub(super) fn held(&self, along: &Along) -> Option<Parameter> {
        if along.two_fingered || along.direction.y.abs() < 0.9 {
            return None;
        }
        let how = "force upwards that holds the tool outside the sheet: its weight, and any bias of its sensor";
        let value = self.loading.offset_n.first()? / along.direction.y;
        let error = (LEVEL_NOISE * along.noise_n).hypot(self.loading.around.std_errors[0]);
        Some(Parameter::identified(OBJECT, HELD, value, error, self.samples, how))
    }

    /// Half the difference between going in and drawing out of a hole.
    pub(super) fn friction(&self, along: &Along, pushes: &[Push]) -> Option<Parameter> {
        let [inwards, outwards] = self.in_the_hole(along, pushes);
        let samples = inwards.len() + outwards.len();
        let drawn = median_error(&inwards).zip(median_error(&outwards)).map(|(a, b)| 0.5 * a.hypot(b));
        let (inwards, outwards) = (median(inwards)?, median(outwards)?);
        let value = 0.5 * (inwards - outwards);
        // In and out need not be alike: their mean beside zero is unexplained.
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

#[cfg(test)]
mod tests {
    use super::super::strokes::pushes;
    use super::*;

    /// Pushed in by `step_m` a sample into a spring of 450 N/m that is pierced at 1.6 N, `later_m` beyond a sample.
    /// Then the driving spring lets it run ahead, and the force of that falls by and by.
    fn pierced(step_m: f64, later_m: f64) -> Along {
        let (mut depth_m, mut force_n) = (Vec::new(), Vec::new());
        let (mut at, mut left) = (later_m - step_m * (1.6 / 450.0 / step_m + 40.0).round(), None);
        for i in 0..120 + (6e-3 / step_m) as usize {
            // A deterministic stand-in for noise of 4 mN.
            let noise = 5.6e-3 * (i as f64 * 12.9898).sin();
            let elastic = 450.0 * f64::max(at, 0.0);
            left = left.map(|n: f64| 0.7 * n).or((elastic > 1.6).then_some(1.25));
            force_n.push(left.unwrap_or(elastic) + noise);
            depth_m.push(at);
            at += if left.is_some() { 3.0 * step_m } else { step_m };
        }
        let n = depth_m.len();
        Along {
            depth_m,
            force_n,
            side_m: vec![0.0; n],
            direction: haptics::Vec2::new(0.0, -1.0),
            holds: std::iter::once(0..n).collect(),
            give_m_n: (0.0, 0.0),
            calm: 1,
            period_s: step_m / 0.02,
            noise_n: 0.004,
            free_n: None,
            two_fingered: false,
        }
    }

    #[test]
    fn what_runs_ahead_once_it_is_through_is_no_force_of_the_sheet() {
        for step_m in [2e-5, 1e-4, 3e-4] {
            let mut sum = 0.0;
            for part in 0..5 {
                let along = pierced(step_m, step_m * f64::from(part) / 5.0);
                let pushes = pushes(&along);
                let sheet = Sheet::of(&along, &pushes).expect("a sheet");
                let found = sheet.puncture(&along, &pushes);
                let (value, error) = found.value.zip(found.std_error).expect("it goes through");
                assert!((value - 1.6).abs() < 3.0 * error, "{value} ± {error} at {step_m}");
                sum += value / 5.0;
            }
            assert!((sum / 1.6 - 1.0).abs() < 0.015, "{sum} at {step_m}");
        }
    }
}
