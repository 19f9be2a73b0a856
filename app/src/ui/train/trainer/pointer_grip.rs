//! Conversion from pointer, buttons and keys to the desired position of the two fingers.

use haptics::Vec2;
use haptics::device::{HandImpedance, MouseTarget};
use haptics::hand::Workspace;
use haptics::servo::TickRecord;
use haptics::world::{State, World};

/// Spare opening around the widest object, m.
const CLEARANCE_M: f64 = 0.009;
/// Default opening in a world without graspable objects, m.
const USUAL_OPENING_M: f64 = 0.024;
/// Minimum opening, m.
const LEAST_M: f64 = 0.003;
/// Speed of opening and closing, m/s.
const SPEED_M_S: f64 = 0.09;
/// Grip force above which both fingers touch, N.
const TOUCH_N: f64 = 0.04;
/// Range of pinch force, N. The highest breaks fragile objects (a barrel's wall breaks at 5 N): learning a gentle grip
/// requires it.
const STRENGTH_N: std::ops::RangeInclusive<f64> = 0.3..=6.0;

/// Hand of a person with a mouse: position, open or closed, and pinch force.
#[derive(Clone, Copy, Debug)]
pub struct Pinch {
    /// Closed by the mouse button.
    pub button: bool,
    /// Closed by the key, until pressed again.
    pub latched: bool,
    /// Desired pinch force, N.
    strength_n: f64,
    center_m: Vec2,
    aperture_m: f64,
    opening_m: f64,
    workspace: Workspace,
}

impl Default for Pinch {
    fn default() -> Self {
        let workspace = haptics::hand::Hand::default().workspace;
        Self {
            button: false,
            latched: false,
            strength_n: 1.5,
            center_m: workspace.center_m,
            aperture_m: USUAL_OPENING_M,
            opening_m: USUAL_OPENING_M,
            workspace,
        }
    }
}

impl Pinch {
    /// Starts from the current finger positions, and opens wide enough for the objects in the world.
    pub fn prepare_for(&mut self, world: &World, state: &State) {
        let widths = world.blocks.iter().map(|b| b.width_m).chain(world.crank.iter().map(|c| c.handle_width_m));
        let widths = widths.chain(world.switch.iter().map(|s| 2.0 * s.knob_radius_m));
        let widest = widths.fold(0.0, f64::max);
        self.opening_m = if widest > 0.0 { widest + CLEARANCE_M } else { USUAL_OPENING_M };
        let tips = state.input.tip_in_world;
        self.center_m = 0.5 * (tips[0] + tips[1]);
        self.aperture_m = tips[1].x - tips[0].x;
        self.workspace = world.hand.workspace;
        (self.button, self.latched) = (false, false);
    }

    /// Distance between open fingers, m.
    pub fn opening_m(&self) -> f64 {
        self.opening_m
    }

    /// True while the fingers should close.
    pub fn closed(&self) -> bool {
        self.button || self.latched
    }

    /// Moves the midpoint between the fingers to a position, within reach.
    pub fn move_to(&mut self, point_in_world: Vec2) {
        self.center_m = self.workspace.clamp(point_in_world);
    }

    /// Moves the midpoint by an offset, m.
    pub fn move_by(&mut self, offset_m: Vec2) {
        self.move_to(self.center_m + offset_m);
    }

    /// Desired pinch force, N.
    pub fn strength_n(&self) -> f64 {
        self.strength_n
    }

    /// Changes the desired pinch force by `change_n`.
    pub fn strengthen(&mut self, change_n: f64) {
        self.strength_n = (self.strength_n + change_n).clamp(*STRENGTH_N.start(), *STRENGTH_N.end());
    }

    /// Goal of the next frame. Once both fingers touch, the arm springs produce the desired force: the fingers' goal is
    /// inside the object by force over stiffness.
    pub fn follow(&mut self, tick: &TickRecord, frame_s: f64) -> MouseTarget {
        let grip_n = tick.tip_force_n[0].x.min(-tick.tip_force_n[1].x);
        let apart_m = tick.input.tip_in_world[1].x - tick.input.tip_in_world[0].x;
        let step_m = SPEED_M_S * frame_s.min(0.1);
        self.aperture_m = if !self.closed() {
            // Opening starts from the fingers' positions, not from inside the object.
            let from = if grip_n > TOUCH_N { self.aperture_m.max(apart_m - 0.002) } else { self.aperture_m };
            (from + step_m).min(self.opening_m.max(apart_m.min(self.opening_m)))
        } else if grip_n > TOUCH_N {
            apart_m - 2.0 * self.strength_n / HandImpedance::default().stiffness_n_m
        } else {
            (self.aperture_m.min(apart_m) - step_m).max(LEAST_M)
        };
        MouseTarget { center_in_world: self.center_m, aperture_m: self.aperture_m }
    }
}
