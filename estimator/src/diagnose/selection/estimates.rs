use super::comparison::ChannelFit;
use super::profile_likelihood::{firsts, settled};
use crate::diagnose::contract::{CauseParameter, parameter};
use crate::diagnose::data::regression_data::Track;
use crate::diagnose::hypotheses::candidate::Candidate;
use crate::diagnose::hypotheses::pad_compliance;
use crate::diagnose::hypotheses::return_spring::{self, about_its_rest};
use haptics::law::{Coordinate, Law as _, ReturnSpring};

pub(crate) fn parameters(study: &ChannelFit, k: usize) -> Vec<CauseParameter> {
    let Some(settled) = settled(study) else { return Vec::new() };
    let picks = study.picks();
    let (own, first) = (&study.candidates[picks[k]], firsts(study, &picks)[k]);
    let mut found: Vec<CauseParameter> = own
        .linear
        .iter()
        .enumerate()
        .map(|(i, (name, unit))| {
            let (value, error) = (settled.values[first + i], settled.std_errors[first + i]);
            match own.id {
                // The answer states the stiffness, while the estimate is a compliance.
                _ if own.channel.is_some() => of_channel(own, name, value, error),
                pad_compliance::ID => parameter("k", 1.0 / value.max(1e-12), error / (value * value).max(1e-24), "N/m"),
                _ => parameter(name, value, error, unit),
            }
        })
        .collect();
    let searched = own.searched.iter().zip(&settled.searched[k]);
    found.extend(searched.map(|(s, known)| parameter(s.name, known.value, known.std_error, s.unit)));
    found
}

/// Parameter of an effect in proportion to a recorded channel, per unit of that channel.
pub(crate) fn of_channel(candidate: &Candidate, name: &str, value: f64, std_error: f64) -> CauseParameter {
    let (channel, unit) = candidate.channel.clone().unwrap_or_default();
    parameter(&format!("{name} with {channel}"), value, std_error, &format!("1/{unit}"))
}

/// Parameters of a hardening spring: stiffness, force, hardening and rest position, from the coefficients of two
/// cubics. Errors are to first order.
pub(crate) fn of_hardening_spring(track: &Track, study: &ChannelFit, k: usize) -> Option<Vec<CauseParameter>> {
    let candidate = &study.candidates[study.chosen[k].candidate];
    if candidate.id != return_spring::ID || candidate.columns.len() != 4 {
        return None;
    }
    let solved = study.solved.as_ref()?;
    let first = firsts(study, &study.picks())[k];
    let values = &solved.values[first..first + 4];
    let variance = solved.variance(study.system.rows);
    let found = about_its_rest(values, track);
    let slopes: Vec<[f64; 4]> = (0..4)
        .map(|j| {
            let step =
                1e-4 * values[j].abs().max((variance * solved.inverse[(first + j, first + j)]).sqrt()).max(1e-12);
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
