//! The mouse as a pair of fingers with adjustable pinch: position only, the force is shown.

use super::pointer::{Pointer, tips};
use super::{Command, Device, DeviceSpec, Sample};
use crate::Vec2;
use crate::hand::Workspace;
use triple_buffer::{Input, Output, triple_buffer};

/// Where the pointer wants the fingers to be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MouseTarget {
    /// Middle between the tips, m in the world.
    pub center_in_world: Vec2,
    /// Wanted distance between the tips, m; the pads stop at what is between them, the rest is pinch force.
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
}

/// A mouse device whose fingers start at `start` and stay in `workspace`.
pub fn mouse(start: MouseTarget, workspace: Workspace) -> (MouseHandle, MouseDevice) {
    let (input, output) = triple_buffer(&start);
    let pointer = Pointer::new(tips(start.center_in_world, start.aperture_m), workspace);
    (MouseHandle { target: input }, MouseDevice { spec: Pointer::spec("Mouse"), target: output, pointer })
}

impl Device for MouseDevice {
    fn spec(&self) -> &DeviceSpec {
        &self.spec
    }

    fn exchange(&mut self, command: &Command, dt_s: f64) -> Sample {
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
}
