//! The loading curve of an untouched sheet: f = offset + k x + k₃ x³, x the way beyond the surface.
//!
//! The surface is the bend of the curve, so it is searched for; all else is linear. The curve's regressors are those of
//! [`MembraneLaw::loading_n`](haptics::law::object::MembraneLaw::loading_n).

use crate::identify::limits::{GOLDEN_STEPS, SEARCH_STEPS};
use crate::regression::bootstrap::{Resampled, block_bootstrap};
use crate::regression::linear::{LinearFit, least_squares};
use foundation::estimate::EstimateError;
use haptics::law::object::MembraneLaw;
use nalgebra::{DMatrix, DVector};

/// One sample of the loading: which offset it has, its depth, m, and its force, N.
#[derive(Clone, Copy, Debug)]
pub struct Point {
    /// Index of the hold.
    pub hold: usize,
    /// Depth, m.
    pub depth_m: f64,
    /// Force, N.
    pub force_n: f64,
}

/// The fitted curve.
#[derive(Clone, Debug)]
pub struct Loading {
    /// Offsets by hold, N.
    pub offset_n: Vec<f64>,
    /// First stiffness, N/m.
    pub stiffness_n_m: f64,
    /// Hardening, N/m³; 0 where none is seen.
    pub cubic_n_m3: f64,
    /// Depth of the surface, m.
    pub surface_m: f64,
    /// Linearised fit around the answer: offsets, stiffness, (hardening,) surface.
    pub around: LinearFit,
    /// The errors of these by a block bootstrap of the samples; `None` where they are too few.
    pub resampled: Option<Resampled>,
}

impl Loading {
    /// Force of the sheet at a depth, N.
    pub fn force_n(&self, depth_m: f64) -> f64 {
        self.law().loading_n(depth_m - self.surface_m)
    }

    fn law(&self) -> MembraneLaw {
        let (stiffness_n_m, cubic_n_m3) = (self.stiffness_n_m, self.cubic_n_m3);
        MembraneLaw { stiffness_n_m, cubic_n_m3, give: 0.0, puncture_n: f64::MAX, friction_n: 0.0, drag_n_s_m: 0.0 }
    }

    /// Index of the stiffness among the regressors of [`Self::around`].
    pub fn stiffness_at(&self) -> usize {
        self.offset_n.len()
    }

    /// Index of the surface there.
    pub fn surface_at(&self) -> usize {
        self.around.values.len() - 1
    }

    /// Standard error of [`Self::force_n`], N, by the fit's covariance.
    pub fn force_error_n(&self, depth_m: f64) -> f64 {
        self.force_error_by(&self.around.covariance, depth_m)
    }

    /// The same by resampling.
    pub fn force_resampled_n(&self, depth_m: f64) -> Option<f64> {
        Some(self.force_error_by(self.resampled.as_ref()?.covariance(), depth_m))
    }

    fn force_error_by(&self, covariance: &DMatrix<f64>, depth_m: f64) -> f64 {
        let x = (depth_m - self.surface_m).max(0.0);
        let mut gradient = DVector::zeros(self.around.values.len());
        gradient[self.stiffness_at()] = x;
        if self.surface_at() > self.stiffness_at() + 1 {
            gradient[self.stiffness_at() + 1] = x.powi(3);
        }
        gradient[self.surface_at()] = -self.law().stiffness_n_m(x);
        (gradient.transpose() * covariance * gradient)[(0, 0)].max(0.0).sqrt()
    }
}

/// Fits the curve to `points` of `holds` holds.
pub fn fit(points: &[Point], holds: usize) -> Result<Loading, EstimateError> {
    let whole = fit_with(points, holds, true)?;
    if whole.around.identified[whole.stiffness_at() + 1] && whole.stiffness_n_m > 0.0 && whole.cubic_n_m3 >= 0.0 {
        return Ok(whole);
    }
    // No sheet gets softer: the deviation of such a curve is noise, and goes into the errors.
    let mut straight = fit_with(points, holds, false)?;
    let mut errors = vec![0.0; straight.around.values.len()];
    errors[straight.stiffness_at()] = 0.5 * (whole.stiffness_n_m - straight.stiffness_n_m);
    errors[straight.surface_at()] = 0.5 * (whole.surface_m - straight.surface_m);
    if errors.iter().all(|e| e.is_finite()) {
        straight.around.widen(&errors);
        straight.resampled = straight.resampled.map(|drawn| drawn.widened(&errors));
    }
    Ok(straight)
}

fn fit_with(points: &[Point], holds: usize, cubic: bool) -> Result<Loading, EstimateError> {
    let (low, high) =
        points.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), p| (l.min(p.depth_m), h.max(p.depth_m)));
    let at = |k: f64| low + (high - low) * k / SEARCH_STEPS as f64;
    let cost = |surface: f64| solve(points, holds, cubic, surface).map_or(f64::INFINITY, |(_, cost)| cost);
    let costs: Vec<f64> = (0..SEARCH_STEPS).map(|k| cost(at(k as f64))).collect();
    let best = (0..SEARCH_STEPS).min_by(|&a, &b| costs[a].total_cmp(&costs[b])).unwrap_or(0) as f64;
    let surface_m = golden(&cost, at((best - 1.0).max(0.0)), at(best + 1.0));
    let Some((values, _)) = solve(points, holds, cubic, surface_m) else {
        return Err(EstimateError::Other("the needle's pushes do not show a curve of force over depth".to_owned()));
    };
    let (stiffness_n_m, cubic_n_m3) = (values[holds], if cubic { values[holds + 1] } else { 0.0 });
    let mut columns = columns(points, holds, cubic, surface_m);
    let bend = |p: &Point| {
        let x = (p.depth_m - surface_m).max(0.0);
        if x > 0.0 { -(stiffness_n_m + 3.0 * cubic_n_m3 * x * x) } else { 0.0 }
    };
    columns.push(points.iter().map(bend).collect());
    let force: Vec<f64> = points.iter().map(|p| p.force_n).collect();
    // Around the answer the surface's own regressor asks for no change: this fit serves the errors.
    let around = least_squares(&columns, &force, None)?;
    let resampled = block_bootstrap(&columns, &force, None, &around);
    let offset_n = values.iter().take(holds).copied().collect();
    Ok(Loading { offset_n, stiffness_n_m, cubic_n_m3, surface_m, around, resampled })
}

fn columns(points: &[Point], holds: usize, cubic: bool, surface_m: f64) -> Vec<Vec<f64>> {
    let column = |f: &dyn Fn(&Point) -> f64| points.iter().map(f).collect::<Vec<f64>>();
    let way = |p: &Point| (p.depth_m - surface_m).max(0.0);
    let mut columns: Vec<Vec<f64>> =
        (0..holds).map(|hold| column(&|p| if p.hold == hold { 1.0 } else { 0.0 })).collect();
    columns.push(column(&way));
    if cubic {
        columns.push(column(&|p| way(p).powi(3)));
    }
    columns
}

/// Values and sum of squares for a given surface.
fn solve(points: &[Point], holds: usize, cubic: bool, surface_m: f64) -> Option<(DVector<f64>, f64)> {
    let columns = columns(points, holds, cubic, surface_m);
    let design = DMatrix::from_columns(&columns.iter().map(|c| DVector::from_column_slice(c)).collect::<Vec<_>>());
    // To unit length, so that the cube of millimetres does not drown.
    let scales: Vec<f64> = design.column_iter().map(|c| c.norm()).collect();
    if scales.iter().any(|s| *s <= 0.0) {
        return None;
    }
    let scaled = DMatrix::from_fn(design.nrows(), design.ncols(), |i, j| design[(i, j)] / scales[j]);
    let force = DVector::from_iterator(points.len(), points.iter().map(|p| p.force_n));
    let normal = scaled.transpose() * &scaled;
    let values = normal.cholesky()?.solve(&(scaled.transpose() * &force));
    let cost = (force - scaled * &values).norm_squared();
    Some((DVector::from_fn(values.len(), |j, _| values[j] / scales[j]), cost))
}

/// The smallest value of a function with one valley between `low` and `high`.
fn golden(cost: &dyn Fn(f64) -> f64, mut low: f64, mut high: f64) -> f64 {
    let share = 0.5 * (5.0_f64.sqrt() - 1.0);
    for _ in 0..GOLDEN_STEPS {
        let (a, b) = (high - share * (high - low), low + share * (high - low));
        if cost(a) < cost(b) { high = b } else { low = a }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_curve_with_known_numbers_comes_back() {
        let (surface, k, cubic) = (0.0123, 180.0, 2e6);
        let points: Vec<Point> = (0..2000)
            .map(|i| {
                let depth = 0.008 + 9e-3 * f64::from(i) / 2000.0;
                let x = (depth - surface).max(0.0);
                // A deterministic stand-in for noise of 5 mN.
                let noise = 7e-3 * (f64::from(i) * 12.9898).sin();
                Point { hold: 0, depth_m: depth, force_n: -0.08 + k * x + cubic * x.powi(3) + noise }
            })
            .collect();
        let fit = fit(&points, 1).expect("fits");
        let near = |value: f64, truth: f64, at: usize| (value - truth).abs() < 3.0 * fit.around.std_errors[at];
        assert!(near(fit.stiffness_n_m, k, fit.stiffness_at()), "{} ± {}", fit.stiffness_n_m, fit.around.std_errors[1]);
        assert!(near(fit.surface_m, surface, fit.surface_at()) && near(fit.offset_n[0], -0.08, 0));
        assert!((fit.force_n(0.0163) - (k * 0.004 + cubic * 6.4e-8)).abs() < 4.0 * fit.force_error_n(0.0163));
    }
}
