//! Columns that a log can do without: a fault in one of them need not refuse the file.

use super::own_names::{canonical, forms};
use super::{Plan, Use};
use crate::errors::LogError;
use crate::suggested;
use crate::units::{self, Dimension};
use haptics::recording::{Meta, Suggested, Task};
use serde_json::Value;

/// Forces of a mechanism beside its coordinates.
const MECHANISMS: [(&str, &str); 2] = [("q_m", "f_N"), ("q_rad", "tau_Nm")];

impl Plan {
    /// Notes the columns that the log can do without.
    pub fn note_spare(&mut self, headers: &[String], meta: &Meta) {
        let columns = self.targets.iter().filter(|target| self.left_out_with(&target.name, headers, meta).is_some());
        self.spare = columns.map(|target| target.column).collect();
    }

    /// The outcome of reading. A faulty column that the log can do without is left out, with those that are of no use without it, if
    /// the sidecar maps others: what is not mapped is not needed. Otherwise, the error says how to leave it out. `first`: the
    /// outcome with all columns.
    pub fn without_spare<T>(
        &mut self,
        (headers, meta): (&[String], &Meta),
        first: Result<T, LogError>,
        mut read: impl FnMut(&Self) -> Result<T, LogError>,
    ) -> Result<T, LogError> {
        let mut outcome = first;
        while let Err(error) = &mut outcome {
            let LogError::BadCell { row, column, what, mend, .. } = error else { break };
            let faulty = self.targets.iter().find(|target| headers[target.column] == *column);
            let Some((columns, why)) = faulty.and_then(|one| self.left_out_with(&one.name, headers, meta)) else {
                break;
            };
            if meta.columns.is_empty() {
                let targets = self.targets.iter().filter(|target| columns.contains(&target.column));
                let left_out: Suggested = targets.map(|target| (target.name.clone(), Value::Null)).collect();
                *mend = Some(Box::new(suggested::entry("columns", Value::Object(left_out))));
                break;
            }
            let fault = format!("row {row}, column `{column}`: {what}");
            self.leave_out(&columns, headers, &format!("{why}: {fault}"));
            outcome = read(self);
        }
        outcome
    }

    /// Leaves columns out, and says why.
    fn leave_out(&mut self, columns: &[usize], headers: &[String], why: &str) {
        let names: Vec<&str> = columns.iter().map(|column| headers[*column].as_str()).collect();
        let names = format!("`{}` {}", names.join("`, `"), if names.len() == 1 { "is" } else { "are" });
        self.notes.push(format!("{names} not used, since {why}"));
        for column in columns {
            self.uses[*column] = Use::Ignore;
        }
        self.targets.retain(|target| !columns.contains(&target.column));
        self.watched.retain(|column| !columns.contains(column));
    }

    /// Columns that are left out with a channel, and the reason; none if the log needs it, or if the sidecar mentions one of them.
    fn left_out_with(&self, name: &str, headers: &[String], meta: &Meta) -> Option<(Vec<usize>, &'static str)> {
        let (is_spare, why) = self.test_of_spare(name, meta)?;
        let spare = || self.targets.iter().filter(|target| is_spare(&target.name));
        let is_stated = spare().any(|target| is_mentioned(&target.name, &headers[target.column], meta));
        (!is_stated).then(|| (spare().map(|target| target.column).collect(), why))
    }

    /// Test for the names that can be left out with this one, and the reason; none if it is needed. Rates follow from
    /// positions. Beside the position and force of a mechanism, another motion belongs to another task.
    fn test_of_spare(&self, name: &str, meta: &Meta) -> Option<(impl Fn(&str) -> bool + use<>, &'static str)> {
        let has = |name: &str| self.targets.iter().any(|target| target.name == name);
        let own = forms(name);
        let kind = rate(name).filter(|(_, position)| has(position)).map(|(kind, _)| kind);
        let is_for_mechanism = meta.task.is_none_or(|task| task == Task::Mechanism);
        let is_other = own.iter().any(|form| *form > 1) && is_for_mechanism;
        if kind.is_none() && !(is_other && MECHANISMS.iter().any(|(q, f)| has(q) && has(f))) {
            return None;
        }
        let is_spare = move |other: &str| match kind {
            Some(kind) => forms(other) == own && rate(other).is_some_and(|(other, _)| other == kind),
            None => forms(other).iter().any(|form| *form > 1),
        };
        Some((
            is_spare,
            if kind.is_some() { "the position shows its rates" } else { "the motion of a mechanism stands beside" },
        ))
    }
}

/// Sign of a velocity or an acceleration, and the name of the position that it is a derivative of.
fn rate(name: &str) -> Option<(&'static str, String)> {
    let (quantity, unit) = units::split(name)?;
    let si = match unit.dimension {
        Dimension::Velocity | Dimension::Acceleration => "m",
        Dimension::AngularVelocity | Dimension::AngularAcceleration => "rad",
        _ => return None,
    };
    let (kind, position) = ["ddq", "dq", "v"].iter().find_map(|kind| Some((*kind, quantity.strip_prefix(kind)?)))?;
    let stem = if kind == "v" { "" } else { "q" };
    Some((kind, format!("{stem}{position}_{si}")))
}

/// True if the sidecar speaks of a column.
fn is_mentioned(name: &str, header: &String, meta: &Meta) -> bool {
    let is_key = |key: &String| key == header || canonical(key) == name;
    let mut keys = meta.columns.keys().chain(meta.scale.keys()).chain(meta.sign.keys()).chain(meta.clocks.keys());
    keys.any(is_key) || meta.columns.values().any(|source| source == header)
}
