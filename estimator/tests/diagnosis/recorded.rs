//! Recordings of two fingers with noisy sensors.

use haptics::recording::{Channel, Recording, Task};
use rand::{RngExt as _, SeedableRng as _};
use std::f64::consts::TAU;

/// Noise of a place, m.
const PLACE_M: f64 = 1e-5;

/// Smooth step from 0 to 1 between two times, like the motion of a hand.
pub fn reach(t: f64, from: f64, to: f64) -> f64 {
    let u = ((t - from) / (to - from)).clamp(0.0, 1.0);
    u * u * u * (10.0 + u * (6.0 * u - 15.0))
}

/// Places and forces of both fingers (x1, y1, x2, y2, fx1, fy1, fx2, fy2) as noisy sensors see them.
pub fn recorded(
    seed: u64,
    (rate_hz, length_s): (f64, f64),
    noise_n: f64,
    exact: &dyn Fn(f64) -> [f64; 8],
) -> Recording {
    let mut rng = rand::rngs::StdRng::seed_from_u64(seed);
    let mut normal = move || {
        let (a, b): (f64, f64) = (rng.random_range(1e-12..1.0), rng.random());
        (-2.0 * a.ln()).sqrt() * (TAU * b).cos()
    };
    let names = ["x1_m", "y1_m", "x2_m", "y2_m", "fx1_N", "fy1_N", "fx2_N", "fy2_N"];
    let mut columns = vec![Vec::new(); names.len()];
    let time_s: Vec<f64> = (0..(length_s * rate_hz) as u32).map(|i| f64::from(i) / rate_hz).collect();
    for t in &time_s {
        for (k, (column, value)) in columns.iter_mut().zip(exact(*t)).enumerate() {
            column.push(value + normal() * if k < 4 { PLACE_M } else { noise_n });
        }
    }
    let channel = |(name, values): (&str, Vec<f64>)| Channel { name: name.to_owned(), unit: String::new(), values };
    let mut recording = Recording {
        name: "block".to_owned(),
        time_s: Some(time_s),
        channels: names.into_iter().zip(columns).map(channel).collect(),
        ..Recording::default()
    };
    recording.meta.task = Some(Task::BlockStack);
    recording
}
