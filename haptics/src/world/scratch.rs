//! Scratch space of one tick. Its buffers are sized once and kept from tick to tick, because the servo never allocates.

use super::contact::Touch;
use super::limits::MAX_BLOCKS;
use super::rect::Rect;
use crate::Vec2;

/// Largest number of contacts in a state: four corners of every block against the table, two points for each touching
/// pair (a planar packing has at most 3 n pairs), two fingers on every block, and some on table and handle. Every state
/// has this room, whatever its world, so that worlds can be swapped without allocation.
pub(super) const MAX_CONTACTS: usize = (4 + 6 + 2) * MAX_BLOCKS + 16;

/// Scratch space of one tick; nothing in it outlives the tick.
#[derive(Debug, Default)]
pub(super) struct Scratch {
    /// Places that touch or may touch within the tick.
    pub touches: Vec<Touch>,
    /// The movable bodies as this tick finds them.
    pub solids: Vec<Solid>,
    /// Direction of the crank's arm.
    pub arm: Arm,
    /// Largest possible compression of a fingertip within the tick, m.
    pub deepest_pad_m: f64,
}

/// Direction of an arm at the angle it was last asked for: the same angle is asked for several times a tick.
#[derive(Clone, Copy, Debug)]
pub(super) struct Arm {
    angle_rad: f64,
    outward: Vec2,
}

impl Default for Arm {
    fn default() -> Self {
        Self { angle_rad: 0.0, outward: Vec2::new(1.0, 0.0) }
    }
}

impl Arm {
    /// Unit vector from the axis outwards at an angle.
    #[inline]
    pub fn outward(&mut self, angle_rad: f64) -> Vec2 {
        if angle_rad.to_bits() != self.angle_rad.to_bits() {
            let (sin, cos) = angle_rad.sin_cos();
            *self = Self { angle_rad, outward: Vec2::new(cos, sin) };
        }
        self.outward
    }
}

/// A movable body as a tick finds it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Solid {
    /// Its outline.
    pub rect: Rect,
    /// Radius of the circle around it, m.
    pub reach_m: f64,
    /// Farthest way of any of its points within the tick, m.
    pub sweep_m: f64,
    /// 1/kg.
    pub inverse_mass: f64,
    /// 1/(kg m²); zero when it cannot turn.
    pub inverse_inertia: f64,
    /// Force on it in this part of the tick, N.
    pub force_n: Vec2,
    /// Moment about its centre in this part, N m.
    pub moment_n_m: f64,
}

impl Scratch {
    /// Room for the largest world.
    pub fn with_room() -> Self {
        Self {
            touches: Vec::with_capacity(MAX_CONTACTS),
            solids: Vec::with_capacity(MAX_BLOCKS),
            arm: Arm::default(),
            deepest_pad_m: 0.0,
        }
    }
}

/// The scratch space is no part of a state's identity.
impl PartialEq for Scratch {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}
