//! The preview: the path or the curves, missing data, and warnings.

use crate::text::format;
use crate::ui::background::jobs::Jobs;
use crate::ui::column_mapping::preview::Seen;
use crate::ui::column_mapping::state::{Mapping, View};
use crate::ui::document::prepared::{Group, Prepared};
use crate::ui::kit::icons::Icon;
use crate::ui::kit::theme;
use crate::ui::kit::theme::{mix, palette, space};
use crate::ui::kit::widgets::{compact, fact, remark, sheet};
use crate::ui::plots::axes::{marks, time_axis, value_axis};
use crate::ui::plots::decimate::decimate;
use crate::ui::session::Session;
use egui::{RichText, ScrollArea, Ui};
use egui_plot::{Line, Plot, PlotPoint, PlotPoints};
use haptics::Vec2;
use render::ColorRole;

/// Draws the preview.
pub fn preview(ui: &mut Ui, mapping: &mut Mapping, jobs: &Jobs<Session>) {
    let stale = mapping.preview.is_stale(jobs);
    sheet(ui).inner_margin(space::M).show(ui, |ui| {
        ui.set_min_size(ui.available_size());
        // As tall as the headings of the cards beside it.
        compact(ui, |ui| {
            ui.set_min_height(16.0);
            ui.label(theme::heading("Preview"));
            if stale {
                ui.add(egui::Spinner::new().size(14.0));
                ui.label(theme::caption(ui, "reading …"));
            }
        });
        match &mapping.preview.seen {
            None => {}
            Some(Err(problem)) => {
                remark(ui, Icon::Wrong, problem);
            }
            Some(Ok(seen)) => {
                drawn(ui, &mut mapping.view, seen);
                verdict(ui, seen);
            }
        }
    });
}

fn drawn(ui: &mut Ui, view: &mut View, seen: &Seen) {
    let Some(prepared) = seen.recordings.first() else { return };
    let paths = paths(prepared);
    let automatic = if paths.is_empty() { View::Curves(0) } else { View::Path };
    let exists = match view {
        View::Automatic => false,
        View::Path => !paths.is_empty(),
        View::Curves(at) => *at < prepared.groups.len(),
    };
    let now = if exists { view.clone() } else { automatic };
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing.x = 4.0;
        let mut choices: Vec<View> = Vec::new();
        if !paths.is_empty() {
            choices.push(View::Path);
        }
        choices.extend((0..prepared.groups.len()).map(View::Curves));
        for choice in choices {
            let words = match choice {
                View::Curves(at) => tab(&prepared.groups[at]),
                _ => "Path".to_owned(),
            };
            if ui.selectable_label(now == choice, RichText::new(words).size(11.5)).clicked() {
                *view = choice;
            }
        }
    });
    let height = (0.42 * ui.available_height()).clamp(120.0, 330.0);
    match &now {
        View::Curves(at) => {
            if let Some(group) = prepared.groups.get(*at) {
                curves(ui, prepared, group, height);
            }
        }
        _ => path(ui, &paths, height),
    }
}

/// Tab label of a group; extra channels are distinguished by their unit.
fn tab(group: &Group) -> String {
    if group.title == "Other" && !group.unit.is_empty() { group.unit.clone() } else { group.title.clone() }
}

/// Paths of fingers or tool, mm.
fn paths(prepared: &Prepared) -> Vec<(ColorRole, Vec<PlotPoint>)> {
    let thinned = |position: &[Vec2]| {
        let at = |i: &usize| position.get(*i).map(|p| PlotPoint::new(1e3 * p.x, 1e3 * p.y));
        prepared.path_samples.iter().filter_map(at).collect()
    };
    let fingers = prepared.tips.iter().flatten().zip([ColorRole::Finger(0), ColorRole::Finger(1)]);
    let tool = prepared.tool.iter().map(|tool| (tool, ColorRole::Measured));
    fingers.chain(tool).map(|(series, role)| (role, thinned(&series.position))).collect()
}

fn frame<'a>(ui: &Ui, id: &str, height: f32) -> Plot<'a> {
    Plot::new(id)
        .height(height)
        .show_background(false)
        .show_x(false)
        .show_y(false)
        .allow_scroll(false)
        .grid_color(palette(ui).border)
        .grid_spacing(egui::Rangef::new(4.0, 40.0))
        .x_grid_spacer(|input| marks(input.bounds, 6.0))
        .y_grid_spacer(|input| marks(input.bounds, 5.0))
        .custom_y_axes(vec![value_axis(palette(ui), height)])
}

/// Horizontal axis in millimetres, labelled like the time axis.
fn value_axis_below(ui: &Ui) -> egui_plot::AxisHints<'static> {
    time_axis(palette(ui), true)
}

fn path(ui: &mut Ui, paths: &[(ColorRole, Vec<PlotPoint>)], height: f32) {
    let dark = ui.visuals().dark_mode;
    let axes = vec![value_axis_below(ui)];
    frame(ui, "mapping path", height).data_aspect(1.0).custom_x_axes(axes).show(ui, |plot| {
        for (role, points) in paths {
            let line = Line::new("", PlotPoints::Borrowed(points));
            plot.line(line.color(theme::role(dark, *role)).width(1.5).allow_hover(false));
        }
    });
    ui.label(theme::caption(ui, "in the plane, mm; y is up"));
}

fn curves(ui: &mut Ui, prepared: &Prepared, group: &Group, height: f32) {
    let dark = ui.visuals().dark_mode;
    let (from, to) = prepared.span();
    let columns = (ui.available_width() * ui.pixels_per_point()) as usize;
    let points: Vec<Vec<PlotPoint>> = group
        .traces
        .iter()
        .map(|t| decimate(&prepared.times, t.levels.samples(&prepared.recording), from, to, columns))
        .collect();
    let color = |at: usize| {
        let trace = &group.traces[at];
        let plain = theme::role(dark, trace.role);
        if trace.second { mix(plain, palette(ui).text, 0.4) } else { plain }
    };
    let colors: Vec<egui::Color32> = (0..points.len()).map(color).collect();
    let axes = vec![time_axis(palette(ui), prepared.clockless())];
    frame(ui, "mapping curves", height).custom_x_axes(axes).show(ui, |plot| {
        for (points, color) in points.iter().zip(&colors) {
            plot.line(Line::new("", PlotPoints::Borrowed(points)).color(*color).width(1.3).allow_hover(false));
        }
    });
    ui.horizontal_wrapped(|ui| {
        for (trace, color) in group.traces.iter().zip(&colors).take(8) {
            ui.label(RichText::new(&trace.label).size(11.5).color(*color));
        }
        let axis = if prepared.clockless() { "sample" } else { "s" };
        ui.label(theme::caption(
            ui,
            format!("{} over {axis}", if group.unit.is_empty() { "values" } else { &group.unit }),
        ));
    });
}

/// Draws the result: recordings, missing data, warnings.
fn verdict(ui: &mut Ui, seen: &Seen) {
    ui.add_space(space::XS);
    if let Some(first) = seen.recordings.first() {
        let recording = &first.recording;
        if seen.recordings.len() > 1 {
            fact(ui, "Recordings in the file", seen.recordings.len().to_string());
        }
        fact(ui, "Samples", recording.len().to_string());
        if let (Some(length), Some(rate)) = (recording.duration_s(), recording.rate_hz()) {
            fact(ui, "Length", format!("{length:.2} s at {} Hz", format::significant(rate, 3)));
        }
        fact(ui, "Task", first.task.map_or("not told yet".to_owned(), |t| t.name().replace('-', " ")));
    }
    ui.add_space(space::XS);
    ScrollArea::vertical().id_salt("mapping verdict").auto_shrink(false).show(ui, |ui| {
        match &seen.missing {
            Some(missing) => remark(ui, Icon::Wrong, missing),
            None => remark(ui, Icon::Good, "Nothing is missing: the log can be fitted."),
        };
        for warning in &seen.warnings {
            remark(ui, Icon::Doubt, warning);
        }
    });
}
