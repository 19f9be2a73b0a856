//! Undo and redo of everything about the fit that the user changes, and of recordings that lie over each other.

use crate::ui::document::fit_choice::FitChoice;
use crate::ui::plots::choices::{Overlaid, PlotChoices};
use egui::util::undoer::{Settings, Undoer};

/// Changes that follow each other faster are one.
pub(crate) const ONE_CHANGE_S: f32 = 0.6;

/// Largest number of kept changes.
pub(crate) const KEPT: usize = 200;

/// History of changes, for undo and redo.
pub struct Undo {
    pub(crate) undoer: Undoer<Undoable>,
}

/// Choices of the user that undo covers.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Undoable {
    pub(crate) choice: FitChoice,
    /// Recordings over the shown one, each with its shift in time.
    pub(crate) overlaid: Vec<Overlaid>,
}

impl Undoable {
    pub(crate) fn of(choice: &FitChoice, plots: &PlotChoices) -> Self {
        Self { choice: choice.clone(), overlaid: plots.overlaid.clone() }
    }
}

impl Default for Undo {
    fn default() -> Self {
        let settings = Settings { max_undos: KEPT, stable_time: ONE_CHANGE_S, ..Settings::default() };
        Self { undoer: Undoer::with_settings(settings) }
    }
}

/// Differences between two choices, in words.
pub(crate) fn difference(now: &Undoable, then: &Undoable) -> String {
    let (a, b) = (&now.choice, &then.choice);
    let changed = [
        (a.task != b.task, "task"),
        (a.own != b.own, "rules"),
        (a.thresholds != b.thresholds, "thresholds"),
        (a.method != b.method, "method"),
        (a.segments != b.segments, "states set by hand"),
        (a.stated.known != b.stated.known, "known value"),
        (a.stated.prior != b.stated.prior, "prior"),
        (a.stated.bounds != b.stated.bounds, "bounds"),
        (a.only_s != b.only_s, "part of the recording"),
        (now.overlaid != then.overlaid, "recordings over each other"),
    ];
    let names: Vec<&str> = changed.iter().filter(|(differs, _)| *differs).map(|(_, name)| *name).collect();
    names.join(", ")
}
