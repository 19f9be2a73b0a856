//! Passivity and stability limits of a sampled virtual wall, and an observer that watches the energy at run time.
//!
//! A wall of stiffness K and damping B, sampled with period T and held in between, on a device with physical damping b:
//! passive for b > K T/2 + |B| (Colgate & Schenkel 1997), with an extra delay `t_d` for b > K (T/2 + `t_d`) + |B|; stable already
//! for K < (b + B)/(T/2 + `t_d`) (Gil et al. 2009, light damping). The first is the promise that nothing the operator does can
//! draw energy out of the wall; the second only that a free hand is left alone. With B > b a wall can be stable and never passive.
//!
//! Positions in steps of Δ make the spring's force wrong by up to K Δ/2, and the damper's, which takes the difference
//! of two of them, by up to B Δ/T. Only Coulomb friction `f_c` takes up the energy of these errors (Abbott & Okamura
//! 2005, for the spring).

#[cfg(test)]
mod oracles;
#[cfg(test)]
mod tests;

use crate::Vec2;
use crate::device::DeviceSpec;
use nalgebra::Complex;

/// Physical damping that makes a sampled wall passive, N s/m: K T/2 + |B|.
pub fn required_damping(stiffness_n_m: f64, damping_n_s_m: f64, period_s: f64) -> f64 {
    0.5 * stiffness_n_m * period_s + damping_n_s_m.abs()
}

/// The same by the general criterion, for any pulse transfer function H(z) from displacement to force: sup over 0 < ω ≤
/// π/T of (T/2)/(1 − cos ωT) · Re{(1 − e^(−jωT)) H(e^(jωT))}.
pub fn required_damping_of(transfer: impl Fn(Complex<f64>) -> Complex<f64>, period_s: f64) -> f64 {
    const FREQUENCIES: usize = 4096;
    (1..=FREQUENCIES)
        .map(|i| {
            let angle = std::f64::consts::PI * i as f64 / FREQUENCIES as f64;
            let z = Complex::from_polar(1.0, angle);
            let gain = ((Complex::new(1.0, 0.0) - z.inv()) * transfer(z)).re;
            0.5 * period_s / (1.0 - angle.cos()) * gain
        })
        .fold(f64::NEG_INFINITY, f64::max)
}

/// Pulse transfer function of a wall with a backward difference: H(z) = K + B (z − 1)/(T z).
pub fn wall(stiffness_n_m: f64, damping_n_s_m: f64, period_s: f64) -> impl Fn(Complex<f64>) -> Complex<f64> {
    move |z| (z - 1.0) / (z * period_s) * damping_n_s_m + stiffness_n_m
}

/// Largest stiffness, N/m, that a device can render as a passive wall beside a damping B (N s/m). It depends on the
/// period (s) and an extra delay (s) between a motion and the force that answers it: (b − |B|)/(T/2 + `t_d`). With
/// position steps it is at most 2 (`f_c`/Δ − |B|/T). Zero when the damping alone is too much.
pub fn passive_stiffness(spec: &DeviceSpec, damping_n_s_m: f64, period_s: f64, delay_s: f64) -> f64 {
    let sampled = (spec.damping_n_s_m - damping_n_s_m.abs()) / (0.5 * period_s + delay_s);
    let quantised = 2.0 * (friction_per_step_n_m(spec) - damping_n_s_m.abs() / period_s);
    sampled.min(quantised).max(0.0)
}

/// Largest damping that a device can render passively on its own at a period (s), N s/m: b, and with steps of position no more
/// than `f_c` T/Δ.
pub fn passive_damping(spec: &DeviceSpec, period_s: f64) -> f64 {
    spec.damping_n_s_m.min(friction_per_step_n_m(spec) * period_s)
}

/// `f_c`/Δ, N/m: the part of the steps that friction takes up; infinite without steps.
pub(super) fn friction_per_step_n_m(spec: &DeviceSpec) -> f64 {
    if spec.resolution_m > 0.0 { spec.coulomb_n / spec.resolution_m } else { f64::INFINITY }
}

/// Stiffness below which a wall is stable, N/m: (b + B)/(T/2 + `t_d`) for an extra delay `t_d`.
pub fn stable_stiffness(device_damping: f64, damping_n_s_m: f64, period_s: f64, delay_s: f64) -> f64 {
    (device_damping + damping_n_s_m) / (0.5 * period_s + delay_s)
}

/// Time-domain passivity observer (Hannaford & Ryu 2002): the energy that the virtual environment has taken in. It sums
/// Σ F (`x_{k+1}` − `x_k`) over both fingers, with F the force of the operator on the environment, less the rise of the
/// energy stored in the environment ([`Stored`](crate::world::Stored)). A passive environment never has E < 0: an
/// operator who lowers a raised object gets its energy back, and that is not counted as activity. A single finger may
/// have E < 0: it is pushed when the other one moves an object that both hold.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Observer {
    taken_j: f64,
    /// At the start, and now.
    stored_j: Option<(f64, f64)>,
    last: Option<([Vec2; 2], [Vec2; 2])>,
}

impl Observer {
    /// Takes the newest positions (m), the forces that will be held from now on (N, of the operator on the environment), and the
    /// energy that the environment holds, J.
    pub fn add(&mut self, positions: [Vec2; 2], forces_n: [Vec2; 2], stored_j: f64) {
        if let Some((before, held)) = self.last {
            self.taken_j += (0..2).map(|finger| held[finger].dot(&(positions[finger] - before[finger]))).sum::<f64>();
        }
        self.last = Some((positions, forces_n));
        let start_j = self.stored_j.map_or(stored_j, |(start_j, _)| start_j);
        self.stored_j = Some((start_j, stored_j));
    }

    /// Energy taken in and not held, J; negative: the environment has generated energy.
    pub fn energy_j(&self) -> f64 {
        self.taken_j - self.stored_j.map_or(0.0, |(start_j, now_j)| now_j - start_j)
    }
}

/// Passivity controller: while the observer is negative, an extra damping takes the generated energy back within one
/// period, α = −E/(T Σ v²), capped. At rest it is zero: it would be without bound there.
///
/// Returns the extra force on each of the operator's fingers, N.
pub fn control(observer: &Observer, velocities: [Vec2; 2], period_s: f64, most_n_s_m: f64) -> [Vec2; 2] {
    const REST_M_S: f64 = 1e-4;
    let energy = observer.energy_j();
    let square: f64 = velocities.iter().map(Vec2::norm_squared).sum();
    if energy >= 0.0 || square < REST_M_S * REST_M_S {
        return [Vec2::zeros(); 2];
    }
    let damping = (-energy / (period_s * square)).min(most_n_s_m);
    velocities.map(|velocity| -velocity * damping)
}
