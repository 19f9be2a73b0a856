//! Builds an answer in words from a comparison.

use super::build::verdict;
use super::excitation::unseen;
use super::rejected::{passed_over, unsaid};
use super::residual_table;
use super::time_series::course;
use crate::diagnose::contract::{Alternative, Baseline, Cause, Diagnosis, Final, Gain, NextExperiment, Verdict};
use crate::diagnose::data::regression_data::{Model, Place, Track};
use crate::diagnose::experiment::proposal::propose;
use crate::diagnose::experiment::turned_track;
use crate::diagnose::extension::hypothetical_worlds::hypotheses;
use crate::diagnose::extension::model::{effects, plain};
use crate::diagnose::findings::{DelayFindings, Findings};
use crate::diagnose::free_run::along_coordinate::rollout;
use crate::diagnose::free_run::windows::{AT_ONCE, NO_LAW};
use crate::diagnose::hypotheses::all::{twins, widen};
use crate::diagnose::hypotheses::length_scale;
use crate::diagnose::recording::sample_offset::{apart, rest_s, skew};
use crate::diagnose::selection::comparison::Study;
use crate::diagnose::selection::estimates::{number, of_hardening_spring, parameters};
use crate::diagnose::selection::held_out_gain::{chi_square_tail, gain, gain_between, rms, shows_beside, whiteness_p};
use crate::diagnose::selection::rules::Rules;
use crate::diagnose::selection::stepwise::Chosen;
use crate::diagnose::validation::fitted_terms::of_study;
use crate::words::amount;
use haptics::law::entries;

/// Channel of a motion along one coordinate.
pub(crate) const FORCE: &str = "force";

/// The answer of one object's recordings.
pub fn explain(track: &Track, model: &Model, study: &Study, geometries: &[Study], faults: Vec<Cause>) -> Findings {
    let along: Vec<bool> = track.rows.iter().map(|r| r.place == Place::Along).collect();
    let unit = track.force_unit();
    let picks = study.picks();
    let (heldout, train) = rms(study, &[], &along);
    let (end, end_train) = rms(study, &picks, &along);
    let floor = if track.noise_is_measured { track.force_noise } else { end_train.min(end) };
    let (mut found, mut alternatives, mut warnings) = (Vec::<(f64, Cause)>::new(), Vec::new(), Vec::new());
    for (k, chosen) in study.chosen.iter().enumerate() {
        if let Some(skew_s) = skew(study, k, track) {
            warnings.push(apart(skew_s));
            continue;
        }
        let mut named = cause(study, k, floor, (channel(track), unit));
        named.gain = named.gain.run(rollout(track, model, study, k));
        widen(&named.id, &mut named.parameters, track);
        if let Some(parameters) = of_hardening_spring(track, study, k) {
            named.parameters = parameters;
        }
        found.push((chosen.score, named));
        alternatives.extend(rivals(study, chosen));
    }
    for geometry in geometries {
        of_path(geometry, &mut found, &mut alternatives);
    }
    let strange = strange(study, &picks);
    let mut causes = in_order(faults, found);
    let open_ones: Vec<Alternative> = alternatives.iter().filter(|a| a.posterior > study.rules.open).cloned().collect();
    let mut verdict = verdict(!causes.is_empty(), strange.is_some(), !open_ones.is_empty());
    if let Some(strange) = strange {
        let (left, warning) = unnamed(study, strange, (floor, unit));
        causes.push(left);
        warnings.push(warning);
    }
    let white = whiteness_p(study, &picks);
    if let Some(much) = much_left(track, &study.rules, end, white).filter(|_| causes.is_empty()) {
        verdict = Verdict::Unexplained;
        warnings.push(much);
    }
    let not_excited = unseen(track, study, &causes, &alternatives);
    let passed_over = passed_over(study, study.rules.unexplained);
    let diagnosis = Diagnosis {
        verdict,
        baseline: Baseline {
            model: model.iter().map(|e| e.law().id()).collect::<Vec<_>>().join("+"),
            rms_n: train,
            heldout_rms_n: heldout,
            whiteness_p: whiteness_p(study, &[]),
            unit: Some(unit.to_owned()),
            ..Baseline::default()
        },
        noise_floor_n: floor,
        residuals: residual_table::of_crank_or_mechanism(track, study, geometries, (unit, floor)),
        passed_over: unsaid(passed_over, &causes, &alternatives, &not_excited),
        not_excited,
        causes,
        alternatives,
        next_experiment: next(track, model, study, &open_ones),
        end: Final { heldout_rms_n: end, whiteness_p: white, ..Final::default() },
        warnings,
        ..Diagnosis::default()
    };
    Findings {
        diagnosis,
        plain: plain(track, model, study),
        effects: effects(track, model, study),
        course: course(track, study),
        kept: of_study(FORCE, study),
        per_inertia: track.freely.is_some_and(|free| !free.is_known),
        delay: DelayFindings { rest_s: rest_s(study, &picks), ..DelayFindings::default() },
        hypotheses: hypotheses(track, model, study),
        ..Findings::default()
    }
}

/// Adds the causes that were found in a path but not in the force.
fn of_path(geometry: &Study, found: &mut Vec<(f64, Cause)>, alternatives: &mut Vec<Alternative>) {
    for (k, chosen) in geometry.chosen.iter().enumerate() {
        let id = geometry.candidates[chosen.candidate].id;
        if found.iter().all(|(_, c)| c.id != id) {
            let mut named = cause(geometry, k, 0.0, ("path", "m"));
            named.gain = named.gain.run(Err(AT_ONCE.to_owned()));
            found.push((chosen.score, named));
            alternatives.extend(rivals(geometry, chosen));
        }
    }
}

/// Sentence on the final residual (`end`) if it is far above the force noise and not white. `white`: p-value of its
/// whiteness.
fn much_left(track: &Track, rules: &Rules, end: f64, white: f64) -> Option<String> {
    let times = end / track.force_noise;
    (rules.much.is_some_and(|much| times > much) && white < rules.surely_not_white).then(|| {
        let left = amount(end, track.force_unit());
        format!("{left} are left, {times:.0} times the noise of the force, and go with nothing that was tried")
    })
}

/// Name of the compared channel.
fn channel(track: &Track) -> &'static str {
    if track.freely.is_some() { "motion" } else { "force" }
}

/// Next experiment, if a question is `open`.
fn next(track: &Track, model: &Model, study: &Study, open: &[Alternative]) -> Option<NextExperiment> {
    if track.freely.is_some() { turned_track::next(open) } else { propose(track, model, study, open) }
}

/// Order of the causes: faults first, causes of the force as they were found, and those of the path by their evidence.
fn in_order(faults: Vec<Cause>, found: Vec<(f64, Cause)>) -> Vec<Cause> {
    let mut scores: Vec<f64> = vec![f64::INFINITY; faults.len()];
    let mut causes = faults;
    for (score, cause) in found {
        let place = if cause.evidence.contains("of the path") {
            scores.iter().position(|s| *s < score).unwrap_or(scores.len())
        } else {
            scores.len()
        };
        scores.insert(place, score);
        causes.insert(place, cause);
    }
    causes
}

/// Generic term that no known cause explains, with its evidence.
pub(crate) fn strange(study: &Study, picks: &[usize]) -> Option<(usize, f64)> {
    // A term that increases the held-out residual is an overfit to a few other rows.
    let worse = |candidate: usize| {
        let gain = gain_between(study, picks, &[picks, &[candidate]].concat(), 0.0);
        gain.heldout_rms_after > study.rules.overfit * gain.heldout_rms_before
    };
    let strongest = study.of_each().unexplained(picks);
    strongest.filter(|(candidate, score)| *score > study.rules.unexplained && !worse(*candidate))
}

fn cause(study: &Study, k: usize, floor: f64, (channel, unit): (&str, &str)) -> Cause {
    let chosen = &study.chosen[k];
    let candidate = &study.candidates[chosen.candidate];
    let entry = entries().find(|e| e.id == candidate.id);
    let gain = Gain { unit: Some(unit.to_owned()), ..gain(study, k, floor) };
    let (title, equation) = entry.map_or((candidate.id, ""), |e| (e.title, e.equation));
    let stands = if shows_beside(study, &[chosen.candidate]) {
        " (and, in newtons, of how far it gives where it stands)"
    } else {
        ""
    };
    let link = if candidate.id == length_scale::ID
        && candidate.linear.first().is_some_and(|(n, _)| n.starts_with("link_error"))
    {
        "; the length is that of the first link (an error of the second link's, as large and the other way round, makes the same path but for the size of \
         the circle)"
    } else {
        ""
    };
    let goes_with = candidate.channel.as_ref().map_or_else(String::new, |(name, _)| format!(" with {name}"));
    let evidence = format!(
        "{title}: what the model leaves of the {channel} follows {equation}{goes_with}; on data held out it{stands} goes from {} to {} RMS (score \
         {:.0}, {:.0} would do){link}",
        amount(gain.heldout_rms_before, unit),
        amount(gain.heldout_rms_after, unit),
        chosen.score,
        20.0
    );
    Cause {
        id: candidate.id.to_owned(),
        kind: candidate.kind,
        parameters: parameters(study, k),
        p_value: p_value(study, chosen),
        posterior: 1.0 / total_odds(study, chosen),
        gain,
        evidence,
    }
}

/// Sum of the likelihoods of a cause and its rivals, relative to its own. An equivalent cause counts as one.
fn total_odds(study: &Study, chosen: &Chosen) -> f64 {
    let own = study.candidates[chosen.candidate].id;
    let rival = |id: &str| chosen.rivals.iter().any(|(c, _)| study.candidates[*c].id == id);
    let tested = |id: &str| study.candidates.iter().any(|c| c.id == id);
    let twins = twins().filter(|(a, b, _)| *a == own && !rival(b) && !tested(b)).count();
    1.0 + twins as f64 + chosen.rivals.iter().map(|(_, behind)| (-0.5 * behind).exp()).sum::<f64>()
}

/// Probability of this evidence by chance, among all candidates that were tried.
pub(crate) fn p_value(study: &Study, chosen: &Chosen) -> f64 {
    let tried = study.candidates.iter().filter(|c| c.expression.is_none()).count() as f64;
    (tried * chi_square_tail(chosen.lambda, study.candidates[chosen.candidate].cost)).min(1.0)
}

pub(crate) fn rivals(study: &Study, chosen: &Chosen) -> Vec<Alternative> {
    let own = study.candidates[chosen.candidate].id;
    let total = total_odds(study, chosen);
    let mut found: Vec<Alternative> = chosen
        .rivals
        .iter()
        .map(|(candidate, behind)| Alternative {
            id: study.candidates[*candidate].id.to_owned(),
            instead_of: own.to_owned(),
            posterior: (-0.5 * behind).exp() / total,
            why: format!("it explains this recording nearly as well (score {behind:.1} behind)"),
        })
        .collect();
    for (a, b, why) in twins() {
        // A cause that has a regressor of its own here is not equivalent here.
        if own == a && study.candidates.iter().all(|c| c.id != b) {
            found.push(Alternative {
                id: b.to_owned(),
                instead_of: own.to_owned(),
                posterior: 1.0 / total,
                why: why.to_owned(),
            });
        }
    }
    found
}

/// Unnamed cause for a generic term, with its amplitudes and gain, and the warning about it.
pub(crate) fn unnamed(study: &Study, (candidate, score): (usize, f64), (floor, unit): (f64, &str)) -> (Cause, String) {
    let picks = study.picks();
    let with: Vec<usize> = picks.iter().copied().chain([candidate]).collect();
    let term = &study.candidates[candidate];
    let expression = term.expression.as_deref().unwrap_or_default();
    let mut parameters = Vec::new();
    let mut odds = 1.0;
    if let Some(solved) = study.system.solve(&with) {
        let first = solved.values.len() - term.columns.len();
        let variance = solved.variance(study.system.rows);
        let names: &[&str] = if term.columns.len() == 2 { &["A cos phi", "A sin(-phi)"] } else { &["A"] };
        parameters.extend(names.iter().zip(first..).map(|(name, i)| {
            number(name, solved.values[i], (variance * solved.inverse[(i, i)]).sqrt(), term.linear[i - first].1)
        }));
        // Other generic terms with as small a residual.
        let others = (0..study.candidates.len()).filter(|c| study.candidates[*c].expression.is_some());
        odds = others
            .filter_map(|c| {
                let other = study.system.solve(&[picks.as_slice(), &[c]].concat())?;
                let more = study.candidates[c].cost - term.cost;
                let behind = study.system.rows * (other.rss / solved.rss).ln() + more * study.system.rows.ln();
                Some((-0.5 * behind).exp().min(1.0))
            })
            .sum();
    }
    let cause = Cause {
        id: format!("other:{expression}"),
        kind: term.kind,
        parameters,
        p_value: chi_square_tail(score, term.cost),
        posterior: 1.0 / odds.max(1.0),
        gain: Gain { unit: Some(unit.to_owned()), ..gain_between(study, &picks, &with, floor) }
            .run(Err(NO_LAW.to_owned())),
        evidence: format!("what is left goes with {expression}; no known cause does so here"),
    };
    let warning =
        format!("something is left that no known cause explains: it goes with {expression} (score {score:.0})");
    (cause, warning)
}

/// Adds the unexplained terms of paths: a comparison, its generic term and the term's evidence for each path.
pub fn add_of_path(found: &mut Diagnosis, strange: &[(Study, usize, f64)]) {
    for (study, term, score) in strange.iter().filter(|(study, _, score)| *score > study.rules.unexplained) {
        let (cause, warning) = unnamed(study, (*term, *score), (0.0, "m"));
        if found.causes.iter().all(|c| c.id != cause.id) {
            found.causes.push(cause);
            found.warnings.push(warning);
        }
        if found.verdict == Verdict::None {
            found.verdict = Verdict::Unexplained;
        }
    }
}
