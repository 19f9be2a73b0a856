//! A cushion: a spring, hardening or not, that has an end: [`StiffnessHardening`] and [`Densification`] together.

use super::densification::Densification;
use super::stiffness_hardening::StiffnessHardening;

/// Normal elastic law of a surface; forces push apart.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cushion {
    /// While it is open.
    pub spring: StiffnessHardening,
    /// Its end.
    pub end: Densification,
}

impl Cushion {
    /// A linear spring of a stiffness, N/m, without an end.
    pub fn linear(stiffness_n_m: f64) -> Self {
        let spring = StiffnessHardening { k1: stiffness_n_m, ..StiffnessHardening::default() };
        Self { spring, end: Densification::NONE }
    }

    /// Elastic force at a depth, N.
    #[inline]
    pub fn force_n(&self, depth_m: f64) -> f64 {
        self.spring.force_n(depth_m) + self.end.force_n(depth_m)
    }

    /// Slope of the force at a depth, N/m.
    pub fn stiffness_n_m(&self, depth_m: f64) -> f64 {
        self.spring.stiffness_n_m(depth_m) + self.end.stiffness_n_m(depth_m)
    }

    /// Depth at which it presses with a force, N.
    ///
    /// Newton's steps from where the linear part alone would press that hard; a step that leaves the bracket is replaced by
    /// halving it (Press et al., `rtsafe`). The law only stiffens with depth, so that the steps do not overshoot as a rule.
    pub fn depth_m(&self, force_n: f64) -> f64 {
        const ENOUGH: usize = 50;
        let mut high_m = force_n.max(0.0) / self.spring.k1;
        let (mut low_m, mut depth_m) = (0.0, high_m);
        for _ in 0..ENOUGH {
            let excess_n = self.force_n(depth_m) - force_n;
            if excess_n < 0.0 {
                low_m = depth_m;
            } else {
                high_m = depth_m;
            }
            let newton_m = depth_m - excess_n / self.stiffness_n_m(depth_m);
            let next_m = if newton_m >= low_m && newton_m <= high_m { newton_m } else { 0.5 * (low_m + high_m) };
            let moved_m = (next_m - depth_m).abs();
            depth_m = next_m;
            if moved_m <= 1e-15 * depth_m {
                break;
            }
        }
        depth_m
    }

    /// Slope at a force, N/m: the steepest that a device feels which renders no more than that.
    pub fn stiffness_at_n_m(&self, force_n: f64) -> f64 {
        self.stiffness_n_m(self.depth_m(force_n))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn knows_how_deep_a_force_presses_it() {
        let spring = StiffnessHardening { k1: 2500.0, k3: 1e8, hertz: 0.0 };
        let cushion = Cushion { spring, end: Densification::of(2e-3, 2500.0) };
        for force in [0.0, 1.0, 4.0, 9.0, 40.0] {
            assert!((cushion.force_n(cushion.depth_m(force)) - force).abs() < 1e-9, "{force} N");
        }
        // 1 N: 0.4 mm, nothing of the end; 40 N: all cells closed, 2.5 + 7.5 kN/m.
        let linear = Cushion { spring: StiffnessHardening { k3: 0.0, ..spring }, ..cushion };
        assert!((linear.depth_m(1.0) - 4e-4).abs() < 1e-12);
        assert!((linear.stiffness_at_n_m(1.0) - 2500.0).abs() < 1e-9);
        assert!((linear.stiffness_at_n_m(40.0) - 10_000.0).abs() < 1e-6);
        assert!((Cushion::linear(800.0).force_n(0.1) - 80.0).abs() < 1e-9);
    }
}
