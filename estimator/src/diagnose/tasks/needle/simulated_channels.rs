use super::rows::Needle;
use crate::diagnose::contract::parameter;
use crate::diagnose::extension::hypothetical_worlds::{Act, Simulated};
use crate::diagnose::hypotheses::candidate::Candidate;
use crate::diagnose::hypotheses::sensor_fault::SensorFault;
use crate::diagnose::hypotheses::{coulomb_friction, hysteresis, stiffness_hardening, viscous_friction};
use haptics::Vec2;

/// Estimated model of a sheet or a hole: a world's with a factor, or the plain one.
pub struct InWorld {
    /// Name of its act.
    name: &'static str,
    /// Indices of the regressors in the base, and the names of their values.
    columns: Vec<(usize, &'static str)>,
    two_fingered: bool,
}

impl InWorld {
    /// `has_law`: the model is the sheet of a world.
    pub fn of_sheet(needle: &Needle, has_law: bool) -> Self {
        let columns = vec![(needle.holds, if has_law { "factor" } else { "k" })];
        Self { name: "sheet", columns, two_fingered: needle.two_fingered }
    }

    /// The same of a hole.
    pub fn of_hole(needle: &Needle, has_law: bool) -> Self {
        let first = needle.holds + usize::from(needle.two_fingered) + 1;
        let columns = if has_law { vec![(first, "factor"), (first + 1, "c")] } else { Vec::new() };
        Self { name: "hole", columns, two_fingered: needle.two_fingered }
    }
}

impl Simulated for InWorld {
    fn base(&self, values: &[f64]) -> Vec<Act> {
        let value =
            |(k, name): &(usize, &'static str)| parameter(name, values.get(*k).copied().unwrap_or(0.0), 0.0, "");
        vec![(self.name.to_owned(), self.columns.iter().map(value).collect())]
    }

    /// A world has no drag on a pressed sheet, and no change of friction in a hole.
    fn act(&self, candidate: &Candidate, values: &[f64]) -> Option<Act> {
        let named = |name: &str| candidate.linear.first().is_some_and(|(n, _)| *n == name);
        let known = match (self.name, candidate.id) {
            ("sheet", stiffness_hardening::ID) => named("k3"),
            ("sheet", hysteresis::ID) | ("hole", coulomb_friction::ID | viscous_friction::ID | hysteresis::ID) => true,
            _ => false,
        };
        known.then(|| (format!("{}: {}", self.name, candidate.id), candidate.parameters(values)))
    }

    /// Forces along the needle are downward pushes, of both fingers together.
    fn fault(&self, fault: SensorFault) -> SensorFault {
        let share = if self.two_fingered { 0.5 } else { 1.0 };
        let down = |along: f64| {
            [Vec2::new(0.0, -share * along), Vec2::new(0.0, if self.two_fingered { -share * along } else { 0.0 })]
        };
        SensorFault {
            offset_n: down(fault.offset_along),
            drift_n_s: down(fault.drift_along_per_s),
            offset_along: 0.0,
            drift_along_per_s: 0.0,
            ..fault
        }
    }
}
