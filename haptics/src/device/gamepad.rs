//! A gamepad: sticks move the tips, the rumble is a cue of the force and of impacts.

mod backend;
#[cfg(feature = "gamepad")]
mod pad;
mod rumble;

pub use backend::{GamepadDevice, GamepadHandle, GamepadMode, PadState, gamepad};
#[cfg(feature = "gamepad")]
pub use pad::{GamepadError, GamepadThread, open};
pub use rumble::{Rumble, force_strength, impact_strength};
