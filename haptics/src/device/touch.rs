//! The touch screen: two real fingers, each touch point is one fingertip. Bring them together to pinch.
//!
//! The left-most of two touches is finger 1. One touch alone moves the tip that it came nearest to; the other tip
//! stays. A finger that is lifted while the other stays down opens gently, after a moment. Fingers never leave the
//! glass at the same instant, and lifting both must not release the object. With both up, both tips keep their goals
//! and forces.

use super::interface::{Command, Device, DeviceSpec, Sample};
use super::pointer::{Pointer, towards};
use crate::Vec2;
use crate::hand::Workspace;
use triple_buffer::{Input, Output, triple_buffer};

/// A tip goes to a new touch at this speed, m/s: a quick reach, not a leap, so that nothing in between is hit hard.
const REACH_M_S: f64 = 0.4;
/// Speed at which a lifted finger opens, m/s.
const OPENING_M_S: f64 = 0.04;
/// Opening distance, m: enough to come clear of a squeezed object.
const OPENING_M: f64 = 0.012;
/// Fingers that leave the glass within this time leave it together, s.
const TOGETHER_S: f64 = 0.15;

/// Goals of the tips set by the touches, m in the world; `None` for a lifted finger.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Touches {
    tip_in_world: [Option<Vec2>; 2],
}

/// The window's end of a touch device. Used on the GUI thread; touches are named by the window system's ids.
pub struct TouchHandle {
    touches: Input<Touches>,
    down: [Option<(u64, Vec2)>; 2],
    last_in_world: [Vec2; 2],
}

impl TouchHandle {
    /// A finger came down at a point of the world, m. A third finger is ignored.
    pub fn begin(&mut self, id: u64, at_in_world: Vec2) {
        if !finite(at_in_world) {
            return;
        }
        match (self.finger_of(id), self.down) {
            (Some(_), _) => return self.move_to(id, at_in_world),
            (None, [Some(_), Some(_)]) => return,
            (None, [Some(first), None] | [None, Some(first)]) => {
                let second = (id, at_in_world);
                let (left, right) = if first.1.x <= at_in_world.x { (first, second) } else { (second, first) };
                self.down = [Some(left), Some(right)];
            }
            (None, [None, None]) => {
                let distance = |finger: usize| (self.last_in_world[finger] - at_in_world).norm();
                let nearest = usize::from(distance(1) < distance(0));
                self.down[nearest] = Some((id, at_in_world));
            }
        }
        self.publish();
    }

    /// A finger moved to a point of the world, m.
    pub fn move_to(&mut self, id: u64, at_in_world: Vec2) {
        if let Some(finger) = self.finger_of(id).filter(|_| finite(at_in_world)) {
            self.down[finger] = Some((id, at_in_world));
            self.publish();
        }
    }

    /// A finger was lifted.
    pub fn end(&mut self, id: u64) {
        if let Some(finger) = self.finger_of(id) {
            self.down[finger] = None;
            self.publish();
        }
    }

    /// The window system took the touches away, or the window lost the focus: all fingers are up.
    pub fn cancel(&mut self) {
        self.down = [None; 2];
        self.publish();
    }

    /// Number of fingers on the glass, 0 to 2.
    pub fn count(&self) -> usize {
        self.down.iter().flatten().count()
    }

    fn finger_of(&self, id: u64) -> Option<usize> {
        self.down.iter().position(|touch| touch.is_some_and(|(known, _)| known == id))
    }

    fn publish(&mut self) {
        for (last, touch) in self.last_in_world.iter_mut().zip(self.down) {
            *last = touch.map_or(*last, |(_, at)| at);
        }
        self.touches.write(Touches { tip_in_world: self.down.map(|touch| touch.map(|(_, at)| at)) });
    }
}

fn finite(point: Vec2) -> bool {
    point.x.is_finite() && point.y.is_finite()
}

/// The servo's end of a touch device.
pub struct TouchDevice {
    spec: DeviceSpec,
    touches: Output<Touches>,
    pointer: Pointer,
    goal: [Vec2; 2],
    lifted_s: [f64; 2],
    opened_m: [f64; 2],
}

/// A touch device whose tips start at `start_in_world` (left, right; m) and stay in `workspace`.
pub fn touch(start_in_world: [Vec2; 2], workspace: Workspace) -> (TouchHandle, TouchDevice) {
    let (input, output) = triple_buffer(&Touches::default());
    let handle = TouchHandle { touches: input, down: [None; 2], last_in_world: start_in_world };
    let device = TouchDevice {
        spec: Pointer::spec("Touch screen"),
        touches: output,
        pointer: Pointer::new(start_in_world, workspace),
        goal: start_in_world,
        // Nothing was held before the first touch: nothing opens.
        lifted_s: [0.0; 2],
        opened_m: [OPENING_M; 2],
    };
    (handle, device)
}

impl TouchDevice {
    /// Opens a lifted finger away from the other one, gently, once it is clear that the other stays down.
    fn open(&mut self, finger: usize, dt_s: f64) {
        self.lifted_s[finger] += dt_s;
        if self.lifted_s[finger] < TOGETHER_S || self.opened_m[finger] >= OPENING_M {
            return;
        }
        let away = self.goal[finger] - self.goal[1 - finger];
        let distance = away.norm();
        // Fingers in one place have no direction; the left one then opens to the left.
        let side = if finger == 0 { -1.0 } else { 1.0 };
        let direction = if distance > 1e-6 { away / distance } else { Vec2::new(side, 0.0) };
        let step = (OPENING_M_S * dt_s).min(OPENING_M - self.opened_m[finger]);
        self.opened_m[finger] += step;
        self.goal[finger] = self.pointer.workspace().clamp(self.goal[finger] + direction * step);
    }
}

impl Device for TouchDevice {
    fn spec(&self) -> &DeviceSpec {
        &self.spec
    }

    fn exchange(&mut self, command: &Command, dt_s: f64) -> Sample {
        let touches = *self.touches.read();
        for finger in 0..2 {
            if let Some(at) = touches.tip_in_world[finger] {
                let at = self.pointer.workspace().clamp(at);
                self.goal[finger] = towards(self.goal[finger], at, REACH_M_S * dt_s);
                (self.lifted_s[finger], self.opened_m[finger]) = (0.0, 0.0);
            } else if touches.tip_in_world[1 - finger].is_some() {
                self.open(finger, dt_s);
            } else {
                // Both are up: this finger stays, also when one comes down again.
                self.opened_m[finger] = OPENING_M;
            }
        }
        self.pointer.advance(self.goal, command.force_n, dt_s)
    }

    fn make_safe(&mut self) {}
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hand::Hand;
    use crate::servo::safety::Limits;
    use crate::servo::{Loop, Swap, TickRecord};
    use crate::world::{State, presets};

    const DT: f64 = 1e-3;

    fn device() -> (TouchHandle, TouchDevice, Vec2) {
        let workspace = Hand::default().workspace;
        let center = workspace.center_m;
        let side = Vec2::new(0.012, 0.0);
        let (handle, device) = touch([center - side, center + side], workspace);
        (handle, device, center)
    }

    fn settle(device: &mut TouchDevice, ticks: usize) -> [Vec2; 2] {
        let mut sample = Sample::default();
        for _ in 0..ticks {
            sample = device.exchange(&Command::default(), DT);
        }
        sample.tip_in_world
    }

    #[test]
    fn two_touches_are_two_tips_whatever_order_they_come_in() {
        for swapped in [false, true] {
            let (mut handle, mut device, center) = device();
            let (left, right) = (center + Vec2::new(-0.02, 0.01), center + Vec2::new(0.005, -0.01));
            let order = if swapped { [right, left] } else { [left, right] };
            handle.begin(7, order[0]);
            handle.begin(9, order[1]);
            handle.begin(11, center);
            assert_eq!(handle.count(), 2, "a third finger is ignored");
            let tips = settle(&mut device, 1_000);
            assert!((tips[0] - left).norm() < 1e-6 && (tips[1] - right).norm() < 1e-6, "{tips:?}");
        }
    }

    #[test]
    fn one_touch_moves_the_nearest_tip_and_the_other_stays() {
        let (mut handle, mut device, center) = device();
        let [left, _] = settle(&mut device, 10);
        handle.begin(1, center + Vec2::new(0.015, 0.0));
        handle.move_to(1, center + Vec2::new(0.015, 0.02));
        let tips = settle(&mut device, 1_000);
        assert!((tips[1] - (center + Vec2::new(0.015, 0.02))).norm() < 1e-6);
        assert!((tips[0] - left).norm() < 1e-9);
    }

    #[test]
    fn a_lifted_finger_opens_gently_and_only_while_the_other_stays() {
        let (mut handle, mut device, center) = device();
        let side = Vec2::new(0.006, 0.0);
        handle.begin(1, center - side);
        handle.begin(2, center + side);
        let [left, right] = settle(&mut device, 1_000);
        handle.end(1);
        let mut fastest: f64 = 0.0;
        let mut sample = Sample::default();
        for _ in 0..1_000 {
            sample = device.exchange(&Command::default(), DT);
            fastest = fastest.max(sample.tip_velocity[0].norm());
        }
        assert!((sample.tip_in_world[0] - (left - Vec2::new(OPENING_M, 0.0))).norm() < 1e-5);
        assert!((sample.tip_in_world[1] - right).norm() < 1e-9);
        assert!(fastest < 1.5 * OPENING_M_S, "{fastest} m/s");
    }

    /// Ticks until a condition holds or `most` is over; returns the largest step of force in one tick.
    fn run(servo: &mut Loop, ticks: usize) -> (TickRecord, f64) {
        let (mut last, mut jump) = (servo.tick(DT), 0.0_f64);
        for _ in 1..ticks {
            let tick = servo.tick(DT);
            jump = (0..2).fold(jump, |j, f| j.max((tick.tip_force_n[f] - last.tip_force_n[f]).norm()));
            last = tick;
        }
        (last, jump)
    }

    #[test]
    fn pinches_lifts_and_holds_when_both_fingers_leave_the_glass() {
        let world = presets::stacking();
        let state = State::resting(&world);
        let block = state.bodies[0].center_m;
        let (mut handle, device) = touch(state.input.tip_in_world, world.hand.workspace);
        let mut servo = Loop::new(Swap::at(world, state), Box::new(device), Limits::default());
        let touches = |handle: &mut TouchHandle, center: Vec2, half: f64| {
            handle.move_to(1, center - Vec2::new(half, 0.0));
            handle.move_to(2, center + Vec2::new(half, 0.0));
        };
        let above = block + Vec2::new(0.0, 0.02);
        handle.begin(1, above - Vec2::new(0.014, 0.0));
        handle.begin(2, above + Vec2::new(0.014, 0.0));
        run(&mut servo, 500);
        touches(&mut handle, block, 0.014);
        run(&mut servo, 500);
        touches(&mut handle, block, 0.004);
        run(&mut servo, 500);
        touches(&mut handle, block + Vec2::new(0.0, 0.015), 0.004);
        let (held, _) = run(&mut servo, 1_000);
        assert_eq!(held.label, "hold-above-ground");
        // One finger leaves the glass 40 ms before the other, as fingers do.
        handle.end(2);
        let (_, first) = run(&mut servo, 40);
        handle.end(1);
        let (after, second) = run(&mut servo, 2_000);
        assert_eq!(after.label, "hold-above-ground", "both up: held in place");
        assert!(first.max(second) < 0.05, "a step of {} N", first.max(second));
        assert!((after.tip_force_n[0].x - held.tip_force_n[0].x).abs() < 0.02);
        // One finger down again and nothing happens; both down and apart lets go.
        handle.begin(3, block + Vec2::new(-0.02, 0.015));
        handle.begin(4, block + Vec2::new(0.02, 0.015));
        assert_eq!(run(&mut servo, 1_000).0.label, "free-motion");
    }
}
