//! The virtual world: an immutable [`World`], a mutable [`State`], and [`step`], deterministic to the bit.

mod benchmarks;
mod block;
mod check;
mod collide;
pub mod contact;
mod contact_point;
mod driven;
mod energy;
mod error;
mod face;
mod fixed;
mod fixture;
mod guide;
mod label;
mod limits;
mod mechanism_path;
mod model;
#[cfg(test)]
mod parts_tests;
mod plane;
pub mod presets;
mod rect;
mod scratch;
mod state;
mod step;

pub use block::{Block, Cable, Content, Pose, Shape, Wall};
pub use collide::PAD_HALF_HEIGHT_M;
pub use contact_point::{Contact, Surface};
pub use energy::Stored;
pub use error::WorldError;
pub use fixed::{CUP_FLARE, SWITCH_BASE_HALF};
pub use fixture::{Membrane, Switch};
pub use guide::{Guide, Guided, MAX_GUIDE_POINTS};
pub use label::true_label;
pub use limits::{MAX_BLOCKS, SCHEMA};
pub use mechanism_path::MechanismPath;
pub use model::*;
pub use plane::Plane;
pub use rect::Rect;
pub use state::*;
pub use step::{finger_contacts, step, substeps};
