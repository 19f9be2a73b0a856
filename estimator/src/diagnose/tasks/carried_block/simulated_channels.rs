use super::net_force::Carry;
use crate::diagnose::contract::parameter;
use crate::diagnose::extension::hypothetical_worlds::{Act, Simulated};
use crate::diagnose::hypotheses::candidate::Candidate;
use crate::diagnose::hypotheses::variable::Variable;
use crate::diagnose::hypotheses::{added_constraint, force_drift, gravity_tilt, mass_change};
use std::collections::BTreeSet;

impl Simulated for Carry<'_> {
    fn base(&self, values: &[f64]) -> Vec<Act> {
        let of = |(number, weight_n): (&usize, &f64)| {
            let found = vec![parameter("weight", *weight_n, 0.0, "N"), parameter("block", *number as f64, 0.0, "1")];
            ("weight".to_owned(), found)
        };
        self.weighed.iter().zip(values).map(of).collect()
    }

    /// A world has no drag in the air, no mass without weight, and no sudden change of weight.
    fn act(&self, candidate: &Candidate, values: &[f64]) -> Option<Act> {
        let mut found = candidate.parameters(values);
        if candidate.id != added_constraint::ID {
            found.truncate(candidate.linear.len());
        }
        match candidate.id {
            gravity_tilt::ID | added_constraint::ID => {}
            // The start of a leak does not carry over to another recording: there it leaks from the start.
            mass_change::ID if found.iter().any(|p| p.name == "rate" && p.value < 0.0) => {}
            _ => return None,
        }
        Some((candidate.id.to_owned(), self.of_blocks(candidate, found)))
    }

    /// Such a drift leaves alone what its sensors read before.
    fn is_late(&self, candidate: &Candidate) -> bool {
        let Some((_, time_s)) = self.compared.view.over.iter().find(|(v, _)| *v == Variable::Time) else {
            return false;
        };
        let drifts = candidate.id == force_drift::ID && candidate.searched.is_empty();
        drifts
            && candidate.columns.iter().any(|column| {
                let sensors: BTreeSet<usize> =
                    (0..column.len()).filter(|i| column[*i] != 0.0).map(|i| self.compared.view.sensor[i]).collect();
                let silent = |i: &usize| column[*i] == 0.0 && sensors.contains(&self.compared.view.sensor[*i]);
                (0..column.len()).filter(silent).any(|i| time_s[i] > 0.0)
            })
    }
}
