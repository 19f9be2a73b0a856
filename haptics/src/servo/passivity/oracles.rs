//! Walls that are sampled, held, delayed and measured in steps, and operators who try to draw energy out of them.
//!
//! An operator who moves evenly from sample to sample loses least in the device's damper (b Δx²/T a period) and its friction
//! (`f_c` |Δx|). Each limit is met by the motion that the theory says is the worst: passive at 0.98 of it, active at 1.02.

use super::*;
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};
use std::f64::consts::{PI, TAU};

const T: f64 = 1e-3;

/// A virtual wall on both sides of zero.
#[derive(Clone, Copy, Debug)]
pub(super) struct Wall {
    pub stiffness: f64,
    /// On the backward difference of the measured positions.
    pub damping: f64,
    /// Whole periods between a sample and its force.
    pub delay: i32,
}

/// A device of damping b, N s/m, Coulomb friction, N, and steps, m.
pub(super) fn device(damping_n_s_m: f64, coulomb_n: f64, resolution_m: f64) -> DeviceSpec {
    DeviceSpec { name: String::new(), force_feedback: true, max_force_n: 4.0, damping_n_s_m, coulomb_n, resolution_m }
}

/// Energy that device and wall together take from an operator who repeats a closed path of `period` samples, J each time round.
fn taken(wall: &Wall, device: &DeviceSpec, period: i32, path: impl Fn(i32) -> f64) -> f64 {
    let measured = |k: i32| {
        let x = path(k.rem_euclid(period));
        if device.resolution_m > 0.0 { (x / device.resolution_m).round() * device.resolution_m } else { x }
    };
    let force = |k: i32| {
        let (now, before) = (measured(k - wall.delay), measured(k - wall.delay - 1));
        wall.stiffness * now + wall.damping * (now - before) / T
    };
    let along = |x: f64| [Vec2::new(x, 0.0), Vec2::zeros()];
    let mut observer = Observer::default();
    let mut lost_j = 0.0;
    for k in 0..=period {
        observer.add(along(path(k % period)), along(force(k)), 0.0);
        if k > 0 {
            let step = path(k % period) - path(k - 1);
            lost_j += device.damping_n_s_m * step * step / T + device.coulomb_n * step.abs();
        }
    }
    observer.energy_j() + lost_j
}

/// The same for a sinusoid of 1 mm that advances by an angle, rad, from sample to sample (a whole part of a turn).
pub(super) fn shaken(wall: &Wall, device: &DeviceSpec, angle: f64) -> f64 {
    let period = (TAU / angle).round() as i32;
    // A quarter turn ahead: at π the samples are the peaks.
    taken(wall, device, period, |k| 1e-3 * (angle * f64::from(k)).cos())
}

/// Angles from one sample to the next, from a hundredth of a hertz (at 1 kHz) to the fastest that there is.
fn angles() -> impl Iterator<Item = f64> {
    [2, 3, 4, 5, 7, 10, 20, 50, 100, 1_000, 10_000, 100_000].into_iter().map(|samples| TAU / f64::from(samples))
}

#[test]
fn a_wall_is_passive_below_its_stiffness_and_active_above_with_either_sign_of_damping() {
    // B > 0 is worst at the fastest motion, B < 0 and delay at the slowest; a mere spring generates the same at all.
    for (b, damping, delay, worst) in [
        (0.6, 0.0, 0, PI),
        (0.6, 0.0, 0, TAU / 100.0),
        (0.6, 0.3, 0, PI),
        (0.6, -0.3, 0, TAU / 1_000.0),
        (0.2, -0.1, 0, TAU / 1_000.0),
        (0.6, 0.0, 10, TAU / 10_000.0),
        (0.6, -0.3, 10, TAU / 10_000.0),
    ] {
        let device = device(b, 0.0, 0.0);
        let limit = passive_stiffness(&device, damping, T, f64::from(delay) * T);
        assert!((limit - (b - f64::abs(damping)) / (T * (0.5 + f64::from(delay)))).abs() < 1e-9);
        let wall = |share: f64| Wall { stiffness: share * limit, damping, delay };
        for angle in angles() {
            let energy = shaken(&wall(0.98), &device, angle);
            assert!(energy > 0.0, "b {b}, B {damping}, delay {delay}: {energy} J given out at {angle} rad");
        }
        let energy = shaken(&wall(1.02), &device, worst);
        assert!(energy < 0.0, "b {b}, B {damping}, delay {delay}: {energy} J");
    }
}

#[test]
fn a_damper_alone_is_passive_up_to_b_and_active_beyond() {
    let device = device(0.5, 0.0, 0.0);
    let limit = passive_damping(&device, T);
    for (sign, worst) in [(1.0, PI), (-1.0, TAU / 1_000.0)] {
        let wall = |share: f64| Wall { stiffness: 0.0, damping: sign * share * limit, delay: 0 };
        assert!(angles().all(|angle| shaken(&wall(0.98), &device, angle) > 0.0), "sign {sign}");
        assert!(shaken(&wall(1.02), &device, worst) < 0.0, "sign {sign}");
    }
}

/// Back and forth across the edge between two steps, so closely that the device's damper takes next to nothing.
fn across_an_edge(wall: &Wall, device: &DeviceSpec) -> f64 {
    let edge = 2.5 * device.resolution_m;
    let way = 1e-5 * device.resolution_m;
    taken(wall, device, 2, |k| if k == 0 { edge - way } else { edge + way })
}

#[test]
fn steps_of_position_limit_a_wall_as_abbott_and_okamura_say() {
    for (b, coulomb_n, resolution_m, damping) in
        [(2.0, 0.01, 50e-6, 0.0), (2.0, 0.05, 0.1e-3, 0.0), (2.0, 0.05, 0.1e-3, 0.2), (5.0, 0.02, 10e-6, 1.0)]
    {
        let device = device(b, coulomb_n, resolution_m);
        let limit = passive_stiffness(&device, damping, T, 0.0);
        let steps = 2.0 * coulomb_n / resolution_m;
        assert!((limit - (steps - 2.0 * damping / T)).abs() < 1e-9 && limit < 2.0 * (b - damping) / T);
        let wall = |share: f64| Wall { stiffness: share * limit, damping, delay: 0 };
        let (below, above) = (across_an_edge(&wall(0.98), &device), across_an_edge(&wall(1.02), &device));
        assert!(below > 0.0 && above < 0.0, "B {damping}: {below} J below the limit, {above} J above it");
        // Without steps the same wall is far from active.
        let smooth = DeviceSpec { resolution_m: 0.0, ..device };
        assert!(shaken(&wall(1.02), &smooth, PI) > 0.0);
    }
}

#[test]
fn a_damper_on_steps_is_passive_up_to_its_limit() {
    let device = device(2.0, 0.05, 0.1e-3);
    let limit = passive_damping(&device, T);
    assert!((limit - 0.5).abs() < 1e-12, "f_c T/Δ, and not b");
    let wall = |share: f64| Wall { stiffness: 0.0, damping: share * limit, delay: 0 };
    assert!(across_an_edge(&wall(0.98), &device) > 0.0 && across_an_edge(&wall(1.02), &device) < 0.0);
}

#[test]
fn no_wandering_draws_energy_out_of_a_wall_below_its_limit() {
    let mut rng = StdRng::seed_from_u64(11);
    for (b, coulomb_n, resolution_m, damping, delay) in [
        (0.6, 0.0, 0.0, 0.2, 0),
        (0.6, 0.0, 0.0, -0.2, 3),
        (1.0, 0.05, 0.1e-3, 0.0, 0),
        (0.3, 0.05, 0.1e-3, 0.1, 0),
        (0.3, 0.05, 0.1e-3, -0.1, 0),
        (0.5, 0.03, 50e-6, 0.2, 5),
    ] {
        let device = device(b, coulomb_n, resolution_m);
        let stiffness = 0.98 * passive_stiffness(&device, damping, T, f64::from(delay) * T);
        assert!(stiffness > 10.0, "there is a wall: {stiffness} N/m");
        let wall = Wall { stiffness, damping, delay };
        for _ in 0..3_000 {
            // From a hundredth of a step to many steps, from two places to fifty.
            let reach = 1e-4 * 10.0_f64.powf(rng.random_range(-2.0..1.5));
            let middle = rng.random_range(-3e-4..3e-4);
            let count = rng.random_range(2..50_i32);
            let places: Vec<f64> = (0..count).map(|_| middle + reach * rng.random_range(-1.0..1.0)).collect();
            let energy = taken(&wall, &device, count, |k| places[k as usize]);
            assert!(energy > -1e-15, "{wall:?} on b {b}: {energy} J along {places:?}");
        }
    }
}

#[test]
fn the_general_criterion_agrees_with_delay_and_damping() {
    for (stiffness, damping, delay) in [(400.0, 0.0, 2), (400.0, -0.3, 2), (300.0, -0.1, 7), (300.0, 0.2, 3)] {
        let delayed = |z: Complex<f64>| wall(stiffness, damping, T)(z) * z.powi(-delay);
        let numeric = required_damping_of(delayed, T);
        let formula = stiffness * T * (0.5 + f64::from(delay)) + f64::abs(damping);
        assert!(numeric <= formula * (1.0 + 1e-9), "the formula is safe: {numeric} against {formula}");
        // Spring and positive damper are worst at opposite ends of the frequencies: together they need a little less.
        assert!(damping > 0.0 || numeric > 0.999 * formula, "and no more than safe: {numeric} against {formula}");
    }
}
