//! Rigid or not: a test for a path that yields to force across it, by more than the hand itself.

use crate::regression::linear::least_squares;
use foundation::estimate::Yielding;

/// Both ends of a 95 % interval.
const SIDES: f64 = 1.96;
/// A give counts as seen from this many standard errors on.
const SEEN: f64 = 3.0;

/// Give of hand and pads in series with the constraint.
#[derive(Clone, Copy, Debug)]
pub struct Manipulator {
    /// Stiffness against which a constraint counts as rigid, N/m.
    pub stiffness_n_m: f64,
    /// Give between the measured positions and the object, m/N, that is to be taken off; and its standard error.
    pub give_m_n: (f64, f64),
}

/// From the deviation from the path, m, and the force in the same direction, N: rigid, yielding (`false`) or open (`None`).
pub fn yielding(deviation_m: &[f64], force_n: &[f64], hand: &Manipulator) -> (Option<bool>, Option<Yielding>) {
    let columns = [force_n.to_vec(), vec![1.0; force_n.len()]];
    match least_squares(&columns, deviation_m, None) {
        Ok(fit) if fit.identified[0] => judge(fit.values[0], fit.std_errors[0], hand),
        _ => (None, None),
    }
}

/// The same from a give that was fitted elsewhere, m/N, with its standard error.
pub fn judge(give_m_n: f64, error: f64, hand: &Manipulator) -> (Option<bool>, Option<Yielding>) {
    let give = give_m_n - hand.give_m_n.0;
    let error = error.hypot(hand.give_m_n.1);
    if !give.is_finite() || !error.is_finite() {
        return (None, None);
    }
    let (low, high) = (give - SIDES * error, give + SIDES * error);
    let limit = 1.0 / hand.stiffness_n_m;
    let seen = give > SEEN * error;
    // A give that is known worse than the hand's own says nothing, whatever its value.
    let rigid = if high < limit && SIDES * error < limit {
        Some(true)
    } else if seen && low > limit {
        Some(false)
    } else {
        None
    };
    let found = (high > 0.0).then(|| Yielding {
        stiffness_n_m: seen.then(|| 1.0 / give),
        interval_n_m: (1.0 / high, (low > 0.0).then(|| 1.0 / low)),
        manipulator_n_m: hand.stiffness_n_m,
    });
    (rigid, found)
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt as _, SeedableRng as _, rngs::StdRng};
    use rand_distr::StandardNormal;

    const HAND: Manipulator = Manipulator { stiffness_n_m: 2000.0, give_m_n: (0.0, 0.0) };

    /// A path that yields with `stiffness` under a wandering force of `newtons`, seen with `noise_m`.
    fn look(stiffness: f64, newtons: f64, noise_m: f64, seed: u64) -> (Option<bool>, Option<Yielding>) {
        let mut rng = StdRng::seed_from_u64(seed);
        let force: Vec<f64> = (0..400).map(|i| newtons * (f64::from(i) * 0.05).sin()).collect();
        let deviation: Vec<f64> =
            force.iter().map(|f| f / stiffness + noise_m * rng.sample::<f64, _>(StandardNormal)).collect();
        yielding(&deviation, &force, &HAND)
    }

    #[test]
    fn soft_is_soft_hard_is_hard_and_a_weak_push_shows_neither() {
        for seed in 0..50 {
            let (rigid, found) = look(300.0, 2.0, 2e-4, seed);
            let found = found.expect("an interval");
            assert_eq!(rigid, Some(false));
            let value = found.stiffness_n_m.expect("it gives way");
            assert!((value - 300.0).abs() < 30.0, "{value}");
            assert!(found.interval_n_m.0 < value && found.interval_n_m.1.is_some_and(|h| h > value));
            assert_eq!(look(1e6, 2.0, 2e-4, seed).0, Some(true));
            assert_eq!(look(1e6, 0.02, 1e-3, seed).0, None);
            assert_ne!(look(300.0, 0.02, 1e-3, seed).0, Some(true));
        }
        // A constant force shows nothing.
        let (rigid, found) = yielding(&[1e-4; 100], &[5.0; 100], &HAND);
        assert!(rigid.is_none() && found.is_none());
    }

    #[test]
    fn the_hand_s_own_give_is_taken_off() {
        let hand = Manipulator { stiffness_n_m: 2000.0, give_m_n: (5e-4, 2e-5) };
        assert_eq!(judge(5.1e-4, 1e-5, &hand).0, Some(true));
        let (rigid, found) = judge(2.5e-3, 1e-5, &hand);
        assert_eq!(rigid, Some(false));
        assert!((found.and_then(|f| f.stiffness_n_m).expect("seen") - 500.0).abs() < 1.0);
        assert_eq!(judge(1.0e-3, 3e-4, &hand).0, None);
    }
}
