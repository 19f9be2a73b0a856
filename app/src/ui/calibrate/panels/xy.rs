//! The log as one signal against another: choice of both signals, colour, and the plot.

use crate::text::format;
use crate::text::states::state_name;
use crate::ui::document::prepared::{Group, Prepared, Trace};
use crate::ui::kit::theme;
use crate::ui::kit::theme::{palette, space};
use crate::ui::kit::widgets::{call, compact, segmented, swatch};
use crate::ui::plots::axes::AXIS_WIDTH;
use crate::ui::plots::choices::{PlotChoices, XyAxis, XyColor, name, unit_after};
use crate::ui::plots::curves::Sources;
use crate::ui::plots::derived::Recipe;
use crate::ui::plots::levels::Levels;
use crate::ui::plots::time_plot::GUTTER;
use crate::ui::plots::xy::{XyCache, XyInput, xy_plot};
use egui::{ComboBox, Rangef, ScrollArea, Sense, Ui, UiBuilder, vec2};
use estimator::segment::SystemState;
use estimator::signal::transform::Transform;
use std::sync::Arc;

/// Texts of this panel; a sentence with numbers is in the code that computes them.
mod words {
    pub const UPWARDS: &str = "Upwards";
    pub const TO_THE_RIGHT: &str = "To the right";
    pub const COLOUR: &str = "Colour";
    pub const FROM_DARK_TO_BRIGHT: &str = "From dark to bright in the course of the visible time";
    pub const BY_STATE: &str = "By state";
    pub const THE_CONTACT_STATE: &str = "The contact state";
    pub const BY_TIME: &str = "By time";
    pub const COLOUR_FROM_DARK: &str = "Colour: from dark to bright in the course of the visible time.";
}

/// Offered transforms of a signal.
const TRANSFORMS: [Transform; 5] =
    [Transform::None, Transform::Derivative, Transform::SecondDerivative, Transform::Integral, Transform::MinusMean];

/// Draws choosers and plot in place of the rows. Returns the horizontal extent of the time slider below, and the time
/// to which the user moved the cursor, s.
pub fn xy_view(
    ui: &mut Ui,
    cache: &mut XyCache,
    plots: &mut PlotChoices,
    sources: &Sources<'_>,
    (view_s, cursor_s): ((f64, f64), f64),
    height: f32,
) -> (Rangef, Option<f64>) {
    let prepared = sources.prepared;
    let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), height), Sense::hover());
    let (left, right) = rect.split_left_right_at_x(rect.left() + GUTTER);
    let area = Rangef::new(right.left() + AXIS_WIDTH, right.right());
    let Some((x_axis, y_axis)) = chosen(plots, prepared) else { return (area, None) };
    (plots.xy.x, plots.xy.y) = (Some(x_axis), Some(y_axis));
    ui.scope_builder(UiBuilder::new().max_rect(left).id_salt("xy gutter"), |ui| {
        // In a short plot the last choosers are reached by scrolling.
        let scroll = ScrollArea::vertical().id_salt("xy choices").max_height(height).min_scrolled_height(0.0);
        scroll.show(ui, |ui| gutter(ui, plots, sources, cursor_s));
    });
    let (Some(x_axis), Some(y_axis)) = (plots.xy.x.clone(), plots.xy.y.clone()) else { return (area, None) };
    let both = signal(plots, prepared, &x_axis).zip(signal(plots, prepared, &y_axis));
    let Some(((x, x_unit), (y, y_unit))) = both else {
        ui.scope_builder(UiBuilder::new().max_rect(right), |ui| ui.centered_and_justified(Ui::spinner));
        return (area, None);
    };
    let input = XyInput {
        prepared,
        x: &x,
        x_unit: &x_unit,
        y: &y,
        y_unit: &y_unit,
        color: plots.xy.color,
        segmentation: sources.analysis.map(|(_, segmentation)| segmentation),
        view_s,
        cursor_s,
    };
    let seek = ui
        .scope_builder(UiBuilder::new().max_rect(right).id_salt("xy plot"), |ui| {
            xy_plot(ui, cache, &input, right.size())
        })
        .inner;
    (area, seek)
}

/// Chosen signals as far as the recording has them; otherwise its first two.
fn chosen(plots: &PlotChoices, prepared: &Prepared) -> Option<(XyAxis, XyAxis)> {
    let axis = |group: &Group, trace: &Trace| XyAxis {
        group: group.key(),
        name: trace.name.clone(),
        transform: Transform::None,
    };
    let first = prepared.groups.first()?;
    let x = axis(first, first.traces.first()?);
    let y = match (first.traces.get(1), prepared.groups.get(1)) {
        (Some(trace), _) => axis(first, trace),
        (None, Some(second)) => axis(second, second.traces.first()?),
        (None, None) => XyAxis { transform: Transform::Derivative, ..x.clone() },
    };
    let still = |chosen: &Option<XyAxis>| chosen.clone().filter(|axis| find(prepared, axis).is_some());
    Some((still(&plots.xy.x).unwrap_or(x), still(&plots.xy.y).unwrap_or(y)))
}

fn find<'a>(prepared: &'a Prepared, axis: &XyAxis) -> Option<(&'a Group, &'a Trace)> {
    let group = prepared.groups.iter().find(|g| g.key() == axis.group)?;
    Some((group, group.traces.iter().find(|t| t.name == axis.name)?))
}

/// Curve of an axis and its unit; `None` while it is computed.
fn signal(plots: &mut PlotChoices, prepared: &Arc<Prepared>, axis: &XyAxis) -> Option<(Arc<Levels>, String)> {
    let (group, trace) = find(prepared, axis)?;
    let of = Arc::clone(&trace.levels);
    let recipe = Recipe { prepared: Arc::clone(prepared), of, less: None, transform: axis.transform };
    let unit = unit_after(&group.unit, axis.transform.order(), prepared.clockless());
    Some((plots.derived.get(&recipe)?, unit))
}

fn gutter(ui: &mut Ui, plots: &mut PlotChoices, sources: &Sources<'_>, cursor_s: f64) {
    ui.set_max_width(GUTTER - space::M);
    ui.spacing_mut().item_spacing.y = 5.0;
    ui.add_space(2.0);
    let prepared = sources.prepared;
    for (title, upwards) in [(words::UPWARDS, true), (words::TO_THE_RIGHT, false)] {
        ui.label(theme::caption(ui, title));
        let axis = if upwards { &mut plots.xy.y } else { &mut plots.xy.x };
        if let Some(axis) = axis {
            pick(ui, title, axis, prepared);
        }
        value(ui, plots, prepared, upwards, cursor_s);
        ui.add_space(space::XS);
    }
    if sources.analysis.is_some() {
        ui.label(theme::caption(ui, words::COLOUR));
        let hint = words::FROM_DARK_TO_BRIGHT;
        let choices =
            [(XyColor::State, words::BY_STATE, words::THE_CONTACT_STATE), (XyColor::Time, words::BY_TIME, hint)];
        segmented(ui, &mut plots.xy.color, &choices);
        if plots.xy.color == XyColor::State {
            states(ui, sources);
        }
    } else {
        plots.xy.color = XyColor::Time;
        ui.label(theme::caption(ui, words::COLOUR_FROM_DARK));
    }
}

fn pick(ui: &mut Ui, salt: &str, axis: &mut XyAxis, prepared: &Prepared) {
    let width = GUTTER - space::L - 2.0 * ui.spacing().button_padding.x;
    let label = |group: &Group, trace: &Trace| format!("{}: {}", group.title, trace.label);
    let now = find(prepared, axis).map_or_else(String::new, |(group, trace)| label(group, trace));
    let combo = ComboBox::from_id_salt(("xy signal", salt)).width(width).selected_text(now).truncate();
    let response = combo.show_ui(ui, |ui| {
        for group in &prepared.groups {
            for trace in &group.traces {
                let on = axis.group == group.key() && axis.name == trace.name;
                if ui.selectable_label(on, label(group, trace)).clicked() {
                    (axis.group, axis.name) = (group.key(), trace.name.clone());
                }
            }
        }
    });
    call(&response.response, &format!("{salt}: which signal"));
    response.response.on_hover_text(format!("{salt}: which signal"));
    let combo = ComboBox::from_id_salt(("xy transform", salt)).width(width).selected_text(name(axis.transform));
    let response = combo.show_ui(ui, |ui| {
        for transform in TRANSFORMS {
            ui.selectable_value(&mut axis.transform, transform, name(transform));
        }
    });
    call(&response.response, &format!("{salt}: what is made of it"));
    response.response.on_hover_text(format!("{salt}: what is made of it"));
}

/// Draws the value at the cursor.
fn value(ui: &mut Ui, plots: &mut PlotChoices, prepared: &Arc<Prepared>, upwards: bool, cursor_s: f64) {
    let axis = if upwards { plots.xy.y.clone() } else { plots.xy.x.clone() };
    let Some((levels, unit)) = axis.and_then(|axis| signal(plots, prepared, &axis)) else { return };
    let value = levels.samples(&prepared.recording).value(prepared.sample_at(cursor_s));
    let text = format!("{} {unit} at the cursor", format::significant(value, 4));
    ui.label(egui::RichText::new(text).size(11.5).color(palette(ui).text));
}

/// Draws the occurring states in their colours.
fn states(ui: &mut Ui, sources: &Sources<'_>) {
    let dark = ui.visuals().dark_mode;
    let mut seen: Vec<SystemState> = Vec::new();
    for interval in sources.analysis.iter().flat_map(|(_, s)| &s.states) {
        if !seen.contains(&interval.state) {
            seen.push(interval.state);
        }
    }
    for state in seen {
        compact(ui, |ui| {
            swatch(ui, theme::state_ink(dark, state));
            ui.label(theme::caption(ui, state_name(state)));
        });
    }
}
