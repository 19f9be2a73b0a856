//! One active contact point, and the surfaces that it is between.

use crate::Vec2;

/// Party to a contact.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Surface {
    /// Finger 0 (left) or 1 (right).
    Finger(u8),
    /// A block, by index.
    Block(u16),
    /// The table.
    Floor,
    /// The crank's handle.
    Handle,
    /// The knob of the toggle switch.
    Knob,
    /// The sheet that a needle can pierce, under a finger.
    Membrane,
    /// The wall of the cup that carries that sheet.
    Cup,
    /// The base of the toggle switch.
    Base,
    /// A fixed plane.
    Plane,
}

/// One active contact point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    /// The body that is pushed along `normal`.
    pub on: Surface,
    /// The body that pushes.
    pub by: Surface,
    /// Corner, edge or face of the contact: tells points of one pair apart from tick to tick.
    pub feature: u8,
    /// Position of the contact, m in the world.
    pub point_m: Vec2,
    /// Unit vector from `by` into `on`.
    pub normal: Vec2,
    /// Compression in the middle of the tick's last part, m; positive but for the part in which surfaces meet or leave.
    pub depth_m: f64,
    /// Elastic tangential displacement of the sticking contact, m, along the normal turned by −90° (clockwise).
    pub shear_m: f64,
    /// Speed at which the surfaces met, m/s, positive: closing.
    pub met_m_s: f64,
    /// Normal force on `on`, N, ≥ 0.
    pub normal_force_n: f64,
    /// Tangential force on `on`, N, along the normal turned by −90°.
    pub tangent_force_n: f64,
    /// True while the contact slides.
    pub sliding: bool,
}

impl Contact {
    /// Unit tangent: the normal turned by −90°.
    pub fn tangent(&self) -> Vec2 {
        Vec2::new(self.normal.y, -self.normal.x)
    }

    /// Force on `on` in the world, N.
    pub fn force_n(&self) -> Vec2 {
        self.normal * self.normal_force_n + self.tangent() * self.tangent_force_n
    }
}
