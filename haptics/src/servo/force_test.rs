//! A small force on the fingers to try a device with: up slowly, down quickly, in place of the world's.

use crate::Vec2;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

/// No test pushes harder, N a finger.
pub const MOST_N: f64 = 2.0;
/// Rate at which a test force rises, N/s.
pub const UP_N_S: f64 = 0.75;
/// Rate at which it falls at the end of the test, N/s.
const DOWN_N_S: f64 = 6.0;

/// Effect of a test on the force at a tick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Change {
    /// No test: the world's force counts.
    Off,
    /// This force instead of the world's, N on the operator's fingers; the flag marks the first tick.
    On([Vec2; 2], bool),
    /// The test has just ended: the world's force has to come back softly.
    Ended,
}

/// The ramp of a test.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct ForceTest {
    wanted_n: Option<[Vec2; 2]>,
    now_n: [Vec2; 2],
    active: bool,
}

impl ForceTest {
    /// Asks for a force, N on the operator's fingers, or for the end of the test.
    pub fn ask(&mut self, wanted_n: Option<[Vec2; 2]>) {
        let possible = |f: &[Vec2; 2]| f.iter().all(|v| v.x.is_finite() && v.y.is_finite());
        self.wanted_n = wanted_n.filter(possible).map(|f| f.map(|v| v.cap_magnitude(MOST_N)));
    }

    /// One tick further.
    pub fn advance(&mut self, dt_s: f64) -> Change {
        let first = !self.active && self.wanted_n.is_some();
        self.active |= first;
        if !self.active {
            return Change::Off;
        }
        let target_n = self.wanted_n.unwrap_or_default();
        let rate = if self.wanted_n.is_some() { UP_N_S } else { DOWN_N_S };
        for (now, target) in self.now_n.iter_mut().zip(target_n) {
            *now += (target - *now).cap_magnitude(rate * dt_s);
        }
        if self.wanted_n.is_none() && self.now_n == [Vec2::zeros(); 2] {
            self.active = false;
            return Change::Ended;
        }
        Change::On(self.now_n, first)
    }
}

/// Force that the window asks for, read by the servo at every tick. Torn reads are harmless: the ramp smooths them.
#[derive(Debug, Default)]
pub(super) struct Request {
    on: AtomicBool,
    newtons: [AtomicU64; 4],
}

impl Request {
    /// The window: a force, or the end.
    pub fn set(&self, wanted_n: Option<[Vec2; 2]>) {
        let [one, two] = wanted_n.unwrap_or_default();
        for (slot, value) in self.newtons.iter().zip([one.x, one.y, two.x, two.y]) {
            slot.store(value.to_bits(), Ordering::Relaxed);
        }
        self.on.store(wanted_n.is_some(), Ordering::Release);
    }

    /// The servo's side: the force that the window asks for.
    pub fn get(&self) -> Option<[Vec2; 2]> {
        if !self.on.load(Ordering::Acquire) {
            return None;
        }
        let at = |i: usize| f64::from_bits(self.newtons[i].load(Ordering::Relaxed));
        Some([Vec2::new(at(0), at(1)), Vec2::new(at(2), at(3))])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const DT: f64 = 1e-3;

    #[test]
    fn comes_up_softly_stays_capped_and_goes_quickly() {
        let request = Request::default();
        let mut test = ForceTest::default();
        assert_eq!(test.advance(DT), Change::Off);
        request.set(Some([Vec2::new(0.0, 9.0), Vec2::zeros()]));
        test.ask(request.get());
        let Change::On([first, _], true) = test.advance(DT) else { panic!("the test begins") };
        let mut last = first.norm();
        assert!(last < UP_N_S * DT + 1e-12);
        for _ in 0..4_000 {
            let Change::On([force, _], false) = test.advance(DT) else { panic!("the test goes on") };
            assert!(force.norm() - last < UP_N_S * DT + 1e-12);
            last = force.norm();
        }
        assert!((last - MOST_N).abs() < 1e-9, "{last}");
        request.set(None);
        test.ask(request.get());
        let end = (0..1_000).position(|_| test.advance(DT) == Change::Ended).expect("it ends");
        assert!(end < 400, "after {end} ms");
        assert_eq!(test.advance(DT), Change::Off);
    }

    #[test]
    fn what_is_not_a_number_is_no_test() {
        let mut test = ForceTest::default();
        test.ask(Some([Vec2::new(f64::NAN, 0.0); 2]));
        assert_eq!(test.advance(DT), Change::Off);
    }
}
