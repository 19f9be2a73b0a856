//! The time column: told by its name, or by times of the calendar in it.

use super::{Plan, Planner, Use};
use crate::csv::calendar::{self, Days, Form, Order};
use crate::raw::place_of;
use crate::units::Dimension;
use crate::written_units::{self, Written};
use haptics::recording::Meta;

impl Plan {
    /// Reads the time column as times of the calendar if its first cell is one. Without a time column and a rate, a column
    /// with such a name and cell becomes it; beside a column of dates, the only column with times of the day. Dates that
    /// stand apart belong to the times of the day.
    pub fn take_stamps(&mut self, headers: &[String], first: &[String], meta: &Meta) {
        let cell = |column: usize| first.get(column).map_or("", String::as_str);
        let date = date_column(headers, &cell, meta);
        let is_off = meta.columns.get("t_s").is_some_and(String::is_empty) || meta.rate_hz.is_some();
        let is_named = |column: &usize| {
            let name = headers[*column].trim_matches('_');
            let is_clock = CLOCKS.iter().any(|word| name.eq_ignore_ascii_case(word));
            (is_clock || place_of(name) == Some(*column)) && calendar::parse(cell(*column)).is_some()
        };
        let beside_date = || {
            let mut times = (0..headers.len()).filter(|&column| calendar::of_day(cell(column)).is_some());
            times.next().filter(|_| date.is_some() && times.next().is_none())
        };
        if self.time.is_none()
            && !is_off
            && let Some(column) = (0..headers.len()).find(is_named).or_else(beside_date)
        {
            self.targets.retain(|target| target.column != column);
            self.notes.push(format!("the column `{}` is taken as the time t_s", headers[column]));
            self.time = Some(column);
        }
        let Some(column) = self.time else { return };
        let date = date.filter(|_| calendar::of_day(cell(column)).is_some());
        let forms = [(true, Order::Usual), (true, Order::Other), (false, Order::Usual)];
        let forms = forms.map(|(is_dated, order)| Form { date, is_dated, order });
        let read =
            |form: &Form| Some(Use::Stamp { origin_ns: form.read(&stamp_text(*form, column, &cell))?, form: *form });
        let Some(stamp) = forms.iter().find_map(read) else { return };
        self.uses[column] = stamp;
        if let Some(date) = date {
            self.uses[date] = Use::Ignore;
            self.targets.retain(|target| target.column != date);
            let (date, time) = (&headers[date], &headers[column]);
            self.notes.push(format!("the column `{date}` holds the dates of the times in `{time}`"));
        }
    }

    /// Reads the dates in the other order of day and month, if the first row has a date in it.
    pub fn turn_dates(&mut self, first: &[String]) -> bool {
        let cell = |column: usize| first.get(column).map_or("", String::as_str);
        for (column, wanted) in self.uses.iter_mut().enumerate() {
            let Use::Stamp { form, .. } = *wanted else { continue };
            let form = Form { order: form.order.other(), ..form };
            let text = stamp_text(form, column, &cell);
            if let Some(origin_ns) = form.read(&text).filter(|_| calendar::settles_order(&text) == Some(false)) {
                *wanted = Use::Stamp { origin_ns, form };
                return true;
            }
        }
        false
    }

    /// Sentence about dates that no cell settles the order of.
    pub fn doubt_about_dates(days: Days) -> Option<String> {
        (days.is_open && !days.is_settled).then(|| {
            "no date shows whether its day or its month stands first: 3/4 is read as March 4, 3-4 as April 3; \
             write dates as 2026-04-03 to be sure"
                .to_owned()
        })
    }
}

/// Names of columns of times of the calendar or the day.
const CLOCKS: [&str; 8] = ["time", "timestamp", "datetime", "date_time", "date", "zeit", "uhrzeit", "index"];

/// Text of a stamp in the first row: its date, if that stands apart, and its time.
fn stamp_text<'a>(form: Form, column: usize, cell: &impl Fn(usize) -> &'a str) -> String {
    form.date.map_or_else(|| cell(column).to_owned(), |date| format!("{} {}", cell(date), cell(column)))
}

/// The column of dates without times that the sidecar does not map: one with such a name before others.
fn date_column<'a>(headers: &[String], cell: &impl Fn(usize) -> &'a str, meta: &Meta) -> Option<usize> {
    let is_free = |column: &usize| !meta.columns.values().any(|source| *source == headers[*column]);
    let dates = || (0..headers.len()).filter(is_free).filter(|&column| calendar::is_date(cell(column)));
    let is_named = |column: &usize| ["date", "datum"].iter().any(|word| headers[*column].eq_ignore_ascii_case(word));
    dates().find(is_named).or_else(|| dates().next())
}

/// True for a name of a time, with or without a unit. `unit`: text of its unit outside the name.
pub fn is_clock(header: &str, unit: &str) -> bool {
    let name = if unit.is_empty() { written_units::in_header(header, &[Dimension::Time]).0 } else { header };
    ["t", "time", "timestamp", "zeit", "x_value"].iter().any(|word| name.eq_ignore_ascii_case(word))
}

impl Planner<'_> {
    /// Notes a time column that the sidecar maps in seconds and whose name is one word, without a unit.
    pub(super) fn note_assumed_unit(&mut self) {
        let Some(column) = self.plan.time else { return };
        let header = &self.headers[column];
        let is_mapped = self.meta.columns.get("t_s").is_some_and(|source| source == header);
        let is_scaled = self.meta.scale.contains_key("t_s") || self.meta.scale.contains_key(header);
        let is_word = !header.contains(['_', ' ']) && self.unit_text(column, &[Dimension::Time]).is_empty();
        self.plan.is_unit_assumed = is_mapped && is_word && !is_scaled;
    }

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
