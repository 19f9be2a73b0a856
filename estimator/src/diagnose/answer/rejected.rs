//! Causes that were not named, with the reason: evidence of each alone, and beside the causes found.

use crate::diagnose::contract::{Alternative, Cause, NotExcited, PassedOver};
use crate::diagnose::selection::comparison::ChannelFit;
use haptics::law::cause;

/// Causes that could have shown in this channel and were not chosen, those that would have explained most first.
pub fn passed_over(study: &ChannelFit) -> Vec<PassedOver> {
    let ChannelFit { system, candidates, .. } = study;
    let picks = study.picks();
    let mut ids: Vec<&str> = Vec::new();
    for (c, candidate) in candidates.iter().enumerate() {
        let known = candidate.expression.is_none() && system.supported(c) && cause(candidate.id).is_some();
        if known && !ids.contains(&candidate.id) && picks.iter().all(|p| candidates[*p].id != candidate.id) {
            ids.push(candidate.id);
        }
    }
    let mut all: Vec<PassedOver> = ids.into_iter().map(|id| one(study, &picks, id)).collect();
    all.sort_by(|a, b| b.alone.max(b.beside).total_cmp(&a.alone.max(a.beside)));
    all
}

/// Adds the causes of another channel. A cause that is in both keeps the entry with more evidence.
pub fn join(all: &mut Vec<PassedOver>, more: Vec<PassedOver>) {
    for passed in more {
        match all.iter_mut().find(|p| p.id == passed.id) {
            Some(held) if held.beside >= passed.beside => {}
            Some(held) => *held = passed,
            None => all.push(passed),
        }
    }
}

/// Removes those that the answer already mentions.
pub fn unsaid(
    mut all: Vec<PassedOver>,
    causes: &[Cause],
    alternatives: &[Alternative],
    not_excited: &[NotExcited],
) -> Vec<PassedOver> {
    let named = |id: &str| causes.iter().any(|c| c.id == id) || alternatives.iter().any(|a| a.id == id);
    all.retain(|p| !named(&p.id) && not_excited.iter().all(|n| n.id != p.id));
    all
}

fn one(study: &ChannelFit, picks: &[usize], id: &str) -> PassedOver {
    let ChannelFit { system, candidates, .. } = study;
    let selection = study.of_each();
    let of = |c: &usize| candidates[*c].id == id && system.supported(*c);
    let best = |with: &[usize]| {
        let scores = (0..candidates.len()).filter(of).filter_map(|c| selection.score_beside(with, c));
        scores.max_by(f64::total_cmp)
    };
    let (alone, beside) = (best(&[]), best(picks));
    let why = match (alone, beside) {
        (None, None) => "it would need a sign that it cannot have".to_owned(),
        _ => words(study, picks, alone.unwrap_or(f64::NEG_INFINITY), beside),
    };
    // Evidence that cannot be computed counts as zero.
    let shown = |score: Option<f64>| score.unwrap_or(0.0);
    PassedOver { id: id.to_owned(), alone: shown(alone), beside: shown(beside), least: study.rules.threshold, why }
}

fn words(study: &ChannelFit, picks: &[usize], alone: f64, beside: Option<f64>) -> String {
    let names: Vec<String> = picks.iter().map(|p| study.candidates[*p].id.replace('-', " ")).collect();
    let found = if names.is_empty() { "the model".to_owned() } else { names.join(" and ") };
    let (least, verb) = (study.rules.threshold, if names.len() > 1 { "explain" } else { "explains" });
    match beside {
        Some(beside) if beside >= least => format!(
            "beside {found} it would score {beside:.0} ({least:.0} would do), but data that took no part does not gain by it, or it \
                 is what the form of another cause misses"
        ),
        Some(beside) if alone >= least => format!(
            "alone it would explain something (score {alone:.0}), but {found} {verb} it better, and beside that nothing is left for it \
                 (score {beside:.0}, {least:.0} would do)"
        ),
        None if alone >= least => format!(
            "alone it would explain something (score {alone:.0}), but beside {found} it would need a sign that it cannot have"
        ),
        _ => {
            let score = beside.unwrap_or(alone);
            format!("nothing that is left goes with it (score {score:.0}, {least:.0} would do)")
        }
    }
}
