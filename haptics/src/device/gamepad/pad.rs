//! The thread that reads a real gamepad and makes it rumble. Never the servo's: reading waits.

use super::backend::{GamepadDevice, GamepadHandle, GamepadMode, PadState, gamepad};
use super::rumble::Rumble;
use crate::Vec2;
use crate::hand::Workspace;
use gilrs::ff::{BaseEffect, BaseEffectType, Effect, EffectBuilder, Repeat, Replay, Ticks};
use gilrs::{Axis, Button, GamepadId, Gilrs};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, mpsc};
use std::thread::JoinHandle;
use std::time::Duration;

/// Time between two readings.
const PERIOD: Duration = Duration::from_millis(4);
/// A change of rumble smaller than this is not sent: pads take some thirty commands a second.
const RUMBLE_STEP: f32 = 0.05;

/// Why a gamepad could not be used.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum GamepadError {
    /// Nothing there.
    #[error("no gamepad was found; plug one in, and see that you may read /dev/input (group input)")]
    None,
    /// The system does not do gamepads.
    #[error("gamepads cannot be read here ({0})")]
    System(String),
}

/// The reading thread. Dropping it stops it, and the rumble with it.
pub struct GamepadThread {
    stop: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
    name: String,
}

impl GamepadThread {
    /// Name that the pad reports.
    pub fn name(&self) -> &str {
        &self.name
    }
}

impl Drop for GamepadThread {
    fn drop(&mut self) {
        self.stop.store(true, Ordering::Relaxed);
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

/// Opens the first gamepad and starts to read it; the tips start at `start_in_world` (left, right; m).
pub fn open(
    start_in_world: [Vec2; 2],
    workspace: Workspace,
    mode: GamepadMode,
) -> Result<(GamepadThread, GamepadDevice), GamepadError> {
    let (handle, device) = gamepad(start_in_world, workspace, mode);
    let stop = Arc::new(AtomicBool::new(false));
    let end = Arc::clone(&stop);
    // gilrs is opened where it is used: what it holds may not move between threads on every system.
    let (report, opened) = mpsc::channel();
    let thread = std::thread::Builder::new()
        .name("gamepad".to_owned())
        .spawn(move || match start() {
            Ok((gilrs, id, name)) => {
                let _ = report.send(Ok(name));
                read(gilrs, id, handle, &end);
            }
            Err(error) => {
                let _ = report.send(Err(error));
            }
        })
        .map_err(|e| GamepadError::System(e.to_string()))?;
    let name = opened.recv().unwrap_or_else(|_| Err(GamepadError::System("its thread ended".to_owned())))?;
    Ok((GamepadThread { stop, thread: Some(thread), name }, device))
}

fn start() -> Result<(Gilrs, GamepadId, String), GamepadError> {
    let gilrs = Gilrs::new().map_err(|e| GamepadError::System(e.to_string()))?;
    let found = gilrs.gamepads().next().map(|(id, pad)| (id, pad.name().to_owned()));
    let (id, name) = found.ok_or(GamepadError::None)?;
    Ok((gilrs, id, name))
}

fn read(mut gilrs: Gilrs, id: GamepadId, mut handle: GamepadHandle, stop: &AtomicBool) {
    let full = u16::MAX;
    let mut motors = [BaseEffectType::Weak { magnitude: full }, BaseEffectType::Strong { magnitude: full }]
        .map(|kind| Motor { effect: rumble(&mut gilrs, id, kind), strength: 0.0 });
    let mut number = 0;
    while !stop.load(Ordering::Relaxed) {
        // Events update the pad's state; between them the wait is the period.
        if gilrs.next_event_blocking(Some(PERIOD)).is_some() {
            while gilrs.next_event().is_some() {}
        }
        number += 1;
        handle.set(state(&gilrs, id, number));
        let Rumble { force, impact } = handle.rumble();
        for (motor, wanted) in motors.iter_mut().zip([force, impact]) {
            motor.turn(wanted);
        }
    }
    for motor in &motors {
        if let Some(effect) = &motor.effect {
            let _ = effect.set_gain(0.0);
            let _ = effect.stop();
        }
    }
}

/// One motor of the pad; a pad without rumble has an effect of none.
struct Motor {
    effect: Option<Effect>,
    strength: f32,
}

impl Motor {
    fn turn(&mut self, wanted: f32) {
        let changed = (wanted - self.strength).abs() > RUMBLE_STEP || (wanted == 0.0 && self.strength != 0.0);
        if let Some(effect) = self.effect.as_ref().filter(|_| changed) {
            self.strength = wanted;
            // A pad that does not take it is a pad without rumble.
            let _ = effect.set_gain(wanted);
        }
    }
}

fn state(gilrs: &Gilrs, id: GamepadId, number: u64) -> PadState {
    let Some(pad) = gilrs.connected_gamepad(id) else { return PadState { number, ..PadState::default() } };
    let stick = |x: Axis, y: Axis| Vec2::new(f64::from(pad.value(x)), f64::from(pad.value(y)));
    let trigger = |button: Button| pad.button_data(button).map_or(0.0, |data| f64::from(data.value()));
    PadState {
        sticks: [stick(Axis::LeftStickX, Axis::LeftStickY), stick(Axis::RightStickX, Axis::RightStickY)],
        triggers: [trigger(Button::LeftTrigger2), trigger(Button::RightTrigger2)],
        connected: true,
        number,
    }
}

/// An endless rumble of one motor at gain zero, whose gain then follows force or impact; `None` for a pad without.
fn rumble(gilrs: &mut Gilrs, id: GamepadId, kind: BaseEffectType) -> Option<Effect> {
    if !gilrs.connected_gamepad(id)?.is_ff_supported() {
        return None;
    }
    let scheduling = Replay { play_for: Ticks::from_ms(1_000), ..Replay::default() };
    let effect = EffectBuilder::new()
        .add_effect(BaseEffect { kind, scheduling, ..BaseEffect::default() })
        .gamepads(&[id])
        .repeat(Repeat::Infinitely)
        .gain(0.0)
        .finish(gilrs)
        .ok()?;
    effect.play().ok()?;
    Some(effect)
}
