//! What the user has chosen about the plots: which are shown, what is made of their curves, which recordings lie over each other.

use super::curves::NoiseCache;
use super::derived::Derived;
use crate::ui::prepare::Group;
use estimator::signal::transform::Transform;
use std::collections::{BTreeMap, BTreeSet};

/// How the log is looked at.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LogView {
    /// Curves over time.
    #[default]
    Time,
    /// One signal against another.
    Xy,
}

/// What was chosen for the plot of one quantity.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct GroupChoice {
    /// Shown or not; `None`: as usual for this quantity.
    pub shown: Option<bool>,
    /// What is made of its curves.
    pub transform: Transform,
    /// What the curves on the screen were made with: that of before while the new ones are computed.
    pub drawn: Transform,
    /// A second plot below shows what the models leave.
    pub left_over: bool,
    /// Hidden curves and layers, by name.
    pub hidden: BTreeSet<String>,
}

impl GroupChoice {
    /// True unless the user has hidden it.
    pub fn shows(&self, name: &str) -> bool {
        !self.hidden.contains(name)
    }

    /// Hides what is shown, shows what is hidden.
    pub fn toggle(&mut self, name: &str) {
        if !self.hidden.remove(name) {
            self.hidden.insert(name.to_owned());
        }
    }
}

/// A recording laid over the shown one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Overlaid {
    /// Which of the loaded ones.
    pub recording: usize,
    /// What is added to its times, s (samples without a clock).
    pub offset_s: f64,
}

/// What an XY plot tells by colour.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum XyColor {
    /// The state.
    #[default]
    State,
    /// The time.
    Time,
}

/// One signal of an XY plot.
#[derive(Clone, Debug, PartialEq)]
pub struct XyAxis {
    /// Key of its group.
    pub group: String,
    /// Name of its trace.
    pub name: String,
    /// What is made of it.
    pub transform: Transform,
}

/// The two signals of an XY plot.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct XyChoice {
    /// To the right.
    pub x: Option<XyAxis>,
    /// Upwards.
    pub y: Option<XyAxis>,
    /// Told by colour.
    pub color: XyColor,
}

/// Everything that was chosen about the plots, and the curves that were computed for it.
#[derive(Debug, Default)]
pub struct PlotChoices {
    /// Time or XY.
    pub view: LogView,
    /// By [`Group::key`].
    pub groups: BTreeMap<String, GroupChoice>,
    /// Recordings that lie over the shown one, in the order in which they were added.
    pub overlaid: Vec<Overlaid>,
    /// The XY plot.
    pub xy: XyChoice,
    /// Computed curves.
    pub derived: Derived,
    /// Measured noise.
    pub noise: NoiseCache,
}

impl PlotChoices {
    /// What was chosen for a group.
    pub fn of(&mut self, group: &Group) -> &mut GroupChoice {
        self.groups.entry(group.key()).or_default()
    }

    /// Whether a group has a plot.
    pub fn is_shown(&self, group: &Group) -> bool {
        self.groups.get(&group.key()).and_then(|choice| choice.shown).unwrap_or(group.shown)
    }

    /// The user does not want to wait for the curves that are being computed: those on the screen stay.
    pub fn give_up(&mut self) {
        for choice in self.groups.values_mut() {
            choice.transform = choice.drawn;
        }
    }

    /// Other recordings were loaded: which lie over which is of no use any more.
    pub fn forget_recordings(&mut self) {
        self.overlaid.clear();
    }
}

/// A transform in words.
pub fn name(transform: Transform) -> &'static str {
    match transform {
        Transform::None => "As recorded",
        Transform::Derivative => "Derivative",
        Transform::SecondDerivative => "Second derivative",
        Transform::LowPass(_) => "Low-pass",
        Transform::Integral => "Integral",
        Transform::MinusMean => "Minus mean",
    }
}

/// The unit of a quantity after `order` derivatives with respect to time (of integrals where negative): mm/s² for 2 of mm.
pub fn unit_after(unit: &str, order: i32, clockless: bool) -> String {
    if order == 0 {
        return unit.to_owned();
    }
    let time = if clockless { "sample" } else { "s" };
    let (base, had) = split(unit, time);
    let power = had - order;
    let digits = match power.abs() {
        2 => "²",
        3 => "³",
        4 => "⁴",
        _ => "",
    };
    match power {
        0 => base.to_owned(),
        _ if power > 0 && base.is_empty() => format!("{time}{digits}"),
        _ if power > 0 => format!("{base}·{time}{digits}"),
        _ => format!("{}/{time}{digits}", if base.is_empty() { "1" } else { base }),
    }
}

/// A unit without its time, and the power of that: mm/s is mm and −1.
fn split<'a>(unit: &'a str, time: &str) -> (&'a str, i32) {
    for (digits, power) in [("²", 2), ("³", 3), ("", 1)] {
        if let Some(base) = unit.strip_suffix(&format!("/{time}{digits}")) {
            return (if base == "1" { "" } else { base }, -power);
        }
        if let Some(base) = unit.strip_suffix(&format!("·{time}{digits}")) {
            return (base, power);
        }
    }
    (unit, 0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_follow_the_transform() {
        for (unit, order, expected) in [
            ("mm", 1, "mm/s"),
            ("mm", 2, "mm/s²"),
            ("mm/s", 1, "mm/s²"),
            ("mm/s", -1, "mm"),
            ("m/s²", -1, "m/s"),
            ("m/s²", 1, "m/s³"),
            ("N", -1, "N·s"),
            ("N·s", 1, "N"),
            ("", 1, "1/s"),
            ("1/s", -1, ""),
            ("°", 0, "°"),
        ] {
            assert_eq!(unit_after(unit, order, false), expected, "{unit} {order}");
        }
        assert_eq!(unit_after("mm", 2, true), "mm/sample²");
        assert_eq!(unit_after("mm/s", 1, true), "mm/s/sample", "a measured speed stays one");
    }

    #[test]
    fn who_does_not_want_to_wait_keeps_what_is_on_the_screen() {
        let mut choices = PlotChoices::default();
        let choice =
            GroupChoice { transform: Transform::Derivative, drawn: Transform::LowPass(3.0), ..GroupChoice::default() };
        choices.groups.insert("Force/N".to_owned(), choice);
        choices.give_up();
        assert_eq!(choices.groups["Force/N"].transform, Transform::LowPass(3.0));
    }
}
