//! What resists the hand: the known part, and what is hidden.

use super::effect::Effect;

/// The known part of a crank (along its path, at the handle) or of a mechanism with one degree of freedom.
#[derive(Clone, Copy, Debug)]
pub struct Plant {
    /// Path over angle, m: a crank's radius. 1 for a mechanism that turns; for one that slides a length that makes its stroke a few
    /// radians, so that the same shapes serve both.
    pub radius_m: f64,
    /// Weight of the handle, N.
    pub weight_n: f64,
    /// Friction as a share of the force across the motion.
    pub load_friction: f64,
    /// Dry friction, N.
    pub dry_n: f64,
    /// Viscous friction, N s/m.
    pub viscous: f64,
    /// Inertia, kg.
    pub inertia_kg: f64,
    /// What somebody hung on it.
    pub hung: Hung,
}

/// A weight on the handle, or on a lever of a mechanism that turns; nothing by default.
#[derive(Clone, Copy, Debug, Default)]
pub struct Hung {
    /// Its weight, N (moment, N m).
    pub force: f64,
    /// Its inertia, kg (kg m²).
    pub inertia: f64,
    /// The turn at which its lever is level, rad: a crank's angle is one from the horizontal.
    pub level: f64,
}

/// The instant at which the resistance is asked for.
#[derive(Clone, Copy, Debug, Default)]
pub struct Instant {
    /// Angle since the beginning, not wrapped, rad.
    pub turned: f64,
    /// Angle from the horizontal, rad.
    pub angle: f64,
    /// Speed along the path, m/s.
    pub speed: f64,
    /// Force of the hand across the motion, N; 1 for a mechanism.
    pub across_n: f64,
    /// Time, s.
    pub time_s: f64,
    /// Time as a share of the recording.
    pub share: f64,
}

/// Forces against the motion, split by how they depend on the speed of this very step.
#[derive(Clone, Copy, Debug, Default)]
pub struct Loads {
    /// Dry friction when moving forward, N.
    pub forward_n: f64,
    /// Dry friction when moving backward (positive resists), N.
    pub backward_n: f64,
    /// What does not ask for the speed, N.
    pub smooth_n: f64,
    /// Per speed, N s/m.
    pub viscous: f64,
}

impl Loads {
    /// Both at once.
    pub fn with(self, other: Self) -> Self {
        Self {
            forward_n: self.forward_n + other.forward_n,
            backward_n: self.backward_n + other.backward_n,
            smooth_n: self.smooth_n + other.smooth_n,
            viscous: self.viscous + other.viscous,
        }
    }

    fn dry(force_n: f64) -> Self {
        Self { forward_n: force_n, backward_n: force_n, ..Self::default() }
    }

    fn smooth(force_n: f64) -> Self {
        Self { smooth_n: force_n, ..Self::default() }
    }

    fn viscous(per_speed: f64) -> Self {
        Self { viscous: per_speed, ..Self::default() }
    }

    /// The force against a motion at `speed`, N.
    pub fn at(&self, speed: f64) -> f64 {
        let dry = if speed > 0.0 {
            self.forward_n
        } else if speed < 0.0 {
            -self.backward_n
        } else {
            0.0
        };
        dry + self.smooth_n + self.viscous * speed
    }
}

impl Plant {
    /// True for a crank: its handle has a weight.
    pub fn is_crank(&self) -> bool {
        self.weight_n > 0.0
    }

    /// What the known part resists with.
    pub fn loads(&self, now: &Instant) -> Loads {
        let dry = self.load_friction * now.across_n.abs() + self.dry_n;
        let hung_n = self.hung.force * (now.angle - self.hung.level).cos();
        let smooth_n = self.weight_n * now.angle.cos() + hung_n;
        Loads { forward_n: dry, backward_n: dry, smooth_n, viscous: self.viscous }
    }
}

/// One hidden effect.
#[derive(Clone, Copy, Debug)]
pub struct Hidden {
    /// Which.
    pub effect: Effect,
    /// Which functional form; 0 is the textbook's.
    pub form: u32,
    /// How large, in the effect's own unit.
    pub size: f64,
    /// Numbers that shape it: an angle, a width, a count, a speed; what they are depends on the effect.
    pub shape: [f64; 3],
}

/// What an effect remembers.
#[derive(Clone, Copy, Debug, Default)]
pub struct Memory {
    /// Share of the dry friction that is built up, or the place of the far side of a gap (m).
    pub state: f64,
}

/// A bump around zero of half width `width`: smooth, or a box.
fn bump(distance: f64, width: f64, smooth: bool) -> f64 {
    match (distance.abs() < width, smooth) {
        (false, _) => 0.0,
        (true, true) => 0.5 + 0.5 * (std::f64::consts::PI * distance / width).cos(),
        (true, false) => 1.0,
    }
}

/// The nearest way round.
fn around(angle: f64) -> f64 {
    angle.sin().atan2(angle.cos())
}

impl Hidden {
    /// What it adds to the resistance of `plant`, whose own is `base`.
    pub fn loads(&self, plant: &Plant, base: &Loads, now: &Instant, memory: &Memory) -> Loads {
        let (size, shape) = (self.size, self.shape);
        match self.effect {
            Effect::Asymmetry => self.by_direction(now),
            Effect::Coulomb => Loads::dry(size),
            Effect::Viscous => Loads::viscous(size),
            Effect::Stribeck => Loads::dry(size * self.creep(now.speed.abs() / shape[0])),
            Effect::Drag if self.form == 0 => Loads::viscous(size * now.speed.abs()),
            Effect::Drag => Loads::viscous(size * now.speed.abs().powf(1.5)),
            Effect::Ripple => Loads::smooth(size * self.ripple(now.turned)),
            Effect::Eccentric => Loads::smooth(size * (now.angle - shape[0]).sin()),
            Effect::Tilt => {
                let hangs_n = plant.weight_n + plant.hung.force;
                Loads::smooth(hangs_n * ((now.angle - size).cos() - now.angle.cos()))
            }
            Effect::Spring => Loads::smooth(size * self.spring(now.turned - shape[0])),
            Effect::Leak => {
                let lost = if self.form == 0 { now.share } else { 1.0 - (-3.0 * now.share).exp() };
                Loads::smooth(-plant.weight_n * size * lost * now.angle.cos())
            }
            Effect::FrictionChange => Loads::dry(base.forward_n * size * self.change(now.share)),
            Effect::Local => self.local(plant, now),
            Effect::Cable => Loads::smooth(size * self.cable(now.angle)),
            // A gap lies open as soon as the hand turns round, …
            Effect::Backlash if self.form < 2 => {
                let away = plant.radius_m * now.turned - memory.state;
                let gate = self.gate(plant.radius_m * now.turned, memory.state) - 1.0;
                let on = |side: bool| if side { gate } else { -1.0 };
                Loads {
                    forward_n: on(away >= 0.0) * base.forward_n,
                    backward_n: on(away <= 0.0) * base.backward_n,
                    smooth_n: 0.0,
                    viscous: gate * base.viscous,
                }
            }
            // … or once what sticks at its side has broken loose.
            Effect::Backlash => {
                let gate = self.gate(plant.radius_m * now.turned, memory.state) - 1.0;
                Loads {
                    forward_n: gate * base.forward_n,
                    backward_n: gate * base.backward_n,
                    smooth_n: gate * base.smooth_n,
                    viscous: gate * base.viscous,
                }
            }
            Effect::Hysteresis => Loads {
                forward_n: -base.forward_n,
                backward_n: -base.backward_n,
                smooth_n: base.forward_n * memory.state,
                viscous: 0.0,
            },
            Effect::PositionViscous => Loads::viscous(size * (2.0 * now.angle + shape[0]).sin()),
            Effect::SquareFriction => {
                Loads::dry(size * now.across_n.abs() * (2.0 * now.angle + shape[0]).sin().signum())
            }
            Effect::SquaredLoad => Loads::dry(size * now.across_n * now.across_n),
            Effect::Shaking => Loads::smooth(size * self.shaking(now.time_s)),
            _ => self.structured_loads(plant, base, now),
        }
    }

    /// Inertia that it adds, kg.
    pub fn inertia_kg(&self) -> f64 {
        if self.effect == Effect::Inertia { self.size } else { 0.0 }
    }

    /// Brings its memory along a step of `step_m` that ended at `path_m`.
    pub fn remember(&self, memory: &mut Memory, path_m: f64, step_m: f64) {
        match (self.effect, self.form) {
            (Effect::Backlash, _) => memory.state = memory.state.clamp(path_m - self.size, path_m + self.size),
            (Effect::Hysteresis, 0) => {
                let side = step_m.signum();
                memory.state = side + (memory.state - side) * (-step_m.abs() / self.size).exp();
            }
            (Effect::Hysteresis, _) => {
                let z = memory.state;
                let grown = step_m - 0.5 * step_m.abs() * z * z.abs() - 0.5 * step_m * z * z;
                memory.state = (z + grown / self.size).clamp(-1.0, 1.0);
            }
            _ => {}
        }
    }

    fn by_direction(&self, now: &Instant) -> Loads {
        match self.form {
            0 => {
                let more = self.size * now.across_n.abs();
                Loads { forward_n: more, backward_n: -more, ..Loads::default() }
            }
            1 => Loads::viscous(self.size * now.speed.signum()),
            _ => Loads { forward_n: self.size, backward_n: -self.size, ..Loads::default() },
        }
    }

    fn creep(&self, ratio: f64) -> f64 {
        match self.form {
            0 => (-ratio * ratio).exp(),
            1 => 1.0 / (1.0 + ratio * ratio),
            _ => (-ratio).exp(),
        }
    }

    fn ripple(&self, turned: f64) -> f64 {
        let wave = (self.shape[0] * turned + self.shape[1]).sin();
        if self.form == 0 { wave } else { wave.asin() * std::f64::consts::FRAC_2_PI }
    }

    fn spring(&self, away: f64) -> f64 {
        if self.form == 0 { away } else { away + (away / self.shape[1]).powi(2) * away }
    }

    fn change(&self, share: f64) -> f64 {
        match self.form {
            0 => (-4.0 * share).exp(),
            1 => share,
            _ => f64::from(u8::from(share > self.shape[0])),
        }
    }

    fn local(&self, plant: &Plant, now: &Instant) -> Loads {
        // A crank comes round again, a mechanism's coordinate does not.
        let distance = if plant.is_crank() { around(now.angle - self.shape[0]) } else { now.turned - self.shape[0] };
        let force = self.size * bump(distance, self.shape[1], self.form < 2);
        if self.form.is_multiple_of(2) { Loads::dry(force) } else { Loads::smooth(force) }
    }

    /// A cable that goes taut in a part of the turn: the slope of half its stretch squared.
    fn cable(&self, angle: f64) -> f64 {
        let away = angle - self.shape[0];
        let stretch = away.cos() - self.shape[1].cos();
        if stretch > 0.0 { -stretch * away.sin() } else { 0.0 }
    }

    /// Share of the load that is felt: none inside the gap.
    fn gate(&self, path_m: f64, side_m: f64) -> f64 {
        let depth = (path_m - side_m).abs() / self.size;
        if self.form == 1 { ((depth - 0.7) / 0.3).clamp(0.0, 1.0) } else { f64::from(u8::from(depth > 0.999)) }
    }

    fn shaking(&self, time_s: f64) -> f64 {
        let wave = |hz: f64, phase: f64| (std::f64::consts::TAU * hz * time_s + phase).sin();
        let [hz, phase, _] = self.shape;
        0.8 * wave(hz, phase) + 0.8 * wave(1.07 * hz, 2.0 * phase) + 0.6 * wave(0.91 * hz, 0.4)
    }
}
