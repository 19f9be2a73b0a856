//! The time column: told by its name, or by times of the calendar in it.

use super::{Plan, Planner, Use};
use crate::csv::stamps;
use crate::units::Dimension;
use crate::written_units::{self, Written};
use haptics::recording::Meta;

impl Plan {
    /// Reads the time column as times of the calendar if its first cell is one. Without a time column and a rate, a column
    /// with such a name and cell becomes it.
    pub fn take_stamps(&mut self, headers: &[String], first: &[String], meta: &Meta) {
        let stamp = |column: usize| first.get(column).and_then(|cell| stamps::parse(cell));
        let is_off = meta.columns.get("t_s").is_some_and(String::is_empty) || meta.rate_hz.is_some();
        let is_clock = |name: &str| {
            ["time", "timestamp", "datetime", "date_time", "date", "zeit"]
                .iter()
                .any(|word| name.eq_ignore_ascii_case(word))
        };
        let is_named = |column: &usize| is_clock(&headers[*column]) && stamp(*column).is_some();
        if self.time.is_none()
            && !is_off
            && let Some(column) = (0..headers.len()).find(is_named)
        {
            self.targets.retain(|target| target.column != column);
            self.notes.push(format!("the column `{}` is taken as the time t_s", headers[column]));
            self.time = Some(column);
        }
        if let Some((column, origin_ns)) = self.time.and_then(|column| Some((column, stamp(column)?))) {
            self.uses[column] = Use::Stamp { origin_ns };
        }
    }
}

/// True for a name of a time, with or without a unit. `unit`: text of its unit outside the name.
pub fn is_clock(header: &str, unit: &str) -> bool {
    let name = if unit.is_empty() { written_units::in_header(header, &[Dimension::Time]).0 } else { header };
    ["t", "time", "timestamp", "zeit", "x_value"].iter().any(|word| name.eq_ignore_ascii_case(word))
}

impl Planner<'_> {
    /// `time_s`, `Time [ms]`, `timestamp_ns`: the time, when nothing else claims to be it.
    pub(super) fn guess_time(&mut self) {
        let is_off = self.meta.columns.get("t_s").is_some_and(String::is_empty);
        if self.plan.time.is_some() || self.meta.rate_hz.is_some() || is_off {
            return;
        }
        let clock = |column: usize| {
            let header = &self.headers[column];
            if self.meta.columns.values().any(|source| source == header) {
                return None;
            }
            let is_time = is_clock(header, self.stated(column));
            match written_units::parse(&self.unit_text(column, &[Dimension::Time]), &[Dimension::Time]) {
                Written::Known(Dimension::Time, factor) if is_time => Some(factor),
                _ => None,
            }
        };
        let found = (0..self.plan.targets.len()).find_map(|at| Some((at, clock(self.plan.targets[at].column)?)));
        if let Some((at, factor)) = found {
            let target = self.plan.targets.remove(at);
            self.plan.time = Some(target.column);
            self.plan.uses[target.column] = Use::Number { required: true, factor };
            self.plan.notes.push(format!("the column `{}` is taken as the time t_s", self.headers[target.column]));
        }
    }
}
