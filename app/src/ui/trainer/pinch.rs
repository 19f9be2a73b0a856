//! From pointer, buttons and keys to where the pair of fingers is wanted.

use haptics::Vec2;
use haptics::device::{HandImpedance, MouseTarget};
use haptics::hand::Workspace;
use haptics::servo::TickRecord;
use haptics::world::{State, World};

/// Spare opening around the widest object, m.
const CLEARANCE_M: f64 = 0.009;
/// Opening where there is nothing to grasp, m.
const USUAL_OPENING_M: f64 = 0.024;
/// The fingers never close further, m.
const LEAST_M: f64 = 0.003;
/// Speed of opening and closing, m/s.
const SPEED_M_S: f64 = 0.09;
/// A grip force that says that both fingers touch, N.
const TOUCH_N: f64 = 0.04;
/// Strengths that can be chosen, N. The firmest breaks what can be broken (a barrel's wall gives at 5 N): learning to hold softly
/// needs the other one too.
const STRENGTH_N: std::ops::RangeInclusive<f64> = 0.3..=6.0;

/// The hand of a person with a mouse: a place, open or closed, and how firmly.
#[derive(Clone, Copy, Debug)]
pub struct Pinch {
    /// Closed by the mouse button.
    pub button: bool,
    /// Closed by the key, until pressed again.
    pub latched: bool,
    /// Pinch force that is aimed at, N.
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
    /// Takes over where the fingers are, and opens wide enough for what is in the world.
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

    /// How far apart open fingers are, m.
    pub fn opening_m(&self) -> f64 {
        self.opening_m
    }

    /// True while the fingers are to be closed.
    pub fn closed(&self) -> bool {
        self.button || self.latched
    }

    /// Puts the middle between the fingers somewhere, within reach.
    pub fn move_to(&mut self, point_in_world: Vec2) {
        self.center_m = self.workspace.clamp(point_in_world);
    }

    /// Moves it, m.
    pub fn move_by(&mut self, offset_m: Vec2) {
        self.move_to(self.center_m + offset_m);
    }

    /// Pinch force that is aimed at, N.
    pub fn strength_n(&self) -> f64 {
        self.strength_n
    }

    /// Pinches harder or softer.
    pub fn strengthen(&mut self, change_n: f64) {
        self.strength_n = (self.strength_n + change_n).clamp(*STRENGTH_N.start(), *STRENGTH_N.end());
    }

    /// The goal of the next picture. Once both fingers touch, the arm's springs are set to the wanted force: the fingers'
    /// goal lies behind the object's sides by force over stiffness.
    pub fn follow(&mut self, tick: &TickRecord, frame_s: f64) -> MouseTarget {
        let grip_n = tick.tip_force_n[0].x.min(-tick.tip_force_n[1].x);
        let apart_m = tick.input.tip_in_world[1].x - tick.input.tip_in_world[0].x;
        let step_m = SPEED_M_S * frame_s.min(0.1);
        self.aperture_m = if !self.closed() {
            // Opening starts from where the fingers are, not from behind the object's sides.
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
