//! The keyboard, for people who cannot use a mouse: keys that are held move the hand, close it and open it.
//!
//! Only held keys count, never how often the system repeats a key. Speeds come up and go down with a bounded
//! acceleration, and the fine mode makes everything five times slower.

use super::interface::{Command, Device, DeviceSpec, Sample};
use super::pointer::Pointer;
use super::steering::Steering;
use crate::Vec2;
use crate::hand::Workspace;
use triple_buffer::{Input, Output, triple_buffer};

/// Speed of the hand, m/s: across the workspace in 1.3 s.
const HAND_M_S: f64 = 0.06;
/// Speed at which the fingers open and close, m/s of their distance. On an object that is 6 N/s of pinch.
const APERTURE_M_S: f64 = 0.03;
/// Speeds in fine mode.
const FINE: f64 = 0.2;
/// The keys that are held down now. Their assignment to physical keys is the window's business.
#[allow(clippy::struct_excessive_bools)] // seven keys
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct KeysHeld {
    /// Moves the hand left.
    pub left: bool,
    /// Moves the hand right.
    pub right: bool,
    /// Moves the hand up.
    pub up: bool,
    /// Moves the hand down.
    pub down: bool,
    /// Brings the fingers together, then squeezes.
    pub close: bool,
    /// Takes the fingers apart.
    pub open: bool,
    /// Five times slower.
    pub fine: bool,
}

/// The window's end of a keyboard device. Used on the GUI thread.
pub struct KeyboardHandle {
    keys: Input<KeysHeld>,
}

impl KeyboardHandle {
    /// States which keys are held. With the focus lost, none are: `set(KeysHeld::default())`.
    pub fn set(&mut self, keys: KeysHeld) {
        self.keys.write(keys);
    }
}

/// The servo's end of a keyboard device.
pub struct KeyboardDevice {
    spec: DeviceSpec,
    keys: Output<KeysHeld>,
    pointer: Pointer,
    steering: Steering,
}

/// A keyboard device whose tips start at `start_in_world` (left, right; m) and stay in `workspace`.
pub fn keyboard(start_in_world: [Vec2; 2], workspace: Workspace) -> (KeyboardHandle, KeyboardDevice) {
    let (input, output) = triple_buffer(&KeysHeld::default());
    let device = KeyboardDevice {
        spec: Pointer::spec("Keyboard"),
        keys: output,
        pointer: Pointer::new(start_in_world, workspace),
        steering: Steering::new(start_in_world),
    };
    (KeyboardHandle { keys: input }, device)
}

/// +1, −1 or 0 for two keys that contradict each other.
fn axis(plus: bool, minus: bool) -> f64 {
    f64::from(i8::from(plus) - i8::from(minus))
}

impl Device for KeyboardDevice {
    fn spec(&self) -> &DeviceSpec {
        &self.spec
    }

    fn exchange(&mut self, command: &Command, dt_s: f64) -> Sample {
        let keys = *self.keys.read();
        let scale = if keys.fine { FINE } else { 1.0 };
        let direction = Vec2::new(axis(keys.right, keys.left), axis(keys.up, keys.down));
        // Two keys at once are no faster than one.
        let hand_m_s = direction / direction.norm().max(1.0) * (HAND_M_S * scale);
        let aperture_m_s = axis(keys.open, keys.close) * APERTURE_M_S * scale;
        let goals = self.steering.steer(hand_m_s, aperture_m_s, &self.pointer, dt_s);
        self.pointer.advance(goals, command.force_n, dt_s)
    }

    fn make_safe(&mut self) {}
}

#[cfg(test)]
mod tests {
    use super::super::pointer::tips;
    use super::super::steering::{HAND_M_S2, MAX_LEAN_N};
    use super::*;
    use crate::hand::Hand;
    use crate::servo::safety::Limits;
    use crate::servo::{Loop, Swap};
    use crate::world::{State, presets};

    const DT: f64 = 1e-3;

    fn device() -> (KeyboardHandle, KeyboardDevice, Vec2) {
        let workspace = Hand::default().workspace;
        let (handle, device) = keyboard(tips(workspace.center_m, 0.024), workspace);
        (handle, device, workspace.center_m)
    }

    fn hold(device: &mut KeyboardDevice, ticks: usize) -> (Vec2, f64) {
        let mut sample = Sample::default();
        for _ in 0..ticks {
            sample = device.exchange(&Command::default(), DT);
        }
        let [left, right] = sample.tip_in_world;
        (0.5 * (left + right), right.x - left.x)
    }

    #[test]
    fn a_held_key_moves_at_its_speed_however_often_it_is_reported() {
        let path = |repeats: bool| {
            let (mut handle, mut device, _) = device();
            let mut path = Vec::new();
            for tick in 0..400 {
                if tick == 0 || (repeats && tick % 33 == 0) {
                    handle.set(KeysHeld { right: true, ..KeysHeld::default() });
                }
                path.push(hold(&mut device, 1).0.x);
            }
            path
        };
        let once = path(false);
        assert_eq!(once, path(true), "to the bit");
        // v t − v²/(2 a), less the lag of the smoothing.
        let (start, travelled) = (Hand::default().workspace.center_m.x, once[399]);
        let expected = 0.4 * HAND_M_S - HAND_M_S.powi(2) / (2.0 * HAND_M_S2);
        assert!((travelled - start - expected).abs() < 1.5 * HAND_M_S * 0.02, "{travelled} against {expected}");
    }

    #[test]
    fn diagonals_are_no_faster_and_fine_is_five_times_slower() {
        let distance = |keys: KeysHeld| {
            let (mut handle, mut device, center) = device();
            handle.set(keys);
            (hold(&mut device, 300).0 - center).norm()
        };
        let up = KeysHeld { up: true, ..KeysHeld::default() };
        let diagonal = KeysHeld { left: true, ..up };
        assert!((distance(diagonal) / distance(up) - 1.0).abs() < 1e-6);
        assert!(distance(KeysHeld { fine: true, ..up }) < 0.3 * distance(up));
        assert_eq!(distance(KeysHeld { down: true, ..up }), 0.0, "opposite keys cancel");
    }

    #[test]
    fn stays_in_the_workspace_and_closes_without_passing() {
        let (mut handle, mut device, center) = device();
        handle.set(KeysHeld { right: true, close: true, ..KeysHeld::default() });
        let (middle, apart) = hold(&mut device, 5_000);
        let edge = center.x + Hand::default().workspace.radius_m;
        assert!((middle.x - edge).abs() < 1e-6 && apart.abs() < 1e-6, "{middle} {apart}");
        handle.set(KeysHeld { open: true, ..KeysHeld::default() });
        let (_, apart) = hold(&mut device, 1_000);
        assert!(apart > 0.02, "and opens again at once: {apart}");
    }

    #[test]
    fn squeezes_up_to_its_limit_and_lifts_a_block() {
        let world = presets::stacking();
        let mut state = State::resting(&world);
        let block = state.bodies[0].center_m;
        state = State::new(&world, tips(block, 0.024));
        let (mut handle, device) = keyboard(state.input.tip_in_world, world.hand.workspace);
        let limits = Limits { max_force_n: device.spec().max_force_n, ..Limits::default() };
        let mut servo = Loop::new(Swap::at(world, state), Box::new(device), limits);
        handle.set(KeysHeld { close: true, ..KeysHeld::default() });
        let mut force: f64 = 0.0;
        for _ in 0..4_000 {
            force = servo.tick(DT).tip_force_n[0].norm();
        }
        assert!(force > 2.0 && force < MAX_LEAN_N + 0.5, "{force} N");
        handle.set(KeysHeld { up: true, ..KeysHeld::default() });
        let last = (0..300).map(|_| servo.tick(DT)).last().expect("300 ticks");
        assert_eq!(last.label, "hold-above-ground");
    }
}
