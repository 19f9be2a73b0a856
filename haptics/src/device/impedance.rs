//! A hand as the operator's arm makes it: a mass on a spring and damper that follows where the operator wants to be.
//!
//! Position-only devices (mouse, script) go through it, so that squeezing an object makes a bounded force and touching
//! the table pushes back, as it does with a real arm.

use crate::Vec2;

/// Endpoint impedance of a relaxed human finger–arm chain (order of magnitude: Hajian & Howe 1997, index finger).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HandImpedance {
    /// Apparent mass per finger, kg.
    pub mass_kg: f64,
    /// Stiffness towards the wanted position, N/m.
    pub stiffness_n_m: f64,
    /// Damping, N s/m.
    pub damping_n_s_m: f64,
}

impl Default for HandImpedance {
    fn default() -> Self {
        Self { mass_kg: 0.08, stiffness_n_m: 400.0, damping_n_s_m: 9.0 }
    }
}

impl HandImpedance {
    /// Moves one finger by `dt_s` towards `wanted` (position m, velocity m/s) under `force_n` on the finger, N.
    pub fn advance(&self, position: &mut Vec2, velocity: &mut Vec2, wanted: (Vec2, Vec2), force_n: Vec2, dt_s: f64) {
        let pull = (wanted.0 - *position) * self.stiffness_n_m + (wanted.1 - *velocity) * self.damping_n_s_m;
        *velocity += (pull + force_n) / self.mass_kg * dt_s;
        *position += *velocity * dt_s;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rests_where_spring_and_force_balance() {
        let hand = HandImpedance::default();
        let (mut p, mut v) = (Vec2::zeros(), Vec2::zeros());
        for _ in 0..2_000 {
            hand.advance(&mut p, &mut v, (Vec2::new(0.01, 0.0), Vec2::zeros()), Vec2::new(-2.0, 0.0), 1e-3);
        }
        assert!((p.x - (0.01 - 2.0 / 400.0)).abs() < 1e-9);
    }
}
