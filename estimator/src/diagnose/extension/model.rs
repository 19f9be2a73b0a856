//! Extended model: the base model with the causes found, as laws with values that a world can run.

use crate::diagnose::data::regression_data::{Model, Track};
use crate::diagnose::hypotheses::all::{hypothesis, relations};
use crate::diagnose::hypotheses::candidate::Candidate;
use crate::diagnose::hypotheses::dry_share::DryFriction;
use crate::diagnose::hypotheses::hypothesis::Found;
use crate::diagnose::hypotheses::relations::Relation;
use crate::diagnose::hypotheses::{coulomb_friction, free_motion};
use crate::diagnose::selection::comparison::ChannelFit;
use crate::diagnose::selection::normal_equations::Solved;
use crate::diagnose::selection::profile_likelihood::{settled, shares};
use haptics::law::{Effect, Kind, Role};

/// The model's laws refitted beside the chosen causes, and the plant causes among these as laws of their own.
/// Instruments' faults are no part of a world.
pub fn effects(track: &Track, model: &Model, study: &ChannelFit) -> Vec<Effect> {
    let Some(settled) = settled(study) else { return model.clone() };
    let searched: Vec<Vec<f64>> =
        settled.searched.iter().map(|all| all.iter().map(|known| known.value).collect()).collect();
    let candidates: Vec<&Candidate> = study.picks().into_iter().map(|c| &study.candidates[c]).collect();
    made(track, model, &candidates, &settled.values, &searched).0
}

/// The same for some of the candidates; `None` if a plant cause among them has no law in a world.
pub fn effects_of(
    track: &Track,
    model: &Model,
    study: &ChannelFit,
    picks: &[usize],
    solved: &Solved,
) -> Option<Vec<Effect>> {
    let candidates: Vec<&Candidate> = picks.iter().map(|c| &study.candidates[*c]).collect();
    let searched = tried(&candidates);
    let mut values = solved.values.clone();
    shares(study, picks).for_each(|first| values[first] *= study.shares_of[0]);
    let (found, is_whole) = made(track, model, &candidates, &values, &searched);
    is_whole.then_some(found)
}

/// Tried values of each candidate.
fn tried(candidates: &[&Candidate]) -> Vec<Vec<f64>> {
    candidates.iter().map(|c| c.searched.iter().map(|s| s.value).collect()).collect()
}

/// The laws, and true if every plant cause is among them. `values`: of the model's regressors, then of the causes'
/// ones; `searched`: searched values of each cause.
fn made(
    track: &Track,
    model: &Model,
    causes: &[&Candidate],
    values: &[f64],
    searched: &[Vec<f64>],
) -> (Vec<Effect>, bool) {
    let found: Vec<Effect> = model.iter().zip(values).map(|(e, share)| scaled(e, *share)).collect();
    let of_causes = causes.iter().map(|c| c.regressors.len()).sum::<usize>();
    let values = &values[values.len() - of_causes..];
    let mut dry = DryFriction::of(&found);
    // The shares refer to all dry friction.
    dry.level_n +=
        with_values(causes, values).filter(|(c, _)| c.id == coulomb_friction::ID).map(|(_, v)| v[0]).sum::<f64>();
    beside_model(track, found, &dry, causes, values, searched)
}

/// Each cause with its values.
fn with_values<'a>(causes: &'a [&Candidate], values: &'a [f64]) -> impl Iterator<Item = (&'a Candidate, &'a [f64])> {
    let mut rest = values;
    causes.iter().map(move |cause| {
        let (own, others) = rest.split_at(cause.regressors.len());
        rest = others;
        (*cause, own)
    })
}

/// Laws of causes found beside a model without dry friction of its own. Dry friction must precede the causes that are a
/// share of it. `None` if a cause has no law. `dry_n`: friction to which the shares refer, N; `values`: of the causes
/// alone.
pub fn without_friction(
    track: &Track,
    laws: Vec<Effect>,
    dry_n: f64,
    causes: &[&Candidate],
    values: &[f64],
) -> Option<Vec<Effect>> {
    let searched = tried(causes);
    let (found, is_whole) =
        beside_model(track, laws, &DryFriction { level_n: dry_n, mu: 0.0 }, causes, values, &searched);
    is_whole.then_some(found)
}

fn beside_model(
    track: &Track,
    mut found: Vec<Effect>,
    dry: &DryFriction,
    causes: &[&Candidate],
    values: &[f64],
    searched: &[Vec<f64>],
) -> (Vec<Effect>, bool) {
    let weight_n = found.iter().filter(|e| e.role() == Role::Gravity).map(|e| e.values[0]).sum::<f64>();
    let mut is_whole = true;
    // Dry friction comes first: other causes bend or lift a share of it.
    let mut ordered: Vec<_> = with_values(causes, values).zip(searched).collect();
    ordered.sort_by_key(|((candidate, _), _)| candidate.id != coulomb_friction::ID);
    for ((candidate, values), searched) in ordered {
        if relations(candidate.id).contains(&Relation::TakesDryFriction) {
            found.iter_mut().filter(|e| e.law().is_dry()).for_each(|e| *e = scaled(e, (1.0 - values[0]).max(0.0)));
        }
        let laws = laws_of(&Found { candidate, values, searched, track, weight_n, dry });
        is_whole &= !laws.is_empty() || candidate.kind == Kind::Instrument;
        found.extend(laws);
    }
    (free_motion::whole(track, found), is_whole)
}

/// Laws of a plant cause in a world. Empty for a fault of the measurement.
fn laws_of(found: &Found<'_>) -> Vec<Effect> {
    let plant = hypothesis(found.candidate.id).filter(|_| found.candidate.kind == Kind::Plant);
    plant.map_or_else(Vec::new, |hypothesis| hypothesis.effects(found))
}

/// The model's laws fitted without any cause.
pub fn plain(track: &Track, model: &Model, study: &ChannelFit) -> Vec<Effect> {
    let Some(solved) = study.system.solve(&[]) else { return model.clone() };
    free_motion::whole(track, model.iter().zip(&solved.values).map(|(e, share)| scaled(e, *share)).collect())
}

/// A law whose linear parameters all change by one factor.
fn scaled(effect: &Effect, share: f64) -> Effect {
    let mut scaled = *effect;
    for (value, spec) in scaled.values.iter_mut().zip(effect.law().parameters()) {
        if spec.enters == haptics::law::Enters::Linear {
            *value *= share;
        }
    }
    scaled
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::data::regression_data::Row;
    use haptics::law::{CoulombFriction, LoadFriction, Motion, ViscousFriction};

    #[test]
    fn a_share_of_friction_that_goes_with_the_load_goes_with_it() {
        let model = [
            Effect::new(&CoulombFriction, &[0.1]),
            Effect::new(&LoadFriction, &[0.2]),
            Effect::new(&ViscousFriction, &[3.0]),
        ];
        let at = |time_s: f64| Motion { time_s, direction: 1.0, normal_force_n: -5.0, ..Motion::default() };
        let total = |laws: &[Effect], time_s: f64| laws.iter().map(|e| e.force(&at(time_s))).sum::<f64>();
        let track = Track::of_rows(vec![Row::default()]);
        let of = |model: &[Effect], candidate: &Candidate, values: &[f64], searched: &[f64]| {
            let dry = &DryFriction::of(model);
            laws_of(&Found { candidate, values, searched, track: &track, weight_n: 0.0, dry })
        };
        let bends = Candidate::one("hysteresis", Kind::Plant, "share", "1", Vec::new()).at("way", 1e-4, "m");
        let laws = of(&model, &bends, &[0.8], &[1e-4]);
        assert!(laws.len() == 2 && (total(&laws, 0.0) - 0.8 * (0.1 + 0.2 * 5.0)).abs() < 1e-12, "{laws:?}");
        // The same share under another load.
        let loaded = of(&model[1..2], &bends, &[0.8], &[1e-4]);
        assert!(loaded.len() == 1 && (total(&loaded, 0.0) - 0.8).abs() < 1e-12, "{loaded:?}");
        let change = || Candidate::one("friction-change", Kind::Plant, "relative change", "1", Vec::new());
        let laws = of(&model, &change().at("t0", 8.0, "s"), &[0.5], &[8.0]);
        assert!(total(&laws, 7.9) == 0.0 && (total(&laws, 8.1) - 0.5 * 1.1).abs() < 1e-12, "{laws:?}");
        let warms = of(&model, &change().at("tau", 8.0, "s"), &[-0.5], &[8.0]);
        assert!((total(&warms, 8.0) + 0.5 * 1.1 * (1.0 - (-1.0_f64).exp())).abs() < 1e-12, "{warms:?}");
        let channel = ("temperature_degC".to_owned(), "degC".to_owned());
        assert!(of(&model, &change().with(channel), &[0.5], &[]).is_empty(), "no world has a temperature");
        let other = Candidate::one("time-delay", Kind::Instrument, "tau", "s", Vec::new());
        assert!(of(&model, &other, &[0.5], &[]).is_empty(), "no law");
    }
}
