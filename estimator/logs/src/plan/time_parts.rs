//! Clocks in two columns: whole seconds, and the fraction of a second beside them.

use super::{Plan, Planner, TIMES, Use, words};
use crate::units::Dimension;
use crate::written_units::{Written, parse};

/// Words for a clock in front of `sec` and `nsec`, beside those for a time.
const STAMPS: [&str; 5] = ["stamp", "tv", "epoch", "unix", "clock"];

impl Plan {
    /// Takes the fraction beside times of the calendar: a column whose whole name is a unit below a second, `ms`.
    pub fn take_fraction_of_stamps(&mut self, headers: &[String]) {
        let is_stamp = self.time.is_some_and(|column| matches!(self.uses[column], Use::Stamp { .. }));
        let unit_s = |column: usize| match parse(&headers[column], &[Dimension::Time]) {
            Written::Known(Dimension::Time, unit_s) if unit_s < 1.0 => Some(unit_s),
            _ => None,
        };
        let found = (0..headers.len()).find_map(|column| Some((column, unit_s(column)?)));
        if let Some((column, unit_s)) = found.filter(|_| is_stamp)
            && let Use::Number { factor, .. } = self.uses[column]
        {
            self.fraction = Some((column, unit_s / factor));
        }
    }
}

impl Planner<'_> {
    /// Takes the fraction beside a clock of whole seconds: `sec` and `nanosec`, `tv_sec` and `tv_usec`. Such a pair becomes the
    /// clock if there is none.
    pub(super) fn take_fraction(&mut self) {
        let is_off = self.meta.columns.get("t_s").is_some_and(String::is_empty) || self.meta.rate_hz.is_some();
        if is_off {
            return;
        }
        let pair = match self.plan.time {
            Some(column) => self.fraction_of(column),
            None => (0..self.headers.len()).filter(|&column| self.is_stamp(column)).find_map(|c| self.fraction_of(c)),
        };
        let Some((whole, fraction, unit_s)) = pair else { return };
        // The fraction stays a channel: its values decide if it is one.
        let Use::Number { factor, .. } = self.plan.uses[fraction] else { return };
        self.plan.fraction = Some((fraction, unit_s / factor));
        if self.plan.time.is_none() {
            self.plan.uses[whole] = Use::Number { required: true, factor: 1.0 };
            self.plan.targets.retain(|target| target.column != whole);
            self.plan.time = Some(whole);
        }
    }

    /// True for seconds that stand below the name of a clock and that the sidecar does not map.
    fn is_stamp(&self, column: usize) -> bool {
        let is_free = !self.meta.columns.values().any(|source| *source == self.headers[column]);
        let is_clock = |word: &String| TIMES.contains(&word.as_str()) || STAMPS.contains(&word.as_str());
        is_free && self.time_parts(column).is_some_and(|(name, _)| name.last().is_none_or(is_clock))
    }

    /// A column of seconds, the column of their fraction, and the length of its unit, s.
    fn fraction_of(&self, whole: usize) -> Option<(usize, usize, f64)> {
        let (name, factor) = self.time_parts(whole)?;
        let fraction = |column: usize| {
            let (other, unit_s) = self.time_parts(column)?;
            (column != whole && other == name && unit_s < 1.0).then_some((whole, column, unit_s))
        };
        (factor == 1.0).then(|| (0..self.headers.len()).find_map(fraction)).flatten()
    }

    /// Words of a column's name and the length of the unit of time behind them, s.
    fn time_parts(&self, column: usize) -> Option<(Vec<String>, f64)> {
        let mut name = words(&self.headers[column]);
        let unit = match self.stated(column) {
            "" => name.pop()?,
            stated => stated.to_owned(),
        };
        match parse(&unit, &[Dimension::Time]) {
            Written::Known(Dimension::Time, factor) => Some((name, factor)),
            _ => None,
        }
    }
}
