//! The servo's end of a gamepad. It knows no hardware: the thread that reads a real pad is in `pad.rs`, behind the feature `gamepad`
//! (on Linux it needs the headers of libudev to be built).

use super::rumble::{Knock, Rumble, force_strength};
use crate::Vec2;
use crate::device::interface::{Command, Device, DeviceSpec, Sample};
use crate::device::pointer::{Pointer, towards};
use crate::device::steering::{MAX_LEAN_N, Steering};
use crate::hand::Workspace;
use triple_buffer::{Input, Output, triple_buffer};

/// Speed of a tip with the stick at its end, m/s.
const TIP_M_S: f64 = 0.08;
/// Speed of the fingers' distance with a trigger pressed, m/s.
const APERTURE_M_S: f64 = 0.04;
/// Sticks rest anywhere within this share of their way.
const DEAD: f64 = 0.12;
/// Without a word from the reading thread for this long the sticks count as let go, s.
const SILENCE_S: f64 = 0.1;

/// Assignment of the sticks to motions.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum GamepadMode {
    /// The left stick moves the hand, the triggers close (right) and open (left) the fingers.
    #[default]
    Hand,
    /// Each stick moves its own fingertip.
    Tips,
}

/// The pad as it is now.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PadState {
    /// Left and right stick, each axis −1 to 1, right and up positive.
    pub sticks: [Vec2; 2],
    /// Left and right trigger, 0 to 1.
    pub triggers: [f64; 2],
    /// False while no pad is plugged in.
    pub connected: bool,
    /// Counts the readings: an unchanged number is a reader that hangs.
    pub number: u64,
}

/// The reading thread's end.
pub struct GamepadHandle {
    pad: Input<PadState>,
    rumble: Output<Rumble>,
}

impl GamepadHandle {
    /// States how the pad is now; to be repeated several times in [`SILENCE_S`] even when nothing has changed.
    pub fn set(&mut self, pad: PadState) {
        self.pad.write(pad);
    }

    /// Rumble that the pad should make now.
    pub fn rumble(&mut self) -> Rumble {
        *self.rumble.read()
    }
}

/// The servo's end of a gamepad.
pub struct GamepadDevice {
    spec: DeviceSpec,
    pad: Output<PadState>,
    rumble: Input<Rumble>,
    knock: Knock,
    mode: GamepadMode,
    pointer: Pointer,
    steering: Steering,
    goal: [Vec2; 2],
    number: u64,
    silent_s: f64,
}

/// A gamepad device whose tips start at `start_in_world` (left, right; m) and stay in `workspace`.
pub fn gamepad(start_in_world: [Vec2; 2], workspace: Workspace, mode: GamepadMode) -> (GamepadHandle, GamepadDevice) {
    let (pad_in, pad) = triple_buffer(&PadState::default());
    let (rumble, rumble_out) = triple_buffer(&Rumble::default());
    let device = GamepadDevice {
        spec: Pointer::spec("Gamepad"),
        pad,
        rumble,
        knock: Knock::default(),
        mode,
        pointer: Pointer::new(start_in_world, workspace),
        steering: Steering::new(start_in_world),
        goal: start_in_world,
        number: 0,
        silent_s: f64::INFINITY,
    };
    (GamepadHandle { pad: pad_in, rumble: rumble_out }, device)
}

/// Stick position without its dead zone, with fine control near the middle; 0 for values that are not numbers.
fn shaped(stick: Vec2) -> Vec2 {
    let size = stick.norm().min(1.0);
    if size.is_finite() && size > DEAD {
        let share = (size - DEAD) / (1.0 - DEAD);
        stick.normalize() * share * share
    } else {
        Vec2::zeros()
    }
}

impl GamepadDevice {
    fn goals(&mut self, pad: &PadState, dt_s: f64) -> [Vec2; 2] {
        let [left, right] = pad.sticks.map(|stick| shaped(stick) * TIP_M_S);
        match self.mode {
            GamepadMode::Hand => {
                let [open, close] = pad.triggers.map(|t| if t.is_finite() { t.clamp(0.0, 1.0) } else { 0.0 });
                self.steering.steer(left, (open - close) * APERTURE_M_S, &self.pointer, dt_s)
            }
            GamepadMode::Tips => {
                let (tips, workspace) = (self.pointer.tips(), self.pointer.workspace());
                let reach = self.pointer.reach_m(MAX_LEAN_N);
                for ((goal, tip), speed) in self.goal.iter_mut().zip(tips).zip([left, right]) {
                    *goal = workspace.clamp(towards(tip, *goal + speed * dt_s, reach));
                }
                self.goal
            }
        }
    }
}

impl Device for GamepadDevice {
    fn spec(&self) -> &DeviceSpec {
        &self.spec
    }

    fn exchange(&mut self, command: &Command, dt_s: f64) -> Sample {
        let mut pad = *self.pad.read();
        self.silent_s = if pad.number == self.number { self.silent_s + dt_s } else { 0.0 };
        self.number = pad.number;
        let present = pad.connected && self.silent_s < SILENCE_S;
        if !present {
            // A pad that is gone holds no stick.
            pad = PadState::default();
        }
        let goals = self.goals(&pad, dt_s);
        let most = command.force_n.iter().fold(0.0_f64, |most, force| most.max(force.norm()));
        self.knock.pass(dt_s);
        let impact = self.knock.strength() as f32;
        self.rumble.write(Rumble { force: force_strength(most) as f32, impact });
        let sample = self.pointer.advance(goals, command.force_n, dt_s);
        Sample { fresh: [present; 2], ..sample }
    }

    fn strike(&mut self, speed_m_s: f64) {
        self.knock.strike(speed_m_s);
    }

    fn make_safe(&mut self) {
        self.knock = Knock::default();
        self.rumble.write(Rumble::default());
    }
}

#[cfg(test)]
mod tests {
    use super::super::rumble::impact_strength;
    use super::*;
    use crate::hand::Hand;

    const DT: f64 = 1e-3;

    fn device(mode: GamepadMode) -> (GamepadHandle, GamepadDevice, Vec2) {
        let workspace = Hand::default().workspace;
        let center = workspace.center_m;
        let side = Vec2::new(0.012, 0.0);
        let (handle, device) = gamepad([center - side, center + side], workspace, mode);
        (handle, device, center)
    }

    /// Holds the pad for some ticks, read at 250 Hz.
    fn hold(handle: &mut GamepadHandle, device: &mut GamepadDevice, pad: PadState, ticks: u64) -> Sample {
        let mut sample = Sample::default();
        for tick in 0..ticks {
            if tick % 4 == 0 {
                handle.set(PadState { connected: true, number: device.number + 1, ..pad });
            }
            sample = device.exchange(&Command::default(), DT);
        }
        sample
    }

    #[test]
    fn the_left_stick_moves_the_hand_and_the_triggers_close_and_open() {
        let (mut handle, mut device, center) = device(GamepadMode::Hand);
        let right = PadState { sticks: [Vec2::new(1.0, 0.0), Vec2::zeros()], ..PadState::default() };
        let [a, b] = hold(&mut handle, &mut device, right, 200).tip_in_world;
        assert!(0.5 * (a.x + b.x) > center.x + 0.003 && (b.x - a.x - 0.024).abs() < 1e-3);
        let close = PadState { triggers: [0.0, 1.0], ..PadState::default() };
        let [a, b] = hold(&mut handle, &mut device, close, 3_000).tip_in_world;
        assert!((b.x - a.x).abs() < 1e-6, "closed: {}", b.x - a.x);
        let open = PadState { triggers: [1.0, 0.0], ..PadState::default() };
        let [a, b] = hold(&mut handle, &mut device, open, 1_000).tip_in_world;
        assert!(b.x - a.x > 0.02);
    }

    #[test]
    fn each_stick_moves_its_tip_and_rests_in_its_dead_zone() {
        let (mut handle, mut device, center) = device(GamepadMode::Tips);
        let one = PadState { sticks: [Vec2::new(0.0, -1.0), Vec2::new(0.1, 0.0)], ..PadState::default() };
        let [a, b] = hold(&mut handle, &mut device, one, 200).tip_in_world;
        assert!(a.y < center.y - 0.005 && (b - (center + Vec2::new(0.012, 0.0))).norm() < 1e-9);
        let broken = PadState { sticks: [Vec2::new(f64::NAN, 1.0), Vec2::zeros()], ..PadState::default() };
        assert!(hold(&mut handle, &mut device, broken, 100).tip_in_world[0].y.is_finite());
    }

    #[test]
    fn a_pad_that_is_gone_moves_nothing_and_is_stale() {
        let (mut handle, mut device, _) = device(GamepadMode::Hand);
        let up = PadState { sticks: [Vec2::new(0.0, 1.0), Vec2::zeros()], ..PadState::default() };
        assert!(hold(&mut handle, &mut device, up, 100).is_fresh());
        // The reader hangs with the stick held.
        let samples: Vec<Sample> = (0..1_000).map(|_| device.exchange(&Command::default(), DT)).collect();
        assert!(samples[..90].iter().all(Sample::is_fresh) && samples[110..].iter().all(|s| !s.is_fresh()));
        let height = |tick: usize| samples[tick].tip_in_world[0].y;
        assert!((height(999) - height(600)).abs() < 1e-9, "it stops");
    }

    #[test]
    fn force_rumbles_up_to_full_and_not_after_the_end() {
        let (mut handle, mut device, _) = device(GamepadMode::Hand);
        device.exchange(&Command { force_n: [Vec2::new(0.0, 1.0), Vec2::zeros()] }, DT);
        assert!((handle.rumble().force - 0.25).abs() < 1e-6);
        device.exchange(&Command { force_n: [Vec2::new(0.0, 100.0), Vec2::zeros()] }, DT);
        assert_eq!(handle.rumble(), Rumble { force: 1.0, impact: 0.0 });
        device.strike(0.5);
        device.exchange(&Command::default(), DT);
        assert_eq!(handle.rumble(), Rumble { force: 0.0, impact: 1.0 });
        device.make_safe();
        assert_eq!(handle.rumble(), Rumble::default());
    }

    #[test]
    fn a_block_that_lands_knocks_once_by_its_speed() {
        use crate::servo::{Loop, Swap, safety::Limits};
        use crate::world::presets;
        let mut world = presets::stacking();
        // 5 mm above the table: 0.31 m/s when it lands.
        world.blocks[0].start.center_m.y += 0.005;
        let tips = crate::world::State::resting(&world).input.tip_in_world;
        let (mut handle, device) = gamepad(tips, world.hand.workspace, GamepadMode::Hand);
        let mut servo = Loop::new(Swap::new(world), Box::new(device), Limits::default());
        let (mut fastest_m_s, mut strongest, mut last) = (0.0_f64, 0.0_f32, 0.0);
        for number in 0..400 {
            handle.set(PadState { connected: true, number, ..PadState::default() });
            fastest_m_s = fastest_m_s.max(servo.tick(DT).impact_m_s);
            last = handle.rumble().impact;
            strongest = strongest.max(last);
        }
        assert!((0.2..0.4).contains(&fastest_m_s), "{fastest_m_s} m/s");
        assert!((f64::from(strongest) - impact_strength(fastest_m_s, 0.0)).abs() < 1e-6, "{strongest}");
        assert_eq!(last, 0.0, "and it is over");
    }
}
