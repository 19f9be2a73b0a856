//! Cross-talk of the force axes as a hypothesis, if the force has two.

use super::candidate::{Candidate, HARDLY};
use super::dictionary::Dictionary;
use super::hypothesis::{About, Hypothesis};
use super::relations::Relation;
use super::sensor_fault::{SensorFault, add_each, fingers};
use super::variable::Variable;
use haptics::Vec2;
use haptics::law::Kind;

pub(crate) const ID: &str = "force-cross-axis";

pub(crate) struct ForceCrossAxis;

impl Hypothesis for ForceCrossAxis {
    fn about(&self) -> About {
        About { id: ID, relations: &[Relation::NeedsForce], seen: Variable::Across, ..About::PLAIN }
    }

    fn candidates(&self, data: &Dictionary<'_>) -> Vec<Candidate> {
        if !data.track.planar {
            return Vec::new();
        }
        let cross = |to: Vec2, from: Vec2| data.every(&|r| r.along.dot(&to) * r.force.dot(&from));
        let one = |name, unit, column| Candidate::one(ID, Kind::Instrument, name, unit, column);
        // The whole sensor is rotated: Fx − κ Fy and Fy + κ Fx.
        let turned = data.every(&|r| r.along.y * r.force.x - r.along.x * r.force.y);
        let turned = one("kappa_turned", "rad", turned);
        vec![
            one("kappa_xy", "1", cross(Vec2::x(), Vec2::y())),
            one("kappa_yx", "1", cross(Vec2::y(), Vec2::x())),
            Candidate { cost: turned.cost + HARDLY, ..turned },
        ]
    }

    fn add_to_fault(&self, fault: &mut SensorFault, candidate: &Candidate, values: &[f64]) -> bool {
        add_each(candidate, values, |name, value| {
            let (fingers, name) = fingers(name);
            for cross in &mut fault.cross[fingers] {
                match name {
                    "kappa_xy" => cross.x += value,
                    "kappa_yx" => cross.y += value,
                    "kappa_turned" => *cross += Vec2::new(-value, value),
                    _ => return false,
                }
            }
            true
        })
    }
}
