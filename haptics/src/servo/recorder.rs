//! From ticks to rows: every tick is kept, seen through a sensor model, thinned only when asked.
//!
//! [`Rows`] turns one tick after the other into a row, for streams to a disk; [`to_recording`] turns many into a [`Recording`].

use super::control_loop::TickRecord;
use crate::Vec2;
use crate::recording::{Channel, HandMeta, Meta, Recording, Task};
use crate::world::World;
use rand::SeedableRng;
use rand::rngs::StdRng;
use rand_distr::{Distribution, Normal};

/// Errors that real sensors add to a simulated recording.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SensorModel {
    /// White position noise per axis, m.
    pub position_noise_m: f64,
    /// Position resolution, m, one over a whole number; zero: none.
    pub position_step_m: f64,
    /// White velocity noise per axis, m/s.
    pub velocity_noise_m_s: f64,
    /// Velocity resolution, m/s; zero: none.
    pub velocity_step_m_s: f64,
    /// White force noise per axis, N.
    pub force_noise_n: f64,
    /// Force resolution, N, one over a whole number; zero: none.
    pub force_step_n: f64,
}

impl SensorModel {
    /// No error at all.
    pub const IDEAL: Self = Self {
        position_noise_m: 0.0,
        position_step_m: 0.0,
        velocity_noise_m_s: 0.0,
        velocity_step_m_s: 0.0,
        force_noise_n: 0.0,
        force_step_n: 0.0,
    };

    /// A hand with good encoders and strain gauges.
    pub const TYPICAL: Self = Self {
        position_noise_m: 15e-6,
        position_step_m: 10e-6,
        velocity_noise_m_s: 0.8e-3,
        velocity_step_m_s: 1e-5,
        force_noise_n: 0.010,
        force_step_n: 0.002,
    };

    /// The same sensors with `factor` times the noise and the same resolution.
    #[must_use]
    pub fn noisier(self, factor: f64) -> Self {
        Self {
            position_noise_m: factor * self.position_noise_m,
            velocity_noise_m_s: factor * self.velocity_noise_m_s,
            force_noise_n: factor * self.force_noise_n,
            ..self
        }
    }
}

/// Column names of a two-fingered recording, after the time.
pub const COLUMNS: [&str; 12] =
    ["x1_m", "y1_m", "x2_m", "y2_m", "vx1_m_s", "vy1_m_s", "vx2_m_s", "vy2_m_s", "fx1_N", "fy1_N", "fx2_N", "fy2_N"];

/// Sees one tick after the other through the sensors.
pub struct Rows {
    sensor: SensorModel,
    rng: StdRng,
}

impl Rows {
    /// `seed` draws the sensor noise.
    pub fn new(sensor: SensorModel, seed: u64) -> Self {
        Self { sensor, rng: StdRng::seed_from_u64(seed) }
    }

    /// Sensor readings of the next tick, in the order of [`COLUMNS`], SI units.
    pub fn row(&mut self, tick: &TickRecord) -> [f64; 12] {
        let Self { sensor, rng } = self;
        let mut sense = |v: Vec2, noise: f64, step: f64| {
            let mut draw = |value: f64| {
                // A negative or non-finite spread cannot be sampled; it means no noise.
                let noisy = Normal::new(0.0, noise).map_or(value, |d| value + d.sample(rng));
                // Divided by a whole number of steps a unit, not multiplied: 0.08126, not 0.081260000000000001, in the file.
                let per_unit = (1.0 / step).round();
                if step > 0.0 { (noisy * per_unit).round() / per_unit } else { noisy }
            };
            [draw(v.x), draw(v.y)]
        };
        let [p1, p2] = tick.input.tip_in_world.map(|v| sense(v, sensor.position_noise_m, sensor.position_step_m));
        let [v1, v2] = tick.input.tip_velocity.map(|v| sense(v, sensor.velocity_noise_m_s, sensor.velocity_step_m_s));
        let [f1, f2] = tick.tip_force_n.map(|v| sense(v, sensor.force_noise_n, sensor.force_step_n));
        [p1[0], p1[1], p2[0], p2[1], v1[0], v1[1], v2[0], v2[1], f1[0], f1[1], f2[0], f2[1]]
    }
}

/// Turns ticks into a recording. `every` keeps every n-th tick (1: all); `seed` draws the sensor noise.
pub fn to_recording(
    name: &str,
    world: &World,
    ticks: &[TickRecord],
    every: usize,
    sensor: &SensorModel,
    seed: u64,
) -> Recording {
    let mut rows = Rows::new(*sensor, seed);
    let kept: Vec<&TickRecord> = ticks.iter().step_by(every.max(1)).collect();
    let mut columns: [Vec<f64>; 12] = Default::default();
    for tick in &kept {
        for (column, value) in columns.iter_mut().zip(rows.row(tick)) {
            column.push(value);
        }
    }
    let channels = COLUMNS
        .iter()
        .zip(columns)
        .map(|(name, values)| Channel { name: (*name).to_owned(), unit: unit(name).to_owned(), values })
        .collect();
    Recording {
        name: name.to_owned(),
        trial: None,
        time_s: Some(kept.iter().map(|t| t.time_s).collect()),
        channels,
        labels: Some(kept.iter().map(|t| t.label).collect()),
        meta: facts(world),
        warnings: Vec::new(),
    }
}

fn unit(column: &str) -> &'static str {
    if column.starts_with('f') {
        "N"
    } else if column.starts_with('v') {
        "m_s"
    } else {
        "m"
    }
}

/// Facts about a world for the sidecar of a recording made in it.
pub fn facts(world: &World) -> Meta {
    let base = |i: usize| Some([world.hand.fingers[i].base_m.x, world.hand.fingers[i].base_m.y]);
    Meta {
        task: Some(if world.crank.is_some() { Task::Crank } else { Task::BlockStack }),
        gravity_m_s2: Some(world.gravity_m_s2),
        up: Some("y".to_owned()),
        hand: Some(HandMeta {
            link_m: Some(world.hand.fingers[0].link_m),
            base_m: None,
            base1_m: base(0),
            base2_m: base(1),
        }),
        ..Meta::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::presets;

    #[test]
    fn every_tick_is_kept_and_the_sensor_adds_what_it_says() {
        let ticks: Vec<TickRecord> = (0..20_000)
            .map(|i| TickRecord { time_s: f64::from(i) * 1e-3, label: "free-motion", ..TickRecord::default() })
            .collect();
        let world = presets::stacking();
        let ideal = to_recording("t", &world, &ticks, 1, &SensorModel::IDEAL, 1);
        assert_eq!(ideal.len(), 20_000);
        assert!(ideal.channel("fx1_N").is_some_and(|f| f.iter().all(|v| *v == 0.0)));
        let real = to_recording("t", &world, &ticks, 1, &SensorModel::TYPICAL, 1);
        let force = real.channel("fy2_N").expect("recorded");
        let rms = (force.iter().map(|v| v * v).sum::<f64>() / force.len() as f64).sqrt();
        assert!((rms / 0.010 - 1.0).abs() < 0.03, "{rms}");
        assert_eq!(to_recording("t", &world, &ticks, 4, &SensorModel::IDEAL, 1).len(), 5_000);
    }
}
