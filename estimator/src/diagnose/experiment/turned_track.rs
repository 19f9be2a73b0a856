use crate::diagnose::contract::{Alternative, NextExperiment};
use crate::diagnose::hypotheses::{friction_asymmetry, gravity_tilt};

/// Probability that turning a slope round settles the question: neither answer may be true.
pub(crate) const SETTLES: f64 = 0.85;

/// Next experiment in words: it cannot be driven.
pub fn next(open: &[Alternative]) -> Option<NextExperiment> {
    let pair = [gravity_tilt::ID, friction_asymmetry::ID];
    let asks = |a: &&Alternative| pair.contains(&a.id.as_str()) && pair.contains(&a.instead_of.as_str());
    open.iter().find(asks)?;
    Some(NextExperiment {
        motion: "turn the track end for end, release it again as before, and count the coordinate along the thing, not along the room: a \
                 slope then pulls the other way, friction stays"
            .to_owned(),
        separates: pair.map(str::to_owned).to_vec(),
        expected_power: SETTLES,
        experiment: None,
    })
}
