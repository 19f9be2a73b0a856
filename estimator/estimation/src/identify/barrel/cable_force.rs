//! Forces on the hand while the barrel hangs from it: its weight, which a leak lowers, its inertia, and a cable.

use super::cable::Cable;
use crate::regression::bootstrap::{Resampled, block_bootstrap};
use crate::regression::linear::{LinearFit, least_squares};
use foundation::cancellation;
use foundation::estimate::EstimateError;
use haptics::Vec2;
use nalgebra::{DMatrix, DVector};

/// Number of directions of the cable that are tried.
/// Choice: no case of the ablation reads it.
const DIRECTIONS: usize = 48;
/// Number of taut places that are tried along each direction.
/// Choice: no case of the ablation reads it.
const PLACES: usize = 32;
/// Largest number of Gauss-Newton steps after the search.
/// Choice: no case of the ablation reads it.
const NEWTON_STEPS: usize = 30;
/// Stiffness of a cable in standard errors above zero from which it is seen. It is more than a single test would need,
/// because the best of many directions and places is chosen.
/// Choice: no case of the ablation reads it.
const CABLE_SEEN: f64 = 7.0;
/// Least ratio of the largest pull to the weight.
/// Choice: no case of the ablation reads it.
const LEAST_PULL: f64 = 0.03;
/// Relative error of the fingers' acceleration as that of the barrel.
/// Choice: no case of the ablation reads it.
const ACCELERATION_SHARE: f64 = 0.05;
/// Bend in standard errors above zero from which the pull turns, so that the anchor shows.
/// Choice: no case of the ablation reads it.
const TURNS: f64 = 6.0;

/// Samples while the barrel hangs.
#[derive(Clone, Debug, Default)]
pub struct Rows {
    /// s.
    pub time_s: Vec<f64>,
    /// Middle of the barrel between the pads, m.
    pub place_m: Vec<Vec2>,
    /// Its velocity, m/s.
    pub velocity: Vec<Vec2>,
    /// m/s².
    pub acceleration: Vec<Vec2>,
    /// By both fingers on it, N.
    pub force_n: Vec<Vec2>,
    /// m/s².
    pub gravity: f64,
    /// Noise of the net force as it is filtered, N.
    pub noise_n: f64,
    /// Half of the filter's window, s.
    pub reach_s: f64,
}

impl Rows {
    /// Rows for which the filter saw the cable either slack or taut all the time: the force bends where the cable
    /// becomes taut.
    fn clear_of(&self, cable: &Cable) -> Self {
        let clear = |i: &usize| cable.stretch(self.place_m[*i]).0.abs() > self.velocity[*i].norm() * self.reach_s;
        let kept: Vec<usize> = (0..self.time_s.len()).filter(clear).collect();
        let part = |values: &[Vec2]| kept.iter().map(|&i| values[i]).collect::<Vec<Vec2>>();
        Self {
            time_s: kept.iter().map(|&i| self.time_s[i]).collect(),
            place_m: part(&self.place_m),
            velocity: part(&self.velocity),
            acceleration: part(&self.acceleration),
            force_n: part(&self.force_n),
            ..*self
        }
    }

    /// Weight of every component: pads give while the force changes, so that the barrel's acceleration is not quite the fingers'.
    fn weights(&self) -> Vec<f64> {
        let mean_kg = self.force_n.iter().map(|f| f.y).sum::<f64>() / (self.gravity * self.force_n.len() as f64);
        let missed = |a: &Vec2| ACCELERATION_SHARE * mean_kg * a.norm() / self.noise_n.max(f64::MIN_POSITIVE);
        let weight = |a: &Vec2| 1.0 / (1.0 + missed(a).powi(2));
        self.acceleration.iter().flat_map(|a| [weight(a); 2]).collect()
    }
}

/// The fitted pull.
#[derive(Clone, Debug)]
pub struct Pull {
    /// Mass in the middle of the time, kg; its rate of growth, kg/s; horizontal offset of the forces, N. With a cable
    /// there follow its stiffness, N/m, damping, N s/m, and the changes of angle, taut place and bend (all zero at the
    /// answer).
    pub values: Vec<f64>,
    /// Linearised fit around the answer, with the errors of all of these.
    pub around: LinearFit,
    /// The same errors by a block bootstrap of the rows; `None` where they are too few.
    pub resampled: Option<Resampled>,
    /// Middle of the time, s.
    pub middle_s: f64,
    /// The cable, if one pulled.
    pub cable: Option<Cable>,
    /// Rows in which it was taut.
    pub taut: usize,
}

/// Columns of the fit: mass, growth of the mass, offset, stiffness, damping, then the geometry (angle, taut place, bend).
#[derive(Clone, Copy)]
pub enum Column {
    Mass,
    Growth,
    Stiffness = 3,
    Geometry = 5,
}

impl Pull {
    /// Fits the rows, first without a cable, then with one.
    pub fn of(rows: &Rows) -> Result<Self, EstimateError> {
        let free = Self::linear(rows, None)?;
        let Some(rough) = search(rows) else { return Ok(free) };
        let straight = refine(rows, rough, false);
        let rows = &rows.clear_of(&straight);
        let straight = refine(rows, straight, false);
        let held = [refine(rows, straight, true), straight].map(|cable| Self::linear(rows, Some(cable)));
        for (turns, held) in [true, false].into_iter().zip(held) {
            let Ok(held) = held else { continue };
            let shown = |k: usize| held.around.identified.get(k).copied().unwrap_or(false);
            let known = held.around.std_errors.get(Column::Geometry as usize + 2).map_or(0.0, |e| held.bend() / e);
            if turns && !(shown(Column::Geometry as usize + 2) && known > TURNS) {
                continue;
            }
            let stiffness = held.values[Column::Stiffness as usize];
            let strongest_n =
                rows.place_m.iter().filter_map(|p| Some(stiffness * held.cable?.stretch(*p).0)).fold(0.0, f64::max);
            let weight_n = held.values[Column::Mass as usize] * rows.gravity;
            let clear = shown(Column::Stiffness as usize)
                && stiffness > CABLE_SEEN * held.around.std_errors[Column::Stiffness as usize];
            if clear && strongest_n > LEAST_PULL * weight_n {
                return Ok(held);
            }
        }
        Ok(free)
    }

    /// Fits the rows as those of a barrel that nothing holds.
    pub fn without_cable(rows: &Rows) -> Result<Self, EstimateError> {
        Self::linear(rows, None)
    }

    fn bend(&self) -> f64 {
        self.cable.map_or(0.0, |c| c.bend_1_m)
    }

    /// Values for a cable of given geometry, with errors that count the geometry's own.
    fn linear(rows: &Rows, cable: Option<Cable>) -> Result<Self, EstimateError> {
        let (columns, target) = columns(rows, cable.as_ref());
        let weights = rows.weights();
        let fit = least_squares(&columns, &target, Some(&weights))?;
        let middle_s = middle(&rows.time_s);
        let Some(cable) = cable else {
            let resampled = block_bootstrap(&columns, &target, Some(&weights), &fit);
            return Ok(Self { values: fit.values.clone(), around: fit, resampled, middle_s, cable: None, taut: 0 });
        };
        let mut all = columns;
        let angles = if cable.bend_1_m == 0.0 { 2 } else { 3 };
        all.extend((0..angles).map(|which| geometry_column(rows, &cable, &fit.values, which)));
        let around = least_squares(&all, &target, Some(&weights))?;
        let resampled = block_bootstrap(&all, &target, Some(&weights), &around);
        let taut = rows.place_m.iter().filter(|p| cable.stretch(**p).0 > 0.0).count();
        Ok(Self { values: fit.values, around, resampled, middle_s, cable: Some(cable), taut })
    }
}

fn middle(time_s: &[f64]) -> f64 {
    time_s.iter().sum::<f64>() / time_s.len().max(1) as f64
}

/// The linear columns, x and y of every row one after the other, and the force.
fn columns(rows: &Rows, cable: Option<&Cable>) -> (Vec<Vec<f64>>, Vec<f64>) {
    let n = rows.time_s.len();
    let middle_s = middle(&rows.time_s);
    let pairs = |f: &dyn Fn(usize) -> Vec2| (0..n).flat_map(|i| [f(i).x, f(i).y]).collect::<Vec<f64>>();
    let carried = |i: usize| rows.acceleration[i] + Vec2::new(0.0, rows.gravity);
    let mut columns =
        vec![pairs(&carried), pairs(&|i| carried(i) * (rows.time_s[i] - middle_s)), pairs(&|_| Vec2::x())];
    if let Some(cable) = cable {
        let pull = |i: usize| {
            let (stretch_m, away) = cable.stretch(rows.place_m[i]);
            away * stretch_m.max(0.0)
        };
        let rate = |i: usize| {
            let (stretch_m, away) = cable.stretch(rows.place_m[i]);
            if stretch_m > 0.0 { away * rows.velocity[i].dot(&away) } else { Vec2::zeros() }
        };
        columns.extend([pairs(&pull), pairs(&rate)]);
    }
    (columns, pairs(&|i| rows.force_n[i]))
}

/// Regressor of a change of the geometry: derivative of the predicted force.
fn geometry_column(rows: &Rows, cable: &Cable, values: &[f64], which: usize) -> Vec<f64> {
    let step = [1e-5, 1e-7, 1e-3][which];
    let force = |cable: &Cable, p: Vec2| {
        let (stretch_m, away) = cable.stretch(p);
        away * (values[Column::Stiffness as usize] * stretch_m)
    };
    let taut = |p: &Vec2| cable.stretch(*p).0 > 0.0;
    let change = |p: &Vec2| {
        if !taut(p) {
            return Vec2::zeros();
        }
        (force(&cable.shifted(which, step), *p) - force(&cable.shifted(which, -step), *p)) / (2.0 * step)
    };
    rows.place_m
        .iter()
        .flat_map(|p| {
            let c = change(p);
            [c.x, c.y]
        })
        .collect()
}

/// The straight cable among all directions and places that lowers the residual force most.
fn search(rows: &Rows) -> Option<Cable> {
    let about_m = rows.place_m.iter().sum::<Vec2>() / rows.place_m.len().max(1) as f64;
    let mut best: Option<(f64, Cable)> = None;
    for k in 0..DIRECTIONS {
        cancellation::check().ok()?;
        let angle_rad = std::f64::consts::TAU * k as f64 / DIRECTIONS as f64;
        let straight = Cable { about_m, angle_rad, taut_m: 0.0, bend_1_m: 0.0 };
        let mut along: Vec<f64> = rows.place_m.iter().map(|p| straight.stretch(*p).0).collect();
        along.sort_by(f64::total_cmp);
        let (low, high) = (*along.first()?, *along.last()?);
        for place in 0..PLACES {
            let cable = Cable { taut_m: low + (high - low) * place as f64 / PLACES as f64, ..straight };
            if let Some((values, cost)) = solve(rows, &cable, Column::Stiffness as usize + 1)
                && values[Column::Stiffness as usize] > 0.0
                && best.as_ref().is_none_or(|(least, _)| cost < *least)
            {
                best = Some((cost, cable));
            }
        }
    }
    let (_, mut cable) = best?;
    // About the middle of the taut samples: there direction and bend are told apart best.
    let taut: Vec<Vec2> = rows.place_m.iter().copied().filter(|p| cable.stretch(*p).0 > 0.0).collect();
    let about_m = taut.iter().sum::<Vec2>() / taut.len().max(1) as f64;
    cable.taut_m -= (about_m - cable.about_m).dot(&cable.away());
    Some(Cable { about_m, ..cable })
}

/// Linear values and sum of squares for a given geometry, with the first `count` regressors. The damping does not help
/// the search, but without it a quickly pulled cable seems to become taut too early.
fn solve(rows: &Rows, cable: &Cable, count: usize) -> Option<(Vec<f64>, f64)> {
    let (mut columns, force) = columns(rows, Some(cable));
    columns.truncate(count);
    let p = columns.len();
    let weights = rows.weights();
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).zip(&weights).map(|((a, b), w)| a * b * w).sum::<f64>();
    let norms: Vec<f64> = columns.iter().map(|c| dot(c, c).sqrt()).collect();
    if norms.iter().any(|n| *n <= 0.0) {
        return None;
    }
    let normal = DMatrix::from_fn(p, p, |i, j| dot(&columns[i], &columns[j]) / (norms[i] * norms[j]));
    let right = DVector::from_fn(p, |i, _| dot(&columns[i], &force) / norms[i]);
    let values = normal.cholesky()?.solve(&right);
    let cost = dot(&force, &force) - values.dot(&right);
    Some((values.iter().zip(&norms).map(|(v, n)| v / n).collect(), cost))
}

/// Gauss–Newton on the geometry, steps halved until they help; `bent` lets the distance of the anchor move, too.
fn refine(rows: &Rows, start: Cable, bent: bool) -> Cable {
    let which = if bent { 3 } else { 2 };
    let mut cable = start;
    let Some((_, mut cost)) = solve(rows, &cable, Column::Geometry as usize) else { return start };
    for _ in 0..NEWTON_STEPS {
        let Some((values, _)) = solve(rows, &cable, Column::Geometry as usize) else { return cable };
        let (mut columns, target) = columns(rows, Some(&cable));
        columns.extend((0..which).map(|k| geometry_column(rows, &cable, &values, k)));
        let Ok(fit) = least_squares(&columns, &target, Some(&rows.weights())) else { return cable };
        let mut share = 1.0;
        let better = loop {
            let mut next = cable;
            for k in 0..which {
                next = next.shifted(k, share * fit.values[Column::Geometry as usize + k]);
            }
            next.bend_1_m = next.bend_1_m.max(0.0);
            match solve(rows, &next, Column::Geometry as usize) {
                Some((values, less)) if less < cost && values[Column::Stiffness as usize] > 0.0 => {
                    break Some((next, less));
                }
                _ if share < 1e-3 => break None,
                _ => share *= 0.5,
            }
        };
        let Some((next, less)) = better else { break };
        let settled = cost - less < 1e-9 * cost;
        (cable, cost) = (next, less);
        if settled {
            break;
        }
    }
    cable
}
