//! Forces of a sheet on a needle, and of the rim of a world's hole.

use super::rows::{Phase, Row};
use crate::diagnose::hypotheses::candidate::Candidate;
use crate::diagnose::hypotheses::{hysteresis, stiffness_hardening, viscous_friction};
use haptics::law::object::MembraneLaw;

/// Relative change of the rim's stiffness in a world's hole, for the first step of its linearisation.
/// Choice: halved or doubled, none of 2 answers changes.
pub const RIM_SHARE: f64 = 0.05;

/// Names of the two forms of hardening.
pub const CUBIC: &str = "k3";
pub const HERTZ: &str = "hertz";

/// Force of a sheet beside its linear spring.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Law {
    /// A power of the depth.
    Power(f64),
    /// In proportion to the rate.
    Drag,
    /// A share of the deepest indentation that stays as a dent.
    Dent(f64),
}

impl Law {
    /// The law of a candidate, if it is one.
    pub fn of(candidate: &Candidate) -> Option<Self> {
        match (candidate.id, candidate.linear[0].0) {
            (stiffness_hardening::ID, CUBIC) => Some(Self::Power(3.0)),
            (stiffness_hardening::ID, HERTZ) => Some(Self::Power(1.5)),
            (viscous_friction::ID, _) => Some(Self::Drag),
            (hysteresis::ID, _) => candidate.searched.first().map(|s| Self::Dent(s.value)),
            _ => None,
        }
    }

    /// Force against the needle per unit of its parameter, N. `elastic`: force of the first push at a depth.
    pub fn unit_n(self, r: &Row, elastic: &dyn Fn(f64) -> f64) -> f64 {
        match self {
            _ if !touches(r) => 0.0,
            Self::Power(power) => r.depth_m.powf(power),
            Self::Drag => r.rate_m_s,
            Self::Dent(share) => with_dent(share, r, elastic) - elastic(r.depth_m),
        }
    }
}

/// Force of the model's own sheet at a row for a coefficient of one, N: of the world's sheet, or of a spring of 1 N/m.
pub fn own_n(law: Option<&MembraneLaw>, r: &Row) -> f64 {
    match law {
        _ if !touches(r) => 0.0,
        Some(law) => with_dent(law.give, r, &|x| law.loading_n(x)),
        None => r.depth_m,
    }
}

/// Force of the first push at a depth, to which dents are relative, N.
pub fn first_push_n(stiffness_n_m: f64, law: Option<&MembraneLaw>, depth_m: f64) -> f64 {
    law.map_or(stiffness_n_m * depth_m, |l| l.loading_n(depth_m))
}

/// True if a needle presses the sheet.
pub fn touches(r: &Row) -> bool {
    matches!(r.phase, Phase::Loading | Phase::Unloading) && r.depth_m > 0.0
}

/// Force of a sheet that keeps a share of its deepest indentation as a dent: above that depth it is steeper and lower.
pub fn with_dent(share: f64, row: &Row, elastic: &dyn Fn(f64) -> f64) -> f64 {
    let (x, deepest) = (row.depth_m, row.deepest_m);
    if row.phase == Phase::Loading || x >= deepest {
        return elastic(x);
    }
    let dent = share * deepest;
    elastic(deepest) * ((x - dent) / (deepest - dent).max(1e-9)).max(0.0)
}

/// A world's hole in a pierced sheet, without drag.
pub fn rim(law: &MembraneLaw) -> MembraneLaw {
    MembraneLaw { drag_n_s_m: 0.0, puncture_n: 0.0, ..*law }
}
