//! Free-run simulation of a knob: a hand holds it on its measured path, and its curve acts on it.

use super::measured_curve::{Curve, along_m};
use super::model::asked_n;
use super::rows::{Place, Row, direction};
use crate::diagnose::free_run::channel::{Fit, Forward, consecutive};
use crate::diagnose::free_run::integrate::{Side, over};
use crate::diagnose::free_run::windows::Errors;
use crate::diagnose::hypotheses::candidate::Candidate;
use crate::diagnose::hypotheses::{local_resistance, return_spring, viscous_friction};
use haptics::law::object::ToggleCurve;
use haptics::law::{Effect, Inertia, LocalResistance, Memories, Motion};

/// Rows along the travel of a push, in the order of a comparison.
struct Travel {
    time_s: Vec<f64>,
    /// Side of the push of each row; `None` without a push.
    side: Vec<Option<usize>>,
    stretch: Vec<usize>,
    period_s: f64,
    /// Along the travel, m and m/s.
    place_m: Vec<f64>,
    speed_m_s: Vec<f64>,
}

impl Travel {
    fn windows(&self) -> Vec<Vec<usize>> {
        let pushed: Vec<usize> = (0..self.time_s.len()).filter(|i| self.side[*i].is_some()).collect();
        let of = |i: usize| (self.stretch[i], self.side[i]);
        consecutive(&pushed, &|i| self.time_s[i], self.period_s, &|a, b| of(a) == of(b))
    }

    /// Errors of a knob of this mass, kg, under this driving force in every row, N, and these forces against it.
    fn errors(
        &self,
        window: &[usize],
        mass_kg: f64,
        drive: &dyn Fn(usize) -> f64,
        acts: &dyn Fn(&Motion) -> f64,
    ) -> Errors {
        let row = |i: usize| {
            let (time_s, position, velocity) = (self.time_s[i], self.place_m[i], self.speed_m_s[i]);
            (Motion { time_s, position, velocity, ..Motion::default() }, drive(i))
        };
        // A negative mass is noise of a zero one.
        let effects = [Effect::new(&Inertia, &[mass_kg.max(0.0)])];
        let acts = &mut |motion: &Motion, _: [f64; 2]| acts(motion);
        over(window, &row, Side { effects: &effects, memory: Memories::default(), acts, driven: false })
    }
}

/// Contribution of a candidate to a row, N.
fn added(candidate: &Candidate, own: &[f64], row: usize) -> f64 {
    candidate.regressors.iter().zip(own).map(|(column, value)| value * column[row]).sum()
}

/// One row on the travel of a throw.
#[derive(Clone, Copy)]
pub struct Point {
    pub side: usize,
    pub at_m: f64,
    pub speed_m_s: f64,
    /// Measured and predicted force along the travel, N, and slope of the latter, N/m.
    pub residual_n: f64,
    pub asked_n: f64,
    pub slope_n_m: f64,
}

/// Force of a local resistance of one newton at a position, N.
pub fn bind_n(at_m: f64, place_m: f64, width_m: f64) -> f64 {
    let law = Effect::new(&LocalResistance, &[1.0, place_m, width_m, 0.0]);
    law.force(&Motion { position: at_m, direction: 1.0, velocity: 1.0, ..Motion::default() })
}

/// Force over the travel of a knob.
enum Course {
    /// Estimated curves, whose forces are the first values of the model.
    Estimated(Vec<Curve>),
    /// The curve of a world, with the rows compared with it.
    OfWorld(ToggleCurve, Vec<Point>),
}

/// Free-run model of a knob.
pub struct Knob {
    travel: Travel,
    course: Course,
}

impl Knob {
    /// A knob whose curve is estimated.
    pub fn thrown(rows: &[Row], stretch: &[usize], period_s: f64, curves: &[Curve]) -> Self {
        let pushed = |r: &Row| matches!(r.place, Place::Push(_)).then(|| r.side()).flatten();
        let travel = Travel {
            time_s: rows.iter().map(|r| r.time_s).collect(),
            side: rows.iter().map(pushed).collect(),
            stretch: stretch.to_vec(),
            period_s,
            place_m: rows.iter().map(along_m).collect(),
            speed_m_s: rows.iter().map(Row::speed_m_s).collect(),
        };
        Self { travel, course: Course::Estimated(curves.to_vec()) }
    }

    /// A knob with the curve of a world.
    pub fn captured(
        curve: &ToggleCurve,
        points: Vec<Point>,
        time_s: Vec<f64>,
        stretch: &[usize],
        period_s: f64,
    ) -> Self {
        let travel = Travel {
            time_s,
            side: points.iter().map(|p| Some(p.side)).collect(),
            stretch: stretch.to_vec(),
            period_s,
            place_m: points.iter().map(|p| direction(p.side) * p.at_m).collect(),
            speed_m_s: points.iter().map(|p| p.speed_m_s).collect(),
        };
        Self { travel, course: Course::OfWorld(curve.clone(), points) }
    }

    fn errors_of_thrown(&self, curves: &[Curve], fit: &Fit<'_>, window: &[usize]) -> Errors {
        let side = self.travel.side[window[0]].unwrap_or(0);
        let curve = of_side(curves, side, fit.values);
        let is_drag = |c: &Candidate| c.id == viscous_friction::ID;
        let drag: f64 = fit.causes().filter(|(c, _)| is_drag(c)).map(|(_, own)| own[0]).sum();
        let drive = |i: usize| {
            let beside = fit.causes().filter(|(c, _)| !is_drag(c));
            fit.study.target[i] - beside.map(|(c, own)| added(c, own, i)).sum::<f64>()
        };
        let acts = |motion: &Motion| {
            curve.map_or(0.0, |(curve, forces)| curve.force_n(motion.position, forces)) + drag * motion.velocity
        };
        // The mass is the last regressor of the model.
        self.travel.errors(window, fit.values[fit.study.baseline.len() - 1], &drive, &acts)
    }

    fn errors_of_captured(&self, curve: &ToggleCurve, points: &[Point], fit: &Fit<'_>, window: &[usize]) -> Errors {
        let side = points[window[0]].side;
        let goes_with_motion =
            |c: &Candidate| [viscous_friction::ID, return_spring::ID, local_resistance::ID].contains(&c.id);
        let drive = |i: usize| {
            let Point { residual_n, asked_n, slope_n_m, .. } = points[i];
            let beside = fit.causes().filter(|(c, _)| !goes_with_motion(c));
            // The position of the switch is estimated.
            let moved = fit.values[0] * direction(side) * slope_n_m;
            residual_n + asked_n - moved - beside.map(|(c, own)| added(c, own, i)).sum::<f64>()
        };
        let laws: Vec<(&Candidate, &[f64])> = fit.causes().filter(|(c, _)| goes_with_motion(c)).collect();
        let acts = |motion: &Motion| {
            let at_m = direction(side) * motion.position;
            let law = |(candidate, own): &(&Candidate, &[f64])| match (candidate.id, candidate.searched.as_slice()) {
                (viscous_friction::ID, _) => own[0] * motion.velocity,
                (return_spring::ID, _) => direction(side) * (own[0] * at_m + own[1]),
                (_, [place, width]) => own[0] * bind_n(at_m, place.value, width.value),
                _ => 0.0,
            };
            asked_n(curve, at_m, side).0 + laws.iter().map(law).sum::<f64>()
        };
        self.travel.errors(window, 0.0, &drive, &acts)
    }
}

/// Curve of a side with its forces from the model's values.
fn of_side<'a>(curves: &'a [Curve], side: usize, values: &'a [f64]) -> Option<(&'a Curve, &'a [f64])> {
    let mut at = 0;
    curves.iter().find_map(|curve| {
        let own = at..at + curve.len();
        at = own.end;
        (curve.side == side).then(|| (curve, &values[own]))
    })
}

impl Forward for Knob {
    fn windows(&self) -> Vec<Vec<usize>> {
        self.travel.windows()
    }

    fn errors(&self, fit: &Fit<'_>, window: &[usize]) -> Result<Errors, String> {
        Ok(match &self.course {
            Course::Estimated(curves) => self.errors_of_thrown(curves, fit, window),
            Course::OfWorld(curve, points) => self.errors_of_captured(curve, points, fit, window),
        })
    }
}
