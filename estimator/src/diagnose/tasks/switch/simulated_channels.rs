use crate::diagnose::contract::parameter;
use crate::diagnose::extension::hypothetical_worlds::{Act, Hypothesis, Simulated, of_channels};
use crate::diagnose::hypotheses::candidate::Candidate;
use crate::diagnose::hypotheses::{
    added_constraint, coulomb_friction, friction_asymmetry, local_resistance, pad_compliance, return_spring,
    viscous_friction,
};
use crate::diagnose::selection::comparison::ChannelFit;

/// Causes that a world's switch or its pads can have. A world has no change of friction over time and no length scale.
pub(crate) const POSSIBLE: [&str; 7] = [
    viscous_friction::ID,
    coulomb_friction::ID,
    friction_asymmetry::ID,
    return_spring::ID,
    local_resistance::ID,
    added_constraint::ID,
    pad_compliance::ID,
];

/// Effects of a switch's channel. Its base model is already in the world.
pub(crate) struct Channel;

impl Simulated for Channel {
    fn base(&self, _: &[f64]) -> Vec<Act> {
        Vec::new()
    }

    fn act(&self, candidate: &Candidate, values: &[f64]) -> Option<Act> {
        let linear =
            candidate.linear.iter().zip(values).map(|((name, unit), value)| parameter(name, *value, 0.0, unit));
        let searched = candidate.searched.iter().map(|s| parameter(s.name, s.value, 0.0, s.unit));
        POSSIBLE.contains(&candidate.id).then(|| (candidate.id.to_owned(), linear.chain(searched).collect()))
    }

    fn is_late(&self, _: &Candidate) -> bool {
        false
    }
}

/// The hypothesis as found, and those of every rival cause.
pub fn hypotheses(studies: &[&ChannelFit]) -> Vec<Hypothesis> {
    let channels: Vec<(&ChannelFit, &dyn Simulated)> =
        studies.iter().map(|s| (*s, &Channel as &dyn Simulated)).collect();
    of_channels(&channels)
}
