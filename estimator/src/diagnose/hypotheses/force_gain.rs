//! A wrong gain of the force channel as a hypothesis, if a force is completely known.

use super::candidate::Candidate;
use super::dictionary::Dictionary;
use super::hypothesis::{About, Hypothesis};
use super::relations::Relation;
use super::sensor_fault::{SensorFault, add_each};
use super::variable::Variable;
use haptics::law::Kind;

pub(crate) const ID: &str = "force-gain";

pub(crate) struct ForceGain;

impl Hypothesis for ForceGain {
    fn about(&self) -> About {
        About { id: ID, relations: &[Relation::NeedsForce], seen: Variable::Force, ..About::PLAIN }
    }

    fn candidates(&self, data: &Dictionary<'_>) -> Vec<Candidate> {
        let Some((first, others)) = data.fixed.split_first() else { return Vec::new() };
        let mut known = first.clone();
        for other in others {
            known.iter_mut().zip(other).for_each(|(sum, more)| *sum += more);
        }
        vec![Candidate::one(ID, Kind::Instrument, "g - 1", "1", known)]
    }

    fn add_to_fault(&self, fault: &mut SensorFault, candidate: &Candidate, values: &[f64]) -> bool {
        add_each(candidate, values, |_, value| {
            fault.gain_error = value;
            true
        })
    }
}
