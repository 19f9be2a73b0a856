//! Smooth random functions: columns whose coefficients share one variance.

use std::f64::consts::PI;

/// A structured error of a channel: an unknown smooth function of some variables.
#[derive(Clone, Debug, PartialEq)]
pub struct Discrepancy {
    /// Variables of which it is a function.
    pub over: &'static str,
    /// Columns of equal prior variance; their mean squares sum to one.
    pub columns: Vec<Vec<f64>>,
}

impl Discrepancy {
    /// Products of a carrier with the functions of a basis, scaled to unit mean square over the rows of the carrier.
    /// `None` if nothing varies.
    pub fn of(over: &'static str, carrier: &[f64], basis: &[Vec<f64>]) -> Option<Self> {
        let product = |column: &Vec<f64>| column.iter().zip(carrier).map(|(a, b)| a * b).collect::<Vec<f64>>();
        Self::new(over, basis.iter().map(product).collect())
    }

    /// A force as a function of a basis in these rows. Its means are taken out: a constant force belongs to the laws.
    pub fn of_force(over: &'static str, used: &[bool], basis: &[Vec<f64>]) -> Option<Self> {
        let rows = used.iter().filter(|u| **u).count().max(1) as f64;
        let varying = |column: &Vec<f64>| {
            let mean = column.iter().zip(used).filter(|(_, u)| **u).map(|(v, _)| v).sum::<f64>() / rows;
            column.iter().zip(used).map(|(v, u)| if *u { v - mean } else { 0.0 }).collect()
        };
        Self::new(over, basis.iter().map(varying).collect())
    }

    /// These columns, scaled together.
    pub fn new(over: &'static str, mut columns: Vec<Vec<f64>>) -> Option<Self> {
        let rows = (0..columns.first()?.len()).filter(|i| columns.iter().any(|c| c[*i] != 0.0)).count();
        let power: f64 = columns.iter().flatten().map(|v| v * v).sum::<f64>() / rows.max(1) as f64;
        if !power.is_finite() || power <= 0.0 {
            return None;
        }
        let scale = power.sqrt().recip();
        columns.iter_mut().flatten().for_each(|v| *v *= scale);
        Some(Self { over, columns })
    }
}

/// Weight of a harmonic of a function with this correlation length, in radians of its phase (Matérn 3/2).
fn weight(order: f64, length: f64) -> f64 {
    (1.0 + (order * length).powi(2)).powf(-0.75)
}

/// Functions of an angle: harmonics without the mean.
pub fn periodic(angle_rad: &[f64], count: u32) -> Vec<Vec<f64>> {
    let wave = |k: u32, of: fn(f64) -> f64| {
        let k = f64::from(k);
        angle_rad.iter().map(|a| weight(k, 0.4) * of(k * a)).collect()
    };
    (1..=count).flat_map(|k| [wave(k, f64::cos), wave(k, f64::sin)]).collect()
}

/// Functions of a variable over its range: half waves without the mean. `length`: correlation length as a share of the
/// range.
pub fn over_range(values: &[f64], used: &[bool], length: f64, count: usize) -> Vec<Vec<f64>> {
    let mut sorted: Vec<f64> = values.iter().zip(used).filter(|(_, u)| **u).map(|(v, _)| *v).collect();
    if sorted.is_empty() {
        return Vec::new();
    }
    sorted.sort_by(f64::total_cmp);
    let at = |share: f64| sorted[((sorted.len() - 1) as f64 * share).round() as usize];
    // A few outliers must not stretch the range.
    let (low, high) = (at(0.005), at(0.995));
    if high - low <= 1e-12 * (high.abs() + low.abs()) {
        return Vec::new();
    }
    let share = |v: f64| ((v - low) / (high - low)).clamp(0.0, 1.0);
    let wave = |k: usize| {
        let k = k as f64;
        let of = |(v, u): (&f64, &bool)| if *u { weight(k, PI * length) * (PI * k * share(*v)).cos() } else { 0.0 };
        values.iter().zip(used).map(of).collect()
    };
    (1..=count).map(wave).collect()
}

/// Functions of time: half waves up to a frequency, with the spectrum of a process of this correlation time, s.
pub fn over_time(time_s: &[f64], highest_hz: f64, correlation_s: f64, most: usize) -> Vec<Vec<f64>> {
    let begin = time_s.iter().copied().fold(f64::INFINITY, f64::min);
    let span_s = time_s.iter().copied().fold(f64::NEG_INFINITY, f64::max) - begin;
    if !span_s.is_finite() || span_s <= 0.0 {
        return Vec::new();
    }
    let count = ((2.0 * highest_hz * span_s) as usize).clamp(2, most);
    let wave = |k: usize| {
        let omega = PI * k as f64 / span_s;
        let size = (1.0 + (omega * correlation_s).powi(2)).powf(-0.5);
        time_s.iter().map(|t| size * (omega * (t - begin)).cos()).collect()
    };
    (1..=count).map(wave).collect()
}

/// Functions of several variables of unit scale: random Fourier features (Rahimi & Recht 2007) of a Gaussian kernel of
/// unit length, with the same frequencies every time.
pub fn field(variables: &[Vec<f64>], count: usize) -> Vec<Vec<f64>> {
    let mut state = 0x9E37_79B9_7F4A_7C15_u64;
    let mut uniform = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((state >> 11) as f64 + 0.5) / (1_u64 << 53) as f64
    };
    let rows = variables.first().map_or(0, Vec::len);
    (0..count)
        .map(|_| {
            let mut phase = vec![2.0 * PI * uniform(); rows];
            for variable in variables {
                let frequency = (-2.0 * uniform().ln()).sqrt() * (2.0 * PI * uniform()).cos();
                phase.iter_mut().zip(variable).for_each(|(p, v)| *p += frequency * v);
            }
            phase.into_iter().map(f64::cos).collect()
        })
        .collect()
}

/// Root mean square over the rows on which a force acts, each by its weight.
pub fn rms(values: &[f64], weight: &[f64]) -> f64 {
    let acting = || values.iter().zip(weight).filter(|(v, _)| **v != 0.0);
    let rows: f64 = acting().map(|(_, w)| w * w).sum();
    (acting().map(|(v, w)| (v * w).powi(2)).sum::<f64>() / rows.max(f64::MIN_POSITIVE)).sqrt()
}
