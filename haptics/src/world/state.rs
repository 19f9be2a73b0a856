//! The mutable part of a world: where everything is now. Copied to the pictures without allocation.

use super::contact_point::Contact;
use super::guide::Guided;
use super::limits::MAX_BLOCKS;
use super::model::World;
use super::scratch::{MAX_CONTACTS, Scratch};
use crate::Vec2;
use crate::law::Memories;
use crate::law::object::{MembraneHistory, MembranePhase};

/// Positions and velocities of the fingers during one tick, from the device.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Input {
    /// Tip position in the world of finger 1 (left) and 2 (right), m.
    pub tip_in_world: [Vec2; 2],
    /// Tip velocity, m/s.
    pub tip_velocity: [Vec2; 2],
}

/// A moving block.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BodyState {
    /// Centre in the world, m.
    pub center_m: Vec2,
    /// Angle, rad, counter-clockwise.
    pub angle_rad: f64,
    /// Velocity of the centre, m/s.
    pub velocity_m_s: Vec2,
    /// Angular velocity, rad/s.
    pub rate_rad_s: f64,
    /// Mass that has run out of it so far, kg.
    pub leaked_kg: f64,
    /// Mean place along the table where that fell, m in the world.
    pub spilled_x_m: f64,
    /// True once its wall is broken.
    pub broken: bool,
    /// Pull of its cable, N.
    pub cable_n: f64,
    /// Place on its guide, and the holding force.
    pub guided: Guided,
}

/// Places of a membrane that are remembered; the oldest is forgotten first.
pub const MAX_HOLES: usize = 8;

/// A place of the membrane that a needle has touched.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Hole {
    /// Position along the sheet, m from its middle, to the right.
    pub along_m: f64,
    /// Memory of the sheet at this place.
    pub history: MembraneHistory,
}

/// The membrane and the needle in it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MembraneState {
    /// Places touched so far.
    pub holes: [Hole; MAX_HOLES],
    /// Number of holes in use.
    pub touched: usize,
    /// The place that the needle is in.
    pub active: Option<usize>,
    /// Insertion of the point beyond the undisturbed surface, m; negative above it.
    pub insertion_m: f64,
    /// Force of the sheet along the needle, N, positive: out.
    pub force_n: f64,
    /// Phase of the needle's motion.
    pub phase: MembranePhase,
}

/// The toggle switch.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SwitchState {
    /// Way of the knob along its arc, m, positive to the right.
    pub at_m: f64,
    /// Its rate, m/s.
    pub rate_m_s: f64,
    /// Velocity of the knob as it moved in the last part of a tick, m/s.
    pub knob_velocity: Vec2,
    /// 1 on the forward branch of the curve, 0 on the backward one.
    pub branch: f64,
    /// Force of the mechanism against a displacement to the right, N.
    pub force_n: f64,
}

/// The crank's handle.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CrankState {
    /// Angle of the arm from the horizontal, rad, counter-clockwise, unwrapped.
    pub angle_rad: f64,
    /// Its rate, rad/s.
    pub rate_rad_s: f64,
    /// Radial give of arm and bearing, m, outwards.
    pub radial_m: f64,
    /// Its rate, m/s.
    pub radial_rate_m_s: f64,
    /// Velocity of the handle as it moved in the last part of a tick, m/s.
    pub handle_velocity: Vec2,
    /// Force that arm and bearing put on the handle along the outward normal, N.
    pub constraint_force_n: f64,
    /// Memories of its laws, by effect.
    pub memories: Memories,
}

/// Everything that changes. All buffers are sized for the largest world when it is made; `copy_from` never allocates.
#[derive(Debug, PartialEq)]
pub struct State {
    /// Simulated time, s.
    pub time_s: f64,
    /// Tick counter.
    pub tick: u64,
    /// The input that led here.
    pub input: Input,
    /// Force each tip exerts on the environment, N (the reading of a force sensor in the tip).
    pub tip_force_n: [Vec2; 2],
    /// Blocks, in the order of the world's.
    pub bodies: Vec<BodyState>,
    /// Crank, zero when there is none.
    pub crank: CrankState,
    /// Membrane, at rest when there is none.
    pub membrane: MembraneState,
    /// Toggle switch, at rest when there is none.
    pub switch: SwitchState,
    /// Active contacts of the last tick, in the order in which they are found.
    pub contacts: Vec<Contact>,
    /// Scratch space of a tick.
    pub(super) scratch: Scratch,
    /// Largest impact speed since it was last cleared, m/s: drives sound and flash.
    pub impact_m_s: f64,
    /// Position of that impact, m.
    pub impact_in_world: Vec2,
}

impl State {
    /// The state a world starts in. `tips` are where the fingers are, m.
    pub fn new(world: &World, tips: [Vec2; 2]) -> Self {
        let mut bodies = Vec::with_capacity(MAX_BLOCKS);
        bodies.extend(world.blocks.iter().map(|block| BodyState {
            center_m: block.start.center_m,
            angle_rad: block.start.angle_rad,
            guided:
                block.guide.as_ref().map_or_else(Guided::default, |g| Guided {
                    at: g.nearest(block.start.center_m),
                    ..Guided::default()
                }),
            ..BodyState::default()
        }));
        Self {
            time_s: 0.0,
            tick: 0,
            input: Input { tip_in_world: tips, tip_velocity: [Vec2::zeros(); 2] },
            tip_force_n: [Vec2::zeros(); 2],
            bodies,
            crank: CrankState { angle_rad: world.crank.as_ref().map_or(0.0, |c| c.start_rad), ..CrankState::default() },
            membrane: MembraneState::default(),
            switch: SwitchState { at_m: world.switch.as_ref().map_or(0.0, |s| s.start_m), ..SwitchState::default() },
            contacts: Vec::with_capacity(MAX_CONTACTS),
            scratch: Scratch::with_room(),
            impact_m_s: 0.0,
            impact_in_world: Vec2::zeros(),
        }
    }

    /// The usual start: fingers apart, above the middle of the workspace.
    pub fn resting(world: &World) -> Self {
        let workspace = world.hand.workspace;
        let center = workspace.center_m + Vec2::new(0.0, 0.5 * workspace.radius_m);
        let half = Vec2::new(0.3 * world.hand.workspace.radius_m, 0.0);
        Self::new(world, [center - half, center + half])
    }

    /// Overwrites this state; allocates nothing.
    pub fn copy_from(&mut self, other: &Self) {
        self.time_s = other.time_s;
        self.tick = other.tick;
        self.input = other.input;
        self.tip_force_n = other.tip_force_n;
        self.bodies.clone_from(&other.bodies);
        self.crank = other.crank;
        self.membrane = other.membrane;
        self.switch = other.switch;
        self.contacts.clone_from(&other.contacts);
        self.impact_m_s = other.impact_m_s;
        self.impact_in_world = other.impact_in_world;
    }

    /// Position of the crank's handle in the world, m.
    pub fn handle_in_world(&self, world: &World) -> Option<Vec2> {
        let crank = world.crank.as_ref()?;
        let (sin, cos) = self.crank.angle_rad.sin_cos();
        Some(crank.center_m + Vec2::new(cos, sin) * (crank.radius_m + self.crank.radial_m))
    }
}

impl Clone for State {
    /// A copy with the same buffer capacities, so that later `copy_from` calls need not allocate.
    fn clone(&self) -> Self {
        let mut contacts = Vec::with_capacity(MAX_CONTACTS);
        contacts.extend_from_slice(&self.contacts);
        let mut bodies = Vec::with_capacity(MAX_BLOCKS);
        bodies.extend_from_slice(&self.bodies);
        Self {
            time_s: self.time_s,
            tick: self.tick,
            input: self.input,
            tip_force_n: self.tip_force_n,
            bodies,
            crank: self.crank,
            membrane: self.membrane,
            switch: self.switch,
            contacts,
            scratch: Scratch::with_room(),
            impact_m_s: self.impact_m_s,
            impact_in_world: self.impact_in_world,
        }
    }
}
