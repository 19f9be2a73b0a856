//! Part of the recording that is fitted, and that is read.

use crate::text::format;
use crate::ui::background::jobs::Jobs;
use crate::ui::calibrate::state::Calibration;
use crate::ui::document::correction;
use crate::ui::document::state::Document;
use crate::ui::kit::theme;
use crate::ui::session::Session;
use egui::Ui;
use serde_json::json;

/// Texts of these lines.
mod words {
    pub const FITTED: &str = "Fitted";
    pub const ALL: &str = "the whole recording";
    pub const ONLY_SHOWN: &str = "Only what is shown";
    pub const ONLY_SHOWN_MORE: &str = "Fit the part that the plots show";
    pub const WHOLE: &str = "Whole recording";
    pub const KEEP_PART: &str = "Read only this part";
    pub const KEEP_PART_MORE: &str = "Write from_s and to_s into the sidecar and open the log again";
    pub const READ_ALL: &str = "Read the whole log";
    pub const READ_ALL_MORE: &str = "Take the window of time out of the sidecar and open the log again";
}

/// Draws the chooser of the fitted time range.
pub fn fitted_part(ui: &mut Ui, document: &Document, calibration: &mut Calibration) {
    let Some(prepared) = document.prepared().filter(|p| !p.clockless()) else { return };
    let (whole, shown) = (prepared.span(), document.view_s);
    ui.horizontal_wrapped(|ui| {
        ui.label(theme::caption(ui, words::FITTED));
        let words = match calibration.choice.only_s {
            None => words::ALL.to_owned(),
            Some((from, to)) => format!("{} to {} s", format::number(from, 2), format::number(to, 2)),
        };
        ui.label(egui::RichText::new(words).size(12.0));
    });
    let zoomed = shown.1 - shown.0 < 0.999 * (whole.1 - whole.0) && calibration.choice.only_s != Some(shown);
    if !zoomed && calibration.choice.only_s.is_none() {
        return;
    }
    ui.horizontal_wrapped(|ui| {
        if zoomed && ui.link(words::ONLY_SHOWN).on_hover_text(words::ONLY_SHOWN_MORE).clicked() {
            calibration.choice.only_s = Some(shown);
        }
        if calibration.choice.only_s.is_some() && ui.link(words::WHOLE).clicked() {
            calibration.choice.only_s = None;
        }
    });
}

/// Draws the links that put the fitted part into the sidecar of a log with one recording, and take it out again.
pub fn read_part(ui: &mut Ui, document: &Document, calibration: &mut Calibration, jobs: &mut Jobs<Session>) {
    let Some(prepared) = document.prepared().filter(|p| document.path.is_some() && !p.clockless()) else { return };
    let part_s = calibration.choice.only_s.filter(|_| document.recordings.len() == 1);
    let mut link = |words: &str, more: &str, from_s: Option<f64>, to_s: Option<f64>| {
        if ui.link(words).on_hover_text(more).clicked() {
            let entries = json!({ "from_s": from_s, "to_s": to_s, "windows": null });
            let ctx = ui.ctx().clone();
            entries.as_object().inspect(|entries| correction::correct(document, jobs, &ctx, entries));
            calibration.choice.only_s = None;
        }
    };
    if let Some((from, to)) = part_s {
        link(words::KEEP_PART, words::KEEP_PART_MORE, Some(from), Some(to));
    }
    if !prepared.recording.meta.windows().is_empty() {
        link(words::READ_ALL, words::READ_ALL_MORE, None, None);
    }
}
