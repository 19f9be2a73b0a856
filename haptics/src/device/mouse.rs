//! The mouse as a pair of fingers with adjustable pinch: position only, the force is shown.

use super::interface::{Command, Device, DeviceSpec, Sample};
use super::pointer::{Pointer, tips};
use crate::Vec2;
use crate::hand::Workspace;
use triple_buffer::{Input, Output, triple_buffer};

/// Goal of the fingers that the pointer sets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MouseTarget {
    /// Middle between the tips, m in the world.
    pub center_in_world: Vec2,
    /// Wanted distance between the tips, m; the pads stop at the object between them, the rest is pinch force.
    pub aperture_m: f64,
}

/// The window's end of a mouse device. Used on the GUI thread.
pub struct MouseHandle {
    target: Input<MouseTarget>,
}

impl MouseHandle {
    /// Moves the fingers' goal.
    pub fn set(&mut self, target: MouseTarget) {
        self.target.write(target);
    }
}

/// The servo's end of a mouse device.
pub struct MouseDevice {
    spec: DeviceSpec,
    target: Output<MouseTarget>,
    pointer: Pointer,
    /// Since the window told its goal last, s.
    since_s: f64,
}

/// A mouse device whose fingers start at `start` and stay in `workspace`.
pub fn mouse(start: MouseTarget, workspace: Workspace) -> (MouseHandle, MouseDevice) {
    let (input, output) = triple_buffer(&start);
    let pointer = Pointer::new(tips(start.center_in_world, start.aperture_m), workspace);
    let device = MouseDevice { spec: Pointer::spec("Mouse"), target: output, pointer, since_s: 0.0 };
    (MouseHandle { target: input }, device)
}

impl Device for MouseDevice {
    fn spec(&self) -> &DeviceSpec {
        &self.spec
    }

    fn exchange(&mut self, command: &Command, dt_s: f64) -> Sample {
        self.since_s += dt_s;
        if self.target.updated() {
            self.pointer.smooth_steps_of(self.since_s);
            self.since_s = 0.0;
        }
        let target = *self.target.read();
        let center = self.pointer.workspace().clamp(target.center_in_world);
        self.pointer.advance(tips(center, target.aperture_m), command.force_n, dt_s)
    }

    fn make_safe(&mut self) {}
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hand::Hand;

    #[test]
    fn follows_the_pointer_and_squeezes_with_bounded_force() {
        let workspace = Hand::default().workspace;
        let start = MouseTarget { center_in_world: workspace.center_m, aperture_m: 0.03 };
        let (mut handle, mut device) = mouse(start, workspace);
        handle.set(MouseTarget { center_in_world: workspace.center_m + Vec2::new(1.0, 0.0), aperture_m: 0.01 });
        // 1 N holds the fingers apart.
        let command = Command { force_n: [Vec2::new(-1.0, 0.0), Vec2::new(1.0, 0.0)] };
        let mut sample = Sample::default();
        for _ in 0..3_000 {
            sample = device.exchange(&command, 1e-3);
        }
        let [left, right] = sample.tip_in_world;
        let edge = workspace.center_m.x + workspace.radius_m;
        assert!((0.5 * (left.x + right.x) - edge).abs() < 1e-6, "stays in the workspace");
        assert!((right.x - left.x - (0.01 + 2.0 / 400.0)).abs() < 1e-6, "opened by force over stiffness");
    }

    /// The largest acceleration of a hand whose pointer goes at 50 mm/s, m/s², with `pictures_hz` pointer events a
    /// second.
    fn jolt_m_s2(pictures_hz: f64) -> f64 {
        let workspace = Hand::default().workspace;
        let start = MouseTarget { center_in_world: workspace.center_m, aperture_m: 0.03 };
        let (mut handle, mut device) = mouse(start, workspace);
        let between = (1000.0 / pictures_hz) as usize;
        let (mut most, mut before) = (0.0_f64, 0.0);
        for tick in 0..600 {
            if tick % between == 0 {
                let way = Vec2::new(5e-5 * tick as f64, 0.0);
                handle.set(MouseTarget { center_in_world: workspace.center_m + way, ..start });
            }
            let now = device.exchange(&Command::default(), 1e-3).tip_velocity[0].x;
            // The first pictures tell it how often they come.
            if tick > 3 * between {
                most = most.max((now - before).abs() / 1e-3);
            }
            before = now;
        }
        most
    }

    /// A window on a slow driver moves the fingers in large steps: carried objects must not be thrown off by that.
    #[test]
    fn a_slow_window_does_not_jolt_the_hand() {
        let (fast, slow) = (jolt_m_s2(60.0), jolt_m_s2(8.0));
        assert!(slow < 1.6 * fast, "{slow} m/s² at 8 pictures a second, {fast} at 60");
    }
}
