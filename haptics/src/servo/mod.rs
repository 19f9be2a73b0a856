//! The servo: one thread that reads the device, steps the world and returns the force, a thousand times a second.
//!
//! * [`Loop`] is one tick as a plain function: the thread, the headless recorder and the tests all call it.
//! * [`Servo`] is the thread with its absolute deadlines, and a guard that watches it.
//! * [`rate`] chooses how often, [`timing`] measures, [`safety`] limits, [`recorder`] keeps every tick.
//! * [`force_test`] tries a device; [`coupling`] keeps a force device passive in worlds that are stiffer than it can render; [`passivity`] has the limits.
//!
//! Newest state out by triple buffer, every tick out by ring (a second one, [`tap`], during a recording), commands in
//! by ring. Worlds are built elsewhere, swapped in, and dropped elsewhere. Nothing in the tick allocates, locks,
//! prints, waits or panics.

mod clock;
mod config;
mod control_loop;
pub mod coupling;
pub mod force_test;
mod guard;
mod histogram;
pub mod passivity;
#[cfg(test)]
mod protections;
pub mod rate;
mod realtime;
pub mod recorder;
mod runner;
pub mod safety;
mod swap;
pub mod tap;
mod thread;
pub mod timing;

pub use clock::Deadlines;
pub use config::ServoConfig;
pub use control_loop::{Loop, Snapshot, TickRecord};
pub use guard::FAULT_AFTER_S;
pub use histogram::Percentiles;
pub use realtime::Privileges;
pub use swap::Swap;
pub use thread::{Servo, ServoError};
