//! A block that is carried in fingers which press evenly, put down and let go of: forces and places by statics, without the stepped world.
//!
//! The shear that is left in the pads when the block stands stays while the grip is opened, until friction (coefficient 1) holds no more.

use haptics::recording::{Channel, Meta, Recording, Task};
use rand::rngs::StdRng;
use rand::{RngExt as _, SeedableRng as _};

/// Block and pads.
pub const WIDTH_M: f64 = 0.016;
/// N
pub const WEIGHT_N: f64 = 0.6;
/// Of a pad under pressure, N/m …
pub const PAD_N_M: f64 = 12_000.0;
/// … and in shear.
const SHEAR_N_M: f64 = 7_000.0;
/// N
const GRIP_N: f64 = 1.6;
/// m
const OPEN_M: f64 = 0.012;

/// A normal number, by Box and Muller.
fn gauss(rng: &mut StdRng) -> f64 {
    let (a, b): (f64, f64) = (1.0 - rng.random::<f64>(), rng.random());
    (-2.0 * a.ln()).sqrt() * (std::f64::consts::TAU * b).cos()
}

/// From 0 at `from` to 1 at `to`, smoothly.
fn ramp(t: f64, from: f64, to: f64) -> f64 {
    let s = ((t - from) / (to - from)).clamp(0.0, 1.0);
    s * s * s * (10.0 - 15.0 * s + 6.0 * s * s)
}

/// The recording of one carry at `rate_hz`, with white noise of the forces.
pub fn carried_evenly(seed: u64, rate_hz: f64, noise_n: f64) -> Recording {
    let mut rng = StdRng::seed_from_u64(seed);
    let left_n = 0.2 + 0.8 * rng.random::<f64>();
    let opening_s = 0.25 + 0.35 * rng.random::<f64>();
    let n = (9.0 * rate_hz) as usize;
    let mut channels: Vec<(&str, Vec<f64>)> =
        ["x1_m", "y1_m", "x2_m", "y2_m", "fx1_N", "fy1_N", "fx2_N", "fy2_N"].map(|c| (c, Vec::new())).to_vec();
    let mut time_s = Vec::with_capacity(n);
    for i in 0..n {
        let t = i as f64 / rate_hz;
        time_s.push(t);
        // A tremor of a hundredth of the grip.
        let usual_n = GRIP_N + 0.015 * (50.0 * t).sin();
        let grip_n = usual_n * ramp(t, 1.4, 1.6) * (1.0 - ramp(t, 6.5, 6.5 + opening_s));
        let open_m = OPEN_M * (1.0 - ramp(t, 0.8, 1.4) + ramp(t, 6.5 + opening_s, 7.2));
        let height_m = 0.03 * (ramp(t, 2.4, 3.4) - ramp(t, 4.4, 5.4));
        let shear_n = WEIGHT_N * ramp(t, 2.2, 2.4) - (WEIGHT_N + left_n) * ramp(t, 5.4, 5.6);
        let shear_n = 0.5 * shear_n.clamp(-2.0 * grip_n, 2.0 * grip_n);
        let apart_m = if grip_n > 0.0 { WIDTH_M - 2.0 * grip_n / PAD_N_M } else { WIDTH_M } + 2.0 * open_m;
        let away_m = 0.04 * ramp(t, 7.4, 8.4);
        let y_m = -0.1 + height_m + shear_n / SHEAR_N_M + away_m;
        let exact = [-0.5 * apart_m, y_m, 0.5 * apart_m, y_m, grip_n, shear_n, -grip_n, shear_n];
        for (k, ((_, values), value)) in channels.iter_mut().zip(exact).enumerate() {
            let noise = if k < 4 { 1e-7 } else { noise_n };
            values.push(value + noise * gauss(&mut rng));
        }
    }
    let of = |(name, values): (&str, Vec<f64>)| Channel {
        name: name.to_owned(),
        unit: if name.starts_with('f') { "N" } else { "m" }.to_owned(),
        values,
    };
    Recording {
        name: format!("held evenly {seed}"),
        time_s: Some(time_s),
        channels: channels.into_iter().map(of).collect(),
        meta: Meta { task: Some(Task::BlockStack), ..Meta::default() },
        ..Recording::default()
    }
}
