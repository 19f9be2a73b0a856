//! What loads a crank's bearing: the pull of the fingers alone (thesis, eq. 5.2), or that and the weight of the handle, which hangs on the same
//! bearing. The recording decides.

use super::blur::blur;
use super::force::{Model, column};
use super::track::{Place, Row, Track};
use crate::estimate::EstimateError;
use crate::identify::linear::least_squares_values;
use haptics::Vec2;
use haptics::law::{CoulombFriction, Effect, Law, LoadFriction, Weight};

/// The other load must be likelier by so much, 2 ln(likelihood): rows are not independent.
const LIKELIER: f64 = 60.0;
/// Rounds in which weight and load settle.
const ROUNDS: usize = 3;

/// Puts the weight on the bearing where friction goes with both; the weight that was found, N.
pub fn load(track: &mut Track, model: &Model, fixed: &Model) -> Result<Option<f64>, EstimateError> {
    let rubs = model.iter().any(|e| e.law().id() == LoadFriction.id());
    if !rubs || !track.planar {
        return Ok(None);
    }
    let (before, mut weight_n) = plain(track, model, fixed)?;
    let mut other = track.clone();
    let mut after = before;
    for _ in 0..ROUNDS {
        put(&mut other, weight_n);
        (after, weight_n) = plain(&other, model, fixed)?;
    }
    let likelier = 2.0 * track.along().count() as f64 * (before / after.max(1e-300)).ln();
    if likelier < LIKELIER || weight_n <= 0.0 {
        return Ok(None);
    }
    put(track, weight_n);
    Ok(Some(weight_n))
}

/// Changes the load of every row to that with this weight on the bearing, N.
fn put(track: &mut Track, weight_n: f64) {
    let more = weight_n - track.bearing_weight_n;
    track.bearing_weight_n = weight_n;
    for row in track.rows.iter_mut().filter(|r| r.place == Place::Along) {
        row.motion.normal_force_n -= more * row.up_outward();
    }
}

/// What friction and whatever else may be wrong leave, root mean square, and the weight that the model alone comes out at, N.
fn plain(track: &Track, model: &Model, fixed: &Model) -> Result<(f64, f64), EstimateError> {
    let mut track = track.clone();
    blur(&mut track);
    without_bias(&mut track);
    let is_weight = |e: &Effect| e.law().id() == Weight.id();
    let of = |laws: &[Effect]| laws.iter().map(|effect| column(&track, effect)).collect::<Vec<_>>();
    let along: Vec<f64> =
        track.rows.iter().map(|r| if r.place == Place::Along { r.motion.direction.powi(4) } else { 0.0 }).collect();
    let known = of(fixed);
    let y: Vec<f64> =
        track.rows.iter().enumerate().map(|(i, r)| r.y - known.iter().map(|k| k[i]).sum::<f64>()).collect();
    let coulomb = Effect::new(&CoulombFriction, &[1.0]);
    let weighed: Vec<Effect> = model.iter().copied().chain([coulomb]).collect();
    let fit = least_squares_values(&of(&weighed), &y, Some(&along))?;
    let found = weighed.iter().zip(&fit.values).filter(|(e, _)| is_weight(e));
    let known_n: f64 = fixed.iter().filter(|e| is_weight(e)).map(|e| e.values[0]).sum();
    let weight_n = known_n + found.map(|(e, share)| e.values[0] * share).sum::<f64>();
    // A mass off the axis, a tilt or a bias is no reason to look for another load.
    let rubs: Vec<Effect> = weighed.into_iter().filter(|e| !is_weight(e)).collect();
    let mut columns = of(&rubs);
    let beside: [&dyn Fn(&Row) -> f64; 4] =
        [&|_| 1.0, &|r| r.along.x, &|r| r.along.y, &|r| r.motion.velocity * r.motion.velocity.abs()];
    for of in beside {
        columns.push(track.rows.iter().map(|r| if r.place == Place::Along { of(r) } else { 0.0 }).collect());
    }
    Ok((least_squares_values(&columns, &y, Some(&along))?.rms, weight_n))
}

/// Takes what the sensors say where nothing is touched out of the load: a bias across the motion looks like a weight.
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
