//! A toggle switch captured as force against displacement, there and back (future work of the thesis; the way of Mac
//! Lean 1996): its actuation force, the place of the snap, the fall of the force, and its stops.
//!
//! Two fingers measure their tips, not the knob. The width of the knob is shown by one finger that leaves it at rest
//! and the other that meets it. The give of the pads is seen at the stops only, where knob and finger stand. A stop is
//! taken as at least two thirds as stiff as a pad, and the remaining uncertainty joins the errors of all places. The
//! knob's path is taken as an arc about a lever twice as long as its travel, its axis below; the effect of a straighter
//! path joins the errors of the forces.

mod assumptions;
mod report;
mod signals;
mod throw_curve;

use crate::identify::limits::CLEARLY_SIGNIFICANT;
use crate::identify::pads::EVEN;
use crate::regression::bootstrap::{Resampled, median_error_of_few};
use assumptions::Assumptions;
use foundation::estimate::{EstimateError, Fit, Parameter};
use haptics::recording::Recording;
use nalgebra::DMatrix;
use signals::Signals;
pub use signals::longest_push_m;
use throw_curve::{Stop, Throw};

/// The object's name in the results.
pub const OBJECT: &str = "switch";
/// Length of the lever that is assumed, in travels of the knob.
/// Choice: not varied, because other constants are made from it. Its uncertainty is a half ([`LEVER_SPREAD`]).
pub const LEVER_TRAVELS: f64 = 1.9;
/// Relative uncertainty of the inverse of the lever's length.
/// Derived: evenly likely within half of itself.
const LEVER_SPREAD: f64 = 0.5 * EVEN;
/// The pads' share of the give at the stops, and its error.
/// Derived: evenly likely between 0.4 and 1.
const PAD_SHARE: (f64, f64) = (0.7, 0.3 * EVEN);
/// Stiffness of a pad in terms of that at the stops, and its error.
/// Derived: the middle of the 95 % range of 1/share, 1.02 … 2.41, and its half width over 1.96, for shares as in
/// `PAD_SHARE`.
pub const PADS_IN_GIVE: (f64, f64) = (1.71, 0.36);
/// Uncertainty of the place of a touch on the knob's round side, as a share of the longest push.
/// Choice: halved or doubled, none of 21 answers changes.
const TOUCHED: f64 = 0.004;
/// Uncertainty of the resting place of a knob held by friction, as a share of the longest push.
/// Choice: halved or doubled, none of 21 answers changes.
const RESTING: f64 = 0.006;
/// Share of the least force of a touch, over the rise, by which a finger moves the knob before the touch is seen.
/// Choice: halved or doubled, none of 21 answers changes.
const UNSEEN_TOUCH: f64 = 0.15;
/// Largest delay of a touch, as a share of the way between two samples.
/// Choice: halved or doubled, none of 21 answers changes.
const TOUCH_STEP_SHARE: f64 = 0.7;

/// Fits one recording.
pub fn fit(recording: &Recording) -> Result<Fit, EstimateError> {
    let signals = Signals::of(recording)?;
    let rough = Curves::of(&signals, &Assumptions::default())?;
    let give_m_n = rough.give_m_n();
    let travel_m = rough.travel_m().map_or(signals.range_m, |(travel_m, _)| travel_m);
    let bend_1_m = 1.0 / (LEVER_TRAVELS * travel_m);
    let reading = Assumptions { give_m_n: PAD_SHARE.0 * give_m_n.map_or(0.0, |g| g.0), bend_1_m };
    let softer = Assumptions { give_m_n: reading.give_m_n * (1.0 + PAD_SHARE.1 / PAD_SHARE.0), ..reading };
    let straighter = Assumptions { bend_1_m: (1.0 - LEVER_SPREAD) * bend_1_m, ..reading };
    let of = |reading: &Assumptions| Curves::of(&signals, reading);
    let captured = Captured {
        curves: of(&reading)?,
        others: [of(&softer)?, of(&straighter)?],
        give_m_n,
        zero_error_n: signals.zero_error_n,
        touched_m: TOUCHED * signals.push_m,
    };
    Ok(captured.report(recording))
}

/// Mean height of the tips while they touch the knob, m.
pub fn height_m(recording: &Recording) -> Option<f64> {
    Signals::of(recording).ok().map(|s| s.height_m)
}

/// Estimates in both directions, to the right first, with one reading of the samples.
struct Curves {
    reading: Assumptions,
    /// Middle of the seen range, m in the world.
    top_m: f64,
    ways: [Option<Throw>; 2],
    stops: [Option<Stop>; 2],
    /// Width of the knob between the tips, m.
    width_m: Option<f64>,
    /// The error of that median by resampling the throws, m; `None` for fewer than three.
    width_resampled_m: Option<f64>,
    /// Uncertainty of its place at rest, m.
    resting_m: f64,
}

/// Estimates with the effects of systematic errors.
struct Captured {
    curves: Curves,
    others: [Curves; 2],
    /// Give of pad and stop together with its error, m/N.
    give_m_n: Option<(f64, f64)>,
    zero_error_n: f64,
    /// Uncertainty of the place of a touch, m.
    touched_m: f64,
}

impl Curves {
    fn of(signals: &Signals, reading: &Assumptions) -> Result<Self, EstimateError> {
        let seen = [signals.seen(0, reading), signals.seen(1, reading)];
        let peaked =
            |w: &Throw| w.around.t_value(1) > CLEARLY_SIGNIFICANT && w.around.t_value(2) < -CLEARLY_SIGNIFICANT;
        let ways = [throw_curve::throw(&seen[0])?.filter(peaked), throw_curve::throw(&seen[1])?.filter(peaked)];
        let rise = ways.iter().flatten().map(|w| w.values[1]).fold(f64::INFINITY, f64::min);
        Ok(Self {
            reading: *reading,
            top_m: signals.middle_m,
            ways,
            resting_m: (RESTING * signals.push_m)
                .hypot(UNSEEN_TOUCH * signals.touch_n / rise)
                .hypot(TOUCH_STEP_SHARE * signals.step_m),
            stops: [throw_curve::stop(&seen[0])?, throw_curve::stop(&seen[1])?],
            width_m: signals.width_m(reading.give_m_n),
            width_resampled_m: median_error_of_few(&signals.widths_m(reading.give_m_n)),
        })
    }

    /// Give of finger and stop together, m/N; both sides weighted by their errors.
    fn give_m_n(&self) -> Option<(f64, f64)> {
        let found: Vec<(f64, f64)> = self.stops.iter().flatten().map(|s| s.give_m_n).collect();
        let weight: f64 = found.iter().map(|g| g.1.powi(-2)).sum();
        let mean = found.iter().map(|g| g.0 * g.1.powi(-2)).sum::<f64>() / weight;
        (weight > 0.0 && mean > 0.0 && weight.is_finite()).then(|| (mean, weight.powf(-0.5)))
    }

    /// A place of the knob along its arc as one of its middle in the world, m.
    fn middle_m(&self, side: usize, (at_m, error_m): (f64, f64)) -> Option<(f64, f64)> {
        self.width_m?;
        let across_m = [1.0, -1.0][side] * self.reading.across_m(at_m);
        Some((self.top_m + across_m, error_m.hypot(0.5 * self.resting_m)))
    }

    fn snap_m(&self, side: usize) -> Option<(f64, f64)> {
        let way = self.ways[side].as_ref()?;
        self.middle_m(side, (way.values[3], way.around.std_errors[3]))
    }

    /// Beginning of the stop in a direction, m in the world.
    fn end_m(&self, side: usize) -> Option<(f64, f64)> {
        self.middle_m(side, self.stops[side].as_ref()?.end_m)
    }

    /// Slope of the rise or of the fall in a direction over the way across, N/m: along the arc over the same range. The
    /// rise begins at the stop behind, and the fall ends as far beyond the top.
    fn slope_n_m(&self, side: usize, falling: bool) -> Option<(f64, f64)> {
        let way = self.ways[side].as_ref()?;
        let snap = way.values[3];
        let far = if falling { -snap } else { self.stops[1 - side].as_ref().map_or(2.0 * snap, |s| -s.end_m.0) };
        let across = self.reading.across_m(far) - self.reading.across_m(snap);
        let stretched = if across.abs() > 0.0 { (far - snap) / across } else { 1.0 };
        let k = if falling { 2 } else { 1 };
        Some((way.values[k] * stretched, way.around.std_errors[k] * stretched))
    }

    fn travel_m(&self) -> Option<(f64, f64)> {
        let (right, left) = (self.end_m(0)?, self.end_m(1)?);
        Some((right.0 - left.0, right.1.hypot(left.1).hypot(self.resting_m))).filter(|t| t.0 > 0.0)
    }

    /// Half of the force of both directions in the middle between the places where their forces vanish: friction, N.
    fn friction_n(&self) -> Option<(f64, f64)> {
        self.friction_by(|way| Some(&way.around.covariance))
    }

    /// The same with its error by resampling.
    fn friction_resampled_n(&self) -> Option<(f64, f64)> {
        self.friction_by(|way| way.resampled.as_ref().map(Resampled::covariance))
    }

    fn friction_by(&self, covariance: impl Fn(&Throw) -> Option<&DMatrix<f64>>) -> Option<(f64, f64)> {
        let ([Some(there), Some(back)], Some(_)) = (&self.ways, self.width_m) else { return None };
        let gone = |w: &Throw| w.values[3] - w.values[0] / w.values[2];
        let middle = 0.5 * (gone(there) - gone(back));
        let error = |way: &Throw, at_m: f64| Some(way.falling_error_n(at_m, covariance(way)?));
        let errors = error(there, middle)?.hypot(error(back, -middle)?);
        let slope = 0.5 * (there.values[2] + back.values[2]).abs();
        let value = 0.5 * (there.falling_n(middle) + back.falling_n(-middle));
        Some((value, 0.5 * errors.hypot(slope * self.resting_m)))
    }
}

impl Captured {
    /// A value with `own` error, the fit's, and the changes by softer pads and a straighter path.
    fn with_errors(&self, own: f64, of: impl Fn(&Curves) -> Option<(f64, f64)>) -> Option<(f64, f64)> {
        let (value, fitted) = of(&self.curves)?;
        let change = |other: &Curves| of(other).map_or(0.0, |(v, _)| v - value);
        let error = self.others.iter().map(change).fold(own.hypot(fitted), f64::hypot);
        error.is_finite().then_some((value, error))
    }

    /// The same with the fit's own errors by resampling: `of` gives a value of some curves, and the fit's own error of it.
    fn with_bootstrap(
        &self,
        parameter: Parameter,
        own: f64,
        of: impl Fn(&Curves) -> Option<(f64, f64)>,
        resampled: impl Fn(&Curves) -> Option<f64>,
    ) -> Parameter {
        let Some(drawn) = resampled(&self.curves) else { return parameter };
        let found = self.with_errors(own, |c| Some((of(c)?.0, drawn)));
        parameter.with_bootstrap(found.map(|(_, error)| error))
    }

    fn samples(&self) -> usize {
        self.curves.ways.iter().flatten().map(|w| w.samples).sum()
    }
}
