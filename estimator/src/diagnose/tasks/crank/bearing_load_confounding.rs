//! Weight on a crank's bearing, compared with other hidden causes.

use super::bearing_load::{known_n, put, weights};
use crate::diagnose::answer::cause::unexplained;
use crate::diagnose::data::regression_data::{Model, Place, Track};
use crate::diagnose::data::row_means::column;
use crate::diagnose::hypotheses::{eccentric_mass, force_bias, force_cross_axis, gravity_tilt};
use crate::diagnose::selection::comparison::ChannelFit;
use crate::diagnose::selection::held_out_gain::rms;
use crate::diagnose::tasks::one_coordinate;
use estimation::regression::linear::least_squares_values;
use foundation::estimate::EstimateError;
use haptics::law::{Law as _, LoadFriction, Weight};

/// Causes that resemble a weight on the bearing if another cause hides it.
const MISTAKEN: [&str; 4] = [eccentric_mass::ID, gravity_tilt::ID, force_bias::ID, force_cross_axis::ID];
/// Margin by which the comparison with the weight on the bearing must win: −2 ln(likelihood) plus a penalty of ln(rows)
/// for each parameter of a cause.
const SIMPLER: f64 = 40.0;
/// Largest ratio of residuals, with the weight on the bearing over with the causes alone, for which the full comparison
/// is made.
const NEARLY: f64 = 1.25;
/// Rounds in which the weight converges beside the causes.
const CONFOUNDING_ROUNDS: usize = 2;

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
    if !rubs || !track.planar || !(mistaken || unexplained(study).is_some()) {
        return Ok(None);
    }
    let (mut weight_n, mut found) = (weight_of(study, model, fixed), None);
    for _ in 0..CONFOUNDING_ROUNDS {
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
    Ok(found.filter(|(_, other, again)| price(other, again) + SIMPLER < price(looked_at, study)))
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
        columns.extend(kept.flat_map(|c| c.columns.iter().map(|column| column.to_vec())));
        least_squares_values(&columns, &study.y, Some(&weights(track))).map(|fit| fit.rms)
    };
    let with_causes = left(track, &|_| true)?;
    let on_bearing = left(&other, &|id| !MISTAKEN.contains(&id))?;
    Ok(on_bearing < NEARLY * with_causes)
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
    let columns: usize = picks.iter().map(|c| study.candidates[*c].columns.len()).sum();
    2.0 * rows * heldout.max(train).max(1e-300).ln() + columns as f64 * rows.ln()
}
