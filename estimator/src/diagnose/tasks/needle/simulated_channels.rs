use super::hole::Shaft;
use crate::diagnose::contract::parameter;
use crate::diagnose::extension::hypothetical_worlds::{Act, Hypothesis, Simulated, of_channels};
use crate::diagnose::hypotheses::candidate::Candidate;
use crate::diagnose::hypotheses::sensor_fault::SensorFault;
use crate::diagnose::hypotheses::{coulomb_friction, hysteresis, stiffness_hardening, viscous_friction};
use crate::diagnose::selection::comparison::Compared;
use haptics::Vec2;

/// Estimated model of a sheet or a hole: a world's with a factor, or the plain one.
pub(crate) struct Channel {
    /// Name of its act.
    name: &'static str,
    /// Indices of the regressors in the base, and the names of their values.
    columns: Vec<(usize, &'static str)>,
    two_fingered: bool,
}

impl Simulated for Channel {
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
        let linear =
            candidate.linear.iter().zip(values).map(|((name, unit), value)| parameter(name, *value, 0.0, unit));
        let searched = candidate.searched.iter().map(|s| parameter(s.name, s.value, 0.0, s.unit));
        known.then(|| (format!("{}: {}", self.name, candidate.id), linear.chain(searched).collect()))
    }

    fn is_late(&self, _: &Candidate) -> bool {
        false
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

/// The hypothesis as found, and those of every rival cause. `holds`: number of regressors of the base for the held
/// weight.
pub fn hypotheses(
    (sheet, shaft): (&Compared, Option<&Shaft>),
    (holds, two_fingered): (usize, bool),
    has_law: bool,
) -> Vec<Hypothesis> {
    let of_sheet = vec![(holds, if has_law { "factor" } else { "k" })];
    let first = holds + usize::from(two_fingered) + 1;
    let of_hole = if has_law { vec![(first, "factor"), (first + 1, "c")] } else { Vec::new() };
    let on_sheet = Channel { name: "sheet", columns: of_sheet, two_fingered };
    let in_hole = Channel { name: "hole", columns: of_hole, two_fingered };
    let mut all: Vec<(&_, &dyn Simulated)> = vec![(&sheet.study, &on_sheet)];
    all.extend(shaft.map(|s| (&s.compared.study, &in_hole as &dyn Simulated)));
    of_channels(&all)
}
