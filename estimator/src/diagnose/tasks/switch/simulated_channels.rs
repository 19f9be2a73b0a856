use crate::diagnose::extension::hypothetical_worlds::{Act, Simulated};
use crate::diagnose::hypotheses::candidate::Candidate;
use crate::diagnose::hypotheses::{
    added_constraint, coulomb_friction, friction_asymmetry, local_resistance, pad_compliance, return_spring,
    viscous_friction,
};

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
pub(crate) struct InWorld;

impl Simulated for InWorld {
    fn act(&self, candidate: &Candidate, values: &[f64]) -> Option<Act> {
        POSSIBLE.contains(&candidate.id).then(|| (candidate.id.to_owned(), candidate.parameters(values)))
    }
}
