//! Readings of a sensor with a load, by code of its own: quaternions, a person's poses, noise, a bias that wanders, errors
//! between holds, orientations that are slightly off.

use haptics::recording::{Channel, Recording};
use rand::{RngExt as _, SeedableRng as _, rngs::StdRng};
use rand_distr::StandardNormal;
use std::f64::consts::TAU;

pub type V = [f64; 3];
/// Scalar first, as the columns of the program are not.
pub type Q = [f64; 4];

pub fn times(a: Q, b: Q) -> Q {
    [
        a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
        a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
        a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
        a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0],
    ]
}

pub fn conjugate(q: Q) -> Q {
    [q[0], -q[1], -q[2], -q[3]]
}

/// q v q*.
pub fn turn(q: Q, v: V) -> V {
    let [_, x, y, z] = times(times(q, [0.0, v[0], v[1], v[2]]), conjugate(q));
    [x, y, z]
}

pub fn about(axis: V, angle: f64) -> Q {
    let norm = axis.iter().map(|v| v * v).sum::<f64>().sqrt().max(1e-12);
    let s = (0.5 * angle).sin() / norm;
    [(0.5 * angle).cos(), axis[0] * s, axis[1] * s, axis[2] * s]
}

fn cross(a: V, b: V) -> V {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn add(a: V, b: V) -> V {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

fn scaled(a: V, s: f64) -> V {
    a.map(|v| v * s)
}

/// Form of a recording.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Form {
    /// A table of so many poses without a clock.
    Table(usize),
    /// So many holds with moves between them, 20 Hz.
    Holds(usize),
    /// A slow motion of so many seconds, 20 Hz.
    Slow(f64),
}

/// Load and sensor.
#[derive(Clone, Copy, Debug)]
pub struct Sensor {
    pub weight_n: f64,
    pub com_m: V,
    pub bias_n: V,
    pub bias_nm: V,
    pub drift_n_s: V,
    /// Errors between holds by axis, N.
    pub between_n: V,
    /// Errors of an orientation, rad.
    pub off_rad: f64,
    /// Standard deviation of the slow wandering of the bias, N.
    pub wander_n: f64,
    /// Noise of a sample, N.
    pub noise_n: f64,
    /// Axis by which the base is tilted, times the angle, rad.
    pub tilt: V,
}

fn normal(rng: &mut StdRng) -> f64 {
    rng.sample(StandardNormal)
}

fn normals(rng: &mut StdRng, std: f64) -> V {
    [(); 3].map(|()| std * normal(rng))
}

impl Sensor {
    pub fn drawn(rng: &mut StdRng) -> Self {
        let mut any = |reach: f64| [(); 3].map(|()| rng.random_range(-reach..reach));
        let (com_m, bias_n, bias_nm, drift_n_s) = (any(0.12), any(12.0), any(0.6), any(0.002));
        let size = rng.random_range(0.03..0.15);
        let mut share = || size * rng.random_range(0.5..2.0);
        let between_n = [share(), share(), share()];
        Self {
            weight_n: rng.random_range(3.0..25.0),
            com_m,
            bias_n,
            bias_nm,
            drift_n_s,
            between_n,
            off_rad: 0.003,
            wander_n: 0.03,
            noise_n: 0.03,
            tilt: [0.0; 3],
        }
    }

    /// Force and torque in the sensor's axes, without errors. `q` turns from the sensor to the base.
    fn reading(&self, q: Q, time_s: f64) -> [V; 2] {
        let angle = self.tilt.iter().map(|v| v * v).sum::<f64>().sqrt();
        let down = turn(about(self.tilt, angle), [0.0, 0.0, -1.0]);
        let pull = scaled(turn(conjugate(q), down), self.weight_n);
        let force = add(add(pull, self.bias_n), scaled(self.drift_n_s, time_s));
        [force, add(cross(self.com_m, pull), self.bias_nm)]
    }
}

/// A person's poses: level, on the sides, overhead, none of it exact.
fn pose(rng: &mut StdRng) -> Q {
    let quarters = [0.0, 90.0, -90.0, 180.0, 45.0, -45.0, 120.0];
    let mut angle = || (quarters[rng.random_range(0..quarters.len())] + rng.random_range(-20.0..20.0_f64)).to_radians();
    times(times(about([0.0, 0.0, 1.0], angle()), about([0.0, 1.0, 0.0], angle())), about([1.0, 0.0, 0.0], angle()))
}

/// Interpolation on the shorter arc, with a smooth start and end.
fn between(a: Q, b: Q, share: f64) -> Q {
    let mut step = times(conjugate(a), b);
    if step[0] < 0.0 {
        step = step.map(|v| -v);
    }
    let sine = (1.0 - step[0] * step[0]).max(0.0).sqrt();
    let angle = 2.0 * sine.atan2(step[0]);
    let eased = share * share * share * (10.0 - 15.0 * share + 6.0 * share * share);
    times(a, about([step[1], step[2], step[3]], angle * eased))
}

/// True orientation over time, and true for samples of a hold, with the number of the hold.
fn path(form: Form, rng: &mut StdRng) -> Vec<(f64, Q, usize)> {
    let step_s = 0.05;
    match form {
        Form::Table(n) => (0..n).map(|i| (i as f64, pose(rng), i)).collect(),
        Form::Holds(n) => {
            let mut all = Vec::new();
            let (mut t, mut now) = (0.0, pose(rng));
            for hold in 0..n {
                for _ in 0..rng.random_range(40..120) {
                    all.push((t, now, hold));
                    t += step_s;
                }
                let next = pose(rng);
                for i in 0..40 {
                    all.push((t, between(now, next, f64::from(i) / 40.0), hold));
                    t += step_s;
                }
                now = next;
            }
            all
        }
        Form::Slow(seconds) => {
            // Slow turns about three axes with periods that have no common multiple; 0.1 to 0.4 rad/s.
            let phase = [(); 6].map(|()| rng.random_range(0.0..TAU));
            let at = |t: f64| {
                let part = |k: usize, reach: f64, period: f64| reach * (TAU * t / period + phase[k]).sin();
                let roll = about([1.0, 0.0, 0.0], part(0, 1.6, 47.0) + part(1, 0.4, 19.0));
                let pitch = about([0.0, 1.0, 0.0], part(2, 1.4, 61.0) + part(3, 0.4, 23.0));
                times(times(about([0.0, 0.0, 1.0], part(4, 1.0, 71.0)), pitch), roll)
            };
            // Errors of a slow motion change every 4 s.
            (0..(seconds / step_s) as usize).map(|i| (i as f64 * step_s, at(i as f64 * step_s), i / 80)).collect()
        }
    }
}

/// A recording with the quaternion as it is read out, x y z w, and the wrench in the sensor's axes. Beside it stand its
/// true bias, N, and drift, N/s: those of a straight line through the bias as it wandered.
pub fn make(form: Form, sensor: Sensor, seed: u64) -> (Recording, [V; 2]) {
    let mut rng = StdRng::seed_from_u64(seed);
    let path = path(form, &mut rng);
    let with_clock = !matches!(form, Form::Table(_));
    let step_s = if with_clock { 0.05 } else { 20.0 };
    let (decay, mut wander) = ((-step_s / 60.0_f64).exp(), normals(&mut rng, sensor.wander_n));
    let holds = path.last().map_or(0, |last| last.2) + 1;
    let errors: Vec<(V, V, V)> = (0..holds)
        .map(|_| {
            let force = [0, 1, 2].map(|k| sensor.between_n[k] * normal(&mut rng));
            (force, normals(&mut rng, 0.1 * sensor.between_n[0]), normals(&mut rng, sensor.off_rad))
        })
        .collect();
    let mut columns = vec![Vec::new(); 10];
    let mut biases = Vec::new();
    for (t, q, hold) in &path {
        let (force_error, torque_error, off) = errors[*hold];
        let own_s = if with_clock { *t } else { 0.0 };
        let [force, torque] = sensor.reading(*q, own_s);
        let stirred = add(normals(&mut rng, (1.0 - decay * decay).sqrt() * sensor.wander_n), scaled(wander, decay));
        wander = stirred;
        biases.push((own_s, add(add(sensor.bias_n, scaled(sensor.drift_n_s, own_s)), wander)));
        let force = add(add(add(force, force_error), wander), normals(&mut rng, sensor.noise_n));
        let torque = add(add(torque, torque_error), normals(&mut rng, 0.05 * sensor.noise_n));
        let angle = off.iter().map(|v| v * v).sum::<f64>().sqrt();
        let told = times(*q, about(off, angle));
        let row = [told[1], told[2], told[3], told[0], force[0], force[1], force[2], torque[0], torque[1], torque[2]];
        columns.iter_mut().zip(row).for_each(|(column, value)| column.push(value));
    }
    let names = ["qx", "qy", "qz", "qw", "fx_N", "fy_N", "fz_N", "tx_Nm", "ty_Nm", "tz_Nm"];
    let channel = |(name, values): (&str, Vec<f64>)| Channel { name: name.to_owned(), unit: String::new(), values };
    let recording = Recording {
        name: "generated.csv".to_owned(),
        time_s: with_clock.then(|| path.iter().map(|(t, ..)| *t).collect()),
        channels: names.into_iter().zip(columns).map(channel).collect(),
        ..Recording::default()
    };
    let middle_s = 0.5 * (biases[0].0 + biases[biases.len() - 1].0);
    (recording, line(&biases, middle_s))
}

/// Value in the middle and slope of the straight line through the biases.
fn line(biases: &[(f64, V)], middle_s: f64) -> [V; 2] {
    let n = biases.len() as f64;
    let mean_t = biases.iter().map(|(t, _)| t).sum::<f64>() / n;
    let spread: f64 = biases.iter().map(|(t, _)| (t - mean_t).powi(2)).sum();
    let of = |k: usize| {
        let mean = biases.iter().map(|(_, b)| b[k]).sum::<f64>() / n;
        let slope = biases.iter().map(|(t, b)| (t - mean_t) * b[k]).sum::<f64>() / spread.max(1e-300);
        (mean + slope * (middle_s - mean_t), slope)
    };
    let all = [of(0), of(1), of(2)];
    [all.map(|(value, _)| value), all.map(|(_, slope)| slope)]
}
