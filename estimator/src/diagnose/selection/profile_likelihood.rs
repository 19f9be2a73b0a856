//! Uncertainty of searched values, from the likelihood of their neighbours on the grid.

use super::comparison::ChannelFit;
use crate::diagnose::contract::{CauseParameter, parameter};
use crate::diagnose::data::limits::HALF;
use crate::diagnose::data::regression_data::Track;
use crate::diagnose::hypotheses::all::is_share;
use crate::diagnose::hypotheses::candidate::Candidate;
use crate::diagnose::hypotheses::pad_compliance;
use crate::diagnose::hypotheses::return_spring::{self, about_its_rest};
use haptics::law::{Coordinate, Law, PositionRipple, ReturnSpring};

/// Share of the distance between two tried values that is added to the vertex's standard error.
/// Choice: halved or doubled, none of 30 answers changes.
const OF_STEP: f64 = 0.1;

/// A searched value with one standard error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Known {
    pub value: f64,
    pub std_error: f64,
}

/// The chosen causes with their searched values at the vertices, and the coefficients solved there.
pub struct Settled {
    /// Coefficients of the model's regressors and then of the causes' ones, in the order of
    /// [`System::columns`](super::normal_equations::System::columns).
    pub values: Vec<f64>,
    /// Standard errors of these values, including the uncertainty of the searched ones.
    pub std_errors: Vec<f64>,
    /// The searched values of each chosen cause.
    pub searched: Vec<Vec<Known>>,
}

/// Estimates interpolated between the tried values. `None` without a solution.
pub fn settled(study: &ChannelFit) -> Option<Settled> {
    let solved = study.solved.as_ref()?;
    let picks = study.picks();
    let variance = solved.variance(study.system.rows);
    let squares = (0..solved.values.len()).map(|i| variance * solved.inverse[(i, i)]);
    let (mut values, mut squares) = (solved.values.clone(), squares.collect::<Vec<f64>>());
    let mut searched = Vec::new();
    for (k, pick) in picks.iter().enumerate() {
        let (own, own_values) = (&study.candidates[*pick], study.system.own(&picks, k));
        let all: Vec<Known> = (0..own.searched.len()).map(|which| known(study, k, which)).collect();
        for (i, unknown) in carried_over(study, k, &all).into_iter().enumerate() {
            squares[i] += unknown.powi(2);
        }
        // A longer wave has another phase at its start: its components are no smooth functions of its length.
        if own.id != PositionRipple.id() {
            for (which, known) in all.iter().enumerate() {
                let moved = moved(study, k, which, known.value);
                values.iter_mut().zip(moved.into_iter().flatten()).for_each(|(v, by)| *v += by);
            }
        }
        if !own.admits(&values[own_values.clone()]) {
            values[own_values.clone()].copy_from_slice(&solved.values[own_values]);
        }
        searched.push(all);
    }
    let mut std_errors: Vec<f64> = squares.into_iter().map(f64::sqrt).collect();
    for first in shares(study, &picks) {
        // Friction that was smaller at first has changed by more: both errors add up.
        let [ratio, error] = study.shares_of;
        values[first] *= ratio;
        std_errors[first] = std_errors[first] * ratio + error * values[first].abs();
    }
    Some(Settled { values, std_errors, searched })
}

/// First index of the values of those causes that are shares of the dry friction.
pub fn shares<'a>(study: &'a ChannelFit, picks: &'a [usize]) -> impl Iterator<Item = usize> + 'a {
    (0..picks.len()).filter(|k| is_share(&study.candidates[picks[*k]])).map(|k| study.system.own(picks, k).start)
}

/// All values and −2 ln(likelihood), with another candidate in the place of the k-th chosen cause.
fn fitted(study: &ChannelFit, k: usize, candidate: usize) -> Option<(Vec<f64>, f64)> {
    let mut with = study.picks();
    with[k] = candidate;
    study.system.least(&with).map(|(values, rss)| (values, study.system.rows * rss.max(1e-300).ln()))
}

/// Change of all values if one searched value differs from the tried one, on the parabola through the solutions of its
/// neighbours.
fn moved(study: &ChannelFit, k: usize, which: usize, to: f64) -> Option<Vec<f64>> {
    let own = study.picks()[k];
    let place = |candidate: usize| study.candidates[candidate].searched[which].value;
    let [below, above] = neighbours(study, own, which);
    let (below, above) = (below?, above?);
    let (left, right, away) = (place(below) - place(own), place(above) - place(own), to - place(own));
    let [here, below, above] = [own, below, above].map(|c| fitted(study, k, c));
    let ((here, _), (below, _), (above, _)) = (here?, below?, above?);
    // Lagrange polynomials: one at their own place, zero at the others.
    let of_below = away * (away - right) / (left * (left - right));
    let of_above = away * (away - left) / (right * (right - left));
    let changes = here.iter().zip(&below).zip(&above);
    Some(changes.map(|((h, b), a)| of_below * (b - h) + of_above * (a - h)).collect())
}

/// Estimate of the `which`-th searched value of the k-th chosen cause: vertex of −2 ln(likelihood) through it and its
/// neighbours, all else fitted again beside each. Its standard error follows from the curvature.
pub fn known(study: &ChannelFit, k: usize, which: usize) -> Known {
    let own = study.picks()[k];
    let value = |candidate: usize| study.candidates[candidate].searched[which].value;
    let price = |candidate: usize| fitted(study, k, candidate).map(|(_, price)| price);
    let tried = |candidate: Option<usize>| candidate.and_then(|c| Some((value(c), price(c)?)));
    let here = value(own);
    let Some(least) = price(own) else { return alone(here) };
    if study.candidates[own].id == PositionRipple.id() {
        return wave(neighbours(study, own, which).map(tried), (here, least));
    }
    match neighbours(study, own, which).map(tried).into() {
        (Some(below), Some(above)) => vertex(below, (here, least), above),
        (Some((other, _)), None) | (None, Some((other, _))) => {
            Known { value: here, std_error: HALF * (other - here).abs() }
        }
        (None, None) => alone(here),
    }
}

/// Standard errors of all solved values due to those of the searched values of the k-th chosen cause: a wider gap takes
/// a smaller share. Computed from the slope over the neighbours and from the likelihood-weighted solutions at all other
/// tried values; the larger one counts.
fn carried_over(study: &ChannelFit, k: usize, searched: &[Known]) -> Vec<f64> {
    let own = study.picks()[k];
    let Some((best, least)) = fitted(study, k, own).filter(|_| !searched.is_empty()) else { return Vec::new() };
    let mut by_slope = vec![0.0_f64; best.len()];
    for (which, known) in searched.iter().enumerate() {
        let place = |candidate: usize| study.candidates[candidate].searched[which].value;
        let [below, above] = neighbours(study, own, which).map(|c| c.unwrap_or(own));
        let apart = place(above) - place(below);
        let (Some((low, _)), Some((high, _))) = (fitted(study, k, below), fitted(study, k, above)) else { continue };
        if apart > 0.0 {
            let slopes = low.iter().zip(&high).map(|(l, h)| (h - l) / apart * known.std_error);
            by_slope.iter_mut().zip(slopes).for_each(|(sum, s)| *sum = sum.hypot(s));
        }
    }
    let own = &study.candidates[own];
    let alike = |c: &Candidate| c.id == own.id && c.part == own.part && c.linear == own.linear;
    let others = (0..study.candidates.len()).filter(|c| alike(&study.candidates[*c]));
    let (mut weights, mut squares) = (0.0, vec![0.0; best.len()]);
    for (values, price) in others.filter_map(|c| fitted(study, k, c)) {
        let weight = (-0.5 * (price - least)).min(0.0).exp();
        weights += weight;
        squares.iter_mut().zip(values.iter().zip(&best)).for_each(|(s, (v, b))| *s += weight * (v - b).powi(2));
    }
    by_slope
        .into_iter()
        .zip(squares)
        .map(|(slope, square)| slope.max((square / f64::max(weights, 1e-300)).sqrt()))
        .collect()
}

/// The candidates with the next smaller and the next larger of one searched value, all others equal.
fn neighbours(study: &ChannelFit, own: usize, which: usize) -> [Option<usize>; 2] {
    let value = |candidate: usize| study.candidates[candidate].searched[which].value;
    let here = value(own);
    let beside = || {
        let all = 0..study.candidates.len();
        all.filter(|c| differs_in_one(&study.candidates[own], &study.candidates[*c], which))
    };
    [
        beside().filter(|c| value(*c) < here).max_by(|a, b| value(*a).total_cmp(&value(*b))),
        beside().filter(|c| value(*c) > here).min_by(|a, b| value(*a).total_cmp(&value(*b))),
    ]
}

/// The same for the length of a wave. Waves are similar by their number over the motion, not by their length. Those
/// that differ by a whole wave over the motion explain nothing, so no parabola fits them.
fn wave([below, above]: [Option<(f64, f64)>; 2], (here, least): (f64, f64)) -> Known {
    let number = |(length, price): (f64, f64)| (1.0 / length, price);
    let (Some(below), Some(above)) = (below.map(number), above.map(number)) else {
        return Known { value: here, std_error: OF_STEP * here };
    };
    // The shorter wave has the larger number.
    let known = vertex(above, number((here, least)), below);
    Known { value: 1.0 / known.value, std_error: here * here * known.std_error }
}

fn alone(value: f64) -> Known {
    Known { value, std_error: value.abs() }
}

/// The same cause with another value at one place.
fn differs_in_one(own: &Candidate, other: &Candidate, which: usize) -> bool {
    let same = |a: f64, b: f64| (a - b).abs() <= 1e-9 * (a.abs() + b.abs());
    own.id == other.id
        && own.linear == other.linear
        && own.part == other.part
        && same(own.side, other.side)
        && own.searched.len() == other.searched.len()
        && own
            .searched
            .iter()
            .zip(&other.searched)
            .enumerate()
            .all(|(i, (a, b))| a.name == b.name && (i == which) != same(a.value, b.value))
}

/// Vertex of the parabola through three points, and the standard error from its curvature.
fn vertex(below: (f64, f64), here: (f64, f64), above: (f64, f64)) -> Known {
    let (left, right) = (here.0 - below.0, above.0 - here.0);
    let (down, up) = ((here.1 - below.1) / left, (above.1 - here.1) / right);
    let curvature = 2.0 * (up - down) / (left + right);
    let step = 0.5 * (left + right);
    if curvature <= 0.0 || curvature.is_nan() {
        return Known { value: here.0, std_error: step };
    }
    let slope = (down * right + up * left) / (left + right);
    let away = (-slope / curvature).clamp(-0.5 * left, 0.5 * right);
    // −2 ln(likelihood) rises by one within one standard error.
    let std_error = (2.0 / curvature).sqrt().min(step).hypot(OF_STEP * step);
    Known { value: here.0 + away, std_error }
}

pub(crate) fn parameters(study: &ChannelFit, k: usize) -> Vec<CauseParameter> {
    let Some(settled) = settled(study) else { return Vec::new() };
    let picks = study.picks();
    let (own, first) = (&study.candidates[picks[k]], study.system.own(&picks, k).start);
    let mut found: Vec<CauseParameter> = own
        .linear
        .iter()
        .enumerate()
        .map(|(i, (name, unit))| {
            let (value, error) = (settled.values[first + i], settled.std_errors[first + i]);
            match own.id {
                // The answer states the stiffness, while the estimate is a compliance.
                _ if own.channel.is_some() => of_channel(own, (name, unit), value, error),
                pad_compliance::ID => parameter(
                    "k",
                    1.0 / value.max(f64::MIN_POSITIVE),
                    error / (value * value).max(f64::MIN_POSITIVE),
                    "N/m",
                ),
                _ => parameter(name, value, error, unit),
            }
        })
        .collect();
    let searched = own.searched.iter().zip(&settled.searched[k]);
    found.extend(searched.map(|(s, known)| parameter(s.name, known.value, known.std_error, s.unit)));
    found
}

/// Parameter of an effect in proportion to a recorded channel, per unit of that channel.
pub(crate) fn of_channel(candidate: &Candidate, own: (&str, &str), value: f64, std_error: f64) -> CauseParameter {
    let (channel, unit) = candidate.channel.clone().unwrap_or_default();
    let per = if unit.is_empty() { String::new() } else { format!("/{unit}") };
    parameter(&format!("{} with {channel}", own.0), value, std_error, &format!("{}{per}", own.1))
}

/// Parameters of a hardening spring: stiffness, force, hardening and rest position, from the coefficients of two
/// cubics. Errors are to first order.
pub(crate) fn of_hardening_spring(track: &Track, study: &ChannelFit, k: usize) -> Option<Vec<CauseParameter>> {
    let candidate = &study.candidates[study.chosen[k].candidate];
    if candidate.id != return_spring::ID || candidate.regressors.len() != 4 {
        return None;
    }
    let solved = study.solved.as_ref()?;
    let own = study.system.own(&study.picks(), k);
    let first = own.start;
    let values = &solved.values[own];
    let variance = solved.variance(study.system.rows);
    let found = about_its_rest(values, track);
    let slopes: Vec<[f64; 4]> = (0..4)
        .map(|j| {
            let error = solved.std_error(first + j, study.system.rows);
            let step = 1e-4 * values[j].abs().max(error).max(f64::MIN_POSITIVE);
            let mut moved = [values[0], values[1], values[2], values[3]];
            moved[j] += step;
            let after = about_its_rest(&moved, track);
            std::array::from_fn(|i| (after[i] - found[i]) / step)
        })
        .collect();
    let error = |i: usize| {
        let pairs = (0..4).flat_map(|a| (0..4).map(move |b| (a, b)));
        let sum: f64 = pairs.map(|(a, b)| slopes[a][i] * slopes[b][i] * solved.inverse[(first + a, first + b)]).sum();
        (variance * sum.max(0.0)).sqrt()
    };
    let specs = ReturnSpring.parameters();
    let unit = |i: usize| if track.coordinate == Coordinate::Angular { specs[i].unit_angular } else { specs[i].unit };
    Some((0..4).map(|i| parameter(specs[i].name, found[i], error(i), unit(i))).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use haptics::law::Kind;

    #[test]
    fn a_time_in_another_part_of_the_recording_is_no_neighbour() {
        let slip = |t0: f64, part: usize| {
            Candidate::one("fingertip-slip", Kind::Plant, "dy", "m", vec![0.0]).at("t0", t0, "s").within(part)
        };
        assert!(differs_in_one(&slip(7.4, 1), &slip(7.5, 1), 0));
        assert!(!differs_in_one(&slip(7.4, 1), &slip(4.0, 0), 0));
    }

    #[test]
    fn the_vertex_of_a_parabola_and_its_error_are_found_between_tried_values() {
        let price = |v: f64| 7.0 + ((v - 0.312) / 0.02).powi(2);
        let at = |v: f64| (v, price(v));
        let known = vertex(at(0.25), at(0.30), at(0.36));
        assert!((known.value - 0.312).abs() < 1e-9, "{known:?}");
        assert!((known.std_error - 0.02_f64.hypot(0.1 * 0.055)).abs() < 1e-9, "{known:?}");
    }

    #[test]
    fn a_wave_that_is_a_whole_number_of_a_turn_is_that_number() {
        let turn = 0.126;
        let length = |n: f64| turn / n;
        // Two, three and four waves a turn where there are three.
        let known = wave([Some((length(4.0), 900.0)), Some((length(2.0), 900.0))], (length(3.0), 200.0));
        assert!((known.value - length(3.0)).abs() < 1e-9 && known.std_error < 0.05 * length(3.0), "{known:?}");
    }

    #[test]
    fn what_the_neighbours_do_not_tell_is_known_to_a_step_at_best() {
        let flat = vertex((1.0, 5.0), (2.0, 5.0), (4.0, 5.0));
        assert_eq!(flat, Known { value: 2.0, std_error: 1.5 });
        // The vertex beside much worse neighbours is at most half way to them.
        let steep = vertex((1.0, 500.0), (2.0, 5.0), (3.0, 400.0));
        assert!(steep.value > 1.5 && steep.value < 2.5 && steep.std_error < 0.2, "{steep:?}");
    }
}
