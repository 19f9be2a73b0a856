//! Effects of the catalogue in carried blocks, in a size of any kind.

use crate::tasks::sensor::Instruments;
use blind::Chance;
use haptics::Vec2;
use haptics::world::{Cable, Content, State, World};

/// Kind of an effect.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// The first block leaks; its size in kg/s.
    Leak,
    /// One vertical force drifts, N/s.
    Drift,
    /// Both forces have a bias, N.
    Bias,
    /// All forces have a gain, and the weights are known.
    Gain,
    /// One vertical channel reads a share of the grip.
    Cross,
    /// A cable at the first block, N/m.
    Cable,
    /// Forces are late, s.
    Late,
    /// The blocks move in something viscous, N s/m.
    Viscous,
    /// The plane is tilted, rad.
    Tilt,
}

impl Kind {
    /// All of them.
    pub const ALL: [Self; 9] = [
        Self::Leak,
        Self::Drift,
        Self::Bias,
        Self::Gain,
        Self::Cross,
        Self::Cable,
        Self::Late,
        Self::Viscous,
        Self::Tilt,
    ];

    /// The name, as answers have it.
    pub fn id(self) -> &'static str {
        match self {
            Self::Leak => "mass-change",
            Self::Drift => "force-drift",
            Self::Bias => "force-bias",
            Self::Gain => "force-gain",
            Self::Cross => "force-cross-axis",
            Self::Cable => "added-constraint",
            Self::Late => "time-delay",
            Self::Viscous => "viscous-friction",
            Self::Tilt => "gravity-tilt",
        }
    }

    /// A size to begin with.
    pub fn first_size(self) -> f64 {
        match self {
            Self::Leak => 1e-3,
            Self::Drift => 5e-3,
            Self::Gain | Self::Cross | Self::Tilt => 0.05,
            Self::Cable => 15.0,
            Self::Bias | Self::Late => 0.02,
            Self::Viscous => 0.5,
        }
    }

    /// Sizes beyond which it would be another thing.
    pub fn limited(self, size: f64) -> f64 {
        match self {
            Self::Gain | Self::Cross => size.min(0.4),
            Self::Late => size.clamp(2e-3, 0.15),
            Self::Cable => size.min(120.0),
            Self::Leak => size.min(6e-3),
            Self::Tilt => size.min(0.5),
            _ => size,
        }
    }
}

/// An effect: its kind and whatever is drawn for it.
#[derive(Clone, Copy, Debug)]
pub struct Effect {
    /// Its kind.
    pub kind: Kind,
    /// Its size in the unit of its kind.
    pub size: f64,
    sign: f64,
    finger: usize,
    /// Direction of a bias; place of an anchor beside the first block, m, and the free length of a cable, m.
    direction: [Vec2; 2],
    anchor: (Vec2, f64),
    /// Begin of a leak, s.
    from_s: f64,
}

impl Effect {
    /// An effect of a first size.
    pub fn drawn(kind: Kind, chance: &mut Chance) -> Self {
        let angle = [chance.between(0.0, 6.3), chance.between(0.0, 6.3)];
        Self {
            kind,
            size: kind.first_size(),
            sign: chance.sign(),
            finger: usize::from(chance.happens(0.5)),
            direction: angle.map(|a| Vec2::new(a.cos(), a.sin())),
            anchor: (Vec2::new(-chance.between(0.01, 0.04), chance.between(-0.01, 0.02)), chance.between(0.004, 0.016)),
            from_s: chance.between(1.0, 3.0),
        }
    }

    /// Puts it into the world.
    pub fn hide(&self, world: &mut World) {
        let Some(block) = world.blocks.first_mut() else { return };
        match self.kind {
            Kind::Leak => {
                let mass_kg = 0.9 * block.mass_kg;
                block.content = Some(Content { mass_kg, leak_kg_s: self.size, leaks_from_s: Some(self.from_s) });
            }
            Kind::Cable => {
                let (aside, slack_m) = self.anchor;
                let anchor_m = block.start.center_m + aside;
                let length_m = aside.norm() + slack_m;
                block.cable = Some(Cable { anchor_m, length_m, stiffness_n_m: self.size, damping_n_s_m: 0.2 });
            }
            _ => {}
        }
    }

    /// Puts it into the instruments.
    pub fn spoil(&self, instruments: &mut Instruments) {
        let signed = self.sign * self.size;
        match self.kind {
            Kind::Drift => instruments.drift_n_s[self.finger].y = signed,
            Kind::Bias => instruments.bias_n = self.direction.map(|d| self.size * d),
            Kind::Gain => instruments.gain = 1.0 + signed,
            Kind::Cross => instruments.cross[self.finger] = signed,
            Kind::Late => instruments.late_s = self.size,
            _ => {}
        }
    }

    /// Force on a block that is carried, N, beside those of the world itself.
    pub fn field_n(&self, world: &World, block: usize, speed_m_s: Vec2) -> Vec2 {
        match self.kind {
            Kind::Viscous => -self.size * speed_m_s,
            Kind::Tilt => {
                let weight_n = world.blocks[block].mass_kg * world.gravity_m_s2;
                let (sin, cos) = (self.sign * self.size).sin_cos();
                weight_n * Vec2::new(sin, 1.0 - cos)
            }
            _ => Vec2::zeros(),
        }
    }

    /// Force on the carried block by which the world differs from one without the effect, N.
    pub fn in_world_n(&self, world: &World, state: &State, block: usize) -> Vec2 {
        let body = &state.bodies[block];
        match self.kind {
            Kind::Leak => Vec2::new(0.0, body.leaked_kg * world.gravity_m_s2),
            Kind::Cable if block == 0 => {
                let anchor_m = world.blocks[0].cable.map_or(body.center_m, |cable| cable.anchor_m);
                let to = anchor_m - body.center_m;
                body.cable_n / to.norm().max(1e-9) * to
            }
            _ => self.field_n(world, block, body.velocity_m_s),
        }
    }

    /// Error of the reading of a finger, N: its force now, and `late_s` ago.
    pub fn in_reading_n(&self, finger: usize, time_s: f64, now_n: Vec2, before_n: Vec2) -> Vec2 {
        let mut with = Instruments::default();
        self.spoil(&mut with);
        let cross = Vec2::new(0.0, with.cross[finger] * now_n.x);
        (with.gain - 1.0) * now_n + cross + with.bias_n[finger] + time_s * with.drift_n_s[finger] + before_n - now_n
    }

    /// True if only the instruments have it.
    pub fn is_in_reading(&self) -> bool {
        matches!(self.kind, Kind::Drift | Kind::Bias | Kind::Gain | Kind::Cross | Kind::Late)
    }
}
