//! Forces of a sheet on a needle, and of the rim of a world's hole.

use super::rows::{Phase, Row};
use crate::diagnose::hypotheses::candidate::Candidate;
use crate::diagnose::hypotheses::{hysteresis, stiffness_hardening, viscous_friction};
use haptics::law::object::{MembraneLaw, unloading_n};

/// Relative change of the rim's stiffness in a world's hole, for the first step of its linearisation.
/// Choice: halved or doubled, none of 2 answers changes.
pub const RIM_SHARE: f64 = 0.05;

/// Names of the two forms of hardening.
pub const CUBIC: &str = "k3";
pub const HERTZ: &str = "hertz";

/// Force of a sheet beside its linear spring.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Law {
    /// A power of the depth of the first push.
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

    /// Force against the needle per unit of its parameter, N. `elastic`: force of the first push at a depth; `give`: share
    /// of the deepest indentation that the model keeps as a dent.
    pub fn unit_n(self, r: &Row, elastic: &dyn Fn(f64) -> f64, give: f64) -> f64 {
        match self {
            _ if !touches(r) => 0.0,
            Self::Power(power) => with_dent(give, r, &|x| x.powf(power)),
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
    if row.phase == Phase::Loading {
        return elastic(row.depth_m);
    }
    unloading_n(row.depth_m, row.deepest_m, share, elastic)
}

/// A world's hole in a pierced sheet, without drag.
pub fn rim(law: &MembraneLaw) -> MembraneLaw {
    MembraneLaw { drag_n_s_m: 0.0, puncture_n: 0.0, ..*law }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::data::regression_data::Span;
    use haptics::law::object::MembraneHistory;

    /// A row at a place that was pushed in by 3 mm.
    fn pressed(depth_m: f64, phase: Phase) -> Row {
        Row {
            recording: 0,
            start_s: 0.0,
            time_s: 0.0,
            depth_m,
            rate_m_s: 0.0,
            acceleration_m_s2: 0.0,
            side_m: 0.0,
            force_n: 0.0,
            phase,
            hold: 0,
            push: 0,
            deepest_m: 3e-3,
            stretch: 0,
            span: Span::default(),
        }
    }

    #[test]
    fn a_sheet_that_hardens_is_drawn_back_as_its_law_is() {
        let linear = MembraneLaw {
            stiffness_n_m: 300.0,
            cubic_n_m3: 0.0,
            give: 0.2,
            puncture_n: 9.0,
            friction_n: 0.0,
            drag_n_s_m: 0.0,
        };
        let hard = MembraneLaw { cubic_n_m3: 2e7, ..linear };
        let mut history = MembraneHistory::default();
        for (depth_m, phase) in
            [(1e-3, Phase::Loading), (3e-3, Phase::Loading), (2e-3, Phase::Unloading), (1e-3, Phase::Unloading)]
        {
            let row = pressed(depth_m, phase);
            let regressor = Law::Power(3.0).unit_n(&row, &|x| x, linear.give);
            let expected = hard.force_n(depth_m, 0.0, &mut history);
            assert!((own_n(Some(&linear), &row) + 2e7 * regressor - expected).abs() < 1e-9, "{depth_m} {phase:?}");
        }
    }
}
