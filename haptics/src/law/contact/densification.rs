//! End of a foam: its cells are closed at the strain 1 − 1.4 ρ/ρs, and beyond it carries like its solid material
//! (Gibson & Ashby 1997, section 5.3). ρ/ρs = 0.1 is taken, a usual density of soft closed-cell foam: up to 0.86 of its
//! thickness nothing is added. From there to the whole thickness the stiffness rises evenly to [`CLOSED`] times that of
//! the open foam, and stays: then the fingertip behind the foam yields. The force pushes apart and is added to the open
//! foam's.

/// Share of the thickness at which the cells begin to be closed: 1 − 1.4 · 0.1.
pub const ONSET: f64 = 0.86;

/// Stiffness of a fingertip with all cells closed, in multiples of that of the open foam (assumed, not measured). With
/// the usual pad that is 10 kN/m: 8 N, the largest force of a pointer's hand, end 0.2 mm beyond the foam. A hand with a
/// damping of 9 N s/m can lean on about as much at 1 kHz without chatter (Colgate & Schenkel 1997). A harder end would
/// need a virtual coupling for every hand.
pub const CLOSED: f64 = 4.0;

/// Additional force at the end of a foam; the law is in the module's head.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Densification {
    /// Thickness, m.
    thickness_m: f64,
    /// Stiffness of the open foam, N/m.
    open_n_m: f64,
}

impl Densification {
    /// No end: a surface that is no foam.
    pub const NONE: Self = Self { thickness_m: f64::INFINITY, open_n_m: 0.0 };

    /// The end of a foam of a thickness, m, and an open stiffness, N/m.
    pub fn of(thickness_m: f64, open_n_m: f64) -> Self {
        Self { thickness_m, open_n_m }
    }

    /// Force that it adds at a depth, N.
    #[inline]
    pub fn force_n(&self, depth_m: f64) -> f64 {
        if depth_m > ONSET * self.thickness_m { self.beyond_n(depth_m) } else { 0.0 }
    }

    /// Slope of that force, N/m.
    pub fn stiffness_n_m(&self, depth_m: f64) -> f64 {
        if depth_m > ONSET * self.thickness_m {
            self.closed_n_m() * ((depth_m - ONSET * self.thickness_m) / self.span_m()).min(1.0)
        } else {
            0.0
        }
    }

    #[cold]
    fn beyond_n(&self, depth_m: f64) -> f64 {
        let (way_m, span_m) = (depth_m - ONSET * self.thickness_m, self.span_m());
        let share = if way_m < span_m { 0.5 * way_m * way_m / span_m } else { way_m - 0.5 * span_m };
        self.closed_n_m() * share
    }

    /// From the first closed cell to the last, m.
    fn span_m(&self) -> f64 {
        (1.0 - ONSET) * self.thickness_m
    }

    /// Stiffness that is added when all cells are closed, N/m.
    fn closed_n_m(&self) -> f64 {
        (CLOSED - 1.0) * self.open_n_m
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_effect() {
        // 2 mm of 2500 N/m: nothing up to 1.72 mm; 7.5 kN/m more at 2 mm, so half of that over 0.28 mm: 1.05 N. A tenth of a
        // millimetre further: 0.75 N more.
        let end = Densification::of(2e-3, 2500.0);
        assert_eq!((end.force_n(1.72e-3), end.stiffness_n_m(1.7e-3)), (0.0, 0.0));
        assert!((end.force_n(2e-3) - 1.05).abs() < 1e-9 && (end.stiffness_n_m(2e-3) - 7500.0).abs() < 1e-6);
        assert!((end.force_n(2.1e-3) - 1.8).abs() < 1e-9 && (end.stiffness_n_m(2.1e-3) - 7500.0).abs() < 1e-6);
        // Half way its stiffness is half of that and its force a quarter.
        assert!((end.force_n(1.86e-3) - 0.2625).abs() < 1e-9 && (end.stiffness_n_m(1.86e-3) - 3750.0).abs() < 1e-6);
        assert_eq!(Densification::NONE.force_n(1.0), 0.0);
    }
}
