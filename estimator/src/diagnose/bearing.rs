//! What loads a crank's bearing: the pull of the fingers alone (thesis, eq. 5.2), or that and the weight of the handle, which hangs on the same
//! bearing. The recording decides.

use super::blur::blur;
use super::force::{Model, column};
use super::gain::rms;
use super::geometry::Study;
use super::track::{Bearing, Place, Row, Track};
use crate::estimate::EstimateError;
use crate::identify::linear::least_squares_values;
use haptics::Vec2;
use haptics::law::{CoulombFriction, Effect, Inertia, Law, LoadFriction, Weight};

/// The other load must be likelier by so much, 2 ln(likelihood): rows are not independent.
const LIKELIER: f64 = 60.0;
/// Rounds in which weight and load settle.
const ROUNDS: usize = 3;

/// A load that only goes one way makes of the weight on the bearing a pull like gravity's, a quarter turn ahead: the weight is taken to be there when one
/// free pull in every direction is likelier by no more than this.
const AS_LIKELY: f64 = 25.0;

/// Puts the weight on the bearing where friction goes with both; the weight that was found, N. `gravity_m_s2`: what makes a mass of it, which the bearing
/// holds on its circle, too.
pub fn load(track: &mut Track, model: &Model, fixed: &Model, gravity_m_s2: f64) -> Result<Option<f64>, EstimateError> {
    let rubs = model.iter().any(|e| e.law().id() == LoadFriction.id());
    if !rubs || !track.planar {
        return Ok(None);
    }
    let (before, mut weight_n) = plain(track, model, fixed)?;
    let mut other = track.clone();
    let mut after = before;
    for _ in 0..ROUNDS {
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

/// Whether a weight on the bearing explains at once what nothing but a pull of gravity, as large as it happens to be, would explain otherwise.
fn one_way(
    track: &Track,
    other: &Track,
    model: &Model,
    fixed: &Model,
    likelier: &dyn Fn(f64, f64) -> f64,
) -> Result<bool, EstimateError> {
    let before = simply(track, model, fixed, false)?;
    let after = simply(other, model, fixed, false)?;
    let free = simply(track, model, fixed, true)?;
    Ok(likelier(before, after) > LIKELIER && likelier(after, free) < AS_LIKELY)
}

/// Causes that a weight on the bearing looks like when another one hides it.
const MISTAKEN: [&str; 4] = ["eccentric-mass", "gravity-tilt", "force-bias", "force-cross-axis"];
/// With the weight on the bearing the causes that are found must leave, or be, so much less: 2 ln(likelihood), a cause's parameter counted as the
/// logarithm of the rows.
const SIMPLER: f64 = 40.0;

/// The comparison with the weight on the bearing, and that weight, N, where that leaves less or needs fewer causes than without (`looked_at`: its rows and
/// what came of them; `track`: the rows as they were measured). What else is hidden may keep [`load`] from seeing it.
pub fn beside_causes(
    track: &Track,
    (looked_at, study): (&Track, &Study),
    (model, fixed): (&Model, &Model),
    (gravity_m_s2, threshold): (f64, f64),
) -> Result<Option<(f64, Track, Study)>, EstimateError> {
    let rubs = model.iter().any(|e| e.law().id() == LoadFriction.id());
    let mistaken = study.picks().iter().any(|c| MISTAKEN.contains(&study.candidates[*c].id));
    if !rubs || !track.planar || !(mistaken || super::explain::strange(study, &study.picks()).is_some()) {
        return Ok(None);
    }
    let (mut weight_n, mut found) = (weight_of(study, model, fixed), None);
    for _ in 0..ROUNDS_BESIDE {
        if weight_n <= 0.0 {
            return Ok(None);
        }
        if found.is_none() && !may_be(looked_at, study, model, weight_n, gravity_m_s2)? {
            return Ok(None);
        }
        let mut other = track.clone();
        put(&mut other, weight_n, gravity_m_s2);
        let again = super::force::study(&mut other, model, fixed, threshold)?;
        let put_n = std::mem::replace(&mut weight_n, weight_of(&again, model, fixed));
        found = Some((put_n, other, again));
    }
    Ok(found.filter(|(_, other, again)| price(other, again) + SIMPLER < price(looked_at, study)))
}

/// Whether the weight on the bearing leaves about as little as the causes that it looks like, beside the others: a quick look, because a comparison takes
/// as long as all the rest.
fn may_be(
    track: &Track,
    study: &Study,
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
        columns.extend(kept.flat_map(|c| c.columns.iter().cloned()));
        let weight: Vec<f64> =
            track.rows.iter().map(|r| if r.place == Place::Along { r.motion.direction.powi(4) } else { 0.0 }).collect();
        least_squares_values(&columns, &study.y, Some(&weight)).map(|fit| fit.rms)
    };
    let with_causes = left(track, &|_| true)?;
    let on_bearing = left(&other, &|id| !MISTAKEN.contains(&id))?;
    Ok(on_bearing < NEARLY * with_causes)
}

/// At a quick look the weight on the bearing leaves so much of what the causes leave at most.
const NEARLY: f64 = 1.25;

/// Rounds in which the weight settles beside the causes.
const ROUNDS_BESIDE: usize = 2;

/// The weight that a comparison came out at, N.
fn weight_of(study: &Study, model: &Model, fixed: &Model) -> f64 {
    let is_weight = |e: &&Effect| e.law().id() == Weight.id();
    let known_n: f64 = fixed.iter().filter(is_weight).map(|e| e.values[0]).sum();
    let place = model.iter().position(|e| e.law().id() == Weight.id());
    let found_n = place.and_then(|k| study.solved.as_ref()?.values.get(k).copied());
    known_n + found_n.unwrap_or(0.0)
}

/// How unlikely what is left is, and how many parameters it took: −2 ln(likelihood) and a logarithm of the rows each.
fn price(track: &Track, study: &Study) -> f64 {
    let picks = study.picks();
    let along: Vec<bool> = track.rows.iter().map(|r| r.place == Place::Along).collect();
    let (heldout, train) = rms(study, &picks, &along);
    let rows = along.iter().filter(|a| **a).count() as f64;
    let columns: usize = picks.iter().map(|c| study.candidates[*c].columns.len()).sum();
    2.0 * rows * heldout.max(train).max(1e-300).ln() + columns as f64 * rows.ln()
}

/// What the model leaves with friction of all kinds and a mass, root mean square, N; with gravity of any direction if `free`.
fn simply(track: &Track, model: &Model, fixed: &Model, free: bool) -> Result<f64, EstimateError> {
    let mut track = track.clone();
    blur(&mut track);
    without_bias(&mut track);
    let along: Vec<f64> =
        track.rows.iter().map(|r| if r.place == Place::Along { r.motion.direction.powi(4) } else { 0.0 }).collect();
    let of = |laws: &[Effect]| laws.iter().map(|effect| column(&track, effect)).collect::<Vec<_>>();
    let known = of(fixed);
    let y: Vec<f64> =
        track.rows.iter().enumerate().map(|(i, r)| r.y - known.iter().map(|k| k[i]).sum::<f64>()).collect();
    let has = |law: &dyn Law| model.iter().chain(fixed).any(|e| e.law().id() == law.id());
    let others = [&CoulombFriction as &'static dyn Law, &Inertia].into_iter().filter(|law| !has(*law));
    let laws: Vec<Effect> = model.iter().copied().chain(others.map(|law| Effect::new(law, &[1.0]))).collect();
    let mut columns = of(&laws);
    if free {
        let across = track.rows.iter().map(|r| if r.place == Place::Along { r.up_outward() } else { 0.0 });
        columns.push(across.collect());
    }
    Ok(least_squares_values(&columns, &y, Some(&along))?.rms)
}

/// Changes the load of every row to that with this weight on the bearing, N, and with what keeps its mass on the circle.
fn put(track: &mut Track, weight_n: f64, gravity_m_s2: f64) {
    let before = track.bearing;
    let per_radius = track.radius_m.map_or(0.0, |radius_m| 1.0 / radius_m);
    track.bearing = Bearing { weight_n, mass_kg: weight_n / gravity_m_s2.max(1e-9), per_radius };
    for row in track.rows.iter_mut().filter(|r| r.place == Place::Along) {
        row.motion.normal_force_n += track.bearing.load_n(row) - before.load_n(row);
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
