//! One compared channel as a part of an answer.

use super::cause::Found;
use super::residual_table::residuals;
use crate::diagnose::contract::{Baseline, CauseParameter, Final, NotExcited, Residual};
use crate::diagnose::findings::Figures;
use crate::diagnose::free_run::FreeRun;
use crate::diagnose::free_run::channel::Forward;
use crate::diagnose::free_run::windows::AT_ONCE;
use crate::diagnose::hypotheses::candidate::Candidate;
use crate::diagnose::selection::comparison::{ChannelFit, Compared};
use crate::diagnose::selection::held_out_gain::{rms, whiteness_p};
use foundation::tasks::SystemState;
use haptics::law::entries;

/// Sentence on how the residual shows a cause.
pub type Shows<'a> = &'a dyn Fn(&Found<'_>) -> String;
/// Parameters of the k-th chosen cause, made from those of its regressors.
pub type States<'a> = &'a dyn Fn(usize, &Candidate, Vec<CauseParameter>) -> Vec<CauseParameter>;
/// Usual size of a cause, and the experiment that would show it. `None` if the cause does not belong to the channel.
pub type Usual<'a> = &'a dyn Fn(&Candidate) -> Option<(f64, &'static str)>;
/// Channel and state of a row; `None` for a row of no channel.
pub type State<'a> = Box<dyn Fn(usize) -> Option<(&'static str, SystemState)> + 'a>;
/// Warning about the k-th chosen term if it is no cause.
pub type Excuse<'a> = &'a dyn Fn(usize) -> Option<String>;

/// Role of a channel in the answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// One of several channels: its causes stand by their evidence, and join one that another channel shows.
    Channel,
    /// The force along a coordinate: its causes stand in the order of their selection.
    Coordinate,
    /// A path beside it: its causes stand by their evidence, unless they are named already.
    Path,
}

/// One channel, compared.
pub struct Part<'a> {
    pub role: Role,
    /// The comparison.
    pub study: &'a ChannelFit,
    /// The comparison with the generic terms of the residual, if there are any.
    pub terms: Option<&'a ChannelFit>,
    /// Name of the channel, in words.
    pub channel: &'static str,
    /// Its unit.
    pub unit: &'a str,
    /// Noise of its rows: no cause can explain it.
    pub floor: f64,
    /// Noise to which the final residual is compared.
    pub noise: f64,
    /// True for rows that are held out in turn.
    pub along: &'a [bool],
    pub state: State<'a>,
    pub excuse: Excuse<'a>,
    /// `None` for sentences from the catalogue.
    pub shows: Option<Shows<'a>>,
    pub states: States<'a>,
    /// `None` for causes as large as the noise, and the catalogue's reasons.
    pub usual: Option<Usual<'a>>,
    /// Free-run simulation of the channel, or the reason why it has none.
    pub free_run: FreeRun<'a>,
}

impl Compared {
    /// As one of several channels of an answer.
    pub fn part<'a>(&'a self, shows: Shows<'a>, states: States<'a>, usual: Usual<'a>) -> Part<'a> {
        let Self { study, channel, unit, floor, along, state } = self;
        Part {
            role: Role::Channel,
            study,
            terms: Some(study),
            channel,
            unit,
            floor: *floor,
            noise: *floor,
            along,
            state: Box::new(|i| Some((*channel, state[i]))),
            excuse: &|_| None,
            shows: Some(shows),
            states,
            usual: Some(usual),
            free_run: FreeRun::None(AT_ONCE),
        }
    }
}

impl<'a> Part<'a> {
    /// Adds the free-run simulation.
    pub fn running(self, forward: &'a dyn Forward) -> Self {
        Self { free_run: FreeRun::Channel(forward), ..self }
    }

    /// Marks the channel as static, without a free run, for this reason.
    pub fn still(self, why: &'static str) -> Self {
        Self { free_run: FreeRun::None(why), ..self }
    }

    /// Evidence of the strongest chosen cause.
    pub fn strongest(&self) -> f64 {
        self.study.chosen.iter().map(|c| c.score).fold(0.0, f64::max)
    }

    /// Residual figures of the channel, without and with the causes found.
    pub fn figures(&self) -> Figures {
        let of = |picks: &[usize]| {
            let (heldout, train) = rms(self.study, picks, self.along);
            (heldout, train, whiteness_p(self.study, picks))
        };
        let (heldout_rms_n, rms_n, whiteness) = of(&[]);
        let (end, _, end_white) = of(&self.study.picks());
        let is_one_of_several = self.role == Role::Channel;
        Figures {
            baseline: Baseline {
                rms_n,
                heldout_rms_n,
                whiteness_p: whiteness,
                of: is_one_of_several.then(|| self.channel.to_owned()),
                unit: Some(self.unit.to_owned()),
                ..Baseline::default()
            },
            end: Final { heldout_rms_n: end, whiteness_p: end_white, ..Final::default() },
            // The final residual contains the noise, so the noise floor is no larger.
            noise_floor: if is_one_of_several && end > 0.0 { self.floor.min(end) } else { self.floor },
        }
    }

    /// Residuals of the channel, state by state.
    pub fn residuals(&self) -> Vec<Residual> {
        let floor = if self.role == Role::Path { self.noise } else { self.floor };
        residuals(self.study, (self.unit, floor), &self.state)
    }

    /// Causes of usual size whose effect this recording would hide.
    pub fn not_excited(&self) -> Vec<NotExcited> {
        let ChannelFit { system, candidates, solved, rules, .. } = self.study;
        let picks = self.study.picks();
        let mut best: Vec<(&str, f64, String)> = Vec::new();
        for (k, candidate) in candidates.iter().enumerate().filter(|(_, c)| !self.study.has(c.id)) {
            let seen = match self.usual {
                // A cause as large as the noise.
                None => hidden_by_law(candidate.id)
                    .map(|why| (system.distinct(k, &picks) * system.rows - candidate.cost * system.rows.ln(), why)),
                Some(usual) => usual(candidate).zip(solved.as_ref()).map(|((size, why), solved)| {
                    let first = system.places[k].start;
                    let power = system.distinct(k, &picks) * system.train[(first, first)] * size * size;
                    (power / solved.variance(system.rows), why.to_owned())
                }),
            };
            let Some((evidence, why)) = seen else { continue };
            match best.iter_mut().find(|b| b.0 == candidate.id) {
                Some(held) => held.1 = held.1.max(evidence),
                None => best.push((candidate.id, evidence, why)),
            }
        }
        if self.usual.is_none() {
            best.sort_by_key(|(id, ..)| entries().position(|e| e.id == *id));
        }
        let hidden = best.into_iter().filter(|(_, evidence, _)| *evidence < rules.visible);
        hidden.map(|(id, _, why)| NotExcited { id: id.to_owned(), why }).collect()
    }
}

/// Reason by the catalogue why a motion hides a cause.
fn hidden_by_law(id: &str) -> Option<String> {
    let entry = entries().find(|e| e.id == id)?;
    let mut letters = entry.reveals.trim_end_matches('.').chars();
    let reveals: String = letters.next().map_or_else(String::new, |c| c.to_lowercase().chain(letters).collect());
    Some(format!("this motion hides it behind the model's own terms; {reveals}"))
}
