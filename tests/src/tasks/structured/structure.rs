//! One structured model error: its random functions, which a seed repeats.

use super::family::{Family, Group};
use blind::{Chance, curve};

/// A structure in some shape and size.
#[derive(Clone, Copy, Debug)]
pub struct Structure {
    /// Its family.
    pub family: Family,
    /// One of the [`Family::FORMS`].
    pub form: u32,
    /// Seed of its random functions.
    pub seed: u64,
    /// Scales of its functions, as drawn for its family: s, m, m/s, N, or Hz.
    pub shape: [f64; 2],
    /// Factor of the functions: N, a share of a force that is there, m, or m/N.
    pub size: f64,
}

impl Structure {
    /// A structure of a family, of a first size.
    pub fn drawn(family: Family, form: u32, group: Group, chance: &mut Chance) -> Self {
        let seed = u64::from(chance.whole(0, u32::MAX));
        let is_block = group == Group::Blocks;
        let shape = match family {
            Family::SensorWander | Family::SheetWander => [chance.of_order(1.0, 8.0), 0.0],
            Family::SensorCreep | Family::GripCreep | Family::Relaxation => [chance.of_order(0.3, 4.0), 0.0],
            Family::SensorPlace | Family::PlaceField => [chance.of_order(5e-3, 15e-3), chance.between(0.2, 1.0)],
            Family::SpeedField if is_block => [0.1 / f64::from(chance.whole(4, 6)), 0.0],
            Family::SpeedField => [0.05 / f64::from(chance.whole(4, 6)), 0.0],
            Family::LoadField => [chance.of_order(0.1, 0.4), 0.0],
            Family::StateField if is_block => [chance.of_order(8e-3, 20e-3), chance.of_order(0.02, 0.06)],
            Family::StateField => [chance.of_order(1.5e-3, 4e-3), chance.of_order(8e-3, 25e-3)],
            Family::FingerRoll => [chance.of_order(5e-3, 15e-3), chance.of_order(0.03, 0.1)],
            Family::Ringing => [chance.of_order(8.0, 25.0), chance.of_order(0.05, 0.25)],
            Family::Hum => [chance.of_order(10.0, 45.0), chance.of_order(0.7, 4.0)],
            Family::Steps => [0.0; 2],
            Family::DepthField => [chance.of_order(1e-3, 3e-3), 0.0],
            Family::FrictionOverDepth => [chance.of_order(0.8e-3, 2.5e-3), 0.0],
            Family::FrictionWander => [chance.of_order(2.0, 10.0), 0.0],
        };
        Self { family, form, seed, shape, size: first_size(family) }
    }

    /// A random function of time in one of the two forms, variance about 1.
    pub fn over_time(&self, axis: u64, time_s: f64) -> f64 {
        let x = time_s / self.shape[0];
        if self.form == 0 { curve::noise(self.seed + axis, x, None) } else { curve::octaves(self.seed + axis, x) }
    }

    /// A random function of a place in one of the two forms.
    pub fn over_place(&self, axis: u64, place_m: f64) -> f64 {
        let x = place_m / self.shape[0];
        if self.form == 0 { curve::noise(self.seed + axis, x, None) } else { curve::bumps(self.seed + axis, x, None) }
    }

    /// A random function of the place in a plane, of each of two axes.
    pub fn over_plane(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        // Slanted, so that no axis of the plane is an axis of the function.
        let along = |axis: u64| self.over_place(axis, x + 0.4 * y) + self.over_place(axis + 2, y - 0.4 * x);
        [0, 1].map(|axis| std::f64::consts::FRAC_1_SQRT_2 * along(axis))
    }

    /// A random function of the speed in one of the two forms: odd, 0 at rest, against the motion on average or along it.
    pub fn over_speed(&self, speed_m_s: f64) -> f64 {
        let x = speed_m_s.abs() / self.shape[0];
        let force =
            if self.form == 0 { curve::from_rest(self.seed, x) } else { x.tanh() * curve::bumps(self.seed, x, None) };
        speed_m_s.signum() * force
    }

    /// Force of the structure on a block in motion, N.
    pub fn field_n(&self, place_m: [f64; 2], speed_m_s: [f64; 2]) -> [f64; 2] {
        let sized = |force: [f64; 2]| force.map(|f| self.size * f);
        match self.family {
            Family::PlaceField if self.form == 0 => sized(self.over_plane(place_m)),
            Family::PlaceField => sized(self.pull(place_m)),
            Family::SpeedField => {
                let speed = speed_m_s[0].hypot(speed_m_s[1]);
                let force = -self.over_speed(speed);
                sized(speed_m_s.map(|v| force * v / speed.max(1e-9)))
            }
            Family::StateField => sized([0, 1].map(|axis| self.over_state(axis, place_m, speed_m_s))),
            _ => [0.0; 2],
        }
    }

    /// A one-sided pull toward an anchor, uneven as that of a cable that drags over an edge.
    fn pull(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [knot_m, slack] = self.shape;
        let side = curve::unit(self.seed, 3);
        let (dx, dy) = (x - 0.04 * side, y - 0.05);
        let away_m = dx.hypot(dy).max(1e-6);
        let taut = ((away_m - 0.02) / knot_m - slack).max(0.0);
        let force = taut * (1.0 + 0.55 * curve::noise(self.seed, 2.0 * taut, None));
        [-force * dx / away_m, -force * dy / away_m]
    }

    /// A function of place and speed: a network, or a product.
    pub fn over_state(&self, axis: u64, [x, y]: [f64; 2], [vx, vy]: [f64; 2]) -> f64 {
        let [place, speed] = self.shape;
        let at_rest = self.seed + 16 * axis;
        if self.form == 0 {
            curve::network(at_rest, [x / place, y / place, vx / speed, vy / speed])
        } else {
            let over = curve::noise(at_rest, (x + y) / place, None);
            over * (1.0 + curve::from_rest(at_rest + 8, (vx + vy) / speed)) * 0.8
        }
    }

    /// Sizes beyond which a structure would be another thing.
    pub fn limited(&self, size: f64) -> f64 {
        match self.family {
            Family::SensorCreep | Family::Relaxation => size.min(0.6),
            Family::FrictionOverDepth | Family::FrictionWander => size.min(1.2),
            // A pad of 2000 N/m sinks in by as much as it gives.
            Family::GripCreep => size.min(5e-4),
            Family::FingerRoll => size.min(0.5),
            _ => size,
        }
    }
}

fn first_size(family: Family) -> f64 {
    match family {
        Family::SensorCreep | Family::FingerRoll => 0.03,
        Family::Relaxation => 0.1,
        Family::FrictionOverDepth | Family::FrictionWander => 0.3,
        Family::GripCreep => 3e-5,
        Family::SheetWander => 5e-5,
        Family::Steps => 0.05,
        _ => 0.02,
    }
}
