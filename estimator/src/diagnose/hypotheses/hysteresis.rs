//! Presliding as a hypothesis: friction bends over a searched distance before it slides.

use super::candidate::{Candidate, LEAST_SHARE, Shape};
use super::dictionary::Dictionary;
use super::grid::{Near, Point, Ranges};
use super::hypothesis::{About, Found, Hypothesis};
use super::relations::{Form, Over, Relation};
use crate::diagnose::data::stick_phases;
use haptics::law::{Effect, Hysteresis, Kind, LoadHysteresis};

pub(crate) const ID: &str = "hysteresis";

/// Least share of the friction that counts as all of it.
/// Choice: halved or doubled, none of 62 answers changes.
const ALL_BENT: f64 = 0.65;
/// Presliding distance from which only a share of the friction may bend, in multiples of the shortest that is felt.
/// Choice: halved or doubled, none of 62 answers changes.
const LONG_BENT: f64 = 6.0;
/// Shape parameter of presliding that springs back along a straight line.
/// Source: Wen 1976; with β = ½ the Bouc–Wen law unloads along a straight line.
const STRAIGHT_SHAPE: f64 = 0.5;
/// Points: presliding distance.
const BENT: &str = "presliding distance";
/// Points: the same of friction that springs back along a straight line (Bouc and Wen). Tried if a presliding was
/// found.
const STRAIGHT: &str = "presliding distance of a straight spring";

impl Hypothesis for Hysteresis {
    fn about(&self) -> About {
        About {
            id: ID,
            form: Form::Curve(&[Over::Motion, Over::Place]),
            relations: &[
                Relation::OfDryFriction,
                Relation::ShareOfDryFriction,
                Relation::TakesDryFriction,
                Relation::LosesMotion,
            ],
            ..About::PLAIN
        }
    }

    fn coarse(&self, ranges: &Ranges<'_>) -> Vec<Point> {
        ranges.ways().into_iter().map(|way| Point::one(BENT, way)).collect()
    }

    fn around(&self, near: &Near<'_>) -> Vec<Point> {
        let bent = near.ways().into_iter().map(|way| Point::one(BENT, way));
        let straight = near.of(ID).flat_map(|found| near.ways_of(found)).map(|way| Point::one(STRAIGHT, way));
        bent.chain(straight).collect()
    }

    fn candidates(&self, data: &Dictionary<'_>) -> Vec<Candidate> {
        let bent = data.points(ID, BENT).map(|[way, ..]| bent(data, way, 0.0));
        let straight = |[way, ..]: [f64; 3]| self::bent(data, way, STRAIGHT_SHAPE).at("shape", STRAIGHT_SHAPE, "1");
        bent.chain(data.points(ID, STRAIGHT).map(straight)).collect()
    }

    fn effects(&self, found: &Found<'_>) -> Vec<Effect> {
        let (share, way) = (found.value(0), found.searched(0).max(f64::MIN_POSITIVE));
        let level = share * found.dry.level_n;
        let everywhere = Effect::new(&Hysteresis, &[level, level / way, found.searched(1)]);
        found.dry.parts(everywhere, Effect::new(&LoadHysteresis, &[share * found.dry.mu, way, found.searched(1)]))
    }
}

/// Candidate by which the model's friction bends over `way` before it slides: the difference from sliding at once.
fn bent(data: &Dictionary<'_>, way: f64, shape: f64) -> Candidate {
    let values = [1.0, 1.0 / way, shape];
    let bent = data.remembered(&Hysteresis, &values, &|motion, memory, _| memory[0] - motion.direction);
    let felt = f64::from(u8::from(way > data.grid.felt));
    let mut column: Vec<f64> = bent.iter().zip(data.dry).map(|(b, d)| felt * b * d).collect();
    stick_phases::bends(&data.track.rows, &values, &mut column);
    // Presliding of only part of the friction needs strong evidence: noise of the path during sticking looks like a
    // short bend.
    let least = if way > LONG_BENT * data.grid.felt { LEAST_SHARE } else { ALL_BENT };
    let hysteresis = Candidate::one(ID, Kind::Plant, "share", "1", column);
    let share = Shape::Share { least, whole: ALL_BENT };
    hysteresis.shaped(share).at("way", way, data.units().length)
}
