//! The segmentation: a coloured band of states, the subtasks under it, a legend.

use crate::text::format;
use crate::text::states::{state_of_task, state_short};
use crate::ui::background::jobs::Jobs;
use crate::ui::calibrate::manual_states;
use crate::ui::calibrate::panels::boundaries;
use crate::ui::calibrate::panels::rules_table::parameter;
use crate::ui::calibrate::refits::FIT;
use crate::ui::calibrate::state::Calibration;
use crate::ui::document::state::Document;
use crate::ui::headless::gallery::sample::Sample;
use crate::ui::headless::stage;
use crate::ui::kit::icons::Icon;
use crate::ui::kit::theme;
use crate::ui::kit::theme::{palette, space, state_color};
use crate::ui::kit::widgets::{card, compact, empty_state, swatch};
use crate::ui::session::Session;
use crate::ui::shell::panel::{Framing, PANEL, Panel, Picture, Registration};
use crate::ui::shell::panel_id::PanelId;
use crate::ui::shell::workspace::Workspace;
use egui::{
    Align, Align2, FontId, Layout, Pos2, Rangef, Rect, Response, RichText, Sense, Stroke, StrokeKind, Ui, vec2,
};
use egui_extras::{Column, TableBuilder};
use egui_tiles::ContainerKind;
use estimator::segment::agreement::Score;
use estimator::segment::{Interval, Segmentation, SystemState};
use std::ops::Range;

/// Texts of this panel; a sentence with numbers is in the code that computes them.
mod words {
    pub const STATES_AND_SUBTASKS: &str = "States and subtasks";
    pub const NUMBERS_OF_STATES: &str = "1 free motion, 2 hold above ground, 3 hold on ground, x sliding, 0 none";
    pub const NO_STATES_YET: &str = "No states yet";
    pub const NO_STATES_YET_MORE: &str = "Open a recording; its states are told from motion and force.";
    pub const STATES: &str = "States";
    pub const FITTING: &str = "Fitting …";
    pub const NO_STATES_THEY: &str = "No states: they are told from velocities, and this log has no clock.";
    pub const NO_STATES_WERE: &str = "No states were told in this recording.";
    pub const NO_STATES_THE_FIT: &str = "No states: the fit did not succeed.";
    pub const SUBTASKS: &str = "Subtasks";
    pub const MEAN_PROBABILITY: &str = "mean probability";
    pub const SAMPLES_SHOW_IT: &str = "of its samples show this state by themselves";
    pub const AGAINST_THE_LABELS: &str = "Against the labels of this recording";
    pub const LABELS_ARE_ONLY: &str = "Labels are only compared; nothing is estimated from them.";
    pub const FROM: &str = "From";
    pub const LENGTH: &str = "Length";
    pub const STATE: &str = "State";
    pub const SUBTASK: &str = "Subtask";
    pub const NO_STATES_TAKEN: &str = "The fit of this task takes no states; a right click fits this stretch alone.";
}

/// Height of the band, points.
const BAND: f32 = 22.0;
/// Minimum width of a word, points.
const LEAST_WORD: f32 = 14.0;
/// Height of a line of the list, points.
const LINE: f32 = 21.0;
/// Height of the subtasks' line, points.
const SUBTASKS: f32 = 18.0;

/// The registration of this panel.
pub static REGISTRATION: Registration = Registration {
    workspaces: &[(Workspace::Calibrate, 4), (Workspace::Diagnose, 4)],
    neighbours: &[(PanelId::RESULTS, ContainerKind::Tabs, false), (PanelId::DIAGNOSIS, ContainerKind::Tabs, false)],
    pictures: &[&SEGMENTS],
    ..Registration::new(PanelId::SEGMENTS, "States", Icon::States, || Box::new(SegmentsPanel))
};

/// States and subtasks.
pub static SEGMENTS: Picture = Picture {
    name: "segments",
    place: 30,
    help: "States and subtasks",
    line: "Segments: what was done when, found in the recording",
    size: PANEL,
    sample: Sample::Stack,
    session: stage::fitted,
    framing: Framing::Panel(|| Box::new(SegmentsPanel)),
};

/// Panel of the segmentation alone.
#[derive(Default)]
pub struct SegmentsPanel;

impl Panel for SegmentsPanel {
    fn ui(&mut self, ui: &mut Ui, session: &mut Session) {
        let sequence =
            session.calibration.segmentation(session.document.current).map(Segmentation::sequence).unwrap_or_default();
        card(
            ui,
            words::STATES_AND_SUBTASKS,
            |ui| {
                if !sequence.is_empty() {
                    ui.label(theme::caption(ui, format!("sequence {}", spaced(&sequence))))
                        .on_hover_text(words::NUMBERS_OF_STATES);
                }
            },
            |ui| {
                if session.calibration.segmentation(session.document.current).is_none() {
                    empty_state(ui, (Icon::States, words::NO_STATES_YET), words::NO_STATES_YET_MORE, |_| {});
                    return;
                }
                let left = ui.max_rect().left() + 76.0;
                let area = Rangef::new(left, ui.max_rect().right());
                band(ui, &mut session.document, &mut session.calibration, &session.jobs, area);
                ui.add_space(space::S);
                intervals(ui, &mut session.document, &session.calibration);
            },
        );
    }
}

fn spaced(sequence: &str) -> String {
    sequence.chars().flat_map(|c| [c, ' ']).collect::<String>().trim_end().to_owned()
}

/// Draws the band between the given edges, with its names to the left, and the legend below.
pub fn band(ui: &mut Ui, document: &mut Document, calibration: &mut Calibration, jobs: &Jobs<Session>, area: Rangef) {
    let busy = jobs.is_running(FIT);
    let analysis = calibration.analysis.clone();
    let segmentation = analysis.as_ref().and_then(|a| a.segmentations.get(document.current)?.as_ref());
    let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), BAND + SUBTASKS + 2.0), Sense::hover());
    let p = palette(ui);
    let label = |y: f32, text: &str| {
        ui.painter().text(
            Pos2::new(rect.left(), y),
            Align2::LEFT_CENTER,
            text,
            FontId::proportional(11.5),
            p.secondary,
        );
    };
    let band = Rect::from_x_y_ranges(area, rect.top()..=rect.top() + BAND);
    label(band.center().y, words::STATES);
    ui.painter().rect_filled(band, 4, p.sunken);
    let Some(segmentation) = segmentation else {
        let clockless = document.prepared().is_some_and(|p| p.clockless());
        let text = match (busy, clockless, analysis.is_some()) {
            (true, ..) => words::FITTING,
            (_, true, _) => words::NO_STATES_THEY,
            (_, _, true) => words::NO_STATES_WERE,
            _ => words::NO_STATES_THE_FIT,
        };
        ui.painter().text(band.center(), Align2::CENTER_CENTER, text, FontId::proportional(11.5), p.faint);
        return;
    };
    label(band.bottom() + 2.0 + 0.5 * SUBTASKS, words::SUBTASKS);
    draw_states(ui, document, calibration, segmentation, band);
    draw_subtasks(ui, document, segmentation, Rect::from_x_y_ranges(area, band.bottom() + 2.0..=rect.bottom()));
    legend(ui, segmentation, area.min - rect.left());
}

fn x_of(document: &Document, area: Rangef, time: f64) -> f32 {
    let (from, to) = document.view_s;
    let share = ((time - from) / (to - from).max(1e-12)).clamp(-1.0, 2.0);
    (area.min + share as f32 * area.span()).clamp(area.min, area.max)
}

fn draw_states(
    ui: &mut Ui,
    document: &mut Document,
    calibration: &mut Calibration,
    segmentation: &Segmentation,
    band: Rect,
) {
    let (mut seek, mut change) = (None, None);
    let can_be_set = manual_states::states_can_be_set(calibration);
    let fits_without_states = manual_states::fits_without_states(document, calibration);
    let some_menu_is_open = egui::Popup::is_any_open(ui.ctx());
    for (index, interval) in segmentation.states.iter().enumerate() {
        let (left, right) = (x_of(document, band.x_range(), interval.t0), x_of(document, band.x_range(), interval.t1));
        if right - left < 0.4 {
            continue;
        }
        let rect = Rect::from_x_y_ranges(left..=(right - 0.5).max(left + 0.5), band.y_range());
        let response = draw_state(ui, rect, segmentation, index);
        // Menus and tooltips of hundreds of states would take most of the frame time.
        if !response.hovered() && !response.clicked() && !some_menu_is_open {
            continue;
        }
        if response.hovered() {
            ui.painter().rect_stroke(rect, 3, Stroke::new(1.5, palette(ui).text), StrokeKind::Inside);
        }
        if response.clicked() {
            seek = ui.input(|i| i.pointer.interact_pos()).map(|at| {
                let share = f64::from((at.x - band.left()) / band.width());
                document.view_s.0 + share * (document.view_s.1 - document.view_s.0)
            });
        }
        if can_be_set {
            change = change.or(boundaries::menu(&response, segmentation, index, document));
        } else if fits_without_states {
            boundaries::stretch_menu(&response, (interval.t0, interval.t1), calibration);
        }
        let by_model = segmentation.posterior.is_some();
        let shows = segmentation.shows.get(interval.state.name()).map_or(&[][..], Vec::as_slice);
        response.on_hover_ui(|ui| {
            tooltip(ui, interval, state_of_task(segmentation, interval.state), shows, by_model);
            if fits_without_states {
                ui.label(theme::caption(ui, words::NO_STATES_TAKEN));
            }
        });
    }
    if can_be_set {
        change = change.or(boundaries::handles(ui, document.view_s, segmentation, band));
    }
    if let Some(change) = &change {
        manual_states::set_states(document, calibration, change);
    }
    if let Some(time) = seek {
        document.seek(time);
    }
    let x = x_of(document, band.x_range(), document.cursor_s);
    ui.painter().vline(x, band.y_range(), Stroke::new(1.6, palette(ui).accent));
}

/// Draws one state as a box with its name.
fn draw_state(ui: &Ui, rect: Rect, segmentation: &Segmentation, index: usize) -> Response {
    let state = segmentation.states[index].state;
    let color = state_color(ui.visuals().dark_mode, state);
    ui.painter().rect_filled(rect, if rect.width() > 8.0 { 3 } else { 0 }, color);
    let ink = theme::ink_on(color);
    if rect.width() > LEAST_WORD && !caption(ui, rect, state_of_task(segmentation, state), ink) {
        caption(ui, rect, state_short(state), ink);
    }
    let response = ui.interact(rect, ui.scope_id().with(("state", index)), Sense::click());
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, state_of_task(segmentation, state)));
    response
}

/// Draws text in a box if it fits.
fn caption(ui: &Ui, rect: Rect, text: &str, ink: egui::Color32) -> bool {
    let galley = ui.painter().layout_no_wrap(text.to_owned(), FontId::proportional(11.0), ink);
    let fits = galley.size().x + 6.0 < rect.width();
    if fits {
        let at = rect.center() - 0.5 * galley.size();
        ui.painter().galley(at, galley, ink);
    }
    fits
}

fn tooltip(ui: &mut Ui, interval: &Interval, state: &str, shows: &[String], by_model: bool) {
    ui.set_max_width(320.0);
    ui.label(theme::strong(state));
    if let Some(subtask) = &interval.subtask {
        ui.label(format!("Subtask: {}", format::object(subtask).to_lowercase()));
    }
    let (from, to) = (format::number(interval.t0, 2), format::number(interval.t1, 2));
    ui.label(theme::caption(ui, format!("{from} to {to} s · {} s", format::number(interval.t1 - interval.t0, 2))));
    if !shows.is_empty() {
        let words: Vec<String> = shows.iter().map(|name| parameter(name).to_lowercase()).collect();
        ui.label(theme::caption(ui, format!("Shows: {}", words.join(", "))));
    }
    let share = format::number(100.0 * interval.probability, 0);
    let text = if by_model { words::MEAN_PROBABILITY } else { words::SAMPLES_SHOW_IT };
    ui.label(theme::caption(ui, format!("{share} % {text}")));
}

/// Runs of adjacent intervals of one subtask, each as one bracket.
fn runs(segmentation: &Segmentation) -> Vec<(Range<f64>, String)> {
    let mut runs: Vec<(Range<f64>, String)> = Vec::new();
    for interval in &segmentation.states {
        let Some(subtask) = &interval.subtask else { continue };
        match runs.last_mut() {
            Some((range, name)) if name == subtask => range.end = interval.t1,
            _ => runs.push((interval.t0..interval.t1, subtask.clone())),
        }
    }
    runs
}

fn draw_subtasks(ui: &mut Ui, document: &Document, segmentation: &Segmentation, line: Rect) {
    let p = palette(ui);
    for (range, name) in runs(segmentation) {
        let (left, right) = (x_of(document, line.x_range(), range.start), x_of(document, line.x_range(), range.end));
        if right - left < 3.0 {
            continue;
        }
        let y = line.top() + 2.0;
        ui.painter().hline(left + 1.5..=right - 1.5, y, Stroke::new(1.5, p.faint));
        let name = format::object(&name);
        let rect = Rect::from_x_y_ranges(left..=right, line.top() + 3.0..=line.bottom());
        caption(ui, rect, &name, p.secondary);
        let response = ui.interact(rect, ui.scope_id().with(("subtask", &name)), Sense::hover());
        if response.hovered() {
            response.on_hover_text(name);
        }
    }
}

fn legend(ui: &mut Ui, segmentation: &Segmentation, indent: f32) {
    let dark = ui.visuals().dark_mode;
    let mut present: Vec<SystemState> = Vec::new();
    for interval in &segmentation.states {
        if !present.contains(&interval.state) {
            present.push(interval.state);
        }
    }
    compact(ui, |ui| {
        // If the band is too short for the legend, the legend starts at the left edge.
        if ui.available_width() - indent > 125.0 * present.len() as f32 {
            ui.add_space(indent - ui.spacing().item_spacing.x);
        }
        for state in present {
            let total: f64 = segmentation.states.iter().filter(|i| i.state == state).map(|i| i.t1 - i.t0).sum();
            swatch(ui, state_color(dark, state));
            ui.label(theme::caption(ui, state_of_task(segmentation, state)))
                .on_hover_text(format!("{} s in all", format::number(total, 1)));
            ui.add_space(space::XS);
        }
        if let Some(score) = &segmentation.score {
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| agreement(ui, score));
        }
    });
}

/// Draws the agreement of the states with the labels of the recording.
fn agreement(ui: &mut Ui, score: &Score) {
    let text = format!(
        "labels: {} % agree, boundaries F1 {}",
        format::number(100.0 * score.accuracy, 1),
        format::number(score.boundary_f1, 2)
    );
    if ui.available_width() < 190.0 {
        return;
    }
    ui.label(theme::caption(ui, text)).on_hover_ui(|ui| {
        ui.label(theme::strong(words::AGAINST_THE_LABELS));
        let within = format::number(score.tolerance_s, 2);
        ui.label(theme::caption(ui, format!("{} labelled boundaries, found within {within} s", score.boundaries)));
        for (state, one) in &score.states {
            let f1 = format::number(one.f1, 3);
            ui.label(theme::caption(ui, format!("{}: F1 by samples {f1}", format::object(state))));
        }
        ui.label(theme::caption(ui, words::LABELS_ARE_ONLY));
    });
}

/// Draws all intervals as a list: for reading, and for the screenshot of this panel.
fn intervals(ui: &mut Ui, document: &mut Document, calibration: &Calibration) {
    let analysis = calibration.analysis.clone();
    let Some(segmentation) = analysis.as_ref().and_then(|a| a.segmentations.get(document.current)?.as_ref()) else {
        return;
    };
    let dark = ui.visuals().dark_mode;
    let mut seek = None;
    let elided = |ui: &mut Ui, text: RichText| drop(ui.add(egui::Label::new(text).truncate()));
    let p = palette(ui);
    // In a narrow panel, states and subtasks share the width.
    let state = (0.34 * ui.available_width()).clamp(60.0, 130.0);
    TableBuilder::new(ui)
        .id_salt("intervals")
        .auto_shrink([false, true])
        .min_scrolled_height(0.0)
        .cell_layout(Layout::left_to_right(Align::Center))
        .column(Column::exact(10.0))
        .columns(Column::exact(54.0), 2)
        .column(Column::exact(state))
        .column(Column::remainder().clip(true))
        .header(LINE, |mut header| {
            for text in ["", words::FROM, words::LENGTH, words::STATE, words::SUBTASK] {
                header.col(|ui| elided(ui, theme::caption(ui, text)));
            }
        })
        .body(|body| {
            body.rows(LINE, segmentation.states.len(), |mut row| {
                let interval = &segmentation.states[row.index()];
                row.col(|ui| drop(swatch(ui, state_color(dark, interval.state))));
                row.col(|ui| {
                    if ui.link(format!("{} s", format::number(interval.t0, 2))).clicked() {
                        seek = Some(interval.t0);
                    }
                });
                row.col(|ui| drop(ui.label(format!("{} s", format::number(interval.t1 - interval.t0, 2)))));
                row.col(|ui| elided(ui, RichText::new(state_of_task(segmentation, interval.state))));
                let subtask = interval.subtask.as_deref().map(format::object).unwrap_or_default();
                row.col(|ui| elided(ui, RichText::new(subtask).color(p.secondary)));
            });
        });
    if let Some(time) = seek {
        document.seek(time);
    }
}
