//! Builds one answer from the comparisons of its channels and from evidence of other kinds.

use super::cause::{Unnamed, rivals};
use super::part::{Part, Role};
use super::rejected::{join, passed_over, unsaid};
use crate::diagnose::contract::{
    Alternative, Baseline, Cause, CauseParameter, Diagnosis, NextExperiment, NotExcited, PassedOver, Verdict,
};
use crate::diagnose::findings::{Figures, Findings};
use crate::diagnose::selection::rules::OPEN;
use crate::diagnose::validation::fitted_terms::of_study;

/// What the comparisons name, and the experiment that would settle what they leave open. The task reads it by what it
/// knows beside them.
pub struct Named {
    /// Named causes, then unnamed terms.
    pub causes: Vec<Cause>,
    pub alternatives: Vec<Alternative>,
    pub not_excited: Vec<NotExcited>,
    pub next: Option<NextExperiment>,
}

/// Evidence that does not come from a comparison.
pub struct Evidence<'a> {
    /// Name of the base model.
    pub model: String,
    /// Faults of the samples, and causes found by other tests. They come first.
    pub causes: Vec<Cause>,
    pub alternatives: Vec<Alternative>,
    pub not_excited: Vec<NotExcited>,
    /// Sentences before those of the comparisons.
    pub warnings: Vec<String>,
    /// Sentences after them.
    pub remarks: Vec<String>,
    /// Causes that no motion shows unless a quantity is known, unless something else shows them.
    pub without_known: Vec<NotExcited>,
    /// Figures of the residual if there is no channel.
    pub figures: Figures,
    /// Experiment that would settle the open questions.
    pub next: &'a dyn Fn(&[Alternative]) -> Option<NextExperiment>,
    /// The task's reading of the named causes.
    pub reads: &'a dyn Fn(&mut Named),
}

impl Default for Evidence<'_> {
    fn default() -> Self {
        Self {
            model: String::new(),
            causes: Vec::new(),
            alternatives: Vec::new(),
            not_excited: Vec::new(),
            warnings: Vec::new(),
            remarks: Vec::new(),
            without_known: Vec::new(),
            figures: Figures::of_nothing(),
            next: &|_| None,
            reads: &|_| (),
        }
    }
}

/// Causes of all parts with their evidence, in the order of the answer.
#[derive(Default)]
struct Ranking(Vec<(f64, Cause)>);

impl Ranking {
    /// Adds a cause, unless it is there: then it joins that one, whose name stays, or is left out. True if it was added.
    fn add(&mut self, role: Role, score: f64, cause: Cause) -> bool {
        let all = &mut self.0;
        if let Some((_, held)) = all.iter_mut().find(|(_, c)| c.id == cause.id).filter(|_| role != Role::Coordinate) {
            if role == Role::Channel {
                let is_new = |p: &CauseParameter| held.parameters.iter().all(|q| q.name != p.name);
                let more: Vec<CauseParameter> = cause.parameters.into_iter().filter(is_new).collect();
                held.parameters.extend(more);
                held.evidence = format!("{}; and {}", held.evidence, cause.evidence);
            }
            return false;
        }
        let weaker = all.iter().position(|(other, _)| *other < score).filter(|_| role != Role::Coordinate);
        all.insert(weaker.unwrap_or(all.len()), (score, cause));
        true
    }
}

/// The answer of one or several channels.
pub fn answer(parts: &[Part<'_>], evidence: Evidence<'_>) -> Findings {
    let Evidence { model, mut causes, mut alternatives, mut not_excited, mut warnings, remarks, .. } = evidence;
    let (mut ranking, mut passed) = (Ranking::default(), Vec::<PassedOver>::new());
    for part in parts {
        for (k, chosen) in part.study.chosen.iter().enumerate() {
            if let Some(excuse) = (part.excuse)(k) {
                warnings.push(excuse);
            } else if ranking.add(part.role, chosen.score, part.cause(k)) {
                alternatives.extend(rivals(part.study, chosen));
            }
        }
        if part.role != Role::Path {
            let mut more = part.not_excited();
            more.retain(|n| not_excited.iter().all(|other| other.id != n.id));
            not_excited.extend(more);
            join(&mut passed, passed_over(part.study));
        }
    }
    causes.extend(ranking.0.into_iter().map(|(_, cause)| cause));
    let unnamed: Vec<Option<Unnamed>> = parts.iter().map(Part::unnamed).collect();
    let much = much_left(parts, &unnamed, causes.is_empty());
    let is_strange = !much.is_empty() || unnamed.iter().any(Option::is_some);
    warnings.extend(much);
    alternatives.retain(|a| causes.iter().all(|c| c.id != a.id));
    not_excited.retain(|n| !is_said(&n.id, &causes, &alternatives));
    let without_known = evidence.without_known.into_iter();
    let is_new =
        |n: &NotExcited| !is_said(&n.id, &causes, &alternatives) && not_excited.iter().all(|other| other.id != n.id);
    let more: Vec<NotExcited> = without_known.filter(is_new).collect();
    not_excited.extend(more);
    let passed_over = unsaid(passed, &causes, &alternatives, &not_excited);
    let terms = add_terms(parts, unnamed, &mut causes, &mut warnings);
    warnings.extend(remarks);
    let open = |alternatives: &[Alternative]| -> Vec<Alternative> {
        let limit = parts.first().map_or(OPEN, |p| p.study.rules.open);
        alternatives.iter().filter(|a| a.posterior > limit).cloned().collect()
    };
    let next = (evidence.next)(&open(&alternatives));
    let mut named = Named { causes, alternatives, not_excited, next };
    (evidence.reads)(&mut named);
    let Named { causes, alternatives, not_excited, next } = named;
    let is_named = causes.iter().any(|c| !terms.contains(&c.id));
    let Figures { baseline, end, noise_floor } = told(parts).map_or(evidence.figures, Part::figures);
    let diagnosis = Diagnosis {
        verdict: verdict(is_named, is_strange, !open(&alternatives).is_empty()),
        baseline: Baseline { model, ..baseline },
        noise_floor_n: noise_floor,
        residuals: parts.iter().flat_map(Part::residuals).collect(),
        causes,
        alternatives,
        not_excited,
        passed_over,
        next_experiment: next,
        end,
        warnings,
        ..Diagnosis::default()
    };
    let kept = parts.iter().filter(|p| p.role != Role::Path).flat_map(|p| of_study(p.channel, p.study)).collect();
    Findings { diagnosis, kept, ..Findings::default() }
}

/// Sentences on residuals far above the noise. Along one coordinate, a cause or an unnamed term explains them.
fn much_left(parts: &[Part<'_>], unnamed: &[Option<Unnamed>], no_cause: bool) -> Vec<String> {
    let of = |(part, unnamed): (&Part<'_>, &Option<Unnamed>)| {
        let counts = match part.role {
            Role::Channel => true,
            Role::Coordinate => no_cause && unnamed.is_none(),
            Role::Path => false,
        };
        if counts { part.much_left() } else { None }
    };
    parts.iter().zip(unnamed).filter_map(of).collect()
}

/// Adds the unnamed terms as causes with their warnings, and returns their ids.
fn add_terms(
    parts: &[Part<'_>],
    unnamed: Vec<Option<Unnamed>>,
    causes: &mut Vec<Cause>,
    warnings: &mut Vec<String>,
) -> Vec<String> {
    let mut terms: Vec<String> = Vec::new();
    for (part, Unnamed { cause, warning }) in parts.iter().zip(unnamed).filter_map(|(part, u)| Some((part, u?))) {
        if part.role == Role::Channel || !terms.contains(&cause.id) {
            terms.push(cause.id.clone());
            causes.push(cause);
            warnings.push(warning);
        }
    }
    terms
}

/// True if the answer mentions this cause as named or as possible.
fn is_said(id: &str, causes: &[Cause], alternatives: &[Alternative]) -> bool {
    causes.iter().any(|c| c.id == id) || alternatives.iter().any(|a| a.id == id)
}

/// Channel of the baseline and final figures: that of the strongest cause, or the first one if there is none.
fn told<'a, 'b>(parts: &'b [Part<'a>]) -> Option<&'b Part<'a>> {
    // Of equal ones, the last would be taken.
    let channels = parts.iter().rev().filter(|p| p.role != Role::Path);
    channels.max_by(|a, b| a.strongest().total_cmp(&b.strongest()))
}

/// Verdict of the answer: a cause is named, a term has no name, a name is ambiguous.
fn verdict(is_named: bool, is_strange: bool, is_open: bool) -> Verdict {
    match (is_named, is_strange) {
        (false, false) => Verdict::None,
        (false, true) => Verdict::Unexplained,
        (true, _) if is_open => Verdict::Ambiguous,
        (true, _) => Verdict::Causes,
    }
}
