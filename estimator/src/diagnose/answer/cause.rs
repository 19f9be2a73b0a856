//! One cause of an answer: parameters, probability, gain and evidence sentence.

use super::part::{Found, Part, Role};
use crate::diagnose::contract::{Alternative, Cause, Gain, Standing};
use crate::diagnose::hypotheses::all::twins;
use crate::diagnose::selection::comparison::ChannelFit;
use crate::diagnose::selection::held_out_gain::{chi_square_tail, gain, rms, shows_beside, whiteness_p};
use crate::diagnose::selection::profile_likelihood::parameters;
use crate::diagnose::selection::rules::MUCH_UNSEEN;
use crate::diagnose::selection::stepwise::SelectedTerm;
use foundation::words::amount;
use haptics::law::entries;

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
            id: candidate.name(),
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
        let channel = candidate.channel.as_ref().map_or("", |(name, _)| name);
        let model = match entries().find(|e| e.id == candidate.id) {
            Some(e) if channel.is_empty() => {
                format!("{}: what the model leaves of the {} follows {}", e.title, self.channel, e.equation)
            }
            Some(e) => format!(
                "{}: what the model leaves of the {} follows {} with {channel}",
                e.title, self.channel, e.equation
            ),
            None => format!("what the model leaves of the {} goes with {channel}", self.channel),
        };
        let stands = if shows_beside(self.study, &[chosen.candidate]) {
            " (and, in newtons, of how far it gives where it stands)"
        } else {
            ""
        };
        format!(
            "{model}; on data held out it{stands} goes from {} to {} RMS (score {:.0}, {:.0} would do){}",
            amount(gain.heldout_rms_before, self.unit),
            amount(gain.heldout_rms_after, self.unit),
            chosen.score,
            self.study.rules.threshold,
            self.told.adds(candidate)
        )
    }

    /// Sentence on the final residual if it is above the noise and not white, or far above it.
    pub fn much_left(&self) -> Option<String> {
        let (study, picks) = (self.study, self.study.picks());
        let (end, _) = rms(study, &picks, self.along);
        let times = end / self.noise;
        let much = study.rules.much.filter(|much| times > *much)?;
        // Times that jitter leave a white residual, too.
        let is_far = times > MUCH_UNSEEN * much;
        (is_far || whiteness_p(study, &picks) < study.rules.surely_not_white).then(|| {
            let left = amount(end, self.unit);
            match self.role {
                Role::Channel => format!(
                    "{left} of the {} are left, {times:.0} times its noise, and go with no known cause",
                    self.channel
                ),
                _ => format!(
                    "{left} are left, {times:.0} times the noise of the {}, and go with nothing that was tried",
                    self.channel
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
    (study.candidates.len() as f64 * chi_square_tail(chosen.lambda, study.candidates[chosen.candidate].cost)).min(1.0)
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
