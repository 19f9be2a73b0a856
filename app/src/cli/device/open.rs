//! The available devices, and their construction from the command line.

use crate::operator;
use crate::ui::train::trainer::remote::Remote;
use anyhow::Context;
use haptics::Vec2;
use haptics::device::channel::{ChannelConfig, ChannelDevice, Waves};
use haptics::device::haply::{HaplyHand, Tally};
use haptics::device::udp::{Key, UdpConfig, UdpDevice, UdpMonitor};
use haptics::device::{Device, DeviceSpec, MouseTarget, ReplayDevice, ScriptedOperator, keyboard, mouse, touch};
use haptics::world::{State, World};
use std::path::Path;

/// A kind of device, for the list.
pub struct Kind {
    /// Value of `--device`.
    pub id: &'static str,
    /// Description, one sentence.
    pub what: &'static str,
    /// Specification; `None` if it is known only once the device is connected.
    pub spec: Option<DeviceSpec>,
}

/// Every kind of device of this build.
pub fn kinds(world: &World) -> Vec<Kind> {
    let spec_of = |name: &str| open(name, world).ok().map(|opened| opened.device.spec().clone());
    let mut kinds = vec![
        Kind {
            id: "mouse",
            what: "Moves both fingers, the left button pinches; the force is shown, not felt",
            spec: spec_of("mouse"),
        },
        Kind {
            id: "touch",
            what: "Two real fingers on the glass; bring them together to pinch",
            spec: spec_of("touch"),
        },
        Kind { id: "keyboard", what: "Held keys move, close and open the hand", spec: spec_of("keyboard") },
        Kind {
            id: "scripted[:LEVEL]",
            what: "Does the tasks like a person: steady, novice, intermediate, advanced or expert",
            spec: spec_of("scripted"),
        },
        Kind { id: "replay:LOG", what: "The fingers go where they went in a log", spec: None },
        Kind {
            id: "haply:LEFT_PORT,RIGHT_PORT",
            what: "Two Haply 2DIY boards, one a finger; the force is felt",
            spec: Some(HaplyHand::two_boards()),
        },
        Kind {
            id: "udp:ADDRESS[:PORT],KEYFILE[,DAMPING[,ROUND_TRIP[,waves]]]",
            what: "A device over the network, sealed with a shared key (docs/udp); its damping in N s/m and round trip in ms, if known",
            spec: Some(UdpConfig::unstated()),
        },
    ];
    if cfg!(feature = "gamepad") {
        kinds.push(Kind {
            id: "gamepad[:tips]",
            what: "Left stick and triggers, or a stick a fingertip; rumble is a cue of the force",
            spec: None,
        });
    }
    kinds
}

/// Opened device with its accessories.
pub struct Opened {
    /// The device.
    pub device: Box<dyn Device>,
    /// Initial tip positions, m in the world.
    pub start_in_world: [Vec2; 2],
    /// Advice to a person on moving it, or the reason why nothing moves.
    pub hint: &'static str,
    /// Packet counters of a remote device.
    pub packets: Option<UdpMonitor>,
    /// Answers of the left and the right board.
    pub answers: Option<[Tally; 2]>,
    /// Resources that must live as long as the device.
    pub keep: Option<Box<dyn std::any::Any>>,
}

const NO_WINDOW: &str = "It is moved in the window; here only its servo can be tested.";

/// Opens the device named on the command line.
pub fn open(name: &str, world: &World) -> anyhow::Result<Opened> {
    let state = State::resting(world);
    let tips = state.input.tip_in_world;
    let workspace = world.hand.workspace;
    let opened = |device: Box<dyn Device>, hint| Opened {
        device,
        start_in_world: tips,
        hint,
        packets: None,
        answers: None,
        keep: None,
    };
    let (kind, rest) = name.split_once(':').map_or((name, None), |(kind, rest)| (kind, Some(rest)));
    match (kind, rest) {
        ("mouse", None) => {
            let start = MouseTarget { center_in_world: 0.5 * (tips[0] + tips[1]), aperture_m: tips[1].x - tips[0].x };
            Ok(opened(Box::new(mouse(start, workspace).1), NO_WINDOW))
        }
        ("touch", None) => Ok(opened(Box::new(touch(tips, workspace).1), NO_WINDOW)),
        ("keyboard", None) => Ok(opened(Box::new(keyboard(tips, workspace).1), NO_WINDOW)),
        ("scripted", level) => {
            let skill = operator::skill(level.unwrap_or(operator::USUAL)).map_err(anyhow::Error::msg)?;
            Ok(opened(Box::new(ScriptedOperator::new(world, &state, skill, 1)), "It moves by itself."))
        }
        ("replay", Some(log)) => replay(log),
        ("haply", Some(ports)) => {
            let hand = haply_hand(ports, world)?;
            let answers = Some(hand.tallies());
            Ok(Opened { answers, ..opened(Box::new(hand), "Move both handles while it runs.") })
        }
        ("udp", Some(rest)) => remote(rest, world, tips),
        ("gamepad", mode) => gamepad(mode, world, tips),
        _ => anyhow::bail!("there is no device `{name}`; `touchstone device list` shows what there is"),
    }
}

fn replay(log: &str) -> anyhow::Result<Opened> {
    let recordings = estimator::log::load(Path::new(log), None)?;
    let recording = recordings.first().context("the log holds no recording")?;
    let device = ReplayDevice::from_recording(recording)?;
    let start_in_world = device.start_in_world();
    Ok(Opened {
        device: Box::new(device),
        start_in_world,
        hint: "It moves by itself.",
        packets: None,
        answers: None,
        keep: None,
    })
}

fn haply_hand(ports: &str, world: &World) -> anyhow::Result<HaplyHand> {
    let (left, right) =
        ports.split_once(',').context("two boards are two fingers: name both ports, haply:LEFT_PORT,RIGHT_PORT")?;
    Ok(HaplyHand::open([left, right], world.hand.workspace.center_m, crate::program().as_deref())?)
}

/// `ADDRESS[:PORT],KEYFILE[,DAMPING[,ROUND_TRIP[,waves]]]`
fn remote(text: &str, world: &World, tips: [Vec2; 2]) -> anyhow::Result<Opened> {
    let mut parts = text.split(',');
    let address = parts.next().unwrap_or_default();
    let key_file = parts.next().context("a remote device needs a key: udp:ADDRESS,KEYFILE")?;
    let mut next = || parts.next().unwrap_or_default().to_owned();
    let (damping, round_trip) = (next(), next());
    let waves = match parts.next() {
        None => false,
        Some("waves") => true,
        Some(other) => anyhow::bail!("`{other}` says nothing about a remote device; `waves` asks for wave variables"),
    };
    let remote = Remote { key: key_file.to_owned(), address: address.to_owned(), damping, round_trip, waves };
    let config = remote.config(world).map_err(anyhow::Error::msg)?;
    for doubt in Key::doubts(Path::new(key_file)) {
        eprintln!("{doubt}");
    }
    let device = UdpDevice::open(config, tips)?;
    let packets = Some(device.monitor());
    let hint = "Start the device's program while it runs (docs/udp has examples).";
    Ok(Opened { device: Box::new(device), start_in_world: tips, hint, packets, answers: None, keep: None })
}

#[cfg(feature = "gamepad")]
fn gamepad(mode: Option<&str>, world: &World, tips: [Vec2; 2]) -> anyhow::Result<Opened> {
    use haptics::device::gamepad::{GamepadMode, open};
    let mode = match mode {
        None => GamepadMode::Hand,
        Some("tips") => GamepadMode::Tips,
        Some(other) => anyhow::bail!("a gamepad has no mode `{other}`; use gamepad or gamepad:tips"),
    };
    let (thread, device) = open(tips, world.hand.workspace, mode)?;
    let hint = "Move the sticks while it runs.";
    Ok(Opened {
        device: Box::new(device),
        start_in_world: tips,
        hint,
        packets: None,
        answers: None,
        keep: Some(Box::new(thread)),
    })
}

#[cfg(not(feature = "gamepad"))]
fn gamepad(_: Option<&str>, _: &World, _: [Vec2; 2]) -> anyhow::Result<Opened> {
    anyhow::bail!("this build has no gamepads; build it with `--features gamepad` (on Linux that needs libudev-dev)")
}

/// Puts a device behind a simulated slow network if that was requested.
pub fn behind_a_network(
    opened: Opened,
    config: ChannelConfig,
    waves: bool,
    world: &World,
    period_s: f64,
) -> anyhow::Result<Opened> {
    let none = ChannelConfig { seed: config.seed, ..ChannelConfig::default() };
    if config == none && !waves {
        return Ok(opened);
    }
    let waves = waves.then(|| Waves::new(opened.device.spec(), world, period_s));
    let device = ChannelDevice::new(opened.device, ChannelConfig { waves, ..config })?;
    Ok(Opened { device: Box::new(device), ..opened })
}

#[cfg(test)]
mod tests {
    use super::*;
    use haptics::world::presets;

    #[test]
    fn every_device_without_hardware_opens_and_nonsense_is_refused_in_words() {
        let world = presets::stacking();
        for name in ["mouse", "touch", "keyboard", "scripted", "scripted:novice"] {
            assert!(open(name, &world).is_ok(), "{name}");
        }
        for (name, wanted) in [
            ("joystick", "device list"),
            ("scripted:genius", "novice"),
            ("haply:one", "both ports"),
            ("udp:127.0.0.1", "KEYFILE"),
            ("udp:127.0.0.1,/nowhere", "/nowhere"),
            ("udp:elsewhere,/nowhere", "no address"),
            ("udp:127.0.0.1,/nowhere,-1", "`-1` is no damping"),
            ("udp:127.0.0.1,/nowhere,1,soon", "`soon` is no round trip"),
            ("udp:127.0.0.1,/nowhere,1,5,often", "`often` says nothing"),
            ("replay:/nowhere.csv", "/nowhere.csv"),
        ] {
            let error = open(name, &world).err().map(|e| format!("{e:#}")).unwrap_or_default();
            assert!(error.contains(wanted), "{name}: {error}");
        }
    }
}
