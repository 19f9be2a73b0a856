//! Agreement of a segmentation with the labels that a person or a generator added to a recording. Labels are compared
//! here and nowhere else: nothing is ever estimated from them.

use super::agreement::{Score, StateScore};
use super::segmentation::Segmentation;
use foundation::signal::task::times;
use foundation::tasks::SystemState;
use haptics::recording::{Recording, Task};
use std::collections::BTreeMap;

/// Largest distance of a boundary from the labelled one to be found, s.
const TOLERANCE_S: f64 = 0.1;
/// The same distance in samples of a slow log.
const TOLERANCE_SAMPLES: f64 = 1.5;

/// The state of a label. The generator calls a switch that is touched `pushing`.
fn state_of(label: &str) -> Option<SystemState> {
    match label {
        "pushing" => Some(SystemState::Turning),
        _ => SystemState::ALL.into_iter().find(|state| state.name() == label),
    }
}

/// Scores a segmentation; nothing for a recording without labels that name states.
pub fn score(recording: &Recording, found: &Segmentation) -> Option<Score> {
    let labels = recording.labels.as_ref().filter(|labels| labels.len() == recording.len())?;
    let mut unknown_labels: Vec<String> = Vec::new();
    let mut truth: Vec<Option<SystemState>> = Vec::with_capacity(labels.len());
    for (span, label) in labels.spans() {
        let state = state_of(label);
        if state.is_none() && !label.is_empty() && !unknown_labels.iter().any(|known| known == label) {
            unknown_labels.push(label.to_owned());
        }
        truth.extend(std::iter::repeat_n(state, span.len()));
    }
    if truth.iter().all(Option::is_none) {
        return None;
    }
    // Labels that only say whether a handle is held say nothing of turning and holding it still.
    let moved = matches!(found.like()?, Task::Crank | Task::Mechanism | Task::Switch | Task::Payload);
    let apart = truth.contains(&Some(SystemState::Holding));
    let one = |state: SystemState| match state {
        SystemState::Holding if moved && !apart => SystemState::Turning,
        state => state,
    };
    let claims: Vec<SystemState> = found.per_sample(truth.len()).into_iter().map(one).collect();
    let (states, samples, right) = by_state(&truth, &claims);
    let time_s = times(recording);
    let step = recording.rate_hz().map_or(1.0, |rate| 1.0 / rate);
    let tolerance_s = TOLERANCE_S.max(TOLERANCE_SAMPLES * step);
    let known: Vec<SystemState> = truth.iter().map(|state| state.unwrap_or(SystemState::NoState)).collect();
    // Samples without a label are not compared.
    let labelled =
        |(label, claim): (&Option<SystemState>, &SystemState)| label.map_or(SystemState::NoState, |_| *claim);
    let compared: Vec<SystemState> = truth.iter().zip(&claims).map(labelled).collect();
    let (wanted, got) = (boundaries(&time_s, &known, tolerance_s), boundaries(&time_s, &compared, tolerance_s));
    let mut errors = paired(&wanted, &got, tolerance_s);
    errors.sort_by(f64::total_cmp);
    let both = wanted.len() + got.len();
    Some(Score {
        samples,
        accuracy: right as f64 / samples.max(1) as f64,
        states,
        boundary_f1: if both == 0 { 1.0 } else { 2.0 * errors.len() as f64 / both as f64 },
        tolerance_s,
        boundary_error_s: errors.get(errors.len() / 2).copied(),
        boundaries: wanted.len(),
        as_one: if moved && !apart { vec!["turning".to_owned(), "holding".to_owned()] } else { Vec::new() },
        unknown_labels,
    })
}

/// The agreement of every state, and samples and right ones in all.
fn by_state(truth: &[Option<SystemState>], claims: &[SystemState]) -> (BTreeMap<String, StateScore>, usize, usize) {
    let mut scores: BTreeMap<String, StateScore> = BTreeMap::new();
    let (mut samples, mut all_right) = (0, 0);
    for state in SystemState::ALL {
        let mut score = StateScore::default();
        for (label, claim) in truth.iter().zip(claims).filter_map(|(label, claim)| Some(((*label)?, *claim))) {
            score.labelled += usize::from(label == state);
            score.found += usize::from(claim == state);
            score.right += usize::from(label == state && claim == state);
        }
        samples += score.labelled;
        all_right += score.right;
        if score.labelled + score.found > 0 {
            score.f1 = 2.0 * score.right as f64 / (score.labelled + score.found) as f64;
            scores.insert(state.name().to_owned(), score);
        }
    }
    (scores, samples, all_right)
}

/// Changes of state, s, with the new state. Stays that are shorter belong to the state before; samples without a state
/// are divided between their neighbours.
fn boundaries(time_s: &[f64], states: &[SystemState], shortest_s: f64) -> Vec<(f64, SystemState)> {
    let end = |i: usize| time_s.get(i).copied().unwrap_or(time_s[time_s.len() - 1]);
    let mut stays: Vec<(SystemState, f64, f64)> = Vec::new();
    for run in states.chunk_by(|a, b| a == b).scan(0, |first, run| {
        let start = *first;
        *first += run.len();
        Some((run[0], start, *first))
    }) {
        let (state, from, to) = (run.0, end(run.1), end(run.2));
        match stays.last_mut() {
            _ if state == SystemState::NoState => {}
            Some(last) if last.0 == state => last.2 = to,
            Some(_) if to - from < shortest_s => {}
            _ => stays.push((state, from, to)),
        }
    }
    stays.windows(2).map(|pair| (0.5 * (pair[0].2 + pair[1].1), pair[1].0)).collect()
}

/// Distances of boundaries that belong together: into the same state and within the tolerance, every one used once, s.
fn paired(wanted: &[(f64, SystemState)], got: &[(f64, SystemState)], tolerance_s: f64) -> Vec<f64> {
    let mut used = vec![false; got.len()];
    let mut errors = Vec::new();
    for (time, state) in wanted {
        let near = |(_, (t, s)): &(usize, &(f64, SystemState))| s == state && (t - time).abs() <= tolerance_s + 1e-9;
        let free = got.iter().enumerate().filter(|(at, _)| !used[*at]).filter(near);
        if let Some((at, (found, _))) = free.min_by(|a, b| (a.1.0 - time).abs().total_cmp(&(b.1.0 - time).abs())) {
            used[at] = true;
            errors.push((found - time).abs());
        }
    }
    errors
}

#[cfg(test)]
mod tests;
