//! Experiments that answers ask for, performed: do they settle what was open?

use super::case::Object;
use super::interval::Share;
use super::score::{Engine, Row};
use super::sets::Set;
use estimator::diagnose::{Findings, Options};
use haptics::recording::Recording;

/// An alternative less probable than this is as good as excluded.
const OPEN: f64 = 0.047;

/// A proposed experiment after it was performed.
#[derive(Clone, Debug)]
pub struct Followed {
    /// Which motion was asked for.
    pub id: String,
    /// What it should tell apart.
    pub separates: Vec<String>,
    /// Probability of that, as the answer has it.
    pub expected_power: f64,
    /// The answer to both recordings together.
    pub answer: Result<Findings, String>,
}

/// Performs what an answer asks for and asks again, with both recordings; nothing where nothing (that can be performed) was asked for.
pub fn follow(
    object: &Object,
    first: &[Recording],
    answer: &Findings,
    options: &Options,
    engine: &Engine<'_>,
    seed: u64,
) -> Option<Followed> {
    let next = answer.next_experiment.as_ref()?;
    let asked = next.experiment.as_ref()?;
    let again = match object.perform(asked, seed.wrapping_mul(31).wrapping_add(17)) {
        Some(recording) => {
            let both: Vec<Recording> = first.iter().cloned().chain([recording]).collect();
            engine(&both, options)
        }
        None => Err(format!("nobody can perform `{}` on this object", asked.id)),
    };
    Some(Followed {
        id: asked.id.clone(),
        separates: next.separates.clone(),
        expected_power: next.expected_power,
        answer: again,
    })
}

impl Row {
    /// A proposed experiment counts where something with a name was hidden.
    pub fn proposed(&self) -> Option<&Followed> {
        self.followed.as_ref().filter(|_| matches!(self.set, Set::Single | Set::Pair | Set::Hard))
    }

    /// After the proposed experiment the hidden cause comes first, and nothing else could stand there.
    pub fn settled(&self) -> bool {
        let Some(Followed { answer: Ok(answer), .. }) = self.proposed() else { return false };
        let ids = self.ids();
        let first = answer.causes.iter().find(|c| !c.id.starts_with("other:"));
        let right = first.is_some_and(|first| ids.contains(&first.id.as_str()));
        right && answer.alternatives.iter().all(|a| a.posterior <= OPEN)
    }

    /// The question that was asked is answered rightly: of what should be told apart, what is hidden is named and nothing else is, or
    /// could be.
    pub fn question_answered(&self) -> bool {
        let Some(Followed { answer: Ok(answer), separates, .. }) = self.proposed() else { return false };
        let ids = self.ids();
        let still = |id: &str| {
            answer.causes.iter().any(|c| c.id == id)
                || answer.alternatives.iter().any(|a| a.id == id && a.posterior > OPEN)
        };
        separates.iter().all(|id| still(id) == ids.contains(&id.as_str()))
    }
}

/// How experiments came out.
#[derive(Clone, Debug)]
pub struct Experiments {
    /// Open cases in which only the hidden cause is left afterwards.
    pub settled: Share,
    /// Those in which the hidden one was among what the experiment should tell apart, and is the only one of these that is left.
    pub answered: Share,
    /// Mean of the probabilities that were stated.
    pub expected_power: f64,
    /// By what was stated: mean of it, and how often it was so.
    pub calibration: Vec<(f64, Share)>,
    /// By the motion that was asked for.
    pub by_motion: Vec<(String, Share)>,
}

impl Experiments {
    /// Counts.
    pub fn of(rows: &[Row]) -> Self {
        let open: Vec<&Row> = rows.iter().filter(|r| r.proposed().is_some() && !r.missed).collect();
        let power = |r: &Row| r.proposed().map_or(f64::NAN, |f| f.expected_power);
        let mean = |rows: &[&Row]| rows.iter().map(|r| power(r)).sum::<f64>() / rows.len() as f64;
        let asks_for_truth =
            |r: &&&Row| r.proposed().is_some_and(|f| f.separates.iter().any(|id| r.ids().contains(&id.as_str())));
        let mut motions: Vec<&str> = open.iter().filter_map(|r| r.proposed()).map(|f| f.id.as_str()).collect();
        motions.sort_unstable();
        motions.dedup();
        let bins = [0.0, 0.5, 0.8, 0.95, 1.0 + 1e-9];
        Self {
            settled: Share::count(open.iter(), |r| r.settled()),
            answered: Share::count(open.iter().filter(asks_for_truth), |r| r.question_answered()),
            expected_power: mean(&open),
            calibration: bins
                .windows(2)
                .map(|b| open.iter().filter(|r| power(r) >= b[0] && power(r) < b[1]).copied().collect::<Vec<&Row>>())
                .filter(|bin| !bin.is_empty())
                .map(|bin| (mean(&bin), Share::count(bin.iter(), |r| r.settled())))
                .collect(),
            by_motion: motions
                .into_iter()
                .map(|id| {
                    let of = open.iter().filter(|r| r.proposed().is_some_and(|f| f.id == id));
                    (id.to_owned(), Share::count(of, |r| r.settled()))
                })
                .collect(),
        }
    }
}
