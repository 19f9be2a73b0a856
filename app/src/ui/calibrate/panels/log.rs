//! The log: plots with one time axis, the states under them, the time slider.

use crate::text::format::number;
use crate::ui::background::jobs::Jobs;
use crate::ui::calibrate::panels::loading_preview::incoming;
use crate::ui::calibrate::panels::overlay::{overlay_legend, overlay_menu};
use crate::ui::calibrate::panels::segments::band;
use crate::ui::calibrate::panels::transport::transport;
use crate::ui::calibrate::panels::xy::xy_view;
use crate::ui::calibrate::state::Calibration;
use crate::ui::calibrate::what_if_actions;
use crate::ui::diagnose::state::Diagnosing;
use crate::ui::document::file_kind::LOAD;
use crate::ui::document::files;
use crate::ui::document::overlays;
use crate::ui::document::prepared::Prepared;
use crate::ui::document::state::Document;
use crate::ui::headless::gallery::sample::Sample;
use crate::ui::headless::stage;
use crate::ui::kit::icons::Icon;
use crate::ui::kit::theme;
use crate::ui::kit::theme::{palette, space};
use crate::ui::kit::widgets::{empty_state, primary_button, segmented, sheet};
use crate::ui::plots::choices::{LogView, PlotChoices};
use crate::ui::plots::curves::{Drawn, Sources, can_compare, curves};
use crate::ui::plots::plot_cache::PlotCache;
use crate::ui::plots::plot_input::{RowInput, RowKind};
use crate::ui::plots::shift::Grasp;
use crate::ui::plots::time_plot::{GUTTER, axis_height, row};
use crate::ui::plots::xy::XyCache;
use crate::ui::session::Session;
use crate::ui::shell::dialogs;
use crate::ui::shell::panel::{Framing, PANEL, Panel, Picture, Registration};
use crate::ui::shell::panel_id::PanelId;
use crate::ui::shell::workspace::Workspace;
use egui::{Key, Modifiers, Rangef, RichText, ScrollArea, Stroke, Ui};
use egui_tiles::ContainerKind;
use std::sync::Arc;

/// Texts of this panel; a sentence with numbers is in the code that computes them.
mod words {
    pub const LOG: &str = "Log";
    pub const NO_RECORDING_YET_MORE: &str =
        "Open a log, drop a file on the window, or record one yourself. Its channels, states and forces appear here.";
    pub const NO_RECORDING_YET: &str = "No recording yet";
    pub const OPEN: &str = "Open a log …";
    pub const OPEN_KEYS: &str = "Ctrl+O";
    pub const OR_RECORD_ONE: &str = "or record one in Train";
    pub const TIME: &str = "Time";
    pub const CURVES_OVER_TIME: &str = "Curves over time";
    pub const XY_MORE: &str = "One signal against another";
    pub const WHEEL_ZOOMS_RIGHT: &str =
        "wheel zooms · right drag moves · Shift and drag marks a part · double click shows all";
    pub const HIDE_THIS_PLOT: &str = "Hide this plot";
    pub const SHOW_THIS_PLOT: &str = "Show this plot";
}

/// Minimum height of a plot, points.
const LEAST_HEIGHT: f32 = 56.0;
/// Height of the line with the name and the views, points.
const HEADER: f32 = 32.0;
/// Height of a residual plot relative to a plot of a quantity.
const LEFT_OVER_HEIGHT: f32 = 0.62;
/// Total height of band, subtasks, legend and slider, points.
const FOOT: f32 = 102.0;

/// The registration of this panel.
pub static REGISTRATION: Registration = Registration {
    workspaces: &[(Workspace::Calibrate, 2), (Workspace::Diagnose, 3)],
    neighbours: &[
        (PanelId::SCENE, ContainerKind::Vertical, false),
        (PanelId::VIDEO, ContainerKind::Vertical, false),
        (PanelId::DIAGNOSIS, ContainerKind::Tabs, false),
    ],
    pictures: &[&LOG, &XY, &LEFT_OVER],
    ..Registration::new(PanelId::LOG, "Plots", Icon::Curves, || Box::new(LogPanel::default()))
};

/// Plots, band and time slider.
pub static LOG: Picture = Picture {
    name: "log",
    place: 0,
    help: "Plots, band and time slider",
    line: "The log: curves by quantity, the states as a band, one time cursor",
    size: PANEL,
    sample: Sample::Stack,
    session: stage::fitted,
    framing: Framing::Panel(|| Box::new(LogPanel::default())),
};

/// One signal against another.
pub static XY: Picture = Picture {
    name: "xy",
    place: 10,
    help: "One signal against another",
    line: "XY: the force of a needle over its depth, coloured by state",
    size: PANEL,
    sample: Sample::Needle,
    session: stage::xy,
    framing: Framing::Panel(|| Box::new(LogPanel::default())),
};

/// Picture of the residual forces.
pub static LEFT_OVER: Picture = Picture {
    name: "left-over",
    place: 20,
    help: "What the models leave of the measured forces",
    line: "What is left over: measured less simulated, and less the extended model",
    size: PANEL,
    sample: Sample::Crank,
    session: stage::left_over,
    framing: Framing::Panel(|| Box::new(LogPanel::default())),
};

/// The log panel.
#[derive(Default)]
pub struct LogPanel {
    cache: PlotCache,
    xy: XyCache,
}

impl Panel for LogPanel {
    fn ui(&mut self, ui: &mut Ui, session: &mut Session) {
        sheet(ui).inner_margin(space::M).show(ui, |ui| {
            ui.set_min_size(ui.available_size());
            if let Some((preview, progress)) = session.jobs.preview(LOAD) {
                incoming(ui, preview, &progress);
                return;
            }
            let Some(prepared) = session.document.prepared().cloned() else {
                nothing_loaded(ui, &mut session.workspace, &mut session.jobs);
                return;
            };
            header(ui, &session.document, &mut session.plots, &prepared);
            overlay_legend(ui, session);
            // Taken out of the session for as long as both are read.
            let mut plots = std::mem::take(&mut session.plots);
            let area = match plots.view {
                LogView::Time => self.rows(ui, session, &mut plots, &prepared),
                LogView::Xy => {
                    self.xy(ui, &mut session.document, &session.calibration, &session.diagnosing, &mut plots, &prepared)
                }
            };
            let job = plots.derived.settle(ui.ctx(), &mut session.jobs, |session| &mut session.plots.derived);
            if let Some(job) = job {
                job.if_given_up(|session, _| session.plots.give_up());
            }
            session.plots = plots;
            band(ui, &mut session.document, &mut session.calibration, &session.jobs, area);
            transport(ui, &mut session.document, &session.calibration, area);
        });
    }
}

/// Plot to draw: its group, its content, its share of the height.
struct Place {
    group: usize,
    kind: RowKind,
    drawn: Drawn,
}

impl Place {
    fn share(&self) -> f32 {
        if self.kind == RowKind::LeftOver { LEFT_OVER_HEIGHT } else { 1.0 }
    }
}

fn nothing_loaded(ui: &mut Ui, workspace: &mut Workspace, jobs: &mut Jobs<Session>) {
    let text = words::NO_RECORDING_YET_MORE;
    empty_state(ui, (Icon::Curves, words::NO_RECORDING_YET), text, |ui| {
        if primary_button(ui, true, (Icon::Open, words::OPEN)).on_hover_text(words::OPEN_KEYS).clicked() {
            files::ask(ui.ctx(), jobs, dialogs::OPEN_LOG);
        }
        if ui.link(words::OR_RECORD_ONE).clicked() {
            *workspace = Workspace::Train;
        }
    });
}

fn header(ui: &mut Ui, document: &Document, plots: &mut PlotChoices, prepared: &Arc<Prepared>) {
    ui.horizontal_wrapped(|ui| {
        // As tall as the tallest, so that the rest is centred.
        ui.set_min_height(HEADER);
        ui.label(theme::heading(words::LOG));
        ui.add_space(space::S);
        let choices = [(LogView::Time, words::TIME, words::CURVES_OVER_TIME), (LogView::Xy, "XY", words::XY_MORE)];
        segmented(ui, &mut plots.view, &choices);
        if plots.view == LogView::Time {
            chips(ui, plots, prepared);
            overlay_menu(ui, document, plots);
            if ui.available_size_before_wrap().x > 480.0 {
                ui.add_space(space::L);
                ui.label(theme::caption(ui, words::WHEEL_ZOOMS_RIGHT));
            }
        }
    });
    ui.add_space(space::XS);
}

/// Draws the chips that select the plotted quantities.
fn chips(ui: &mut Ui, plots: &mut PlotChoices, prepared: &Prepared) {
    let p = palette(ui);
    for group in &prepared.groups {
        let on = plots.is_shown(group);
        let text = RichText::new(&group.title).size(11.5).color(if on { p.text } else { p.faint });
        let button = egui::Button::new(text).corner_radius(12).small().fill(if on { p.raised } else { p.card });
        let response = ui.add(button.stroke(Stroke::new(1.0, p.border)));
        if response.on_hover_text(if on { words::HIDE_THIS_PLOT } else { words::SHOW_THIS_PLOT }).clicked() {
            plots.of(group).shown = Some(!on);
        }
    }
}

/// Sources of the shown recording's curves.
fn sources<'a>(
    document: &'a Document,
    calibration: &'a Calibration,
    diagnosing: &'a Diagnosing,
    prepared: &'a Arc<Prepared>,
) -> Sources<'a> {
    let analysis = calibration.analysis.as_ref();
    Sources {
        recordings: &document.recordings,
        prepared,
        simulated: what_if_actions::shown_curves(document, calibration),
        extended: diagnosing.replay(document.current),
        analysis: analysis.and_then(|a| Some((a, a.segmentations.get(document.current)?.as_ref()?))),
    }
}

fn places(sources: &Sources<'_>, plots: &mut PlotChoices, prepared: &Prepared) -> Vec<Place> {
    let mut places = Vec::new();
    for (index, group) in prepared.groups.iter().enumerate() {
        if !plots.is_shown(group) {
            continue;
        }
        let (main, left) = curves(sources, plots, group);
        places.push(Place { group: index, kind: RowKind::Curves, drawn: main });
        places.extend(left.map(|drawn| Place { group: index, kind: RowKind::LeftOver, drawn }));
    }
    places
}

/// Shift of the dragged recording as text, with true if it snapped; and index of the dragged or hovered recording.
fn under_hand(plots: &PlotChoices, clockless: bool) -> (Option<(String, bool)>, Option<usize>) {
    let Some(held) = plots.held else { return (None, plots.pointed) };
    let place = plots.overlaid.iter().position(|o| o.recording == held.recording);
    let offset = place.map_or(0.0, |place| plots.overlaid[place].offset_s);
    let sign = if offset > 0.0 { "+" } else { "" };
    let shift = if clockless { format!("{sign}{offset:.0} samples") } else { format!("{sign}{} s", number(offset, 3)) };
    let words = if held.snapped { format!("{shift}: most alike") } else { shift };
    (Some((words, held.snapped)), place)
}

/// Shifts the dragged recording. Returns the time of a curve that was only clicked.
fn shifting(
    ui: &Ui,
    document: &mut Document,
    jobs: &mut Jobs<Session>,
    plots: &mut PlotChoices,
    grasp: Option<Grasp>,
    area: Rangef,
) -> Option<f64> {
    plots.pointed = if let Some(Grasp::Over(place) | Grasp::Takes(place, _)) = grasp { Some(place) } else { None };
    let clockless = document.prepared().is_some_and(|p| p.clockless());
    if let Some(recording) = grasp.and_then(|grasp| plots.grasp(grasp, document.current, clockless)) {
        document.playing = false;
        overlays::find_likeliest(document, jobs, ui.ctx(), &plots.likeliest, recording);
    }
    if plots.held.is_some() && ui.input_mut(|i| i.consume_key(Modifiers::NONE, Key::Escape)) {
        plots.take_back();
    }
    if plots.held.is_none() || ui.input(|i| i.pointer.primary_down()) {
        return None;
    }
    let clicked = plots.let_go();
    let x = ui.input(|i| i.pointer.latest_pos()).filter(|_| clicked)?.x;
    let share = f64::from((x - area.min) / area.span().max(1.0));
    Some(document.view_s.0 + share * (document.view_s.1 - document.view_s.0))
}

impl LogPanel {
    /// Draws one signal against another. Returns the horizontal extent of the slider below.
    fn xy(
        &mut self,
        ui: &mut Ui,
        document: &mut Document,
        calibration: &Calibration,
        diagnosing: &Diagnosing,
        plots: &mut PlotChoices,
        prepared: &Arc<Prepared>,
    ) -> Rangef {
        let height = (ui.available_height() - FOOT).max(LEAST_HEIGHT);
        let times = (document.view_s, document.cursor_s);
        let (area, seek) =
            xy_view(ui, &mut self.xy, plots, &sources(document, calibration, diagnosing, prepared), times, height);
        if let Some(time) = seek {
            document.playing = false;
            document.seek(time);
        }
        area
    }

    /// Draws the plots. Returns the horizontal extent of their area.
    fn rows(
        &mut self,
        ui: &mut Ui,
        session: &mut Session,
        plots: &mut PlotChoices,
        prepared: &Arc<Prepared>,
    ) -> Rangef {
        let left = ui.max_rect().left() + GUTTER;
        let mut area = Rangef::new(left, ui.max_rect().right());
        let places =
            places(&sources(&session.document, &session.calibration, &session.diagnosing, prepared), plots, prepared);
        if places.is_empty() {
            return area;
        }
        ui.spacing_mut().item_spacing.y = 4.0;
        let (held, grasped) = under_hand(plots, prepared.clockless());
        let shares: f32 = places.iter().map(Place::share).sum();
        let room = ui.available_height() - FOOT;
        let each = ((room - axis_height() - 4.0 * places.len() as f32) / shares).max(LEAST_HEIGHT);
        // The wheel zooms; only the bar scrolls, if there are more plots than space.
        let scroll =
            ScrollArea::vertical().id_salt("plots").max_height(room.max(LEAST_HEIGHT)).auto_shrink([false, true]);
        scroll.scroll_source(egui::scroll_area::ScrollSource::SCROLL_BAR).show(ui, |ui| {
            let (mut seek, mut view_s, mut grasp) = (None, None, None);
            for (index, place) in places.iter().enumerate() {
                let group = &prepared.groups[place.group];
                let sources = sources(&session.document, &session.calibration, &session.diagnosing, prepared);
                let last = index + 1 == places.len();
                let input = RowInput {
                    index,
                    held: held.clone(),
                    grasped,
                    kind: place.kind,
                    group,
                    prepared,
                    drawn: &place.drawn,
                    has_simulated: can_compare(sources.simulated, group),
                    has_extended: can_compare(sources.extended, group),
                    segmentation: sources.analysis.map(|(_, segmentation)| segmentation),
                    view_s: session.document.view_s,
                    cursor_s: session.document.cursor_s,
                    time_axis: last,
                    height: each * place.share() + if last { axis_height() } else { 0.0 },
                };
                let outcome = row(ui, &mut self.cache, plots.of(group), &input);
                (seek, view_s) = (outcome.seek.or(seek), outcome.view_s.or(view_s));
                session.calibration.choice.only_s = outcome.part_s.or(session.calibration.choice.only_s);
                (area, grasp) = (outcome.area, grasp.or(outcome.grasp));
            }
            seek = seek.or(shifting(ui, &mut session.document, &mut session.jobs, plots, grasp, area));
            if let Some(view) = view_s {
                session.document.view_s = view;
            }
            if let Some(time) = seek {
                session.document.playing = false;
                session.document.seek(time);
            }
        });
        area
    }
}
