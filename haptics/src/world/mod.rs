//! The virtual world: an immutable [`World`], a mutable [`State`], and [`step`], deterministic to the bit.

mod benchmarks;
pub mod contact;
mod label;
mod model;
pub mod presets;
mod state;
mod step;

pub use label::true_label;
pub use model::*;
pub use state::*;
pub use step::{PAD_HALF_HEIGHT_M, finger_contacts, step, substeps};
