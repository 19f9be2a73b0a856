//! Columns that belong together: parts of a vector, and of two fingers.

use super::Planner;
use crate::errors::LogError;

/// Columns that are of no use without each other; a log that has one of a pair must have both.
pub const PAIRS: [(&str, &str); 12] = [
    ("x_m", "y_m"),
    ("fx_N", "fy_N"),
    ("qb_rad", "qt_rad"),
    ("x1_m", "y1_m"),
    ("x2_m", "y2_m"),
    ("fx1_N", "fy1_N"),
    ("fx2_N", "fy2_N"),
    ("qb1_rad", "qt1_rad"),
    ("qb2_rad", "qt2_rad"),
    ("x1_m", "x2_m"),
    ("fx1_N", "fx2_N"),
    ("qb1_rad", "qb2_rad"),
];

impl Planner<'_> {
    /// Vectors must be complete: half a position or half a force is of no use.
    pub(super) fn complete(&self) -> Result<(), LogError> {
        let target = |name: &str| self.plan.targets.iter().find(|t| t.name == name);
        let halves = PAIRS.iter().flat_map(|&(a, b)| [(a, b), (b, a)]);
        let mut halves = halves.filter(|(there, absent)| target(there).is_some() && target(absent).is_none());
        let Some((there, absent)) = halves.clone().next() else { return Ok(()) };
        let mut error = self.missing(absent, format!("`{there}` is there and needs it"));
        if let LogError::MissingColumn { instead, .. } = &mut error {
            let name = |half: &str| match half {
                "x_m" | "y_m" => Some("q_m"),
                "fx_N" | "fy_N" => Some("f_N"),
                _ => None,
            };
            let one =
                |(there, _): (&str, &str)| Some((name(there)?.to_owned(), self.headers[target(there)?.column].clone()));
            **instead = halves.by_ref().filter_map(one).collect();
        }
        Err(error)
    }
}
