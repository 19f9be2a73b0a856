//! Bearing load of a crank: either the pull of the fingers alone (thesis, eq. 5.2), or that pull and the weight of the
//! handle. The recording decides between the two models.
//!
//! Weight on a crank's bearing, compared with other hidden causes.

use crate::diagnose::data::direction::blur;
use crate::diagnose::data::limits::SURE;
use crate::diagnose::data::plain_fit::{PlainFit, weights};
use crate::diagnose::data::regression_data::{Bearing, Model, Place, Row, Track};
use crate::diagnose::data::row_means::column;
use crate::diagnose::hypotheses::{eccentric_mass, force_bias, force_cross_axis, gravity_tilt};
use crate::diagnose::selection::comparison::ChannelFit;
use crate::diagnose::selection::held_out_gain::rms;
use crate::diagnose::selection::rules::{AS_GOOD, MUCH, THRESHOLD_SLOW};
use crate::diagnose::tasks::one_coordinate;
use estimation::regression::linear::least_squares_values;
use foundation::estimate::EstimateError;
use haptics::Vec2;
use haptics::law::{CoulombFriction, Effect, Inertia, Law, LoadFriction, Weight};

/// Rounds in which weight and load converge.
/// Choice: halved or doubled, none of 43 answers changes.
const LOAD_ROUNDS: usize = 3;

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
    if weight_n <= 0.0 || (likelier(before, after) < SURE && !one_way(track, &other, model, fixed, &likelier)?) {
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
    if likelier(simply(track, model, fixed, false)?, after) <= SURE {
        return Ok(false);
    }
    Ok(likelier(after, simply(track, model, fixed, true)?) < THRESHOLD_SLOW)
}

/// Residual RMS of the model with friction of every kind and a mass, N. `free` adds gravity of any direction.
fn simply(track: &Track, model: &Model, fixed: &Model, free: bool) -> Result<f64, EstimateError> {
    let track = &prepared(track);
    let look = PlainFit::of(track, fixed);
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
    track.bearing = Bearing { weight_n, mass_kg: weight_n / gravity_m_s2.max(f64::MIN_POSITIVE), per_radius };
    for row in track.rows.iter_mut().filter(|r| r.place == Place::Along) {
        row.motion.normal_force_n += track.bearing.load_n(row) - before.load_n(row);
    }
}

/// Residual RMS of the model with friction and possible disturbances, and the weight that the model alone estimates, N.
fn plain(track: &Track, model: &Model, fixed: &Model) -> Result<(f64, f64), EstimateError> {
    let track = &prepared(track);
    let look = PlainFit::of(track, fixed);
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

/// The rows with blurred directions, and loads without bias.
fn prepared(track: &Track) -> Track {
    let mut track = track.clone();
    blur(&mut track);
    without_bias(&mut track);
    track
}

/// Removes the sensor bias, seen in free rows, from the load. A bias across the motion looks like a weight.
fn without_bias(track: &mut Track) {
    let mean = |place: Place| {
        let free: Vec<f64> = track.rows.iter().filter(|r| r.place == place).map(|r| r.target).collect();
        free.iter().sum::<f64>() / free.len().max(1) as f64
    };
    let bias = Vec2::new(mean(Place::FreeX), mean(Place::FreeY));
    for row in track.rows.iter_mut().filter(|r| r.place == Place::Along) {
        row.motion.normal_force_n -= bias.dot(&Vec2::new(row.along.y, -row.along.x));
    }
}

/// Causes that resemble a weight on the bearing if another cause hides it.
const MISTAKEN: [&str; 4] = [eccentric_mass::ID, gravity_tilt::ID, force_bias::ID, force_cross_axis::ID];

/// Comparison with the weight on the bearing, and that weight, N, if its residual is smaller or it needs fewer causes.
/// `looked_at`: rows and result of the first comparison; `track`: rows as measured. Other hidden causes can keep
/// [`load`] from seeing the weight.
pub fn beside_causes(
    track: &Track,
    (looked_at, study): (&Track, &ChannelFit),
    (model, fixed): (&Model, &Model),
    gravity_m_s2: f64,
) -> Result<Option<(f64, Track, ChannelFit)>, EstimateError> {
    let rubs = model.iter().any(|e| e.law().id() == LoadFriction.id());
    let mistaken = MISTAKEN.iter().any(|id| study.has(id));
    let along: Vec<bool> = looked_at.rows.iter().map(|r| r.place == Place::Along).collect();
    let is_much = rms(study, &study.picks(), &along).0 > MUCH * track.force_noise;
    if !rubs || !track.planar || !(mistaken || is_much) {
        return Ok(None);
    }
    let (mut weight_n, mut found) = (weight_of(study, model, fixed), None);
    for _ in 0..LOAD_ROUNDS {
        if weight_n <= 0.0 {
            return Ok(None);
        }
        if found.is_none() && !may_be(looked_at, study, model, weight_n, gravity_m_s2)? {
            return Ok(None);
        }
        let mut other = track.clone();
        put(&mut other, weight_n, gravity_m_s2);
        let again = one_coordinate::study(&mut other, model, fixed)?;
        let put_n = std::mem::replace(&mut weight_n, weight_of(&again, model, fixed));
        found = Some((put_n, other, again));
    }
    Ok(found.filter(|(_, other, again)| price(other, again) + SURE < price(looked_at, study)))
}

/// Quick test before the full comparison, which is slow: true if the weight on the bearing explains about as much as
/// the causes that it resembles.
fn may_be(
    track: &Track,
    study: &ChannelFit,
    model: &Model,
    weight_n: f64,
    gravity_m_s2: f64,
) -> Result<bool, EstimateError> {
    let mut other = track.clone();
    put(&mut other, weight_n, gravity_m_s2);
    let left = |track: &Track, is_kept: &dyn Fn(&str) -> bool| {
        let mut columns: Vec<Vec<f64>> = model.iter().map(|effect| column(track, effect)).collect();
        let picked = study.picks();
        let kept = picked.iter().map(|c| &study.candidates[*c]).filter(|c| is_kept(c.id));
        columns.extend(kept.flat_map(|c| c.regressors.iter().map(|column| column.to_vec())));
        least_squares_values(&columns, &study.target, Some(&weights(track))).map(|fit| fit.rms)
    };
    let with_causes = left(track, &|_| true)?;
    let on_bearing = left(&other, &|id| !MISTAKEN.contains(&id))?;
    Ok(on_bearing < AS_GOOD * with_causes)
}

/// Weight that a comparison estimates, N.
fn weight_of(study: &ChannelFit, model: &Model, fixed: &Model) -> f64 {
    let place = model.iter().position(|e| e.law().id() == Weight.id());
    let found_n = place.and_then(|k| study.solved.as_ref()?.values.get(k).copied());
    known_n(fixed) + found_n.unwrap_or(0.0)
}

/// Penalised deviance of a comparison: −2 ln(likelihood) plus ln(rows) for each parameter.
fn price(track: &Track, study: &ChannelFit) -> f64 {
    let picks = study.picks();
    let along: Vec<bool> = track.rows.iter().map(|r| r.place == Place::Along).collect();
    let (heldout, train) = rms(study, &picks, &along);
    let rows = along.iter().filter(|a| **a).count() as f64;
    let columns: usize = picks.iter().map(|c| study.candidates[*c].regressors.len()).sum();
    2.0 * rows * heldout.max(train).max(1e-300).ln() + columns as f64 * rows.ln()
}
