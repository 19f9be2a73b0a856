//! Builds one answer in words from comparisons of several channels.

use super::along_coordinate::{p_value, rivals, unnamed};
use super::rejected::{join, passed_over, unsaid};
use super::residual_table::residuals;
use crate::diagnose::contract::{
    Alternative, Baseline, Cause, CauseParameter, Diagnosis, Final, Gain, NextExperiment, NotExcited, PassedOver,
    Residual, Verdict,
};
use crate::diagnose::findings::{Figures, Findings};
use crate::diagnose::free_run::channel::{Forward, in_turn};
use crate::diagnose::free_run::windows::{AT_ONCE, NO_LAW};
use crate::diagnose::hypotheses::candidate::Candidate;
use crate::diagnose::selection::comparison::{Compared, Study};
use crate::diagnose::selection::estimates::parameters;
use crate::diagnose::selection::held_out_gain::{gain, rms, whiteness_p};
use crate::diagnose::selection::rules::OPEN;
use crate::diagnose::selection::stepwise::{Chosen, is_curve};
use crate::diagnose::validation::fitted_terms::of_study;
use crate::segment::SystemState;
use crate::words::amount;

/// Input of a cause's evidence sentence.
pub struct Found<'a> {
    /// The candidate that was chosen.
    pub candidate: &'a Candidate,
    /// Its parameters as the answer states them.
    pub parameters: &'a [CauseParameter],
}

/// Sentence on how the residual shows a cause.
pub type Shows<'a> = &'a dyn Fn(&Found<'_>) -> String;
/// Parameters of a cause, made from those of its regressors.
pub type States<'a> = &'a dyn Fn(&Candidate, Vec<CauseParameter>) -> Vec<CauseParameter>;
/// Usual size of a cause with its unit, for the test of excitation. None if the cause does not belong to the channel.
pub type Usual<'a> = &'a dyn Fn(&Candidate) -> Option<(f64, &'static str)>;

impl Compared {
    /// As a part of the answer.
    pub fn part<'a>(&'a self, shows: Shows<'a>, states: States<'a>, usual: Usual<'a>) -> Part<'a> {
        let Self { study, channel, unit, floor, along, state } = self;
        Part { study, channel, unit, floor: *floor, along, state, shows, states, usual, forward: Err(AT_ONCE) }
    }
}

/// One channel, compared.
pub struct Part<'a> {
    /// The comparison.
    pub study: &'a Study,
    /// Name of the channel, in words.
    pub channel: &'static str,
    /// Its unit.
    pub unit: &'a str,
    /// Noise of its rows.
    pub floor: f64,
    /// True for rows that are held out in turn.
    pub along: &'a [bool],
    /// The state of every row.
    pub state: &'a [SystemState],
    pub shows: Shows<'a>,
    pub states: States<'a>,
    pub usual: Usual<'a>,
    /// Free-run simulation of the channel, or the reason why it has none.
    pub forward: Result<&'a dyn Forward, &'static str>,
}

impl<'a> Part<'a> {
    /// Adds the free-run simulation.
    pub fn running(mut self, forward: &'a dyn Forward) -> Self {
        self.forward = Ok(forward);
        self
    }

    /// Marks the channel as static, without a free run, for this reason.
    pub fn still(mut self, why: &'static str) -> Self {
        self.forward = Err(why);
        self
    }

    fn cause(&self, k: usize, chosen: &Chosen) -> Cause {
        let candidate = &self.study.candidates[chosen.candidate];
        let forward = self.forward.map_err(str::to_owned).and_then(|forward| in_turn(self.study, forward, k));
        let gain = self.in_its_unit(gain(self.study, k, self.floor)).run(forward);
        let parameters = (self.states)(candidate, parameters(self.study, k));
        let shown = (self.shows)(&Found { candidate, parameters: &parameters });
        let held_out = if let Some(why) = &gain.no_share {
            why.clone()
        } else {
            format!(
                "on data held out{} the {} that is left goes from {} to {} RMS",
                if gain.in_turn { " of the fit in turn" } else { "" },
                self.channel,
                amount(gain.heldout_rms_before, self.unit),
                amount(gain.heldout_rms_after, self.unit)
            )
        };
        let evidence = format!("{shown}; {held_out} (score {:.0})", chosen.score);
        Cause {
            id: candidate.id.to_owned(),
            kind: candidate.kind,
            parameters,
            p_value: p_value(self.study, chosen),
            posterior: 1.0 / (1.0 + chosen.rivals.iter().map(|(_, behind)| (-0.5 * behind).exp()).sum::<f64>()),
            gain,
            evidence,
        }
    }

    /// Residual figures of the channel, without and with the causes found.
    pub fn figures(&self) -> Figures {
        let of = |picks: &[usize]| {
            let (heldout, train) = rms(self.study, picks, self.along);
            (heldout, train, whiteness_p(self.study, picks))
        };
        let (heldout_rms_n, rms_n, whiteness) = of(&[]);
        let (end, _, end_white) = of(&self.study.picks());
        Figures {
            baseline: Baseline {
                rms_n,
                heldout_rms_n,
                whiteness_p: whiteness,
                of: Some(self.channel.to_owned()),
                unit: Some(self.unit.to_owned()),
                ..Baseline::default()
            },
            end: Final { heldout_rms_n: end, whiteness_p: end_white, ..Final::default() },
            // The final residual contains the noise, so the noise floor is no larger.
            noise_floor: if end > 0.0 { self.floor.min(end) } else { self.floor },
        }
    }

    /// Residuals of the channel, state by state.
    fn residuals(&self) -> Vec<Residual> {
        residuals(self.study, (self.unit, Some(self.floor)), &|i| Some((self.channel, self.state[i])))
    }

    /// The gain has a unit only if rows were held out.
    fn in_its_unit(&self, gain: Gain) -> Gain {
        let unit = (gain.heldout_rms_before > 0.0).then(|| self.unit.to_owned());
        Gain { unit, ..gain }
    }

    /// Strongest generic term of the residual, as a cause without a name, with its warning.
    fn unnamed(&self) -> Option<(Cause, String)> {
        let (candidate, score) = self.strange()?;
        // If the final residual is small, a generic term may be a small misfit of a strong cause's curve. It is then
        // not reported.
        let misses = |c: &Chosen| {
            is_curve(self.study.candidates[c.candidate].id) && score < self.study.rules.remainder * c.score
        };
        if self.study.rules.much.is_some() && self.much_left().is_none() && self.study.chosen.iter().any(misses) {
            return None;
        }
        let (cause, _) = unnamed(self.study, (candidate, score), (self.floor, self.unit));
        // A term that does not reduce the held-out residual is noise.
        if cause.gain.no_share.is_none() && cause.gain.share_of_explainable <= 0.0 {
            return None;
        }
        let expression = cause.id.trim_start_matches("other:").to_owned();
        let channel = self.channel;
        let warning = format!(
            "something is left of the {channel} that no known cause explains: it goes with {expression} (score {score:.0})"
        );
        let evidence = format!("what is left of the {channel} goes with {expression}; no known cause does so here");
        let gain = self.in_its_unit(cause.gain).run(Err(NO_LAW.to_owned()));
        Some((Cause { gain, evidence, ..cause }, warning))
    }

    /// Sentence on the final residual if it is far above the noise and not white.
    fn much_left(&self) -> Option<String> {
        let picks = self.study.picks();
        let (end, _) = rms(self.study, &picks, self.along);
        let times = end / self.floor;
        let is_much = self.study.rules.much.is_some_and(|much| times > much);
        (is_much && whiteness_p(self.study, &picks) < self.study.rules.surely_not_white).then(|| {
            let left = amount(end, self.unit);
            format!("{left} of the {} are left, {times:.0} times its noise, and go with no known cause", self.channel)
        })
    }

    /// Strongest generic term of the residual, with its evidence.
    fn strange(&self) -> Option<(usize, f64)> {
        let strongest = self.study.of_each().unexplained(&self.study.picks());
        strongest.filter(|(_, score)| *score > self.study.rules.unexplained)
    }

    /// Causes of usual size whose effect this recording would hide.
    fn not_excited(&self, found: &mut Vec<NotExcited>) {
        let Study { system, candidates, solved, rules, .. } = self.study;
        let picks = self.study.picks();
        let Some(solved) = solved else { return };
        let variance = solved.variance(system.rows);
        let mut best: Vec<(&str, f64, &str)> = Vec::new();
        for (k, candidate) in candidates.iter().enumerate() {
            let Some((size, why)) = (self.usual)(candidate) else { continue };
            let first = system.places[k].start;
            let power = system.distinct(k, &picks) * system.train[(first, first)] * size * size / variance;
            match best.iter_mut().find(|b| b.0 == candidate.id) {
                Some(held) => held.1 = held.1.max(power),
                None => best.push((candidate.id, power, why)),
            }
        }
        for (id, power, why) in best {
            let named = picks.iter().any(|p| candidates[*p].id == id);
            if power < rules.visible && !named && found.iter().all(|n| n.id != id) {
                found.push(NotExcited { id: id.to_owned(), why: why.to_owned() });
            }
        }
    }
}

/// Parts of an answer that do not come from a comparison.
#[derive(Default)]
pub struct Beside {
    /// Name of the base model.
    pub model: String,
    /// Faults of the samples, and causes found by other tests. They come first.
    pub causes: Vec<Cause>,
    pub alternatives: Vec<Alternative>,
    pub not_excited: Vec<NotExcited>,
    pub warnings: Vec<String>,
}

/// Channel of the baseline and final figures: that of the strongest cause, or the first one if there is none.
fn told<'a, 'b>(parts: &'b [Part<'a>]) -> Option<&'b Part<'a>> {
    let strongest = |part: &Part<'_>| part.study.chosen.iter().map(|c| c.score).fold(0.0, f64::max);
    // Of equal ones, the last would be taken.
    parts.iter().rev().max_by(|a, b| strongest(a).total_cmp(&strongest(b)))
}

/// Verdict of the answer: true arguments mean that a cause is named, that a term has no name, that a name is ambiguous.
pub fn verdict(is_named: bool, is_strange: bool, is_open: bool) -> Verdict {
    match (is_named, is_strange) {
        (false, false) => Verdict::None,
        (false, true) => Verdict::Unexplained,
        (true, _) if is_open => Verdict::Ambiguous,
        (true, _) => Verdict::Causes,
    }
}

/// Adds a cause of a channel, or merges it into an earlier one of the same id. The name stays, the parameters and
/// evidence of both channels are kept.
fn add(found: &mut Vec<(f64, Cause)>, score: f64, cause: Cause) -> bool {
    let Some((_, held)) = found.iter_mut().find(|(_, c)| c.id == cause.id) else {
        found.push((score, cause));
        return true;
    };
    let named = |p: &CauseParameter| held.parameters.iter().all(|q| q.name != p.name);
    let more: Vec<CauseParameter> = cause.parameters.into_iter().filter(named).collect();
    held.parameters.extend(more);
    held.evidence = format!("{}; and {}", held.evidence, cause.evidence);
    false
}

/// The answer of several channels.
pub fn answer(parts: &[Part<'_>], beside: Beside, next: &dyn Fn(&[Alternative]) -> Option<NextExperiment>) -> Findings {
    let Beside { model, mut causes, mut alternatives, mut not_excited, mut warnings } = beside;
    let (mut strange, mut much) = (Vec::new(), Vec::new());
    let mut found: Vec<(f64, Cause)> = Vec::new();
    let mut passed: Vec<PassedOver> = Vec::new();
    for part in parts {
        for (k, chosen) in part.study.chosen.iter().enumerate() {
            let cause = part.cause(k, chosen);
            if !add(&mut found, chosen.score, cause) {
                continue;
            }
            alternatives.extend(rivals(part.study, chosen));
        }
        strange.extend(part.unnamed());
        much.extend(part.much_left());
        part.not_excited(&mut not_excited);
        join(&mut passed, passed_over(part.study, part.study.rules.unexplained));
    }
    found.sort_by(|a, b| b.0.total_cmp(&a.0));
    causes.extend(found.into_iter().map(|(_, cause)| cause));
    alternatives.retain(|a| causes.iter().all(|c| c.id != a.id));
    not_excited.retain(|n| causes.iter().all(|c| c.id != n.id) && alternatives.iter().all(|a| a.id != n.id));
    let passed = unsaid(passed, &causes, &alternatives, &not_excited);
    let open: Vec<Alternative> = alternatives.iter().filter(|a| a.posterior > OPEN).cloned().collect();
    let verdict = verdict(!causes.is_empty(), !strange.is_empty() || !much.is_empty(), !open.is_empty());
    warnings.extend(much);
    for (cause, warning) in strange {
        causes.push(cause);
        warnings.push(warning);
    }
    let Figures { baseline, end, noise_floor } = told(parts).map_or_else(Figures::of_nothing, Part::figures);
    let diagnosis = Diagnosis {
        verdict,
        baseline: Baseline { model, ..baseline },
        noise_floor_n: noise_floor,
        residuals: parts.iter().flat_map(Part::residuals).collect(),
        next_experiment: next(&open),
        causes,
        alternatives,
        not_excited,
        passed_over: passed,
        end,
        warnings,
        ..Diagnosis::default()
    };
    let kept = parts.iter().flat_map(|p| of_study(p.channel, p.study)).collect();
    Findings { diagnosis, kept, ..Findings::default() }
}
