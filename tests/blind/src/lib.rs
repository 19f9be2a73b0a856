//! The blind battery: recordings in which something is hidden, and the score of whoever looks for it.
//!
//! The generator shares no formula and no code with the estimator, nor with the world that the program renders: it has its own
//! kinematics, integrator, operator, laws and sensors, and takes only the types in which recordings are handed over. Forms of the
//! hidden laws differ from those of any dictionary in a share of cases. What is hidden travels apart ([`case::Truth`]).
//!
//! How a case is made: [`draw`] draws object, person, motion and instruments from a seed; [`simulate`] steps hand ([`hand`], [`plan`])
//! and load ([`plant`]) together; [`measure`] says how large the effect is beside the noise after the known model took what it could;
//! [`case`] rescales and runs again until that is what was asked for; [`record`] and [`sensor`] make a table of it. [`sets`] draws
//! whole batteries, [`score`] opens truth and answer, [`tables`] prints. [`structure`] has the forces that no law describes, made of the random functions
//! in [`curve`] and [`lag`]; [`certain`] says which names are given in their presence, for any case that is [`counted`]. A new effect needs an entry in [`effect`], a law in [`plant`]
//! (or a fault in [`sensor`]) and a first size in [`draw`].
//!
//! The known part of a null case is known to the last bit: weight, load friction and viscous friction of a crank whose inertia nobody
//! could see in its noise; inertia, viscous and dry friction of a mechanism.

pub mod arm;
pub mod case;
pub mod certain;
pub mod chance;
pub mod clock;
pub mod counted;
pub mod curve;
pub mod draw;
pub mod dump;
pub mod effect;
pub mod follow;
pub mod hand;
pub mod interval;
pub mod json;
pub mod lag;
pub mod measure;
pub mod perform;
pub mod plan;
pub mod plant;
pub mod record;
pub mod score;
pub mod sensor;
pub mod sets;
pub mod simulate;
pub mod structure;
pub mod tables;
pub mod tolerated;

pub use case::{Case, Truth, make, make_followed};
pub use chance::Chance;
pub use counted::Counted;
pub use draw::{Bench, Spec, Structure};
pub use effect::Effect;
pub use follow::Experiments;
pub use interval::Share;
pub use json::Said;
pub use plan::Log;
pub use score::{Figures, Row, ask};
pub use sets::{Counts, Job, Set, StructureCounts, battery, long, structured};
pub use tables::report;

#[cfg(test)]
mod answers;
#[cfg(test)]
mod checks;
