//! The interface of a device: its specification, the command that it takes, the sample that it answers, and the trait of every backend.

use crate::Vec2;
use crate::world::{State, World};

/// Capabilities of a device, from which all limits are computed.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct DeviceSpec {
    /// For people.
    pub name: String,
    /// True if the operator feels a force; false if it is only shown.
    pub force_feedback: bool,
    /// Largest force per finger, N.
    pub max_force_n: f64,
    /// Physical damping per finger, N s/m.
    pub damping_n_s_m: f64,
    /// Coulomb friction per finger, N.
    pub coulomb_n: f64,
    /// Position resolution, m.
    pub resolution_m: f64,
}

/// Message from the servo to the device at every tick.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Command {
    /// Force on the operator's fingers, N, after ramp, clamp and slew limit.
    pub force_n: [Vec2; 2],
}

/// Answer of the device.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sample {
    /// Tip positions in the world, m; of a finger that is not fresh, the last that is known.
    pub tip_in_world: [Vec2; 2],
    /// Tip velocities, m/s.
    pub tip_velocity: [Vec2; 2],
    /// False for a finger of which the device had nothing new: the watchdog counts these, each finger by itself. The fingers of
    /// a hand of two boards answer in different ticks.
    pub fresh: [bool; 2],
}

impl Sample {
    /// True if at least one finger has a new sample.
    pub fn is_any_fresh(&self) -> bool {
        self.fresh.contains(&true)
    }

    /// True if both fingers have new samples.
    pub fn is_fresh(&self) -> bool {
        self.fresh == [true; 2]
    }
}

/// A second way to zero force; see [`Device::guard`].
pub type ForceGuard = Box<dyn FnMut() + Send>;

/// A two-fingered input device. Everything but construction is called on the servo thread and must neither allocate, lock,
/// print, wait nor panic.
pub trait Device: Send {
    /// Capabilities of the device.
    fn spec(&self) -> &DeviceSpec;

    /// Sends a force and takes the newest positions; `dt_s` is the time since the call before.
    fn exchange(&mut self, command: &Command, dt_s: f64) -> Sample;

    /// Delay that the device adds between a motion and the force that answers it, s: a network's. Limits count with it.
    fn delay_s(&self) -> f64 {
        0.0
    }

    /// Stiffness that a line with wave variables puts in series with the world, N/m: the wave impedance over the delay one way.
    /// Nothing is felt stiffer, however stiff a passive wall may be at the servo's end. `None` without such a line.
    fn line_stiffness_n_m(&self) -> Option<f64> {
        None
    }

    /// Brings the device to zero force. Called when the servo stops, also after a fault; called again on drop by devices that
    /// hold their last force.
    fn make_safe(&mut self);

    /// The servo stood still for longer than its watchdog allows. For devices that have a safety stage of their own: the force comes
    /// up softly again.
    fn interrupted(&mut self) {}

    /// A second way to zero force, for another thread, while `exchange` does not come back; asked for once, before the first
    /// `exchange`. Devices that wait for nothing, or guard themselves on a thread of their own, need none.
    fn guard(&mut self) -> Option<ForceGuard> {
        None
    }

    /// Something struck something in the world at a speed, m/s; told once an impact, after the tick in which it happened. For
    /// devices that can make it felt beside the force.
    fn strike(&mut self, _speed_m_s: f64) {}

    /// Shows the world to the operator. Only simulated operators look.
    fn see(&mut self, _world: &World, _state: &State) {}

    /// True once a device that performs something (a script, a replay) is done.
    fn finished(&self) -> bool {
        false
    }
}
