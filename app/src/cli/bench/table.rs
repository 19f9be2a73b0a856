//! One table of figures: the measurement, its target, and the value of another program for the same work.

use schemars::JsonSchema;
use serde::Serialize;
use std::fmt::Write as _;

/// What `bench` prints without a word behind it, and `bench diagnosis`.
#[derive(Debug, JsonSchema, Serialize)]
pub(crate) struct Said {
    /// Whether it was the short run.
    pub quick: bool,
    /// Whether the program was built for speed; figures of other builds say nothing.
    pub optimised: bool,
    /// Processors that it could use.
    pub cores: usize,
    /// Every figure.
    pub figures: Vec<Figure>,
    /// What was not measured, and why: one sentence each.
    pub skipped: Vec<String>,
}

/// One figure.
#[derive(Debug, JsonSchema, Serialize)]
pub(crate) struct Figure {
    /// What it is of.
    pub name: String,
    /// How much.
    pub value: f64,
    /// Of what.
    pub unit: String,
    /// What it should be.
    pub wanted: Option<Wanted>,
    /// What another program measured in the same run needs.
    pub peer: Option<Peer>,
}

/// A bound that a figure should keep.
#[derive(Clone, Copy, Debug, JsonSchema, Serialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Wanted {
    /// Of the figure itself.
    AtMost(f64),
    /// Of the figure itself, from below.
    AtLeast(f64),
    /// How many times as fast as the other program.
    TimesAsFast(f64),
}

/// Another program, on the same work in the same run.
#[derive(Debug, JsonSchema, Serialize)]
pub(crate) struct Peer {
    /// Its name.
    pub name: String,
    /// Its figure, in the unit of ours.
    pub value: f64,
    /// How many times as fast ours is.
    pub times_as_fast: f64,
}

impl Figure {
    /// Figure without a target.
    pub fn new(name: impl Into<String>, value: f64, unit: &str) -> Self {
        Self { name: name.into(), value, unit: unit.to_owned(), wanted: None, peer: None }
    }

    /// Adds a target.
    pub fn wanted(mut self, wanted: Wanted) -> Self {
        self.wanted = Some(wanted);
        self
    }

    /// True if the figure meets its target; `None` without one, or without a program to compare with.
    pub fn is_kept(&self) -> Option<bool> {
        match self.wanted? {
            Wanted::AtMost(most) => Some(self.value <= most),
            Wanted::AtLeast(least) => Some(self.value >= least),
            Wanted::TimesAsFast(least) => self.peer.as_ref().map(|peer| peer.times_as_fast >= least),
        }
    }

    fn wanted_in_words(&self) -> String {
        let kept = match self.is_kept() {
            Some(true) => ", kept",
            Some(false) => ", MISSED",
            None => "",
        };
        match self.wanted {
            Some(Wanted::AtMost(most)) => format!("≤ {}{kept}", plain(most)),
            Some(Wanted::AtLeast(least)) => format!("≥ {}{kept}", plain(least)),
            Some(Wanted::TimesAsFast(least)) => format!("{} ×{kept}", plain(least)),
            None => String::new(),
        }
    }
}

/// Number with three significant digits.
pub(super) fn plain(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return format!("{value}");
    }
    let decimals = (2 - value.abs().log10().floor() as i32).clamp(0, 6);
    let text = format!("{value:.*}", decimals as usize);
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

impl Said {
    /// Table of this program on this machine, nothing skipped.
    pub fn of(quick: bool, figures: Vec<Figure>) -> Self {
        let cores = std::thread::available_parallelism().map_or(1, usize::from);
        Self { quick, optimised: !cfg!(debug_assertions), cores, figures, skipped: Vec::new() }
    }

    /// Text for the user.
    pub fn in_words(&self) -> String {
        let mut text = String::new();
        if !self.optimised {
            text.push_str("This is no release build: its figures say nothing about speed.\n");
        }
        let wide = self.figures.iter().map(|figure| figure.name.chars().count()).max().unwrap_or(0);
        let _ = writeln!(text, "{:<wide$} {:>9} {:<12} {:<16} {:>9}  beside", "", "ours", "", "wanted", "times");
        for figure in &self.figures {
            let (times, beside) = figure.peer.as_ref().map_or_else(Default::default, |peer| {
                (format!("{:.1}", peer.times_as_fast), format!("{} {}", peer.name, plain(peer.value)))
            });
            let line = format!(
                "{:<wide$} {:>9} {:<12} {:<16} {times:>9}  {beside}",
                figure.name,
                plain(figure.value),
                figure.unit,
                figure.wanted_in_words()
            );
            let _ = writeln!(text, "{}", line.trim_end());
        }
        for skipped in &self.skipped {
            let _ = writeln!(text, "skipped: {skipped}");
        }
        let _ = writeln!(text, "{} processors{}", self.cores, if self.quick { ", quick" } else { "" });
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_three_digits_that_count() {
        for (value, text) in
            [(0.0, "0"), (1234.4, "1234"), (12.34, "12.3"), (0.001_234, "0.00123"), (2.0, "2"), (100.0, "100")]
        {
            assert_eq!(plain(value), text);
        }
    }

    #[test]
    fn a_figure_says_whether_it_keeps_its_bound() {
        let figure = Figure::new("tick", 0.5, "µs").wanted(Wanted::AtMost(0.7));
        assert_eq!(figure.is_kept(), Some(true));
        let right = Figure::new("right", 0.9, "of all").wanted(Wanted::AtLeast(0.93));
        assert_eq!((right.is_kept(), right.wanted_in_words()), (Some(false), "≥ 0.93, MISSED".to_owned()));
        let mut slow = Figure::new("load", 2.0, "s").wanted(Wanted::TimesAsFast(2.0));
        assert_eq!(slow.is_kept(), None, "nobody to compare with");
        slow.peer = Some(Peer { name: "other".to_owned(), value: 3.0, times_as_fast: 1.5 });
        let said =
            Said { quick: true, optimised: true, cores: 2, figures: vec![figure, slow], skipped: vec!["x".to_owned()] };
        let text = said.in_words();
        assert!(text.contains("≤ 0.7, kept") && text.contains("2 ×, MISSED") && text.contains("skipped: x"), "{text}");
    }
}
