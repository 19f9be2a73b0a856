//! Movements of the scripted operator: goals of the hand, reaches and turns between them, and the blocks to carry.

use super::skill::Mistake;
use crate::Vec2;
use crate::world::World;

/// Goal of the pair of fingers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Goal {
    /// Middle between the tips, m.
    pub center_m: Vec2,
    /// Distance between the tips, m.
    pub aperture_m: f64,
    /// Extra squeeze, N per finger.
    pub pinch_n: f64,
}

impl Goal {
    /// The goal that is fulfilled where the tips are.
    pub fn from_tips(tips: [Vec2; 2]) -> Self {
        Self { center_m: 0.5 * (tips[0] + tips[1]), aperture_m: tips[1].x - tips[0].x, pinch_n: 0.0 }
    }

    pub(super) fn lerp(&self, to: &Self, share: f64) -> Self {
        Self {
            center_m: self.center_m + (to.center_m - self.center_m) * share,
            aperture_m: self.aperture_m + (to.aperture_m - self.aperture_m) * share,
            pinch_n: self.pinch_n + (to.pinch_n - self.pinch_n) * share,
        }
    }
}

/// One movement.
#[derive(Clone, Copy, Debug)]
pub(super) enum Move {
    /// Straight, in minimum jerk.
    Reach { from: Goal, to: Goal },
    /// About a centre, in minimum jerk of the angle, pulling or pushing along the arm.
    Turn { center_m: Vec2, radius_m: f64, from_rad: f64, to_rad: f64, pull_m: f64, grasp: Goal },
    /// About a centre at an even speed.
    Spin(Spin),
}

impl Move {
    /// False for a pause.
    pub fn moves(&self) -> bool {
        !matches!(self, Self::Reach { from, to } if from == to)
    }

    /// Goal at the end of the movement.
    pub fn end(&self) -> Goal {
        match *self {
            Self::Reach { to, .. } => to,
            Self::Turn { center_m, radius_m, to_rad, grasp, .. }
            | Self::Spin(Spin { center_m, radius_m, to_rad, grasp, .. }) => {
                let (sin, cos) = to_rad.sin_cos();
                Goal { center_m: center_m + Vec2::new(cos, sin) * radius_m, ..grasp }
            }
        }
    }
}

/// A turn at an even speed, as far as a hand can.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spin {
    pub center_m: Vec2,
    pub radius_m: f64,
    pub from_rad: f64,
    pub to_rad: f64,
    /// Time to come to its speed, and to leave it, s.
    pub ramp_s: f64,
    /// Distance that the hand pulls off the circle, m.
    pub pull_m: f64,
    /// Modulation of the speed by each of the waves, relative.
    pub uneven: f64,
    /// Frequency, Hz, and phase of the speed's variations.
    pub waves: [(f64, f64); 2],
    pub grasp: Goal,
}

#[derive(Clone, Copy, Debug)]
pub(super) struct Phase {
    pub start_s: f64,
    pub end_s: f64,
    pub movement: Move,
    /// The job whose block should be between the fingers meanwhile.
    pub holds: Option<usize>,
    /// The job whose block has just been put down.
    pub placed: Option<usize>,
}

/// One block to carry.
#[derive(Clone, Copy, Debug)]
pub(super) struct Job {
    /// Its index in the world.
    pub block: usize,
    /// Target position of its centre, m.
    pub to_m: Vec2,
    /// Height at which nothing is in the way, m.
    pub clear_y_m: f64,
    /// Height from which the fingers come down on it, and to which they go afterwards, m.
    pub above_y_m: f64,
    /// Width of the block between the pads in the world, m.
    pub width_m: f64,
    /// Least pinch that holds it, N per finger.
    pub least_pinch_n: f64,
    /// Time for which it is held at that height, s, beside the usual rest; absent if no time was stated.
    pub hold_s: Option<f64>,
    /// Mistake made with it, if any.
    pub mistake: Option<Mistake>,
    /// How often it was tried again.
    pub attempts: u8,
}

impl Job {
    pub fn new(world: &World, block: usize, to_m: Vec2, clear_y_m: f64) -> Self {
        let shape = &world.blocks[block];
        let least_pinch_n = 0.5 * shape.mass_kg * world.gravity_m_s2 / shape.finger_friction.max(0.05);
        Self {
            block,
            to_m,
            clear_y_m,
            above_y_m: clear_y_m,
            width_m: shape.width_m,
            least_pinch_n,
            hold_s: None,
            mistake: None,
            attempts: 0,
        }
    }
}
