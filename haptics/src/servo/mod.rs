//! The servo: one thread that reads the device, steps the world and returns the force, a thousand times a second.
//!
//! * [`Loop`] is one tick as a plain function: the thread, the headless recorder and the tests all call it.
//! * [`Servo`] is the thread with its absolute deadlines.
//! * [`timing`] measures, [`safety`] limits, [`recorder`] keeps every tick.
//!
//! Newest state out by triple buffer, every tick out by ring, commands in by ring. Worlds are built elsewhere, swapped in, and
//! dropped elsewhere. Nothing in the tick allocates, locks, prints, waits or panics.

mod clock;
mod r#loop;
pub mod passivity;
mod realtime;
pub mod recorder;
pub mod safety;
mod thread;
pub mod timing;

pub use clock::Deadlines;
pub use r#loop::{Loop, Snapshot, Swap, TickRecord};
pub use realtime::Privileges;
pub use thread::{Servo, ServoConfig, ServoError};
