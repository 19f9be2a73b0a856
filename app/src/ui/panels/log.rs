//! The log: plots with one time axis, the states under them, the time slider.

use super::Panel;
use super::incoming::incoming;
use super::segments::band;
use super::transport::transport;
use crate::ui::files;
use crate::ui::jobs::Purpose;
use crate::ui::plots::{GUTTER, PlotCache, RowInput, axis_height, row};
use crate::ui::prepare::Prepared;
use crate::ui::session::{Session, Workspace};
use crate::ui::theme::{self, palette, space};
use crate::ui::widgets::{empty_state, primary_button, sheet};
use egui::{Rangef, RichText, Stroke, Ui};
use std::collections::BTreeMap;
use std::sync::Arc;

/// Least height of a plot, points.
const LEAST_HEIGHT: f32 = 56.0;
/// Height of band, subtasks, legend and slider together.
const FOOT: f32 = 102.0;

/// The log panel.
#[derive(Default)]
pub struct LogPanel {
    cache: PlotCache,
    /// Groups that the user has switched, by title.
    switched: BTreeMap<String, bool>,
}

impl Panel for LogPanel {
    fn title(&self) -> &'static str {
        "Log"
    }

    fn ui(&mut self, ui: &mut Ui, session: &mut Session) {
        sheet(ui).inner_margin(space::M).show(ui, |ui| {
            ui.set_min_size(ui.available_size());
            if let Some((preview, progress)) = session.jobs.preview() {
                incoming(ui, preview, &progress);
                return;
            }
            let Some(prepared) = session.prepared().cloned() else {
                nothing_loaded(ui, session);
                return;
            };
            self.header(ui, &prepared);
            let area = self.plots(ui, session, &prepared);
            band(ui, session, area);
            transport(ui, session, area);
        });
    }
}

fn nothing_loaded(ui: &mut Ui, session: &mut Session) {
    let text =
        "Open a log, drop a file on the window, or record one yourself. Its channels, states and forces appear here.";
    empty_state(ui, "No recording yet", text, |ui| {
        if primary_button(ui, true, "Open a log …").on_hover_text("Ctrl+O").clicked() {
            files::ask(ui.ctx(), &mut session.jobs, Purpose::OpenLog);
        }
        if ui.link("or record one in Train").clicked() {
            session.workspace = Workspace::Train;
        }
    });
}

impl LogPanel {
    fn is_shown(&self, prepared: &Prepared, index: usize) -> bool {
        let group = &prepared.groups[index];
        self.switched.get(&group.title).copied().unwrap_or(group.shown)
    }

    fn header(&mut self, ui: &mut Ui, prepared: &Arc<Prepared>) {
        let p = palette(ui);
        ui.horizontal(|ui| {
            ui.label(theme::heading("Log"));
            ui.add_space(space::S);
            for (index, group) in prepared.groups.iter().enumerate() {
                let on = self.is_shown(prepared, index);
                let text = RichText::new(&group.title).size(11.5).color(if on { p.text } else { p.faint });
                let button = egui::Button::new(text).corner_radius(12).small().fill(if on { p.raised } else { p.card });
                let response = ui.add(button.stroke(Stroke::new(1.0, p.border)));
                if response.on_hover_text(if on { "Hide this plot" } else { "Show this plot" }).clicked() {
                    self.switched.insert(group.title.clone(), !on);
                }
            }
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                if ui.available_width() > 280.0 {
                    ui.label(theme::caption(ui, "wheel zooms · right drag moves · double click shows all"));
                }
            });
        });
        ui.add_space(space::XS);
    }

    /// Draws the plots; where their area lies horizontally.
    fn plots(&mut self, ui: &mut Ui, session: &mut Session, prepared: &Arc<Prepared>) -> Rangef {
        let shown: Vec<usize> = (0..prepared.groups.len()).filter(|i| self.is_shown(prepared, *i)).collect();
        let left = ui.max_rect().left() + GUTTER;
        let mut area = Rangef::new(left, ui.max_rect().right());
        if shown.is_empty() {
            return area;
        }
        ui.spacing_mut().item_spacing.y = 4.0;
        let n = shown.len() as f32;
        let room = ui.available_height() - FOOT - axis_height() - 4.0 * n;
        let height = (room / n).max(LEAST_HEIGHT);
        let replay = session.replay().cloned();
        let analysis = session.analysis.clone();
        let segmentation = analysis.as_ref().and_then(|a| a.segmentations.get(session.current)?.as_ref());
        for (place, index) in shown.iter().enumerate() {
            let last = place + 1 == shown.len();
            let input = RowInput {
                index: *index,
                group: &prepared.groups[*index],
                prepared,
                predicted: replay.as_ref().map_or(&[], |r| r.curves.as_slice()),
                segmentation,
                view_s: session.view_s,
                cursor_s: session.cursor_s,
                time_axis: last,
                height: if last { height + axis_height() } else { height },
            };
            let outcome = row(ui, &mut self.cache, &input);
            area = outcome.area;
            if let Some(view) = outcome.view_s {
                session.view_s = view;
            }
            if let Some(time) = outcome.seek {
                session.playing = false;
                session.seek(time);
            }
        }
        area
    }
}
