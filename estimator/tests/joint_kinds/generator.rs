//! Tool paths of drawn mechanisms with the faults of real ones: uneven motion, dropped samples, white and coloured noise, a grip
//! that slips, rounding. Shares nothing with the estimator; the truth travels beside the recording.

use haptics::recording::{Channel, Recording};
use nalgebra::Vector3;
use rand::{RngExt as _, SeedableRng as _, rngs::StdRng};
use rand_distr::StandardNormal;
use std::f64::consts::TAU;

/// What really guides the tool.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Truth {
    Revolute,
    Prismatic,
    Free,
    Spline,
}

/// One drawn path.
pub struct Drawn {
    pub truth: Truth,
    pub recording: Recording,
    /// What was drawn, for people.
    pub about: String,
}

/// The path of `seed`.
pub fn draw(seed: u64) -> Drawn {
    let mut rng = StdRng::seed_from_u64(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ 0x6a09_e667);
    let truth = match rng.random_range(0..20) {
        0..8 => Truth::Revolute,
        8..15 => Truth::Prismatic,
        15..18 => Truth::Free,
        _ => Truth::Spline,
    };
    let (curve, length_m, sweep_rad) = curve(truth, &mut rng);
    let n = log_uniform(&mut rng, 60.0, 1500.0) as usize;
    let passes = if truth == Truth::Free { 1 } else { [1, 1, 2, 3][rng.random_range(0..4)] };
    let (time_s, place) = motion(n, passes, &mut rng);
    let flat: Vec<[f64; 2]> = place.iter().map(|u| curve(*u)).collect();
    // Nobody measures a palm-sized mechanism with an error of a good part of its size.
    let largest = |limit: f64, share: f64| limit.min(share * length_m);
    let white = log_uniform(&mut rng, 5e-5, largest(1.5e-3, 0.015));
    let coloured = if rng.random::<f64>() < 0.7 { rng.random_range(0.0..largest(1.5e-3, 0.015)) } else { 0.0 };
    let memory = log_uniform(&mut rng, 0.01, 0.3);
    let slips = if rng.random::<f64>() < 0.35 { rng.random_range(1..4) } else { 0 };
    let slip_m = rng.random_range(0.0..largest(4e-3, 0.03));
    let quantum = if rng.random::<f64>() < 0.4 { log_uniform(&mut rng, 5e-5, largest(1e-3, 0.01)) } else { 0.0 };
    let planar = rng.random::<bool>();
    let axes = if planar { plane_of(rng.random_range(0.0..TAU)) } else { space(&mut rng) };
    let origin = Vector3::new(0.4, -0.2, if planar { 0.0 } else { 0.7 });
    let mut points: Vec<Vector3<f64>> = flat.iter().map(|p| origin + axes[0] * p[0] + axes[1] * p[1]).collect();
    add_noise(&mut points, planar, white, coloured, memory, &mut rng);
    for _ in 0..slips {
        slip(&mut points, &axes, slip_m, &mut rng);
    }
    let kept = dropped(points.len(), &mut rng);
    let rounded = |v: f64| if quantum > 0.0 { (v / quantum).round() * quantum } else { v };
    let channel = |name: &str, k: usize| Channel {
        name: name.to_owned(),
        unit: "m".to_owned(),
        values: kept.iter().map(|&i| rounded(points[i][k])).collect(),
    };
    let mut channels = vec![channel("x_m", 0), channel("y_m", 1)];
    if !planar {
        channels.push(channel("z_m", 2));
    }
    let clock = rng.random::<bool>();
    let recording = Recording {
        name: format!("seed {seed}"),
        time_s: clock.then(|| kept.iter().map(|&i| time_s[i]).collect()),
        channels,
        ..Recording::default()
    };
    let about = format!(
        "{truth:?}, {:.0} mm, {:.0}°, {} samples, {passes} passes, white {:.2} mm, coloured {:.2} mm over {memory:.2}, {slips} slips of {:.1} mm, rounded to {:.2} mm",
        length_m * 1e3,
        sweep_rad.to_degrees(),
        kept.len(),
        white * 1e3,
        coloured * 1e3,
        slip_m * 1e3,
        quantum * 1e3
    );
    Drawn { truth, recording, about }
}

fn log_uniform(rng: &mut StdRng, low: f64, high: f64) -> f64 {
    low * (high.max(low * 1.001) / low).powf(rng.random::<f64>())
}

type Curve = Box<dyn Fn(f64) -> [f64; 2]>;

/// The guide as a curve over 0 … 1, its length or size, m, and its angle, rad.
fn curve(truth: Truth, rng: &mut StdRng) -> (Curve, f64, f64) {
    match truth {
        Truth::Revolute => {
            let radius = log_uniform(rng, 0.03, 1.0);
            let evenly = rng.random::<bool>();
            let degrees = if evenly { rng.random_range(5.0..360.0) } else { log_uniform(rng, 5.0, 360.0) };
            let sweep = f64::to_radians(degrees);
            let arc = move |u: f64| [radius * (sweep * u).cos(), radius * (sweep * u).sin()];
            (Box::new(arc), radius * sweep.min(2.0), sweep)
        }
        Truth::Prismatic => {
            let length = log_uniform(rng, 0.05, 0.8);
            (Box::new(move |u| [length * u, 0.0]), length, 0.0)
        }
        Truth::Free => {
            let size = log_uniform(rng, 0.05, 0.4);
            let waves: Vec<[f64; 6]> = (0..3)
                .map(|_| {
                    std::array::from_fn(|k| if k < 2 { rng.random_range(0.5..1.0) } else { rng.random_range(0.0..TAU) })
                })
                .collect();
            let turns: Vec<f64> = (0..6).map(|_| rng.random_range(0.5..3.5)).collect();
            let wander = move |u: f64| {
                let axis = |k: usize| {
                    let of = |(w, t): (&[f64; 6], &f64)| w[k] * (TAU * t * u + w[2 + k]).sin() / (0.6 + 0.4 * t);
                    0.35 * size * waves.iter().zip(&turns[3 * k..]).map(of).sum::<f64>()
                };
                [axis(0), axis(1)]
            };
            (Box::new(wander), size, 0.0)
        }
        Truth::Spline => {
            let length = log_uniform(rng, 0.06, 0.5);
            let bend = rng.random_range(0.1..0.3) * length;
            let shape = rng.random_range(0..3);
            let guide = move |u: f64| match shape {
                // An S, a half ellipse, a slot that runs straight and then turns off.
                0 => [length * u, bend * (TAU * u).sin()],
                1 => [0.5 * length * (0.5 * TAU * u).cos(), bend * 0.6 * (0.5 * TAU * u).sin()],
                _ => [length * u, 2.0 * bend * (u - 0.55).max(0.0)],
            };
            (Box::new(guide), length, 0.0)
        }
    }
}

/// Times, s, and places 0 … 1 along the guide: there and back, slower at the ends, with rests in between.
fn motion(n: usize, passes: usize, rng: &mut StdRng) -> (Vec<f64>, Vec<f64>) {
    let rest_at = rng.random_range(0.2..0.8);
    let rest = if rng.random::<f64>() < 0.4 { rng.random_range(0.1..0.4) } else { 0.0 };
    let smooth = |s: f64| s * s * (3.0 - 2.0 * s);
    let rate_hz = log_uniform(rng, 20.0, 1000.0);
    let jitter = rng.random_range(0.0..0.4);
    let place = |at: f64| {
        let moved = if at < rest_at { at } else { (at - rest).max(rest_at) } / (1.0 - rest);
        let along = moved.clamp(0.0, 1.0) * passes as f64;
        let (pass, part) = ((along.floor() as usize).min(passes - 1), along - along.floor().min(passes as f64 - 1.0));
        if pass.is_multiple_of(2) { smooth(part) } else { 1.0 - smooth(part) }
    };
    let times: Vec<f64> = (0..n).map(|i| (i as f64 + jitter * rng.random_range(-0.49..0.49)) / rate_hz).collect();
    let places = times.iter().map(|t| place((t * rate_hz / n as f64).clamp(0.0, 1.0))).collect();
    (times, places)
}

fn plane_of(angle: f64) -> [Vector3<f64>; 2] {
    let (sin, cos) = angle.sin_cos();
    [Vector3::new(cos, sin, 0.0), Vector3::new(-sin, cos, 0.0)]
}

/// Two orthogonal directions in space.
fn space(rng: &mut StdRng) -> [Vector3<f64>; 2] {
    let mut draw = || Vector3::from_fn(|_, _| rng.sample::<f64, _>(StandardNormal));
    let first = draw().normalize();
    let other = draw();
    [first, (other - first * first.dot(&other)).normalize()]
}

/// White noise, and one that remembers over a share `memory` of the recording.
fn add_noise(points: &mut [Vector3<f64>], planar: bool, white: f64, coloured: f64, memory: f64, rng: &mut StdRng) {
    let keep = (-1.0 / (memory * points.len() as f64)).exp();
    for k in 0..if planar { 2 } else { 3 } {
        let mut state: f64 = rng.sample(StandardNormal);
        for p in points.iter_mut() {
            state = keep * state + (1.0 - keep * keep).sqrt() * rng.sample::<f64, _>(StandardNormal);
            p[k] += coloured * state + white * rng.sample::<f64, _>(StandardNormal);
        }
    }
}

/// The grasp moves by up to `size_m` within a few samples and stays there.
fn slip(points: &mut [Vector3<f64>], axes: &[Vector3<f64>; 2], size_m: f64, rng: &mut StdRng) {
    let (at, over) = (rng.random_range(0..points.len()), rng.random_range(1..8));
    let angle = rng.random_range(0.0..TAU);
    let step = (axes[0] * angle.cos() + axes[1] * angle.sin()) * size_m;
    for (i, p) in points.iter_mut().enumerate().skip(at) {
        *p += step * ((i - at) as f64 / f64::from(over)).min(1.0);
    }
}

/// Indices that reached the log.
fn dropped(n: usize, rng: &mut StdRng) -> Vec<usize> {
    let share = if rng.random::<bool>() { rng.random_range(0.0..0.3) } else { 0.0 };
    (0..n).filter(|_| rng.random::<f64>() >= share).collect()
}
