//! Resolved questions: of several recordings of one object, those that settled an ambiguity of earlier ones.

use crate::diagnose::contract::{Diagnosis, Settled};
use crate::diagnose::findings::Findings;
use crate::diagnose::selection::rules::OPEN;
use foundation::estimate::EstimateError;
use haptics::recording::Recording;

/// Number of recordings above which they are repetitions, not answers to each other.
/// Choice: halved or doubled, none of 90 answers changes.
const MOST_RECORDINGS: usize = 8;

/// Named cause and its alternative.
type Pair = (String, String);

fn open(diagnosis: &Diagnosis) -> Vec<Pair> {
    let alternatives = diagnosis.alternatives.iter().filter(|a| a.posterior > OPEN);
    alternatives.map(|a| (a.instead_of.clone(), a.id.clone())).collect()
}

/// Questions that each recording settled. `whole`: the answer of all recordings; `ask` diagnoses the first few.
pub fn settled(
    recordings: &[Recording],
    whole: &Diagnosis,
    ask: &dyn Fn(&[Recording]) -> Result<Findings, EstimateError>,
) -> Vec<Settled> {
    let mut all = Vec::new();
    if !(2..=MOST_RECORDINGS).contains(&recordings.len()) {
        return all;
    }
    let mut unsettled: Vec<Pair> = Vec::new();
    for count in 1..=recordings.len() {
        // If the first recordings cannot be diagnosed, they leave no open question.
        let part = if count < recordings.len() { ask(&recordings[..count]).ok() } else { None };
        let made = part.as_deref().or((count == recordings.len()).then_some(whole));
        let Some(now) = made else { continue };
        let still = open(now);
        let has = |id: &str| now.causes.iter().any(|c| c.id == id);
        let settled = unsettled
            .iter()
            .filter(|(a, b)| !still.iter().any(|(c, d)| (c == a && d == b) || (c == b && d == a)))
            .filter_map(|(a, b)| match (has(a), has(b)) {
                (true, false) => Some((a, b)),
                (false, true) => Some((b, a)),
                // With both or neither, the question no longer exists.
                _ => None,
            })
            .map(|(kept, excluded)| sentence(&recordings[count - 1].name, now, kept, excluded));
        all.extend(settled);
        unsettled = still;
    }
    all
}

fn sentence(by: &str, now: &Diagnosis, kept: &str, excluded: &str) -> Settled {
    let sure = now.causes.iter().find(|c| c.id == kept).map_or(0.0, |c| c.posterior);
    Settled {
        by: by.to_owned(),
        excluded: excluded.to_owned(),
        kept: kept.to_owned(),
        why: format!(
            "before {by} it could have been {excluded} as well as {kept}; with it {kept} has a probability of {:.1} %",
            100.0 * sure
        ),
    }
}
