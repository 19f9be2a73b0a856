//! When a sampled virtual wall is passive, when it is stable, and an observer that watches the energy at run time.
//!
//! A wall of stiffness K and damping B, sampled with period T and held in between, on a device with physical damping b:
//! passive for b > K T/2 + |B| (Colgate & Schenkel 1997); stable already for K < (b + B)/(T/2 + `t_d`) (Gil et al. 2009, light
//! damping). The first is the promise that nothing the operator does can draw energy out of the wall; the second only that a
//! free hand is left alone. With B > b a wall can be stable and never passive.

use crate::Vec2;
use crate::device::DeviceSpec;
use nalgebra::Complex;

/// Physical damping that makes a sampled wall passive, N s/m: K T/2 + |B|.
pub fn required_damping(stiffness_n_m: f64, damping_n_s_m: f64, period_s: f64) -> f64 {
    0.5 * stiffness_n_m * period_s + damping_n_s_m.abs()
}

/// The same by the general criterion, for any pulse transfer function H(z) from displacement to force:
/// sup over 0 < ω ≤ π/T of (T/2)/(1 − cos ωT) · Re{(1 − e^(−jωT)) H(e^(jωT))}.
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

/// Largest stiffness that a device can render as a passive wall, N/m: 2 (b − |B|)/T, and with a quantised encoder no more than
/// 2 `f_c`/Δ (Abbott & Okamura 2005). Zero when the damping alone is too much.
pub fn passive_stiffness(spec: &DeviceSpec, damping_n_s_m: f64, period_s: f64) -> f64 {
    let sampled = 2.0 * (spec.damping_n_s_m - damping_n_s_m.abs()) / period_s;
    let quantised = if spec.resolution_m > 0.0 { 2.0 * spec.coulomb_n / spec.resolution_m } else { f64::INFINITY };
    sampled.min(quantised).max(0.0)
}

/// Stiffness below which a wall is stable, N/m: (b + B)/(T/2 + `t_d`) for an extra delay `t_d`.
pub fn stable_stiffness(device_damping: f64, damping_n_s_m: f64, period_s: f64, delay_s: f64) -> f64 {
    (device_damping + damping_n_s_m) / (0.5 * period_s + delay_s)
}

/// Time-domain passivity observer (Hannaford & Ryu 2002): the energy that the virtual environment has taken in,
/// E = Σ F (`x_{k+1}` − `x_k`), summed over both fingers, with F the force of the operator on the environment. A passive
/// environment never has E < 0. A single finger may: it is pushed when the other one moves what both hold.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Observer {
    energy_j: f64,
    last: Option<([Vec2; 2], [Vec2; 2])>,
}

impl Observer {
    /// Takes the newest positions (m) and the forces that will be held from now on (N, of the operator on the environment).
    pub fn add(&mut self, positions: [Vec2; 2], forces_n: [Vec2; 2]) {
        if let Some((before, held)) = self.last {
            self.energy_j += (0..2).map(|finger| held[finger].dot(&(positions[finger] - before[finger]))).sum::<f64>();
        }
        self.last = Some((positions, forces_n));
    }

    /// Energy taken in so far, J; negative: the environment has given energy out.
    pub fn energy_j(&self) -> f64 {
        self.energy_j
    }
}

/// Passivity controller: while the observer is in the red, an extra damping that takes back what was given out within one
/// period, α = −E/(T Σ v²), capped; nothing at rest, where it would be without bound.
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

#[cfg(test)]
mod tests {
    use super::*;

    const T: f64 = 1e-3;

    #[test]
    fn the_general_criterion_gives_the_closed_form() {
        for (k, b) in [(1000.0, 0.0), (2000.0, 0.4), (500.0, 1.2)] {
            let numeric = required_damping_of(wall(k, b, T), T);
            assert!((numeric / required_damping(k, b, T) - 1.0).abs() < 1e-5, "K {k}, B {b}: {numeric}");
        }
    }

    /// Net energy that a wall and a damper b take from a sinusoidal motion of 1 mm, J over many whole periods.
    fn energy_taken(stiffness: f64, device_damping: f64) -> f64 {
        let (amplitude, steps) = (1e-3, 1000);
        let omega = std::f64::consts::TAU / (f64::from(steps) * T);
        let position = |k: i32| amplitude * (omega * T * f64::from(k)).sin();
        let mut observer = Observer::default();
        for k in 0..=10 * steps {
            let x = position(k);
            observer.add([Vec2::new(x, 0.0), Vec2::zeros()], [Vec2::new(stiffness * x, 0.0), Vec2::zeros()]);
        }
        // The damper takes b A² ω²/2 a second.
        observer.energy_j() + device_damping * (amplitude * omega).powi(2) / 2.0 * f64::from(10 * steps) * T
    }

    #[test]
    fn passive_below_the_limit_and_active_above() {
        let damping = 0.6;
        let limit = 2.0 * damping / T;
        assert!(energy_taken(0.98 * limit, damping) > 0.0);
        assert!(energy_taken(1.02 * limit, damping) < 0.0);
        let spec = DeviceSpec {
            name: String::new(),
            force_feedback: true,
            max_force_n: 4.0,
            damping_n_s_m: damping,
            coulomb_n: 0.0,
            resolution_m: 0.0,
        };
        assert!((passive_stiffness(&spec, 0.0, T) - limit).abs() < 1e-9);
        let coarse = DeviceSpec { coulomb_n: 0.01, resolution_m: 50e-6, ..spec };
        assert!((passive_stiffness(&coarse, 0.0, T) - 400.0).abs() < 1e-9, "the encoder is the limit now");
        assert_eq!(passive_stiffness(&coarse, 1.0, T), 0.0);
    }

    /// Whether a mass let go in a two-sided sampled wall comes to rest. The mass is integrated exactly between the samples.
    fn settles(stiffness: f64, wall_damping: f64, device_damping: f64, delay_periods: usize) -> bool {
        let mass = 0.1;
        let decay = (-device_damping / mass * T).exp();
        let mut held = vec![0.0; delay_periods + 1];
        let (mut x, mut v, mut before) = (1e-3, 0.0, 1e-3);
        let mut late_peak: f64 = 0.0;
        for tick in 0..60_000 {
            held.rotate_right(1);
            held[0] = -stiffness * x - wall_damping * (x - before) / T;
            before = x;
            let force = held[delay_periods];
            let terminal = force / device_damping;
            x += terminal * T + (v - terminal) * mass / device_damping * (1.0 - decay);
            v = terminal + (v - terminal) * decay;
            if !x.is_finite() || x.abs() > 1.0 {
                return false;
            }
            if tick >= 50_000 {
                late_peak = late_peak.max(x.abs());
            }
        }
        late_peak < 1e-3
    }

    #[test]
    fn the_stability_boundary_is_where_the_formula_says() {
        for (b, wall_damping, delay) in [(0.5, 0.0, 0), (0.5, 0.5, 0), (0.4, 0.0, 1), (0.3, 0.6, 0)] {
            let limit = stable_stiffness(b, wall_damping, T, delay as f64 * T);
            assert!(
                settles(0.97 * limit, wall_damping, b, delay),
                "b {b}, B {wall_damping}, delay {delay}: {limit} too high"
            );
            assert!(
                !settles(1.03 * limit, wall_damping, b, delay),
                "b {b}, B {wall_damping}, delay {delay}: {limit} too low"
            );
        }
    }

    #[test]
    fn stable_and_never_passive() {
        // B > b: no stiffness is passive, yet a soft wall is stable.
        let (b, wall_damping) = (0.3, 0.6);
        assert!(required_damping(1.0, wall_damping, T) > b);
        assert!(settles(300.0, wall_damping, b, 0));
    }

    #[test]
    fn the_controller_only_acts_in_the_red_and_is_capped() {
        let still = Vec2::zeros();
        let along = |x: f64| [Vec2::new(x, 0.0), still];
        let mut observer = Observer::default();
        observer.add([still; 2], along(-1.0));
        observer.add(along(1e-3), [still; 2]);
        assert!((observer.energy_j() + 1e-3).abs() < 1e-15, "1 N helped along 1 mm: 1 mJ was given out");
        let [force, other] = control(&observer, along(0.5), T, 100.0);
        assert!((force.x + 0.5 * 4.0).abs() < 1e-9, "α = 1 mJ / (1 ms · 0.25 m²/s²) = 4 N s/m: {force}");
        assert_eq!(other, still);
        assert!((control(&observer, along(0.5), T, 1.0)[0].x + 0.5).abs() < 1e-12);
        assert_eq!(control(&observer, [still; 2], T, 100.0), [still; 2]);
        assert_eq!(control(&Observer::default(), along(1.0), T, 100.0), [still; 2]);
    }

    #[test]
    fn what_one_finger_gives_and_the_other_takes_is_no_activity() {
        // A rigid block pinched with 2 N and carried 10 mm: the left finger pushes, the right one is pushed.
        let mut observer = Observer::default();
        let pinch = [Vec2::new(2.0, 0.0), Vec2::new(-2.0, 0.0)];
        observer.add([Vec2::new(-0.01, 0.0), Vec2::new(0.01, 0.0)], pinch);
        observer.add([Vec2::new(0.0, 0.0), Vec2::new(0.02, 0.0)], pinch);
        assert!(observer.energy_j().abs() < 1e-15);
    }
}
