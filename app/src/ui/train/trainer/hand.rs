//! Devices that move the fingers, and their construction.

use crate::ui::train::trainer::pointer_grip::Pinch;
use crate::ui::train::trainer::remote::Remote;
use haptics::Vec2;
use haptics::device::haply::{HaplyHand, Tally};
use haptics::device::udp::{UdpDevice, UdpMonitor};
use haptics::device::{
    Device, DeviceSpec, KeyboardHandle, MouseHandle, MouseTarget, ReplayDevice, TouchHandle, keyboard, mouse, touch,
};
use haptics::recording::Recording;
use haptics::world::{State, World};
use std::sync::Arc;

/// Device by which a person, a log or another machine moves the fingers.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum HandDevice {
    /// Both fingers with one pointer.
    #[default]
    Mouse,
    /// One finger per touch.
    Touch,
    /// Held keys.
    Keyboard,
    /// The log opened in Calibrate.
    Replay,
    /// Two boards, by the names of their ports: left, right.
    Haply(String, String),
    /// Packets from a network.
    Udp,
    /// The first gamepad.
    #[cfg(feature = "gamepad")]
    Gamepad,
}

/// Device settings that are not part of the world.
#[derive(Default)]
pub struct HandSettings {
    /// The log to replay.
    pub log: Option<Arc<Recording>>,
    /// Settings of the remote device.
    pub remote: Remote,
}

/// Window side of the running device.
#[derive(Default)]
pub enum Steering {
    /// Nothing to steer.
    #[default]
    None,
    /// The pointer's goal.
    Mouse(MouseHandle),
    /// Touches.
    Touch(TouchHandle),
    /// Keys.
    Keyboard(KeyboardHandle),
    /// Answers of the left and the right board.
    Haply([Tally; 2]),
    /// Packet counters.
    Udp(UdpMonitor),
    /// Thread that reads the gamepad; it runs as long as this value lives.
    #[cfg(feature = "gamepad")]
    Gamepad(haptics::device::gamepad::GamepadThread),
}

/// Device with its window side.
pub type Made = (Box<dyn Device>, Steering);

impl HandDevice {
    /// Creates the device, with its fingers at the positions of `state`. The error is one sentence.
    pub fn make(&self, world: &World, state: &mut State, settings: &HandSettings) -> Result<Made, String> {
        let tips = state.input.tip_in_world;
        let workspace = world.hand.workspace;
        let made = |device: Box<dyn Device>, steering| Ok((device, steering));
        match self {
            Self::Mouse => {
                let (handle, device) = mouse(mouse_start(tips), workspace);
                made(Box::new(device), Steering::Mouse(handle))
            }
            Self::Touch => {
                let (handle, device) = touch(tips, workspace);
                made(Box::new(device), Steering::Touch(handle))
            }
            Self::Keyboard => {
                let (handle, device) = keyboard(tips, workspace);
                made(Box::new(device), Steering::Keyboard(handle))
            }
            Self::Replay => {
                let log = settings.log.as_ref().ok_or("There is no log to replay: open one in Calibrate first.")?;
                let device = ReplayDevice::from_recording(log).map_err(|e| said(&e))?;
                state.input.tip_in_world = device.start_in_world();
                made(Box::new(device), Steering::None)
            }
            Self::Haply(left, right) => {
                let hand = HaplyHand::open([left, right], world.hand.workspace.center_m, crate::program().as_deref())
                    .map_err(|e| said(&e))?;
                let tallies = hand.tallies();
                made(Box::new(hand), Steering::Haply(tallies))
            }
            Self::Udp => {
                let config = settings.remote.config(world)?;
                let device = UdpDevice::open(config, tips).map_err(|e| said(&e))?;
                let monitor = device.monitor();
                made(Box::new(device), Steering::Udp(monitor))
            }
            #[cfg(feature = "gamepad")]
            Self::Gamepad => {
                use haptics::device::gamepad::{GamepadMode, open};
                let (thread, device) = open(tips, workspace, GamepadMode::Hand).map_err(|e| said(&e))?;
                made(Box::new(device), Steering::Gamepad(thread))
            }
        }
    }

    /// Name on the page and beside the trainer.
    pub fn title(&self) -> String {
        match self {
            Self::Mouse => "Mouse".to_owned(),
            Self::Touch => "Touch screen".to_owned(),
            Self::Keyboard => "Keyboard".to_owned(),
            Self::Replay => "Replay of the open log".to_owned(),
            Self::Haply(left, right) => format!("Haply boards {left}, {right}"),
            Self::Udp => "Remote device over UDP".to_owned(),
            #[cfg(feature = "gamepad")]
            Self::Gamepad => "Gamepad".to_owned(),
        }
    }

    /// One-sentence description for newcomers.
    pub fn sentence(&self) -> &'static str {
        match self {
            Self::Mouse => "One pointer moves both fingers, the button pinches; the force is shown, not felt.",
            Self::Touch => "Two real fingers on the glass, one a fingertip; bring them together to pinch.",
            Self::Keyboard => "Arrows move, Space closes, Backspace opens, Shift makes it slow.",
            Self::Replay => "The fingers go where they went in the log that is open in Calibrate.",
            Self::Haply(..) => "Two Haply 2DIY boards, one a finger; the force is felt.",
            #[cfg(feature = "gamepad")]
            Self::Gamepad => "The left stick moves, the triggers close and open; the rumble hints at the force.",
            Self::Udp => "A device at the other end of a network; every packet is sealed with a shared key.",
        }
    }
}

fn said(error: &dyn std::error::Error) -> String {
    crate::text::sentence::sentence(&error.to_string())
}

fn mouse_start(tips: [Vec2; 2]) -> MouseTarget {
    MouseTarget { center_in_world: 0.5 * (tips[0] + tips[1]), aperture_m: tips[1].x - tips[0].x }
}

impl Steering {
    /// Forwards the pointer's goal, if there is a pointer.
    pub fn follow(&mut self, pinch: &mut Pinch, tick: &haptics::servo::TickRecord, frame_s: f64) {
        if let Self::Mouse(handle) = self {
            handle.set(pinch.follow(tick, frame_s));
        }
    }
}

/// Description of a device in plain words, as label and sentence. With `waves` it is behind a link with wave variables,
/// and the damping seen by the servo is that of the link.
pub fn spec_sentences(spec: &DeviceSpec, waves: bool) -> Vec<(&'static str, String)> {
    use crate::text::format::number;
    let unit = |value: f64, decimals: usize, unit: &str, none: &str| {
        if value > 0.0 { format!("{} {unit}", number(value, decimals)) } else { none.to_owned() }
    };
    vec![
        ("Force", if spec.force_feedback { "felt by the operator" } else { "shown, not felt" }.to_owned()),
        ("Largest force", format!("{} N a finger", number(spec.max_force_n, 1))),
        (if waves { "Wave impedance b" } else { "Own damping b" }, unit(spec.damping_n_s_m, 2, "N s/m", "none stated")),
        ("Own friction", unit(spec.coulomb_n, 2, "N", "none stated")),
        ("Position step", unit(1e3 * spec.resolution_m, 3, "mm", "none: continuous")),
    ]
}
