//! The virtual world: an immutable [`World`], a mutable [`State`], and [`step`].

mod model;
mod state;

pub use model::*;
pub use state::*;
