//! Touches and held keys from the window to the devices that take them.

use crate::ui::scene::view::SceneResponse;
use crate::ui::train::trainer::hand::{HandDevice, Steering};
use crate::ui::train::trainer::live::Trainer;
use egui::{Event, Key, TouchPhase, Ui};
use haptics::device::{KeysHeld, TouchHandle};

/// Passes this frame's touches to the touch device. A touch while the mouse is the device switches to the touch screen.
/// The error is that of starting the device.
pub fn touches(ui: &Ui, view: &SceneResponse, trainer: &mut Trainer) -> Result<(), String> {
    let events: Vec<(u64, TouchPhase, egui::Pos2)> = ui.input(|i| {
        let touch = |event: &Event| match event {
            Event::Touch { id, phase, pos, .. } => Some((id.0, *phase, *pos)),
            _ => None,
        };
        i.events.iter().filter_map(touch).collect()
    });
    let begins =
        |(_, phase, at): &(u64, TouchPhase, egui::Pos2)| *phase == TouchPhase::Start && view.rect.contains(*at);
    if trainer.hand == HandDevice::Mouse && events.iter().any(begins) {
        trainer.take_up(HandDevice::Touch)?;
    }
    let Steering::Touch(handle) = &mut trainer.steering else { return Ok(()) };
    for (id, phase, at) in events {
        let in_world = view.point_in_world(ui, at);
        pass_on(handle, (id, phase), in_world, view.rect.contains(at));
    }
    if !ui.input(|i| i.focused) && handle.count() > 0 {
        handle.cancel();
    }
    Ok(())
}

fn pass_on(handle: &mut TouchHandle, (id, phase): (u64, TouchPhase), in_world: Option<haptics::Vec2>, inside: bool) {
    match (phase, in_world) {
        (TouchPhase::Start, Some(at)) if inside => handle.begin(id, at),
        (TouchPhase::Move, Some(at)) => handle.move_to(id, at),
        (TouchPhase::End, _) => handle.end(id),
        (TouchPhase::Cancel, _) => handle.cancel(),
        _ => {}
    }
}

/// Passes the held keys to the keyboard device; none while a text field or another window has the keyboard.
pub fn keys(ui: &Ui, trainer: &mut Trainer) {
    let Steering::Keyboard(handle) = &mut trainer.steering else { return };
    let elsewhere = ui.ctx().egui_wants_keyboard_input();
    handle.set(ui.input(|i| {
        if elsewhere || !i.focused {
            return KeysHeld::default();
        }
        KeysHeld {
            left: i.key_down(Key::ArrowLeft),
            right: i.key_down(Key::ArrowRight),
            up: i.key_down(Key::ArrowUp),
            down: i.key_down(Key::ArrowDown),
            close: i.key_down(Key::Space),
            open: i.key_down(Key::Backspace),
            fine: i.modifiers.shift,
        }
    }));
}
