//! Instruments between a stepped world and a recording: noise of two colours, resolution, and faults on purpose.

use blind::Chance;
use haptics::Vec2;
use haptics::recording::{Channel, Recording, Task};
use haptics::servo::TickRecord;
use haptics::servo::recorder::{COLUMNS, facts};
use haptics::world::World;

/// Faults of the forces, and noise.
#[derive(Clone, Copy, Debug)]
pub struct Instruments {
    /// Noise of a position, m, of a velocity, m/s, of a force, N (half of its power is slow).
    pub position_m: f64,
    /// m/s
    pub velocity_m_s: f64,
    /// N
    pub force_n: f64,
    /// Added to every force of a finger, N.
    pub bias_n: [Vec2; 2],
    /// Added more and more, N/s.
    pub drift_n_s: [Vec2; 2],
    /// Share of the horizontal force of a finger that its vertical channel reads as well.
    pub cross: [f64; 2],
    /// Forces are multiplied by this, …
    pub gain: f64,
    /// … positions about the world's middle by this.
    pub scale: f64,
    /// Forces are read so much later than the motion, s.
    pub late_s: f64,
}

impl Default for Instruments {
    fn default() -> Self {
        Self {
            position_m: 15e-6,
            velocity_m_s: 0.8e-3,
            force_n: 0.010,
            bias_n: [Vec2::zeros(); 2],
            drift_n_s: [Vec2::zeros(); 2],
            cross: [0.0; 2],
            gain: 1.0,
            scale: 1.0,
            late_s: 0.0,
        }
    }
}

/// Correlation time of the slow half of the force noise, s.
const SLOW_S: f64 = 0.004;

/// What is read of every `every`-th tick.
pub fn look(
    world: &World,
    ticks: &[TickRecord],
    every: usize,
    with: &Instruments,
    task: Task,
    chance: &mut Chance,
) -> Recording {
    let mut columns: Vec<Vec<f64>> = vec![Vec::new(); COLUMNS.len()];
    let mut slow = [Vec2::zeros(); 2];
    let step_s = ticks.get(every).map_or(1e-3, |t| t.time_s - ticks[0].time_s);
    let keep = (-step_s / SLOW_S).exp();
    let half = std::f64::consts::FRAC_1_SQRT_2;
    let round = |value: f64, step: f64| (value / step).round() * step;
    let tick_s = step_s / every.max(1) as f64;
    let late = (with.late_s / tick_s.max(1e-9)).round() as usize;
    for (k, tick) in ticks.iter().enumerate().step_by(every) {
        let felt = &ticks[k.saturating_sub(late)].tip_force_n;
        let mut noise = |size: f64| Vec2::new(size * chance.normal(), size * chance.normal());
        let mut row = Vec::with_capacity(12);
        for place in tick.input.tip_in_world {
            let seen = place * with.scale + noise(with.position_m);
            row.extend([round(seen.x, 5e-6), round(seen.y, 5e-6)]);
        }
        for speed in tick.input.tip_velocity {
            let seen = speed * with.scale + noise(with.velocity_m_s);
            row.extend([round(seen.x, 1e-5), round(seen.y, 1e-5)]);
        }
        for (f, slow) in slow.iter_mut().enumerate() {
            let true_n = felt[f];
            *slow = keep * *slow + noise((1.0 - keep * keep).sqrt());
            let mut seen = true_n * with.gain + Vec2::new(0.0, with.cross[f] * true_n.x);
            seen += with.bias_n[f] + with.drift_n_s[f] * tick.time_s;
            seen += with.force_n * half * (*slow + noise(1.0));
            row.extend([round(seen.x, 1e-3), round(seen.y, 1e-3)]);
        }
        columns.iter_mut().zip(row).for_each(|(column, value)| column.push(value));
    }
    let unit = |name: &str| match name.as_bytes()[0] {
        b'f' => "N",
        b'v' => "m_s",
        _ => "m",
    };
    let channels = COLUMNS
        .iter()
        .zip(columns)
        .map(|(name, values)| Channel { name: (*name).to_owned(), unit: unit(name).to_owned(), values })
        .collect();
    let mut meta = facts(world);
    meta.task = Some(task);
    let time_s = Some(ticks.iter().step_by(every).map(|t| t.time_s).collect());
    Recording { name: "case".to_owned(), time_s, channels, meta, ..Recording::default() }
}
