//! Sources of finger positions and sinks of forces: one trait, one backend a file.

pub mod channel;
pub mod gamepad;
pub mod haply;
mod impedance;
mod interface;
mod keyboard;
mod mouse;
mod pointer;
mod replay;
mod scripted;
mod steering;
mod touch;
pub mod udp;
mod waves;

pub use impedance::HandImpedance;
pub use interface::{Command, Device, DeviceSpec, ForceGuard, Sample};
pub use keyboard::{KeyboardDevice, KeyboardHandle, KeysHeld, keyboard};
pub use mouse::{MouseDevice, MouseHandle, MouseTarget, mouse};
pub use replay::{ReplayDevice, ReplayError};
pub use scripted::{Act, HandGoal, Mistake, Pull, PullSensor, Pulled, Route, ScriptedOperator, Skill};
pub use touch::{TouchDevice, TouchHandle, touch};
