//! The catalogue of physical laws: one law a file, written once.
//!
//! A law adds a term to the force that is needed to move a coordinate `s` (or angle) against it. The same object is
//! integrated by the servo ([`crate::world`]), summed by the replay, put into a fit as regressor columns by the estimator and
//! proposed by the diagnosis. Ids are those of `docs/causes/README.md`.
//!
//! ```
//! use haptics::law::{CoulombFriction, Effect, Motion, ViscousFriction};
//!
//! // 0.2 N of dry friction and 3 N s/m against 0.1 m/s.
//! let laws = [Effect::new(&CoulombFriction, &[0.2]), Effect::new(&ViscousFriction, &[3.0])];
//! let motion = Motion { velocity: 0.1, direction: 1.0, ..Motion::default() };
//! let force_n: f64 = laws.iter().map(|law| law.force(&motion)).sum();
//! assert!((force_n - 0.5).abs() < 1e-12);
//! ```
//!
//! Adding a law: `docs/guide/developer.md`, *Add a law in 15 minutes*.
//! Laws of contacts, which act on no coordinate, are in [`contact`], those of captured objects in [`object`]; every cause, law or
//! not, is in [`entries`].

mod catalogue;
pub mod contact;
mod coordinate;
mod effect;
mod entry;
mod force_law;
mod instrument;
mod list;
mod memory;
pub mod object;
pub mod page;
#[cfg(test)]
mod tests;

pub use catalogue::{CATALOGUE, cause, causes, entries, law};
pub use coordinate::{
    Resistance, advance, drive_force, drive_force_with, drive_forces, explicit_stiffness, inertia, resistance,
    resistance_with, step_coordinate, step_coordinate_with,
};
pub use effect::Effect;
pub use entry::{Coordinate, Enters, Entry, Kind, ParameterSpec};
pub use force_law::{Law, MAX_PARAMETERS, Motion, Role};
pub use memory::{MAX_EFFECTS, Memories, Memory};

macro_rules! modules {
    (causes { $($cause_file:ident: $cause:ident,)* } models { $($model_file:ident: $model:ident,)* }) => {
        $(mod $cause_file; pub use $cause_file::$cause;)*
        $(mod $model_file; pub use $model_file::$model;)*
    };
}

crate::laws!(modules);
