//! One cause of an answer: parameters, probability, gain and evidence sentence.

use super::part::{Found, Part, Role};
use crate::diagnose::contract::{Alternative, Cause, CauseParameter, Gain, Standing, parameter};
use crate::diagnose::free_run::windows::NO_LAW;
use crate::diagnose::hypotheses::all::twins;
use crate::diagnose::selection::comparison::ChannelFit;
use crate::diagnose::selection::held_out_gain::{chi_square_tail, gain, gain_between, rms, shows_beside, whiteness_p};
use crate::diagnose::selection::profile_likelihood::parameters;
use crate::diagnose::selection::stepwise::{SelectedTerm, is_curve};
use foundation::words::amount;
use haptics::law::entries;

/// Generic term of a residual that no known cause explains.
pub struct Unnamed {
    /// The term as a cause without a name.
    pub cause: Cause,
    pub warning: String,
}

impl Part<'_> {
    /// The k-th chosen cause.
    pub fn cause(&self, k: usize) -> Cause {
        let chosen = &self.study.chosen[k];
        let candidate = &self.study.candidates[chosen.candidate];
        let gain = self.in_its_unit(gain(self.study, k, self.floor)).run(self.free_run.rollout(self.study, k));
        let parameters = self.told.states(k, candidate, parameters(self.study, k));
        let evidence = if self.role == Role::Channel {
            self.shown(&self.told.shows(&Found { candidate, parameters: &parameters }), &gain, chosen)
        } else {
            self.by_law(&gain, chosen)
        };
        let standing = self.standing(k);
        Cause {
            id: candidate.id.to_owned(),
            kind: candidate.kind,
            parameters,
            p_value: p_value(self.study, chosen),
            posterior: standing.map_or(1.0, |s| s.probability(&gain, &self.study.rules))
                / total_odds(self.study, chosen),
            standing,
            gain,
            evidence,
        }
    }

    fn standing(&self, k: usize) -> Option<Standing> {
        self.study.competition.as_ref().and_then(|c| c.causes.get(k)).copied()
    }

    /// Causes that explain the recording nearly as well as the k-th, which has this posterior.
    pub fn rivals(&self, k: usize, posterior: f64) -> Vec<Alternative> {
        rivals(self.study, &self.study.chosen[k], posterior)
    }

    /// Evidence sentence of a channel that has sentences of its own.
    fn shown(&self, shown: &str, gain: &Gain, chosen: &SelectedTerm) -> String {
        let held_out = gain.no_share.clone().unwrap_or_else(|| {
            format!(
                "on data held out{} the {} that is left goes from {} to {} RMS",
                if gain.in_turn { " of the fit in turn" } else { "" },
                self.channel,
                amount(gain.heldout_rms_before, self.unit),
                amount(gain.heldout_rms_after, self.unit)
            )
        });
        format!("{shown}; {held_out} (score {:.0})", chosen.score)
    }

    /// Evidence sentence from the catalogue's entry of a law.
    fn by_law(&self, gain: &Gain, chosen: &SelectedTerm) -> String {
        let candidate = &self.study.candidates[chosen.candidate];
        let entry = entries().find(|e| e.id == candidate.id);
        let (title, equation) = entry.map_or((candidate.id, ""), |e| (e.title, e.equation));
        let goes_with = candidate.channel.as_ref().map_or_else(String::new, |(name, _)| format!(" with {name}"));
        let stands = if shows_beside(self.study, &[chosen.candidate]) {
            " (and, in newtons, of how far it gives where it stands)"
        } else {
            ""
        };
        format!(
            "{title}: what the model leaves of the {} follows {equation}{goes_with}; on data held out it{stands} goes from {} to {} RMS (score \
             {:.0}, {:.0} would do){}",
            self.channel,
            amount(gain.heldout_rms_before, self.unit),
            amount(gain.heldout_rms_after, self.unit),
            chosen.score,
            self.study.rules.threshold,
            self.told.adds(candidate)
        )
    }

    /// Strongest generic term of the residual that no known cause explains.
    pub fn unnamed(&self) -> Option<Unnamed> {
        let study = self.terms?;
        let rules = &study.rules;
        let (term, score) = unexplained(study)?;
        // If the final residual is small, a generic term may be a small misfit of a strong cause's curve. It is then
        // not reported.
        let misses = |c: &SelectedTerm| is_curve(study.candidates[c.candidate].id) && score < rules.remainder * c.score;
        if self.role == Role::Channel
            && rules.much.is_some()
            && self.much_left().is_none()
            && study.chosen.iter().any(misses)
        {
            return None;
        }
        let with = [study.picks(), vec![term]].concat();
        let gain = gain_between(study, &study.picks(), &with, self.floor);
        // A term that does not reduce the held-out residual is noise.
        if gain.no_share.is_none() && gain.share_of_explainable <= rules.least_share {
            return None;
        }
        let candidate = &study.candidates[term];
        let expression = candidate.expression.as_deref().unwrap_or_default();
        let (parameters, odds) = size_of_term(study, term);
        let of = if self.role == Role::Channel { format!(" of the {}", self.channel) } else { String::new() };
        let cause = Cause {
            id: format!("other:{expression}"),
            kind: candidate.kind,
            parameters,
            p_value: chi_square_tail(score, candidate.cost),
            posterior: 1.0 / odds.max(1.0),
            standing: None,
            gain: self.in_its_unit(gain).run(Err(NO_LAW.to_owned())),
            evidence: format!("what is left{of} goes with {expression}; no known cause does so here"),
        };
        let warning =
            format!("something is left{of} that no known cause explains: it goes with {expression} (score {score:.0})");
        Some(Unnamed { cause, warning })
    }

    /// Sentence on the final residual if it is far above the noise and not white.
    pub fn much_left(&self) -> Option<String> {
        let (study, picks) = (self.study, self.study.picks());
        let (end, _) = rms(study, &picks, self.along);
        let times = end / self.noise;
        let is_much = study.rules.much.is_some_and(|much| times > much);
        (is_much && whiteness_p(study, &picks) < study.rules.surely_not_white).then(|| {
            let left = amount(end, self.unit);
            match self.role {
                Role::Channel => format!(
                    "{left} of the {} are left, {times:.0} times its noise, and go with no known cause",
                    self.channel
                ),
                _ => format!(
                    "{left} are left, {times:.0} times the noise of the force, and go with nothing that was tried"
                ),
            }
        })
    }

    /// The gain has a unit only if rows were held out.
    fn in_its_unit(&self, gain: Gain) -> Gain {
        let unit = (gain.heldout_rms_before > 0.0).then(|| self.unit.to_owned());
        Gain { unit, ..gain }
    }
}

/// Strongest generic term of the residual that its rules do not take for an overfit, with its evidence.
pub fn unexplained(study: &ChannelFit) -> Option<(usize, f64)> {
    let (rules, picks) = (&study.rules, study.picks());
    // A term that increases the held-out residual is an overfit to a few other rows.
    let is_overfit = |term: usize| {
        let gain = gain_between(study, &picks, &[picks.as_slice(), &[term]].concat(), 0.0);
        gain.heldout_rms_after > rules.overfit * gain.heldout_rms_before
    };
    let strongest = study.of_each().unexplained(&picks);
    strongest.filter(|(term, score)| *score > rules.unexplained && !is_overfit(*term))
}

/// Amplitudes of a generic term beside the chosen causes, and the sum of the likelihoods of all such terms, relative to
/// its own.
fn size_of_term(study: &ChannelFit, term: usize) -> (Vec<CauseParameter>, f64) {
    let picks = study.picks();
    let with = |c: usize| study.system.solve(&[picks.as_slice(), &[c]].concat());
    let Some(solved) = with(term) else { return (Vec::new(), 1.0) };
    let candidate = &study.candidates[term];
    let first = solved.values.len() - candidate.regressors.len();
    let names: &[&str] = if candidate.regressors.len() == 2 { &["A cos phi", "A sin(-phi)"] } else { &["A"] };
    let parameters = names.iter().zip(first..).map(|(name, i)| {
        parameter(name, solved.values[i], solved.std_error(i, study.system.rows), candidate.linear[i - first].1)
    });
    // Other generic terms with as small a residual.
    let others = (0..study.candidates.len()).filter(|c| study.candidates[*c].expression.is_some());
    let likelihood = |c: usize| {
        let more = study.candidates[c].cost - candidate.cost;
        let behind = study.system.rows * (with(c)?.rss / solved.rss).ln() + more * study.system.rows.ln();
        Some((-0.5 * behind).exp().min(1.0))
    };
    (parameters.collect(), others.filter_map(likelihood).sum())
}

/// Sum of the likelihoods of a cause and its rivals, relative to its own. An equivalent cause counts as one.
fn total_odds(study: &ChannelFit, chosen: &SelectedTerm) -> f64 {
    let own = study.candidates[chosen.candidate].id;
    let rival = |id: &str| chosen.rivals.iter().any(|(c, _)| study.candidates[*c].id == id);
    let tested = |id: &str| study.candidates.iter().any(|c| c.id == id);
    let twins = twins().filter(|(a, b, _)| *a == own && !rival(b) && !tested(b)).count();
    1.0 + twins as f64 + chosen.rivals.iter().map(|(_, behind)| (-0.5 * behind).exp()).sum::<f64>()
}

/// Probability of this evidence by chance, among all candidates that were tried.
fn p_value(study: &ChannelFit, chosen: &SelectedTerm) -> f64 {
    let tried = study.candidates.iter().filter(|c| c.expression.is_none()).count() as f64;
    (tried * chi_square_tail(chosen.lambda, study.candidates[chosen.candidate].cost)).min(1.0)
}

/// Causes that explain the recording nearly as well as a chosen one.
fn rivals(study: &ChannelFit, chosen: &SelectedTerm, posterior: f64) -> Vec<Alternative> {
    let own = study.candidates[chosen.candidate].id;
    let alternative = |id: &str, odds: f64, why: String| Alternative {
        id: id.to_owned(),
        instead_of: own.to_owned(),
        posterior: posterior * odds,
        why,
    };
    let near = chosen.rivals.iter().map(|(c, behind)| {
        let why = format!("it explains this recording nearly as well (score {behind:.1} behind)");
        alternative(study.candidates[*c].id, (-0.5 * behind).exp(), why)
    });
    // A cause that has a regressor of its own here is not equivalent here.
    let is_twin = |(a, b, _): &(&str, &str, &str)| own == *a && study.candidates.iter().all(|c| c.id != *b);
    let twins = twins().filter(is_twin).map(|(_, b, why)| alternative(b, 1.0, why.to_owned()));
    near.chain(twins).collect()
}
