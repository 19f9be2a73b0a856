//! Effects of the catalogue in needles, in a size of any kind.

use crate::tasks::sheet::Sheet;

/// Kind of an effect.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// The sheet hardens, N/m³.
    Hardening,
    /// A dent stays, as a share of the depth.
    Dent,
    /// Dry friction of the shaft, N.
    Shaft,
    /// Drag of the shaft, N s/m.
    Drag,
    /// A drift of the force, N/s.
    Drift,
}

impl Kind {
    /// All of them.
    pub const ALL: [Self; 5] = [Self::Hardening, Self::Dent, Self::Shaft, Self::Drag, Self::Drift];

    /// The name, as answers have it.
    pub fn id(self) -> &'static str {
        match self {
            Self::Hardening => "stiffness-hardening",
            Self::Dent => "hysteresis",
            Self::Shaft => "coulomb-friction",
            Self::Drag => "viscous-friction",
            Self::Drift => "force-drift",
        }
    }

    /// A size to begin with.
    pub fn first_size(self, sheet: &Sheet) -> f64 {
        match self {
            Self::Hardening => 0.1 * sheet.stiffness_n_m.powi(3) / sheet.puncture_n[0].powi(2),
            Self::Dent => 0.1,
            Self::Shaft => 0.02,
            Self::Drag => 2.0,
            Self::Drift => 3e-3,
        }
    }

    /// Sizes beyond which it would be another thing.
    pub fn limited(self, size: f64) -> f64 {
        if self == Self::Dent { size.min(0.6) } else { size }
    }

    /// Puts it into the sheet; returns the drift.
    pub fn hide(self, size: f64, sheet: &mut Sheet) -> f64 {
        match self {
            Self::Hardening => sheet.cubic_n_m3 = size,
            Self::Dent => sheet.dent = size,
            Self::Shaft => sheet.dry_n = [size; 2],
            Self::Drag => sheet.drag_n_s_m = size,
            Self::Drift => return size,
        }
        0.0
    }
}
