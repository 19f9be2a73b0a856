//! Circle of a crank, and motion and force of a held handle along it: the same for recordings and beside the servo.

use haptics::Vec2;
use haptics::law::Motion;

/// Half of the low-pass window that rows of the laws go through, s: motion below about 5 Hz stays.
/// Choice: not varied, because it is an argument of other constants.
pub const LOW_PASS_HALF_S: f64 = 0.06;

/// The sign of a velocity within its noise is a guess: it is blurred over twice that (and never less than 0.5 mm/s), m/s.
pub fn blur(velocity_noise_m_s: f64) -> f64 {
    (2.0 * velocity_noise_m_s).max(0.5e-3)
}

/// Smoothed motion and force of the grip at one instant; every channel through the same filter.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Handled {
    /// Mean of the tips, m.
    pub position: Vec2,
    /// Its velocity, m/s.
    pub velocity: Vec2,
    /// Its acceleration, m/s².
    pub acceleration: Vec2,
    /// Net force on the handle without bias, N.
    pub force: Vec2,
    /// Its first derivative, N/s.
    pub force_rate: Vec2,
    /// Its second derivative, N/s².
    pub force_bend: Vec2,
}

/// Circle of the crank, and give of the pads between tips and handle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// Centre, m.
    pub center_m: Vec2,
    /// Displacement of the tips against the handle per force, x and y, m/N.
    pub give_m_per_n: Vec2,
    /// 1 where y points up, −1 where it points down.
    pub up: f64,
    /// Speed within which the direction is a guess, m/s.
    pub blur_m_s: f64,
}

impl Frame {
    /// Direction from the centre to the handle of a grip at `position`, m, under `force`, N.
    pub fn outward(&self, position: Vec2, force: Vec2) -> Vec2 {
        (position - force.component_mul(&self.give_m_per_n) - self.center_m).normalize()
    }

    /// The motion along the circle (its position left out) and the tangential force, N.
    pub fn at(&self, time_s: f64, handled: &Handled) -> (Motion, f64) {
        let give = &self.give_m_per_n;
        let outward = self.outward(handled.position, handled.force);
        let along = Vec2::new(-outward.y, outward.x);
        // The tips move with the handle plus the changing give of the pads.
        let speed = (handled.velocity - handled.force_rate.component_mul(give)).dot(&along);
        let motion = Motion {
            time_s,
            position: 0.0,
            velocity: speed,
            acceleration: (handled.acceleration - handled.force_bend.component_mul(give)).dot(&along),
            direction: (speed / self.blur_m_s).tanh(),
            normal_force_n: handled.force.dot(&outward),
            up_along: self.up * along.y,
        };
        (motion, handled.force.dot(&along))
    }
}
