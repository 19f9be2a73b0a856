//! A captured force–displacement curve with hysteresis: the force of a toggle switch on the way there and on the way
//! back (recorded and played back this way for a real switch: Mac Lean 1996).
//!
//! The curve is a table of places with the force needed when moving forwards and when moving backwards; forward is nowhere
//! below backward, so that a cycle never generates energy. After a reversal the force goes over from one branch to the
//! other within `reversal_m` of travel. Between two places it is linear, beyond the ends a stop.

use serde::{Deserialize, Serialize};

/// One place of the curve.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct CurvePoint {
    /// Displacement, m.
    pub at_m: f64,
    /// Force needed to move on forwards (towards larger displacements), N.
    pub forward_n: f64,
    /// Force that holds it on the way back, N, at most the forward one.
    pub backward_n: f64,
}

/// The captured curve.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ToggleCurve {
    /// At least two places, in rising order.
    pub points: Vec<CurvePoint>,
    /// Travel over which a reversal changes the branch, m, positive.
    pub reversal_m: f64,
    /// Stiffness of the stops beyond both ends, N/m, positive.
    pub stop_n_m: f64,
}

impl ToggleCurve {
    /// Force that holds against a displacement, N. `branch` is 1 on the forward branch and 0 on the backward one.
    pub fn force_n(&self, at_m: f64, branch: f64) -> f64 {
        let (low, high, share) = self.place(at_m);
        let blend = |p: &CurvePoint| p.backward_n + (p.forward_n - p.backward_n) * branch.clamp(0.0, 1.0);
        let force = blend(low) + (blend(high) - blend(low)) * share;
        force + self.stop_n_m * ((at_m - high.at_m).max(0.0) + (at_m - low.at_m).min(0.0))
    }

    /// True if a displacement is beyond the ends of the curve, in a stop.
    pub fn is_stopped(&self, at_m: f64) -> bool {
        let (low, high, _) = self.place(at_m);
        at_m < low.at_m || at_m > high.at_m
    }

    /// Energy that the curve half way between its branches holds at a displacement, J, from its first place on: the
    /// recoverable part of the work on the way there.
    pub fn held_j(&self, at_m: f64) -> f64 {
        let middle = |p: &CurvePoint| 0.5 * (p.forward_n + p.backward_n);
        let (Some(first), Some(last)) = (self.points.first(), self.points.last()) else { return 0.0 };
        let inside_m = at_m.clamp(first.at_m, last.at_m);
        let mut held_j = 0.0;
        for pair in self.points.windows(2) {
            let way_m = inside_m.min(pair[1].at_m) - pair[0].at_m;
            if way_m <= 0.0 {
                break;
            }
            let slope = (middle(&pair[1]) - middle(&pair[0])) / (pair[1].at_m - pair[0].at_m);
            held_j += (middle(&pair[0]) + 0.5 * slope * way_m) * way_m;
        }
        let beyond_m = at_m - inside_m;
        let end_n = middle(if beyond_m < 0.0 { first } else { last });
        held_j + end_n * beyond_m + 0.5 * self.stop_n_m * beyond_m * beyond_m
    }

    /// Slope of the force over the displacement for a motion at `rate_m_s`, N/m; negative where the switch snaps. It is
    /// the slope of the curve, of an unfinished reversal, and of the stops.
    pub fn stiffness_n_m(&self, at_m: f64, branch: f64, rate_m_s: f64) -> f64 {
        if self.is_stopped(at_m) {
            return self.stop_n_m;
        }
        let (low, high, share) = self.place(at_m);
        let span = (high.at_m - low.at_m).max(1e-9);
        let slope = (self.force_n(high.at_m, branch) - self.force_n(low.at_m, branch)) / span;
        let gap = |p: &CurvePoint| p.forward_n - p.backward_n;
        let turning = (gap(low) + (gap(high) - gap(low)) * share) / self.reversal_m;
        // At the end of a branch nothing turns in the direction of travel.
        let turns = if rate_m_s > 0.0 { branch < 1.0 } else { branch > 0.0 };
        if turns { slope + turning } else { slope }
    }

    /// The branch after `way_m` of further travel.
    pub fn advance(&self, branch: f64, way_m: f64) -> f64 {
        (branch + way_m / self.reversal_m).clamp(0.0, 1.0)
    }

    /// Fault that makes the curve impossible to run, if there is one.
    pub fn fault(&self) -> Option<&'static str> {
        let finite = |p: &CurvePoint| p.at_m.is_finite() && p.forward_n.is_finite() && p.backward_n.is_finite();
        if self.points.len() < 2 || !self.points.iter().all(finite) {
            return Some("a curve of at least two finite places");
        }
        if self.points.windows(2).any(|w| w[1].at_m <= w[0].at_m) {
            return Some("a curve whose places rise");
        }
        if self.points.iter().any(|p| p.forward_n < p.backward_n) {
            return Some("a curve whose forward force is nowhere below the backward one (it would give out energy)");
        }
        let positive = |x: f64| x.is_finite() && x > 0.0;
        (!positive(self.reversal_m) || !positive(self.stop_n_m)).then_some("positive reversal_m and stop_n_m")
    }

    /// The two places around a displacement and the share of the way between them; the end pair's nearer place beyond the ends.
    fn place(&self, at_m: f64) -> (&CurvePoint, &CurvePoint, f64) {
        static NOWHERE: CurvePoint = CurvePoint { at_m: 0.0, forward_n: 0.0, backward_n: 0.0 };
        let (Some(first), Some(last)) = (self.points.first(), self.points.last()) else {
            return (&NOWHERE, &NOWHERE, 0.0);
        };
        if at_m <= first.at_m {
            return (first, first, 0.0);
        }
        if at_m >= last.at_m {
            return (last, last, 0.0);
        }
        let above = self.points.partition_point(|p| p.at_m <= at_m).min(self.points.len() - 1);
        let (low, high) = (&self.points[above - 1], &self.points[above]);
        (low, high, (at_m - low.at_m) / (high.at_m - low.at_m))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn curve() -> ToggleCurve {
        let point = |at_m, forward_n, backward_n| CurvePoint { at_m, forward_n, backward_n };
        ToggleCurve {
            points: vec![
                point(-4e-3, 0.0, -0.2),
                point(-1e-3, 1.0, 0.6),
                point(1e-3, -0.6, -1.0),
                point(4e-3, 0.2, 0.0),
            ],
            reversal_m: 0.2e-3,
            stop_n_m: 4000.0,
        }
    }

    #[test]
    fn what_the_curve_holds_is_the_integral_of_its_middle() {
        let curve = curve();
        let (mut sum_j, step_m) = (curve.held_j(-6e-3), 1e-6);
        for k in 0..12_000 {
            let at_m = -6e-3 + f64::from(k) * step_m;
            sum_j += curve.force_n(at_m + 0.5 * step_m, 0.5) * step_m;
            if k % 500 == 0 {
                assert!((sum_j - curve.held_j(at_m + step_m)).abs() < 1e-9, "{at_m}");
            }
        }
    }

    #[test]
    fn one_effect() {
        let curve = curve();
        // Half way from (−4 mm, 0 N) to (−1 mm, 1 N); on the other branch from −0.2 to 0.6.
        assert!((curve.force_n(-2.5e-3, 1.0) - 0.5).abs() < 1e-12);
        assert!((curve.force_n(-2.5e-3, 0.0) - 0.2).abs() < 1e-12);
        // 1 mm into the stop: 4 N on top of 0.2 N.
        assert!((curve.force_n(5e-3, 1.0) - 4.2).abs() < 1e-9 && (curve.force_n(-5e-3, 0.0) + 4.2).abs() < 1e-9);
        // Half of 0.2 mm back is half way to the other branch.
        assert!((curve.advance(1.0, -0.1e-3) - 0.5).abs() < 1e-12 && curve.advance(0.2, 1.0) == 1.0);
        assert_eq!(curve.fault(), None);
    }

    #[test]
    fn a_cycle_loses_what_lies_between_the_branches() {
        let curve = curve();
        let (mut branch, mut at, mut work) = (0.0, -3e-3, 0.0);
        for (end, steps) in [(3e-3, 6000), (-3e-3, 6000)] {
            let step = (end - at) / f64::from(steps);
            for _ in 0..steps {
                at += step;
                branch = curve.advance(branch, step);
                work += curve.force_n(at, branch) * step;
            }
        }
        // Between the branches: mean gap 0.3667, 0.4, 0.3667 N over 2, 2, 2 mm, less half of the two reversals.
        let between = 0.5 * (0.2 + 0.2 / 3.0 + 0.4) * 2e-3;
        let expected = 2.0 * between + 0.4 * 2e-3;
        assert!((work - expected).abs() < 0.08 * expected && work > 0.0, "{work} against {expected}");
    }

    #[test]
    fn curves_that_would_give_energy_are_refused() {
        let mut curve = curve();
        curve.points[1].backward_n = 1.1;
        assert!(curve.fault().is_some_and(|f| f.contains("energy")));
        curve.points.truncate(1);
        assert!(curve.fault().is_some());
        assert!(curve.force_n(1.0, 1.0).is_finite());
    }
}
