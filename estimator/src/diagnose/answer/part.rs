//! One compared channel as a part of an answer.

use super::atlas::{Against, Channel, strongest};
use crate::diagnose::contract::{Baseline, CauseParameter, Final, ModelError, NotExcited, OverVariable, Residual};
use crate::diagnose::data::limits::HALF;
use crate::diagnose::extension::hypothetical_worlds::Simulated;
use crate::diagnose::findings::Figures;
use crate::diagnose::free_run::FreeRun;
use crate::diagnose::free_run::windows::AT_ONCE;
use crate::diagnose::hypotheses::candidate::Candidate;
use crate::diagnose::selection::comparison::{ChannelFit, Compared, View};
use crate::diagnose::selection::held_out_gain::{rms, whiteness_p};
use foundation::tasks::SystemState;
use foundation::words::amount;
use haptics::law::entries;
use std::collections::BTreeSet;

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

/// A chosen cause, as its evidence sentence sees it.
pub struct Found<'a> {
    pub candidate: &'a Candidate,
    /// Its parameters as the answer states them.
    pub parameters: &'a [CauseParameter],
}

impl Found<'_> {
    /// Value of the first parameter.
    pub fn value(&self) -> f64 {
        self.parameters.first().map_or(0.0, |p| p.value)
    }

    /// Value of a parameter; zero if the cause has none of this name.
    pub fn value_of(&self, name: &str) -> f64 {
        self.parameters.iter().find(|p| p.name == name).map_or(0.0, |p| p.value)
    }
}

/// Words of a compared channel, and everything that its task knows of its causes.
pub trait Told {
    /// Sentence on how the residual shows a cause. Along a coordinate it is that of the catalogue.
    fn shows(&self, _found: &Found<'_>) -> String {
        String::new()
    }
    /// Addition of the task to the sentence of the catalogue.
    fn adds(&self, _candidate: &Candidate) -> &'static str {
        ""
    }
    /// True if the k-th chosen term is a cause.
    fn is_cause(&self, _k: usize) -> bool {
        true
    }
    /// Warning about the k-th chosen term, which is no cause.
    fn excuse(&self, _k: usize) -> Option<String> {
        None
    }
    /// Parameters of the k-th chosen cause, made from those of its regressors.
    fn states(&self, _k: usize, _candidate: &Candidate, found: Vec<CauseParameter>) -> Vec<CauseParameter> {
        found
    }
    /// Reason why a recording hides a cause, and the experiment that would show it. `None` if the cause does not belong
    /// to the channel. Along a coordinate the reasons are those of the catalogue.
    fn hidden_by(&self, _candidate: &Candidate) -> Option<&'static str> {
        None
    }
}

/// One channel, compared.
pub struct Part<'a> {
    pub role: Role,
    pub study: &'a ChannelFit,
    /// Name of the channel, in words.
    pub channel: &'static str,
    pub unit: &'static str,
    /// Noise of its rows: no cause can explain it.
    pub floor: f64,
    /// Noise to which the final residual is compared.
    pub noise: f64,
    /// True for rows that are held out in turn.
    pub along: &'a [bool],
    /// Channel and state of each row; `None` for a row of no channel.
    pub state: Vec<Option<(&'static str, SystemState)>>,
    /// Its rows for the atlas, if that shows them channel by channel.
    pub view: Option<&'a View>,
    pub told: &'a dyn Told,
    /// Free-run simulation of the channel, or the reason why it has none.
    pub free_run: FreeRun<'a>,
    /// Translation of its causes into effects of a world, if one has them.
    pub in_world: Option<&'a dyn Simulated>,
}

impl<'a> Part<'a> {
    /// One of several channels of an answer.
    pub fn of(compared: &'a Compared, told: &'a dyn Told) -> Self {
        let Compared { study, channel, unit, floor, along, state, view } = compared;
        Self {
            role: Role::Channel,
            study,
            channel,
            unit,
            floor: *floor,
            noise: *floor,
            along,
            state: state.iter().map(|state| Some((*channel, *state))).collect(),
            view: Some(view),
            told,
            free_run: FreeRun::None(AT_ONCE),
            in_world: None,
        }
    }

    /// Adds the free-run simulation, or the reason why there is none.
    pub fn running(self, free_run: FreeRun<'a>) -> Self {
        Self { free_run, ..self }
    }

    /// Adds the translation into effects of a world.
    pub fn in_world(self, simulated: &'a dyn Simulated) -> Self {
        Self { in_world: Some(simulated), ..self }
    }

    /// This channel's part of the atlas. If the variable that best shows a cause is missing in the view, the first one
    /// is shown.
    pub(crate) fn atlas(&self) -> Option<Channel> {
        let view = self.view?;
        let left = self.study.residual(&[]);
        let against = |(candidate, score, taken): (&Candidate, f64, Vec<f64>)| {
            let acts = |i: usize| candidate.regressors.iter().any(|column| column[i] != 0.0);
            let sensors: BTreeSet<usize> = (0..left.len()).filter(|i| acts(*i)).map(|i| view.sensor[i]).collect();
            let rows: Vec<usize> = (0..left.len()).filter(|i| sensors.contains(&view.sensor[*i])).collect();
            let best = (view.best)(candidate.id);
            let (variable, values) = view.over.iter().find(|(v, _)| *v == best).or(view.over.first())?;
            Some(Against {
                id: candidate.id.to_owned(),
                score,
                variable: *variable,
                over: rows.iter().map(|i| values[*i]).collect(),
                taken: rows.iter().map(|i| taken[*i]).collect(),
                rows,
            })
        };
        let suspects = strongest(self.study, &left).into_iter().filter_map(against).collect();
        Some(Channel {
            name: self.channel,
            unit: self.unit,
            is_angular: view.is_angular,
            noise: self.floor,
            recording: view.recording.clone(),
            way: view.way.clone(),
            left,
            suspects,
        })
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
            noise_floor: if end > 0.0 { self.floor.min(end) } else { self.floor },
        }
    }

    /// Structured error of the channel.
    pub fn model_error(&self) -> Option<ModelError> {
        let competition = self.study.competition.as_ref().filter(|c| !c.over.is_empty())?;
        let (_, plain) = rms(self.study, &[], self.along);
        let explainable = plain * plain - self.floor.min(plain).powi(2);
        let share = (competition.rms.powi(2) / explainable.max(competition.rms.powi(2))).min(1.0);
        let one = |(variable, rms_n): &(&'static str, f64)| OverVariable {
            variable: (*variable).to_owned(),
            rms_n: *rms_n,
            rms_nm: None,
        };
        let over = competition.over.iter().map(one).collect();
        Some(ModelError { rms_n: competition.rms, rms_nm: None, evidence: competition.evidence, share, over })
    }

    /// Evidence of the whole model beside structured errors, and number of its rows.
    pub fn evidence(&self) -> Option<[f64; 2]> {
        self.study.competition.as_ref().map(|c| c.whole)
    }

    /// Ids of the causes if structured errors have more power than all of them.
    pub fn outweighed(&self) -> Vec<String> {
        let outweighs = self.study.competition.as_ref().is_some_and(|c| c.share > HALF);
        let ids = self.study.picks().into_iter().filter(|_| outweighs);
        ids.map(|p| self.study.candidates[p].id.to_owned()).collect()
    }

    /// Sentence on a structured error beyond doubt.
    pub fn structured(&self) -> Option<String> {
        let competition = self.study.competition.as_ref()?;
        let is_told = self.role != Role::Path && competition.matters(self.floor);
        is_told.then(|| {
            let mut over: Vec<&str> = Vec::new();
            for (variable, _) in &competition.over {
                if !over.contains(variable) {
                    over.push(variable);
                }
            }
            format!(
                "{} RMS of the {} go with {}, and no known cause describes them",
                amount(competition.rms, self.unit),
                self.channel,
                over.join(", ")
            )
        })
    }

    /// Residuals of the channel, state by state.
    pub fn residuals(&self) -> Vec<Residual> {
        let floor = if self.role == Role::Path { self.noise } else { self.floor };
        let (before, after) = (self.study.residual(&[]), self.study.residual(&self.study.picks()));
        let mut found: Vec<((&str, SystemState), [f64; 2], usize)> = Vec::new();
        for (i, state) in self.state.iter().enumerate() {
            let Some(state) = *state else { continue };
            let k = found.iter().position(|(s, ..)| *s == state).unwrap_or_else(|| {
                found.push((state, [0.0; 2], 0));
                found.len() - 1
            });
            let (_, squares, rows) = &mut found[k];
            squares[0] += (self.study.layout.weight[i] * before[i]).powi(2);
            squares[1] += (self.study.layout.weight[i] * after[i]).powi(2);
            *rows += 1;
        }
        let one = |((channel, state), squares, rows): ((&str, SystemState), [f64; 2], usize)| {
            let [rms_before, rms_after] = squares.map(|s| (s / rows as f64).sqrt());
            let noise_floor = Some(floor).filter(|floor| *floor > 0.0);
            let (channel, unit) = (channel.to_owned(), self.unit.to_owned());
            Residual { channel, unit, state, rows, rms_before, rms_after, noise_floor }
        };
        found.into_iter().map(one).collect()
    }

    /// Causes as large as the noise whose effect this recording would hide behind the base model. A cause that is hidden
    /// behind a chosen one is not meant: the motion excites it.
    pub fn not_excited(&self) -> Vec<NotExcited> {
        let ChannelFit { system, candidates, rules, .. } = self.study;
        let mut best: Vec<(&str, f64, String)> = Vec::new();
        for (k, candidate) in candidates.iter().enumerate().filter(|(_, c)| !self.study.has(c.id)) {
            let why = if self.role == Role::Channel {
                self.told.hidden_by(candidate).map(str::to_owned)
            } else {
                hidden_by_law(candidate.id)
            };
            let Some(why) = why else { continue };
            let evidence = system.distinct(k, &[]) * system.rows - candidate.cost * system.rows.ln();
            match best.iter_mut().find(|b| b.0 == candidate.id) {
                Some(held) => held.1 = held.1.max(evidence),
                None => best.push((candidate.id, evidence, why)),
            }
        }
        if self.role != Role::Channel {
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
