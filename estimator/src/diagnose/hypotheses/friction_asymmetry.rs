//! Friction that differs by direction, as a hypothesis: dry, viscous, or in proportion to the load.

use super::candidate::{Candidate, Column, HARDLY};
use super::dictionary::Dictionary;
use super::hypothesis::{About, Found, Hypothesis};
use super::relations::{Form, Over, Relation};
use super::variable::Variable;
use crate::diagnose::data::regression_data::Zero;
use haptics::law::{Effect, FrictionAsymmetry};

pub(crate) const ID: &str = "friction-asymmetry";

impl Hypothesis for FrictionAsymmetry {
    fn about(&self) -> About {
        About {
            id: ID,
            form: Form::Exact(&[Over::Motion]),
            relations: &[Relation::NeedsBothWays],
            seen: Variable::Velocity,
            ..About::PLAIN
        }
    }

    fn candidates(&self, data: &Dictionary<'_>) -> Vec<Candidate> {
        let mut all = Vec::new();
        if data.track.planar {
            all.push(data.plain(&FrictionAsymmetry, &[0.0, 0.0, 1.0], 2));
        }
        // With motion in one direction, a constant and dry friction differ only where the direction is uncertain, which
        // is no evidence.
        let is_friction = !data.track.planar && data.track.goes_one_way();
        if data.track.zero != Zero::OfTheSensor && !is_friction {
            all.push(dry(data));
        }
        all.push(data.plain(&FrictionAsymmetry, &[0.0, 1.0, 0.0], 1));
        all
    }

    fn effects(&self, found: &Found<'_>) -> Vec<Effect> {
        let first = found.value(0);
        let values = match found.candidate.linear.first() {
            Some(("dFc", _)) => [first, 0.0, 0.0],
            Some(("dc", _)) => [0.0, first, 0.0],
            _ => [0.0, 0.0, first],
        };
        vec![Effect::new(&FrictionAsymmetry, &values)]
    }
}

/// Dry friction by direction. Along one coordinate its regressor is the constant that a sensor bias also is. The two
/// differ only in standing rows, where friction may take any value, and at reversals, where the direction is uncertain.
/// Neither counts as a difference.
fn dry(data: &Dictionary<'_>) -> Candidate {
    let by_direction = data.plain(&FrictionAsymmetry, &[1.0, 0.0, 0.0], 0);
    if data.track.planar {
        return by_direction;
    }
    let columns = vec![Column::new(data.column(&|_| 1.0))];
    // The sensor bias takes precedence.
    Candidate { regressors: columns, cost: by_direction.cost + HARDLY, ..by_direction }
}
