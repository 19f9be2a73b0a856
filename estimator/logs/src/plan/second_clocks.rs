//! Columns with a clock of their own: those that the sidecar names, and columns that read as further clocks.

use super::{Plan, Planner, Target, Use};
use crate::errors::LogError;
use crate::units::{self, Dimension};
use crate::written_units::{self, Written};

/// Words for a time in the name of a column.
pub const TIMES: [&str; 6] = ["time", "timestamp", "t", "ts", "zeit", "times"];

/// A clock of some columns only.
#[derive(Clone, Debug, PartialEq)]
pub struct SecondClock {
    /// Column of its times.
    pub clock: usize,
    /// Seconds that are added to them.
    pub offset_s: f64,
    /// Columns whose times these are.
    pub columns: Vec<usize>,
}

/// Words of a name, in lower case.
pub fn words(name: &str) -> Vec<String> {
    let split = name.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty());
    split.map(str::to_lowercase).collect()
}

/// True for a name that begins or ends with a word for a time.
pub fn is_like_a_clock(name: &str) -> bool {
    let words = words(name);
    let is_time = |word: Option<&String>| word.is_some_and(|word| TIMES.contains(&word.as_str()));
    is_time(words.first()) || is_time(words.last())
}

impl Plan {
    /// Gives columns the clocks that the file's format states for them, unless the sidecar states others. `pairs`: columns
    /// of channels and of their clocks, in s.
    pub fn give_clocks(&mut self, pairs: &[(usize, usize)]) {
        for &(column, clock) in pairs {
            let is_used = self.targets.iter().any(|target| target.column == column);
            let is_stated = self.clocks.iter().any(|known| known.columns.contains(&column));
            let (Use::Number { factor, .. }, true) = (self.uses[column], is_used && !is_stated) else { continue };
            self.uses[column] = Use::Number { required: true, factor };
            self.give(clock, 1.0, 0.0, column);
        }
    }

    /// Makes a column the clock of another one, with the seconds that are added to its times.
    fn give(&mut self, clock: usize, factor: f64, offset_s: f64, column: usize) {
        self.uses[clock] = Use::Number { required: true, factor };
        self.targets.retain(|target| target.column != clock);
        self.suspects.retain(|(other, _)| *other != clock);
        let known = self.clocks.iter_mut().find(|known| known.clock == clock && known.offset_s == offset_s);
        match known {
            Some(known) => known.columns.push(column),
            None => self.clocks.push(SecondClock { clock, offset_s, columns: vec![column] }),
        }
    }
}

impl Planner<'_> {
    /// Factor of a column with a unit of time; 1 without a unit. None for another unit.
    fn time_factor(&self, column: usize) -> Option<f64> {
        let text = self.unit_text(column, &[Dimension::Time]);
        match written_units::parse(&text, &[Dimension::Time]) {
            _ if text.is_empty() => Some(1.0),
            Written::Known(Dimension::Time, factor) => Some(factor),
            _ => None,
        }
    }

    /// Takes the clocks that the sidecar gives to columns.
    pub(super) fn take_clocks(&mut self) -> Result<(), LogError> {
        for (name, own) in &self.meta.clocks {
            let (clock_name, offset_s) = own.parts();
            let why = || format!("\"clocks\" in the sidecar names it for `{name}`");
            let clock = self.position(clock_name).ok_or_else(|| self.missing(clock_name, why()))?;
            let target = self.plan.targets.iter().find(|t| t.name == *name || self.headers[t.column] == *name);
            let column =
                target.map(|t| t.column).ok_or_else(|| self.missing(name, "\"clocks\" names it".to_owned()))?;
            if self.plan.time == Some(clock) {
                continue;
            }
            let factor = self.time_factor(clock).ok_or_else(|| LogError::WrongDimension {
                target: format!("the clock of {name}"),
                column: clock_name.to_owned(),
                unit: self.unit_text(clock, &[Dimension::Time]),
                path: self.path.to_path_buf(),
            })?;
            let factor = factor * self.meta.scale.get(clock_name).copied().unwrap_or(1.0);
            self.plan.uses[column] = match self.plan.uses[column] {
                Use::Number { factor, .. } => Use::Number { required: true, factor },
                other => other,
            };
            self.plan.give(clock, factor, offset_s, column);
        }
        Ok(())
    }

    /// Notes the columns that read as clocks and are none so far: with such a name, and a unit of time or none.
    pub(super) fn suspect_clocks(&mut self) {
        let is_suspect = |target: &&Target| {
            let header = &self.headers[target.column];
            let (name, _) = written_units::in_header(header, &[Dimension::Time]);
            let is_free = !self.meta.columns.values().any(|source| source == header);
            // Beside a clock, values that increase in every row are enough.
            let has_unit = self.plan.time.is_some() || !self.unit_text(target.column, &[Dimension::Time]).is_empty();
            let name = if self.stated(target.column).is_empty() { name } else { header.as_str() };
            is_free && has_unit && is_like_a_clock(name) && self.time_factor(target.column).is_some()
        };
        // An extra channel with a unit of the log format is read in seconds, others in their own unit.
        let factor = |column: usize| match units::split(&self.headers[column]) {
            Some(_) if self.stated(column).is_empty() => 1.0,
            _ => self.time_factor(column).unwrap_or(1.0),
        };
        let suspects = self.plan.targets.iter().filter(is_suspect).map(|t| (t.column, factor(t.column)));
        self.plan.suspects = suspects.collect();
    }
}
