//! Kinematics of the five-bar pantograph: two driven cranks of length l, two couplers of length L that meet in the tip.

use crate::Vec2;
use nalgebra::Matrix2;

/// A planar five-bar with its first base at the origin and its second at (d, 0), m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FiveBar {
    /// Length of the driven links, m.
    pub crank_m: f64,
    /// Length of the couplers, m.
    pub coupler_m: f64,
    /// Distance of the bases, m.
    pub base_m: f64,
}

impl FiveBar {
    /// Haply 2DIY, third version.
    pub const V3: Self = Self { crank_m: 0.07, coupler_m: 0.09, base_m: 0.038 };
    /// Haply 2DIY, second version: both motors on one axis.
    pub const V2: Self = Self { crank_m: 0.07, coupler_m: 0.09, base_m: 0.0 };

    fn elbows(&self, angles_rad: [f64; 2]) -> [Vec2; 2] {
        let [a, b] = angles_rad.map(|angle| Vec2::new(angle.cos(), angle.sin()) * self.crank_m);
        [a, b + Vec2::new(self.base_m, 0.0)]
    }

    /// Tip position in the device's frame, m, away from the bases; `None` when the couplers cannot meet.
    pub fn tip(&self, angles_rad: [f64; 2]) -> Option<Vec2> {
        let [a, b] = self.elbows(angles_rad);
        let between = b - a;
        let half = 0.5 * between.norm();
        if half < 1e-6 || half >= self.coupler_m {
            return None;
        }
        let across = Vec2::new(-between.y, between.x) / (2.0 * half);
        Some(0.5 * (a + b) + across * (self.coupler_m.powi(2) - half.powi(2)).sqrt())
    }

    /// d(x, y)/d(θ1, θ2), m/rad, from the couplers' constant length; `None` at a singularity.
    pub fn jacobian(&self, angles_rad: [f64; 2]) -> Option<Matrix2<f64>> {
        let tip = self.tip(angles_rad)?;
        let [a, b] = self.elbows(angles_rad);
        let (ra, rb) = (tip - a, tip - b);
        let rate = |angle: f64| Vec2::new(-angle.sin(), angle.cos()) * self.crank_m;
        // Rows: r·dp = r·d(elbow).
        let couplers = Matrix2::new(ra.x, ra.y, rb.x, rb.y);
        let driven = Matrix2::new(ra.dot(&rate(angles_rad[0])), 0.0, 0.0, rb.dot(&rate(angles_rad[1])));
        Some(couplers.try_inverse()? * driven)
    }

    /// Motor torques, N m, that put `force_n` on the hand at the tip: Jᵀ f. Zero at a singularity.
    pub fn torques(&self, angles_rad: [f64; 2], force_n: Vec2) -> [f64; 2] {
        let torque = self.jacobian(angles_rad).map_or_else(Vec2::zeros, |j| j.transpose() * force_n);
        [torque.x, torque.y]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn golden_pose_and_torque() {
        // Published example: 120° and 60° put the tip at (0.0190, 0.13262) m, and 1 N along y takes ∓0.04023 N m.
        let angles = [120.0_f64.to_radians(), 60.0_f64.to_radians()];
        let tip = FiveBar::V3.tip(angles).expect("reachable");
        assert!((tip - Vec2::new(0.0190, 0.13262)).norm() < 1e-5, "{tip}");
        let [first, second] = FiveBar::V3.torques(angles, Vec2::new(0.0, 1.0));
        assert!((first + 0.04023).abs() < 1e-5 && (second - 0.04023).abs() < 1e-5, "{first} {second}");
    }

    #[test]
    fn the_jacobian_is_the_derivative() {
        for device in [FiveBar::V3, FiveBar::V2] {
            for (one, two) in [(2.2, 0.9), (1.9, 0.6), (2.4, 1.2)] {
                let jacobian = device.jacobian([one, two]).expect("regular");
                let h = 1e-6;
                let tip = |a: f64, b: f64| device.tip([a, b]).expect("reachable");
                let first = (tip(one + h, two) - tip(one - h, two)) / (2.0 * h);
                let second = (tip(one, two + h) - tip(one, two - h)) / (2.0 * h);
                assert!((jacobian - Matrix2::from_columns(&[first, second])).norm() < 1e-7);
            }
        }
    }

    #[test]
    fn out_of_reach_is_none_and_gives_no_torque() {
        let wide = FiveBar { base_m: 0.05, ..FiveBar::V3 };
        let apart = [std::f64::consts::PI, 0.0];
        assert!(wide.tip(apart).is_none());
        assert_eq!(wide.torques(apart, Vec2::new(1.0, 1.0)), [0.0, 0.0]);
    }
}
