//! The user's choices about the plots: visible groups, transforms of their curves, and overlaid recordings.

use super::curves::NoiseCache;
use super::derived::Derived;
use super::shift::{Held, Likeliest};
use crate::ui::document::prepared::Group;
use estimator::signal::transform::Transform;
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};

/// View of the log.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum LogView {
    /// Curves over time.
    #[default]
    Time,
    /// One signal against another.
    Xy,
}

/// Choice for the plot of one quantity.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct GroupChoice {
    /// Shown or not; `None`: as usual for this quantity.
    pub shown: Option<bool>,
    /// Transform of its curves.
    pub transform: Transform,
    /// Transform of the curves on the screen; it lags behind `transform` while the new curves are computed.
    #[serde(skip)]
    pub drawn: Transform,
    /// True if a second plot below shows the residuals of the models.
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
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Overlaid {
    /// Index into the loaded recordings.
    pub recording: usize,
    /// Time offset added to its times, s (samples without a clock).
    pub offset_s: f64,
}

/// Quantity that colour encodes in an XY plot.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum XyColor {
    /// The state.
    #[default]
    State,
    /// The time.
    Time,
}

/// One signal of an XY plot.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct XyAxis {
    /// Key of its group.
    pub group: String,
    /// Name of its trace.
    pub name: String,
    /// Transform of the signal.
    pub transform: Transform,
}

/// The two signals of an XY plot.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct XyChoice {
    /// Horizontal axis.
    pub x: Option<XyAxis>,
    /// Vertical axis.
    pub y: Option<XyAxis>,
    /// Quantity that colour encodes.
    pub color: XyColor,
}

/// All choices about the plots, and the curves computed for them.
#[derive(Debug, Default)]
pub struct PlotChoices {
    /// Time or XY.
    pub view: LogView,
    /// Choices by [`Group::key`].
    pub groups: BTreeMap<String, GroupChoice>,
    /// Recordings that lie over the shown one, in the order in which they were added.
    pub overlaid: Vec<Overlaid>,
    /// Overlaid recording that the pointer drags by its curve.
    pub held: Option<Held>,
    /// Index of the overlaid recording that was under the pointer in the previous frame.
    pub pointed: Option<usize>,
    /// Shifts at which recordings match best.
    pub likeliest: Likeliest,
    /// The XY plot.
    pub xy: XyChoice,
    /// Computed curves.
    pub derived: Derived,
    /// Measured noise.
    pub noise: NoiseCache,
}

/// Part of the choices that a project stores.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct KeptChoices {
    view: LogView,
    groups: BTreeMap<String, GroupChoice>,
    overlaid: Vec<Overlaid>,
    xy: XyChoice,
}

impl PlotChoices {
    /// Copy of the choices for a project.
    pub fn kept(&self) -> KeptChoices {
        let without_curves = |choice: &GroupChoice| GroupChoice { drawn: Transform::None, ..choice.clone() };
        let groups = self.groups.iter().map(|(key, choice)| (key.clone(), without_curves(choice)));
        // A group with default choices is not stored.
        let groups = groups.filter(|(_, choice)| *choice != GroupChoice::default()).collect();
        KeptChoices { view: self.view, groups, overlaid: self.overlaid.clone(), xy: self.xy.clone() }
    }

    /// Restores the choices of a project.
    pub fn restore(&mut self, kept: KeptChoices) {
        let KeptChoices { view, groups, overlaid, xy } = kept;
        (self.view, self.groups, self.overlaid, self.xy) = (view, groups, overlaid, xy);
    }

    /// Choices of a group.
    pub fn of(&mut self, group: &Group) -> &mut GroupChoice {
        self.groups.entry(group.key()).or_default()
    }

    /// True if a group has a plot.
    pub fn is_shown(&self, group: &Group) -> bool {
        self.groups.get(&group.key()).and_then(|choice| choice.shown).unwrap_or(group.shown)
    }

    /// Cancels the curves that are being computed; those on the screen stay.
    pub fn give_up(&mut self) {
        for choice in self.groups.values_mut() {
            choice.transform = choice.drawn;
        }
    }

    /// Clears the overlays: other recordings were loaded, so the indices are no longer valid.
    pub fn forget_recordings(&mut self) {
        self.overlaid.clear();
        self.likeliest.clear();
        (self.held, self.pointed) = (None, None);
    }
}

/// Name of a transform for the user.
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

/// Unit of a quantity after `order` derivatives with respect to time (integrals if negative): mm/s² for 2 of mm.
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

/// Splits a unit into the part without time and the power of time: mm/s is mm and −1.
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
    fn a_project_brings_the_choices_back() {
        let mut choices = PlotChoices { view: LogView::Xy, ..PlotChoices::default() };
        let choice = GroupChoice {
            transform: Transform::LowPass(12.5),
            drawn: Transform::LowPass(12.5),
            left_over: true,
            ..GroupChoice::default()
        };
        choices.groups.insert("Force/N".to_owned(), choice);
        choices.groups.insert("Position/mm".to_owned(), GroupChoice::default());
        choices.overlaid.push(Overlaid { recording: 1, offset_s: -0.25 });
        let axis = XyAxis { group: "Force/N".into(), name: "f_N".into(), transform: Transform::Derivative };
        choices.xy.y = Some(axis);
        let text = serde_json::to_string(&choices.kept()).expect("written");
        assert!(!text.contains("Position"), "{text}");
        let mut back = PlotChoices::default();
        back.restore(serde_json::from_str(&text).expect("read"));
        assert_eq!(back.kept(), choices.kept());
        assert_eq!(back.groups["Force/N"].transform, Transform::LowPass(12.5));
        assert_eq!(
            serde_json::from_str::<KeptChoices>("{}").expect("older projects have none"),
            KeptChoices::default()
        );
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
