//! Correlation of two signals over all shifts, each over its own overlap.

use super::grid::Grid;
use rustfft::num_complex::Complex;
use rustfft::{Fft, FftPlanner};
use std::sync::Arc;

/// Smallest overlap as a share of the shorter signal: a shorter piece of a motion looks like pieces of many others.
const LEAST_OVERLAP: f64 = 0.25;
/// Smallest share of the whole variance in an overlap: less of it is noise.
const LEAST_VARIANCE: f64 = 1e-6;
/// A rival has at least this share of the best shift's overlap: a shorter piece agrees by chance, and shows less.
const RIVAL_OVERLAP: f64 = 0.5;
/// Height of the correlation, over that of the peak, at which its main lobe ends.
const LOBE: f64 = 0.5;

/// Agreement of two signals at one shift.
#[derive(Clone, Copy, Debug)]
pub struct Peak {
    /// Steps by which the other signal is moved to later places.
    pub shift: f64,
    /// Correlation, −1 … 1.
    pub r: f64,
}

impl Peak {
    /// Residual variance of the regression of one signal on the other, as a share of the variance, 0 … 1.
    pub fn residual_share(&self) -> f64 {
        (1.0 - self.r * self.r).max(f64::EPSILON)
    }
}

/// The best shift, and its closest rival outside the main lobe.
#[derive(Clone, Copy, Debug)]
pub struct Peaks {
    pub best: Peak,
    pub rival: Option<Peak>,
    /// Shifts that were compared.
    pub shifts: usize,
}

/// Correlation at every shift by fast Fourier transforms. Mean and variance are those of the overlap without gaps
/// (Padfield 2012). `least`: fewest samples of an overlap. None if no shift has one in which both signals vary.
pub fn peaks(own: &Grid, other: &Grid, least: f64) -> Option<Peaks> {
    let total = |grid: &Grid| grid.weight.iter().sum::<f64>();
    let least = (LEAST_OVERLAP * total(own).min(total(other))).max(least);
    let (na, nb) = (own.values.len(), other.values.len());
    let transform = Transform::new(na + nb);
    let parts = |grid: &Grid| {
        let weighted = |of: &dyn Fn(f64) -> f64| -> Vec<Complex<f64>> {
            let values: Vec<f64> = grid.values.iter().zip(&grid.weight).map(|(v, w)| w * of(*v)).collect();
            transform.forward(&values)
        };
        [weighted(&|_| 1.0), weighted(&|v| v), weighted(&|v| v * v)]
    };
    let ([m_a, a, aa], [m_b, b, bb]) = (parts(own), parts(other));
    let n = transform.correlation(&m_a, &m_b);
    let (s_a, s_aa) = (transform.correlation(&a, &m_b), transform.correlation(&aa, &m_b));
    let (s_b, s_bb) = (transform.correlation(&m_a, &b), transform.correlation(&m_a, &bb));
    let s_ab = transform.correlation(&a, &b);
    let count = na + nb - 1;
    let at = |k: usize| -> (f64, f64) {
        // Place k belongs to the shift k − (nb − 1); negative ones stand at the end of the transform.
        let i = if k + 1 >= nb { k + 1 - nb } else { n.len() + k + 1 - nb };
        if n[i].round() < least {
            return (0.0, 0.0);
        }
        let (v_a, v_b) = (s_aa[i] - s_a[i] * s_a[i] / n[i], s_bb[i] - s_b[i] * s_b[i] / n[i]);
        let is_flat = v_a.min(v_b) < LEAST_VARIANCE * n[i];
        let r = if is_flat { 0.0 } else { (s_ab[i] - s_a[i] * s_b[i] / n[i]) / (v_a * v_b).sqrt() };
        (r.clamp(-1.0, 1.0), n[i])
    };
    let curve: Vec<(f64, f64)> = (0..count).map(at).collect();
    let shifts = curve.iter().filter(|(_, n)| *n > 0.0).count();
    let evidence = |(r, n): (f64, f64)| -n * (1.0 - r * r).max(f64::EPSILON).ln();
    let best = (0..count).max_by(|&a, &b| evidence(curve[a]).total_cmp(&evidence(curve[b])))?;
    let top = curve[best];
    let peak = |k: usize| {
        let (vertex, r) = vertex(&curve, k);
        Peak { shift: k as f64 + vertex - (nb as f64 - 1.0), r }
    };
    let is_in_lobe = |k: &usize| curve[*k].0 * top.0.signum() >= LOBE * top.0.abs();
    let first = (0..best).rev().find(|k| !is_in_lobe(k)).map_or(0, |k| k + 1);
    let end = (best..count).find(|k| !is_in_lobe(k)).unwrap_or(count);
    let rivals = (0..first).chain(end..count).filter(|&k| curve[k].1 >= RIVAL_OVERLAP * top.1);
    let rival = rivals.max_by(|&a, &b| curve[a].0.abs().total_cmp(&curve[b].0.abs())).map(peak);
    (top.0 != 0.0).then(|| Peaks { best: peak(best), rival, shifts })
}

/// Place from sample `k`, −0.5 … 0.5, and height of the parabola through three samples.
fn vertex(curve: &[(f64, f64)], k: usize) -> (f64, f64) {
    let r = curve[k].0;
    let (Some(&(before, n0)), Some(&(after, n1))) = (k.checked_sub(1).and_then(|k| curve.get(k)), curve.get(k + 1))
    else {
        return (0.0, r);
    };
    let bend = before - 2.0 * r + after;
    let is_peak = n0 > 0.0 && n1 > 0.0 && (r - before) * (r - after) >= 0.0 && bend != 0.0;
    if !is_peak {
        return (0.0, r);
    }
    let u = (0.5 * (before - after) / bend).clamp(-0.5, 0.5);
    (u, (r - 0.25 * (before - after) * u).clamp(-1.0, 1.0))
}

/// Number of independent samples for the correlation of two series of equal length with zero mean: n over the sum of the
/// products of their autocorrelations (Bartlett 1935).
pub fn independent_samples(a: &[f64], b: &[f64]) -> f64 {
    let transform = Transform::new(2 * a.len());
    let power = |series: &[f64]| transform.forward(series).iter().map(Complex::norm_sqr).collect::<Vec<f64>>();
    let (power_a, power_b) = (power(a), power(b));
    let sum = |of: &[f64]| of.iter().sum::<f64>();
    let both: f64 = power_a.iter().zip(&power_b).map(|(a, b)| a * b).sum();
    a.len() as f64 * sum(&power_a) * sum(&power_b) / (transform.size as f64 * both)
}

/// Fourier transform and its inverse, of one size.
struct Transform {
    size: usize,
    forward: Arc<dyn Fft<f64>>,
    inverse: Arc<dyn Fft<f64>>,
}

impl Transform {
    fn new(samples: usize) -> Self {
        let size = samples.next_power_of_two();
        let mut planner = FftPlanner::new();
        Self { size, forward: planner.plan_fft_forward(size), inverse: planner.plan_fft_inverse(size) }
    }

    /// Transform of the values, with zeros behind them.
    fn forward(&self, values: &[f64]) -> Vec<Complex<f64>> {
        let mut work: Vec<Complex<f64>> = values.iter().map(|&v| Complex::new(v, 0.0)).collect();
        work.resize(self.size, Complex::default());
        self.forward.process(&mut work);
        work
    }

    /// Sum over j of a(j + k) b(j) at place k, from the transforms.
    fn correlation(&self, a: &[Complex<f64>], b: &[Complex<f64>]) -> Vec<f64> {
        let mut work: Vec<Complex<f64>> = a.iter().zip(b).map(|(a, b)| a * b.conj()).collect();
        self.inverse.process(&mut work);
        work.iter().map(|v| v.re / self.size as f64).collect()
    }
}
