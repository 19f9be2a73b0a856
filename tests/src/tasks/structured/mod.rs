//! Carried blocks and needles with structured model error: real forces, and faults of a force sensor, that no law of the catalogue
//! describes, alone and beside one effect that it does.
//!
//! How a case is made: [`sets`] draws a job; [`carry`] and [`piercing`] perform it; [`scale`] rescales whatever is hidden until it has
//! its size beside the noise of a reading; [`score`] asks. [`structure`] has the random functions of a structure, [`sensor`] the faults of
//! a force sensor. [`carry_effect`] and [`needle_effect`] have the effects of the catalogue. [`family`] says which causes describe a
//! structure itself. Run it by `cargo run -p tests --bin structured -- SEED…`.
//!
//! The size of a structure is the root mean square of what it changes in the rows of contact, after the known model took what it can,
//! over the noise of these rows: in the channel that shows it best.

pub mod carry;
pub mod carry_effect;
pub mod family;
pub mod needle_effect;
pub mod piercing;
pub mod scale;
pub mod score;
pub mod sensor;
pub mod sets;
pub mod structure;

#[cfg(test)]
mod checks;
