//! Bearing load of a crank: either the pull of the fingers alone (thesis, eq. 5.2), or that pull and the weight of the
//! handle. The recording decides between the two models.

use crate::diagnose::data::direction::blur;
use crate::diagnose::data::regression_data::{Bearing, Model, Place, Row, Track};
use crate::diagnose::data::row_means::column;
use estimation::regression::linear::{Values, least_squares_values};
use foundation::estimate::EstimateError;
use haptics::Vec2;
use haptics::law::{CoulombFriction, Effect, Inertia, Law, LoadFriction, Weight};

/// Evidence by which the other load must be favoured, 2 ln(likelihood). It is high because rows are not independent.
const LIKELIER: f64 = 60.0;
/// Rounds in which weight and load converge.
const LOAD_ROUNDS: usize = 3;
/// Evidence by which a free force of gravity, of any direction, may beat the weight on the bearing. On a load in one
/// direction only, that weight acts like a force of gravity a quarter turn ahead.
const AS_LIKELY: f64 = 25.0;

/// Adds the weight on the bearing to the load if the data favour it, and returns that weight, N. `gravity_m_s2` turns
/// it into a mass, whose centripetal force the bearing carries.
pub fn load(track: &mut Track, model: &Model, fixed: &Model, gravity_m_s2: f64) -> Result<Option<f64>, EstimateError> {
    let rubs = model.iter().any(|e| e.law().id() == LoadFriction.id());
    if !rubs || !track.planar {
        return Ok(None);
    }
    let (before, mut weight_n) = plain(track, model, fixed)?;
    let mut other = track.clone();
    let mut after = before;
    for _ in 0..LOAD_ROUNDS {
        put(&mut other, weight_n, gravity_m_s2);
        (after, weight_n) = plain(&other, model, fixed)?;
    }
    let rows = track.along().count() as f64;
    let likelier = |a: f64, b: f64| 2.0 * rows * (a / b.max(1e-300)).ln();
    if weight_n <= 0.0 || (likelier(before, after) < LIKELIER && !one_way(track, &other, model, fixed, &likelier)?) {
        return Ok(None);
    }
    put(track, weight_n, gravity_m_s2);
    Ok(Some(weight_n))
}

/// True if a weight on the bearing explains the data as well as a free force of gravity does.
fn one_way(
    track: &Track,
    other: &Track,
    model: &Model,
    fixed: &Model,
    likelier: &dyn Fn(f64, f64) -> f64,
) -> Result<bool, EstimateError> {
    let after = simply(other, model, fixed, false)?;
    if likelier(simply(track, model, fixed, false)?, after) <= LIKELIER {
        return Ok(false);
    }
    Ok(likelier(after, simply(track, model, fixed, true)?) < AS_LIKELY)
}

/// Residual RMS of the model with friction of every kind and a mass, N. `free` adds gravity of any direction.
fn simply(track: &Track, model: &Model, fixed: &Model, free: bool) -> Result<f64, EstimateError> {
    let look = Look::at(track, fixed);
    let has = |law: &dyn Law| model.iter().chain(fixed).any(|e| e.law().id() == law.id());
    let others = [&CoulombFriction as &'static dyn Law, &Inertia].into_iter().filter(|law| !has(*law));
    let laws: Vec<Effect> = model.iter().copied().chain(others.map(|law| Effect::new(law, &[1.0]))).collect();
    let mut columns = look.laws(&laws);
    if free {
        columns.push(look.rows(&Row::up_outward));
    }
    Ok(look.fit(&columns)?.rms)
}

/// Changes the load of every row to that with this weight on the bearing, N, and with what keeps its mass on the
/// circle.
pub(crate) fn put(track: &mut Track, weight_n: f64, gravity_m_s2: f64) {
    let before = track.bearing;
    let per_radius = track.radius_m.map_or(0.0, |radius_m| 1.0 / radius_m);
    track.bearing = Bearing { weight_n, mass_kg: weight_n / gravity_m_s2.max(1e-9), per_radius };
    for row in track.rows.iter_mut().filter(|r| r.place == Place::Along) {
        row.motion.normal_force_n += track.bearing.load_n(row) - before.load_n(row);
    }
}

/// Residual RMS of the model with friction and possible disturbances, and the weight that the model alone estimates, N.
fn plain(track: &Track, model: &Model, fixed: &Model) -> Result<(f64, f64), EstimateError> {
    let look = Look::at(track, fixed);
    let is_weight = |e: &Effect| e.law().id() == Weight.id();
    let coulomb = Effect::new(&CoulombFriction, &[1.0]);
    let weighed: Vec<Effect> = model.iter().copied().chain([coulomb]).collect();
    let fit = look.fit(&look.laws(&weighed))?;
    let found = weighed.iter().zip(&fit.values).filter(|(e, _)| is_weight(e));
    let weight_n = known_n(fixed) + found.map(|(e, share)| e.values[0] * share).sum::<f64>();
    // An eccentric mass, a tilt or a bias is no reason to look for another load.
    let rubs: Vec<Effect> = weighed.into_iter().filter(|e| !is_weight(e)).collect();
    let mut columns = look.laws(&rubs);
    let beside: [&dyn Fn(&Row) -> f64; 4] =
        [&|_| 1.0, &|r| r.along.x, &|r| r.along.y, &|r| r.motion.velocity * r.motion.velocity.abs()];
    columns.extend(beside.map(|of| look.rows(of)));
    Ok((look.fit(&columns)?.rms, weight_n))
}

/// A weight that the sidecar states, N.
pub(crate) fn known_n(fixed: &Model) -> f64 {
    fixed.iter().filter(|e| e.law().id() == Weight.id()).map(|e| e.values[0]).sum()
}

/// Rows for a plain fit: blurred directions, loads without bias, forces without the known ones.
struct Look {
    track: Track,
    y: Vec<f64>,
    weight: Vec<f64>,
}

impl Look {
    fn at(track: &Track, fixed: &Model) -> Self {
        let mut track = track.clone();
        blur(&mut track);
        without_bias(&mut track);
        let known: Vec<Vec<f64>> = fixed.iter().map(|effect| column(&track, effect)).collect();
        let y = track.rows.iter().enumerate().map(|(i, r)| r.y - known.iter().map(|k| k[i]).sum::<f64>()).collect();
        let weight = weights(&track);
        Self { track, y, weight }
    }

    fn laws(&self, laws: &[Effect]) -> Vec<Vec<f64>> {
        laws.iter().map(|effect| column(&self.track, effect)).collect()
    }

    /// Regressor over the rows along the motion, 0 in all others.
    fn rows(&self, of: &dyn Fn(&Row) -> f64) -> Vec<f64> {
        self.track.rows.iter().map(|r| if r.place == Place::Along { of(r) } else { 0.0 }).collect()
    }

    fn fit(&self, columns: &[Vec<f64>]) -> Result<Values, EstimateError> {
        least_squares_values(columns, &self.y, Some(&self.weight))
    }
}

/// Weight of a row in the sum of squares: the fourth power of its direction estimate.
pub(crate) fn weights(track: &Track) -> Vec<f64> {
    track.rows.iter().map(|r| if r.place == Place::Along { r.motion.direction.powi(4) } else { 0.0 }).collect()
}

/// Removes the sensor bias, seen in free rows, from the load. A bias across the motion looks like a weight.
fn without_bias(track: &mut Track) {
    let mean = |place: Place| {
        let free: Vec<f64> = track.rows.iter().filter(|r| r.place == place).map(|r| r.y).collect();
        free.iter().sum::<f64>() / free.len().max(1) as f64
    };
    let bias = Vec2::new(mean(Place::FreeX), mean(Place::FreeY));
    for row in track.rows.iter_mut().filter(|r| r.place == Place::Along) {
        row.motion.normal_force_n -= bias.dot(&Vec2::new(row.along.y, -row.along.x));
    }
}
