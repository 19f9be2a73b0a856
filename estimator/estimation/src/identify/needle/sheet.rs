//! The sheet that a needle is pushed through: its loading curve, its parameters and its constraint.

use super::loading_curve::{self, Loading, Point};
use super::phases;
use super::signals::Along;
use super::strokes::Push;
use crate::identify::pads::HAND_N_M;
use crate::regression::long_run_variance::HALF_INTERVAL;
use foundation::estimate::{Constraint, ConstraintKind, EstimateError, Parameter, Sided, Yielding};
use haptics::Vec2;
use haptics::recording::Recording;

/// The object's name in the results.
pub const OBJECT: &str = "needle";

/// The force that a single tool is held with outside the sheet, N upwards.
pub const HELD: &str = "held_force_N";

/// Error of a place by geometry and log (seats, resolution), as a share of the dent.
/// Choice: halved or doubled, none of 15 answers changes.
const PLACE_ERROR: f64 = 0.003;

/// Least number of points to which samples are averaged.
/// Choice: halved or doubled, none of 15 answers changes.
const LEAST_POINTS: usize = 60;

/// Least number of samples of loading that show a curve.
/// Choice: halved or doubled, none of 15 answers changes.
pub(super) const LEAST_LOADING: usize = 20;

/// The loading curve with its change by the pads' unknown give.
pub struct Sheet {
    /// Fitted loading curve.
    pub loading: Loading,
    /// The same with pads that give one standard error more.
    softer: Loading,
    pub(super) samples: usize,
    /// Holds with a push, in the order of the offsets.
    holds: Vec<usize>,
}

impl Sheet {
    /// The loading curve of all pushes.
    pub fn of(along: &Along, pushes: &[Push]) -> Result<Self, EstimateError> {
        let mut holds: Vec<usize> = pushes.iter().map(|p| p.hold).collect();
        holds.dedup();
        let (give, error) = along.give_m_n;
        let loading = curve(along, pushes, &holds, give)?;
        let softer = if error > 0.0 { curve(along, pushes, &holds, give + error)? } else { loading.clone() };
        Ok(Self { samples: pushes.iter().map(|p| p.samples.len()).sum(), loading, softer, holds })
    }

    /// Error of a value that the pads' give changes, with the fit's own.
    pub(super) fn error(&self, own: f64, of: impl Fn(&Loading) -> f64) -> f64 {
        own.hypot(of(&self.softer) - of(&self.loading))
    }

    /// The same with the fit's own error by resampling, and the other errors of the value.
    pub(super) fn resampled(&self, column: usize, other: f64, of: impl Fn(&Loading) -> f64) -> Option<f64> {
        self.loading.resampled.as_ref().map(|r| self.error(r[column].hypot(other), of))
    }

    pub(super) fn parameters(&self, along: &Along, pushes: &[Push], recording: &Recording) -> Vec<Parameter> {
        let (loading, errors) = (&self.loading, &self.loading.around.std_errors);
        let stiffness_error = self.error(errors[loading.stiffness_at()], |l| l.stiffness_n_m);
        let pads = if along.give_m_n.0 > 0.0 { ", less the pads' give" } else { "" };
        let how = format!("slope of force over depth where the sheet was first met{pads}");
        let mut found = vec![
            Parameter::identified(OBJECT, "stiffness_N_m", loading.stiffness_n_m, stiffness_error, self.samples, &how)
                .with_bootstrap(self.resampled(loading.stiffness_at(), 0.0, |l| l.stiffness_n_m)),
        ];
        if loading.cubic_n_m3 > 0.0 {
            let (value, column) = (loading.cubic_n_m3, loading.stiffness_at() + 1);
            let error = self.error(errors[column], |l| l.cubic_n_m3);
            let how = "bend of the same curve";
            let found_bend = Parameter::identified(OBJECT, "hardening_N_m3", value, error, self.samples, how);
            found.push(found_bend.with_bootstrap(self.resampled(column, 0.0, |l| l.cubic_n_m3)));
        }
        found.push(self.puncture(along, pushes));
        found.push(self.surface(along, &pushes[0]));
        found.extend(self.friction(along, pushes));
        found.extend(self.weight(along, recording));
        found.extend(self.held(along));
        found
    }

    pub(super) fn offset(&self, hold: usize) -> f64 {
        self.holds.iter().position(|h| *h == hold).map_or(0.0, |k| self.loading.offset_n[k])
    }

    /// Along the world's axis that the needle moves along, else along the needle.
    pub(super) fn surface(&self, along: &Along, first: &Push) -> Parameter {
        let place_error_m = PLACE_ERROR * first.dent_m;
        let own = self.loading.around.std_errors[self.loading.surface_at()].hypot(place_error_m);
        let error = self.error(own, |l| l.surface_m);
        let (x, y) = (along.direction.x, along.direction.y);
        let point = if along.two_fingered { "the middle of the fingertips" } else { "the tool" };
        // Meeting point of the needle: an axis that is a little askew must not count from far away.
        let far = |i: &usize| (along.depth_m[*i] - self.loading.surface_m).abs();
        let met = first.samples.clone().min_by(|a, b| far(a).total_cmp(&far(b))).unwrap_or(first.samples.start);
        let place = along.direction * self.loading.surface_m + Vec2::new(-y, x) * along.side_m[met];
        let (value, axis) = if y.abs() > 0.9 {
            (place.y, "y")
        } else if x.abs() > 0.9 {
            (place.x, "x")
        } else {
            (self.loading.surface_m, "the way along the needle")
        };
        let how = format!("{axis} of {point} where the force begins to rise");
        let resampled = self.resampled(self.loading.surface_at(), place_error_m, |l| l.surface_m);
        Parameter::identified(OBJECT, "surface_position_m", value, error, self.samples, &how).with_bootstrap(resampled)
    }

    /// The sheet beside the hand that pressed it.
    pub(super) fn yielding(&self, along: &Along) -> Option<Yielding> {
        let k = self.loading.stiffness_n_m;
        let error = self.error(self.loading.around.std_errors[self.loading.stiffness_at()], |l| l.stiffness_n_m);
        let hand = if along.give_m_n.0 > 0.0 { 1.0 / along.give_m_n.0 } else { HAND_N_M };
        let interval = ((k - HALF_INTERVAL * error).max(0.0), Some(k + HALF_INTERVAL * error));
        (k > 0.0).then_some(Yielding { stiffness_n_m: Some(k), interval_n_m: interval, manipulator_n_m: hand })
    }

    pub(super) fn constraint(&self, along: &Along, pushes: &[Push], recording: &Recording) -> Constraint {
        let errors = &self.loading.around.std_errors;
        let evidence = format!(
            "force rises with {:.0} N/m from the surface on, on {} samples of pushes into an untouched sheet",
            self.loading.stiffness_n_m, self.samples
        );
        Constraint {
            kind: ConstraintKind::Membrane,
            direction: Some(vec![along.direction.x, along.direction.y]),
            rigid: Some(false),
            std_error: [("surface_m".to_owned(), errors[self.loading.surface_at()])].into(),
            evidence,
            existence: phases::existence(along, pushes, &self.loading),
            sided: Some(Sided::OneSided),
            yielding: self.yielding(along),
            phases: phases::phases(along, pushes, &self.loading, recording),
            ..Constraint::blank(Some(recording.name.clone()), "")
        }
    }
}

/// The loading curve with pads that give so much, m/N.
fn curve(along: &Along, pushes: &[Push], holds: &[usize], give: f64) -> Result<Loading, EstimateError> {
    let mut points = Vec::new();
    let count: usize = pushes.iter().map(|p| p.samples.len()).sum();
    let calm = if count < LEAST_POINTS * along.calm { 1 } else { along.calm };
    for push in pushes {
        let hold = holds.iter().position(|h| *h == push.hold).unwrap_or(0);
        let first_m = along.depth_m[push.samples.start];
        // Below an earlier dent the sheet is another one; well outside it, it is not there at all.
        let counts = |i: &usize| {
            let depth = along.depth_m[*i];
            depth > push.untouched_from_m || depth < first_m + 2e-4
        };
        let samples: Vec<usize> = push.samples.clone().filter(counts).collect();
        for near in samples.chunk_by(|a, b| b - a == 1).flat_map(|run| run.chunks(calm)) {
            let mean = |values: &[f64]| near.iter().map(|i| values[*i]).sum::<f64>() / near.len() as f64;
            let (depth, force_n) = (mean(&along.depth_m), mean(&along.force_n));
            points.push(Point { hold, depth_m: depth - give * force_n, force_n });
        }
    }
    loading_curve::fit(&points, holds.len())
}
