//! Builds one answer from the comparisons of its channels and from evidence of other kinds.
//!
//! Causes that were not named, with the reason: evidence of each alone, and beside the causes found.

use super::atlas::Atlas;
use super::named::Named;
use super::part::{Part, Role};
use super::put_back::PutBack;
use crate::diagnose::contract::{
    Alternative, Cause, CauseParameter, Diagnosis, NextExperiment, NotExcited, PassedOver, Verdict, is_certain,
};
use crate::diagnose::data::limits::HALF;
use crate::diagnose::extension::hypothetical_worlds::of_channels;
use crate::diagnose::findings::{DelayFindings, Figures, Findings};
use crate::diagnose::hypotheses::candidate::Candidate;
use crate::diagnose::selection::comparison::ChannelFit;
use crate::diagnose::selection::rules::OPEN;
use crate::diagnose::validation::on_other_recordings::of_study;
use haptics::law::cause;

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
    /// True if something was compared beside the channels.
    pub is_compared: bool,
    /// Experiment that would settle the open questions.
    pub next: &'a dyn Fn(&[Alternative]) -> Option<NextExperiment>,
    /// True if the residual of each channel is shown beside every suspect.
    pub atlas: bool,
    /// True if the model without any cause is kept.
    pub twins: bool,
    pub delay: DelayFindings,
    /// Part of a sample by which motion and forces were shifted together before the comparison, s.
    pub skew_s: f64,
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
            is_compared: false,
            figures: Figures::of_nothing(),
            next: &|_| None,
            atlas: false,
            twins: false,
            delay: DelayFindings::default(),
            skew_s: 0.0,
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
    draft(parts, evidence).finish(None)
}

/// An answer before its verdict. A task reads what is named by what it knows beside the comparisons.
pub struct Draft {
    pub named: Named,
    /// Everything else.
    pub findings: Findings,
    figures: Figures,
    /// Ids of the causes without a law.
    terms: Vec<String>,
    /// Probability above which an alternative is open.
    open: f64,
    /// True if more of the residuals is unexplained than noise.
    is_strange: bool,
    /// True if the recording can tell no cause for certain.
    is_doubtful: bool,
    /// Ids of the causes that have less power together than the structured errors of their channel.
    outweighed: Vec<String>,
}

/// Findings of the comparisons and of the evidence beside them, without a verdict.
pub fn draft(parts: &[Part<'_>], evidence: Evidence<'_>) -> Draft {
    let Evidence { model, mut causes, mut alternatives, not_excited, mut warnings, remarks, is_compared, .. } =
        evidence;
    let compared = compare(parts, not_excited);
    warnings.extend(compared.excuses);
    causes.extend(compared.ranking.0.into_iter().map(|(_, cause)| cause));
    alternatives.extend(compared.alternatives);
    alternatives.retain(|a| causes.iter().all(|c| c.id != a.id));
    let is_said = |id: &str| causes.iter().any(|c| c.id == id) || alternatives.iter().any(|a| a.id == id);
    let mut not_excited = compared.not_excited;
    not_excited.retain(|n| !is_said(&n.id));
    let unknown = evidence.without_known.into_iter().filter(|n| !is_said(&n.id));
    add_new(&mut not_excited, unknown.collect());
    let passed_over = unsaid(compared.passed, &causes, &alternatives, &not_excited);
    let left = left_over(parts, causes.is_empty());
    let is_strange = !left.is_empty();
    warnings.extend(left.into_iter().chain(remarks));
    let chosen = parts.iter().flat_map(|p| p.study.picks().into_iter().map(|pick| &p.study.candidates[pick]));
    let terms = chosen.filter(|c| c.expression.is_some()).map(Candidate::name).collect();
    let limit = parts.first().map_or(OPEN, |p| p.study.rules.open);
    let open: Vec<Alternative> = alternatives.iter().filter(|a| a.posterior > limit).cloned().collect();
    let next = (evidence.next)(&open);
    let told = told(parts);
    let mut figures = told.map_or(evidence.figures, Part::figures);
    let model_error = told.and_then(Part::model_error);
    let outweighed = parts.iter().flat_map(Part::outweighed).collect();
    figures.baseline.model = model;
    let residuals = parts.iter().flat_map(Part::residuals).collect();
    let atlas = if evidence.atlas { parts.iter().filter_map(Part::atlas).collect() } else { Vec::new() };
    let simulated: Vec<_> = parts.iter().filter_map(|p| Some((p.study, p.in_world?))).collect();
    let findings = Findings {
        diagnosis: Diagnosis { residuals, model_error, warnings, ..Diagnosis::default() },
        kept: parts.iter().filter(|p| p.role != Role::Path).flat_map(|p| of_study(p.channel, p.study)).collect(),
        delay: DelayFindings { whole: parts.first().and_then(Part::evidence), ..evidence.delay },
        skew_s: evidence.skew_s,
        hypotheses: of_channels(&simulated),
        atlas: Atlas { channels: atlas, ..Atlas::default() },
        ..Findings::default()
    };
    let named = Named { causes, alternatives, not_excited, passed_over, next };
    Draft {
        named,
        findings,
        figures,
        terms,
        open: limit,
        is_strange,
        is_doubtful: parts.is_empty() && !is_compared,
        outweighed,
    }
}

impl Draft {
    /// Makes every cause of the comparisons uncertain, for this reason.
    pub fn doubt(&mut self, why: String) {
        self.is_doubtful = true;
        self.findings.diagnosis.warnings.insert(0, why);
        let Named { causes, alternatives, .. } = &mut self.named;
        for cause in causes.iter_mut().filter(|c| c.standing.is_some()) {
            cause.posterior *= HALF;
            let own = alternatives.iter_mut().filter(|a| a.instead_of == cause.id);
            own.for_each(|a| a.posterior *= HALF);
        }
    }

    /// The answer with its verdict. `put_back`: shift of the forces before the comparison.
    pub fn finish(self, put_back: Option<&PutBack<'_>>) -> Findings {
        let Self { mut named, mut findings, mut figures, terms, open, is_strange, is_doubtful, outweighed } = self;
        if let Some(put_back) = put_back {
            figures = put_back.name(&mut named, &mut findings.delay, figures);
        }
        named.certain_first();
        let is_open = named.is_open(open);
        let Named { causes, alternatives, not_excited, passed_over, next } = named;
        let first = causes.iter().find(|c| !terms.contains(&c.id));
        let carries_less = |c: &Cause| outweighed.contains(&c.id);
        let is_certain = first.is_some_and(|c| is_certain(c, &alternatives) && !carries_less(c));
        let is_strange = is_strange || !causes.is_empty();
        findings.diagnosis = Diagnosis {
            verdict: if is_doubtful && !is_certain {
                Verdict::Ambiguous
            } else {
                verdict(is_certain, is_strange, is_open)
            },
            baseline: figures.baseline,
            end: figures.end,
            noise_floor_n: figures.noise_floor,
            causes,
            alternatives,
            not_excited,
            passed_over,
            next_experiment: next,
            ..findings.diagnosis
        };
        findings
    }
}

/// Results of the comparisons of all parts.
struct Compared {
    ranking: Ranking,
    alternatives: Vec<Alternative>,
    not_excited: Vec<NotExcited>,
    passed: Vec<PassedOver>,
    /// Warnings about chosen terms that are no causes.
    excuses: Vec<String>,
}

/// `not_excited`: causes that the task knows to be hidden.
fn compare(parts: &[Part<'_>], not_excited: Vec<NotExcited>) -> Compared {
    let (ranking, alternatives, passed, excuses) = (Ranking::default(), Vec::new(), Vec::new(), Vec::new());
    let mut all = Compared { ranking, alternatives, not_excited, passed, excuses };
    for part in parts {
        for (k, chosen) in part.study.chosen.iter().enumerate() {
            if !part.told.is_cause(k) {
                all.excuses.extend(part.told.excuse(k));
                continue;
            }
            let cause = part.cause(k);
            let rivals = part.rivals(k, cause.posterior);
            if all.ranking.add(part.role, chosen.score, cause) {
                all.alternatives.extend(rivals);
            }
        }
        if part.role != Role::Path {
            add_new(&mut all.not_excited, part.not_excited());
            join(&mut all.passed, passed_over(part.study));
        }
    }
    all
}

/// Adds the causes that are not there yet.
fn add_new(all: &mut Vec<NotExcited>, mut more: Vec<NotExcited>) {
    more.retain(|n| all.iter().all(|other| other.id != n.id));
    all.append(&mut more);
}

/// Sentences on the parts of the residuals that no known cause explains. `is_nothing_named`: a large residual along a
/// coordinate is then told.
fn left_over(parts: &[Part<'_>], is_nothing_named: bool) -> Vec<String> {
    let much = |part: &Part<'_>| match part.role {
        Role::Coordinate if !is_nothing_named => None,
        Role::Channel | Role::Coordinate | Role::Path => part.much_left(),
    };
    parts.iter().filter_map(|part| part.structured().or_else(|| much(part))).collect()
}

/// Channel of the baseline and final figures: that of the strongest cause, or the first one if there is none.
fn told<'a, 'b>(parts: &'b [Part<'a>]) -> Option<&'b Part<'a>> {
    // Of equal ones, the last would be taken.
    let channels = parts.iter().rev().filter(|p| p.role != Role::Path);
    channels.max_by(|a, b| a.strongest().total_cmp(&b.strongest()))
}

/// Verdict of the answer. `is_certain`: of its first cause. `is_strange`: something has no certain name.
fn verdict(is_certain: bool, is_strange: bool, is_open: bool) -> Verdict {
    match (is_certain, is_strange) {
        (false, false) => Verdict::None,
        (false, true) => Verdict::Unexplained,
        (true, _) if is_open => Verdict::Ambiguous,
        (true, _) => Verdict::Causes,
    }
}

/// Causes that could have shown in this channel and were not chosen, those that would have explained most first.
pub fn passed_over(study: &ChannelFit) -> Vec<PassedOver> {
    let ChannelFit { system, candidates, .. } = study;
    let picks = study.picks();
    let mut ids: Vec<&str> = Vec::new();
    for (c, candidate) in candidates.iter().enumerate() {
        let known = system.supported(c) && cause(candidate.id).is_some();
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
