//! The column left of a plot: title with its menu, unit, curves with their values at the cursor.

use crate::text::format;
use crate::ui::kit::theme;
use crate::ui::kit::theme::{palette, space};
use crate::ui::plots::choices::GroupChoice;
use crate::ui::plots::curves::{Curve, Layer, NOISE_SWITCH};
use crate::ui::plots::plot_input::{RowInput, RowKind, curve_color};
use crate::ui::plots::title_menu::title_menu;
use egui::{Align, Color32, FontId, Layout, RichText, Sense, Stroke, Ui, UiBuilder, vec2};

/// Height of an entry, points.
const LINE: f32 = 14.0;
/// Empty space below its text, points.
const BELOW: f32 = 2.0;
/// Font size of its text, points.
const WORDS: f32 = 11.5;
/// Minimum width of a name, points: not even one letter is readable in less.
const LEAST_NAME: f32 = 14.0;

/// One line of the gutter.
struct Entry<'a> {
    label: String,
    /// Short text for the layout in two columns.
    brief: Option<String>,
    hint: String,
    color: Color32,
    width: f32,
    /// Name of the visibility switch that a click toggles.
    switch: &'a str,
    /// Curve of the displayed value.
    curve: Option<&'a Curve>,
}

/// Draws the gutter; clicks change the choice.
pub fn gutter(ui: &mut Ui, choice: &mut GroupChoice, input: &RowInput<'_>) {
    ui.spacing_mut().item_spacing = vec2(6.0, 0.0);
    ui.add_space(2.0);
    head(ui, choice, input);
    let entries = entries(ui, input);
    // Whole lines: half a line cannot be read. The last line needs no space below its text.
    let room = ((ui.available_height() + BELOW) / LINE).floor().max(1.0) * LINE;
    let sample = input.prepared.sample_at(input.cursor_s);
    let scroll = egui::ScrollArea::vertical().id_salt(("curves", input.index)).min_scrolled_height(0.0);
    scroll.max_height(room).show(ui, |ui| {
        ui.spacing_mut().interact_size.y = LINE;
        // Two columns where one would not fit.
        let columns = if entries.len() as f32 * LINE > room { 2 } else { 1 };
        let width = (ui.available_width() - space::S) / columns as f32;
        for line in entries.chunks(columns) {
            ui.horizontal(|ui| {
                for entry in line {
                    let size = vec2(width - 4.0, LINE);
                    ui.allocate_ui(size, |ui| {
                        ui.set_min_size(size);
                        show(ui, choice, input, entry, sample, columns > 1);
                    });
                }
            });
        }
    });
}

fn head(ui: &mut Ui, choice: &mut GroupChoice, input: &RowInput<'_>) {
    ui.horizontal(|ui| {
        ui.spacing_mut().interact_size.y = 18.0;
        match input.kind {
            RowKind::Curves => title_menu(ui, choice, input),
            RowKind::LeftOver => {
                let hint = "What is left of the measured curve when the model's is taken away";
                ui.label(theme::strong("Left over")).on_hover_text(hint);
            }
        }
        ui.label(theme::caption(ui, &input.drawn.unit));
        if input.drawn.pending {
            ui.add(egui::Spinner::new().size(11.0)).on_hover_text("The curves are being computed.");
            ui.ctx().request_repaint_after(std::time::Duration::from_millis(200));
        }
    });
}

fn entries<'a>(ui: &Ui, input: &RowInput<'a>) -> Vec<Entry<'a>> {
    let (dark, p) = (ui.visuals().dark_mode, palette(ui));
    match input.kind {
        RowKind::Curves => {
            let traces = input.group.traces.iter().enumerate().map(|(t, trace)| Entry {
                label: trace.label.clone(),
                brief: None,
                hint: trace.name.clone(),
                color: theme::curve(dark, trace.role, trace.second),
                width: 2.5,
                switch: &trace.name,
                curve: input.drawn.curves.iter().find(|c| c.trace == t && c.layer == Layer::Measured),
            });
            traces.chain(layers(ui, input)).collect()
        }
        RowKind::LeftOver => input
            .drawn
            .curves
            .iter()
            .map(|curve| {
                let trace = &input.group.traces[curve.trace];
                let (model, switch) = match curve.layer {
                    Layer::LeftExtended => ("extended", "layer: extended"),
                    _ => ("simulated", "layer: simulated"),
                };
                Entry {
                    label: if input.group.traces.len() > 1 {
                        format!("{} − {model}", trace.label)
                    } else {
                        format!("− {model}")
                    },
                    // The force plot explains the abbreviations.
                    brief: Some(format!("{}, {}", trace.label, &model[..3])),
                    hint: format!("{} measured less {model}", trace.name),
                    color: curve_color(input, curve, dark, p),
                    width: 2.5,
                    switch,
                    curve: Some(curve),
                }
            })
            .collect(),
    }
}

/// Entries of the models and of the noise band.
fn layers<'a>(ui: &Ui, input: &RowInput<'a>) -> Vec<Entry<'a>> {
    let inks = crate::ui::plots::residual_plot::inks(ui);
    let entry = |label: &str, hint: &str, color, width, switch| Entry {
        label: label.to_owned(),
        brief: None,
        hint: hint.to_owned(),
        color,
        width,
        switch,
        curve: None,
    };
    let mut found = Vec::new();
    if input.has_simulated {
        let hint = "The measured motion in the fitted world";
        found.push(entry("simulated", hint, inks.model.gamma_multiply(0.75), 5.0, "layer: simulated"));
    }
    if input.has_extended {
        let hint = "The measured motion in the world with what the diagnosis found";
        found.push(entry("extended", hint, inks.extended, 2.5, "layer: extended"));
    }
    if let Some(sigma) = input.drawn.curves.iter().filter_map(|c| c.sigma).reduce(f64::max) {
        let hint = format!(
            "Two standard deviations of the sensor's noise to either side of the model, up to ± {} {}: what is measured \
             should stay inside. Told from the phases in which nothing is touched, or from the fastest part of the curve",
            format::significant(2.0 * sigma, 2),
            input.drawn.unit
        );
        found.push(entry("noise ±2σ", &hint, inks.noise, 9.0, NOISE_SWITCH));
    }
    found
}

/// Swatch, name and value at the cursor; a click hides or shows.
fn show(ui: &mut Ui, choice: &mut GroupChoice, input: &RowInput<'_>, entry: &Entry<'_>, sample: usize, narrow: bool) {
    let shown = choice.shows(entry.switch);
    let p = palette(ui);
    let value = value_words(input, entry, sample, narrow).filter(|_| shown).unwrap_or_default();
    let value = ui.painter().layout_no_wrap(value, FontId::proportional(WORDS), p.text);
    let response = ui.scope_builder(UiBuilder::new().sense(Sense::click()).id_salt(&entry.label), |ui| {
        ui.horizontal(|ui| {
            let right = ui.max_rect().right();
            dash(ui, if shown { entry.color } else { p.border }, entry.width);
            let words = if shown { p.secondary } else { p.faint };
            // The value comes first; the name takes the remaining width and is truncated where that is too small.
            let room = right - ui.cursor().left() - value.size().x - ui.spacing().item_spacing.x;
            let label = entry.brief.as_ref().filter(|_| narrow).unwrap_or(&entry.label);
            let name = egui::Label::new(RichText::new(label).size(WORDS).color(words)).truncate();
            let size = vec2(room.max(0.0), LINE);
            ui.allocate_ui_with_layout(size, Layout::left_to_right(Align::Center), |ui| {
                ui.set_min_size(size);
                ui.set_max_width(size.x);
                if size.x > LEAST_NAME {
                    ui.add(name);
                }
            });
            ui.label(value);
        });
    });
    let doing = if shown { "hide" } else { "show" };
    let response = response.response.on_hover_text(format!(
        "{}{}: click to {doing}",
        entry.hint,
        whole_value(input, entry, sample)
    ));
    response.widget_info(|| egui::WidgetInfo::selected(egui::Role::CheckBox, true, shown, &entry.label));
    if response.clicked() {
        choice.toggle(entry.switch);
    }
}

/// Value with its unit, for the tooltip: the gutter may omit the unit.
fn whole_value(input: &RowInput<'_>, entry: &Entry<'_>, sample: usize) -> String {
    let value = entry.curve.map(|c| c.levels.samples(&c.prepared.recording).value(sample));
    let value = value.filter(|v| v.is_finite());
    value.map_or_else(String::new, |v| format!(", {} {}", format::significant(v, 5), input.drawn.unit))
}

/// Value of an entry at the cursor, as text.
fn value_words(input: &RowInput<'_>, entry: &Entry<'_>, sample: usize, narrow: bool) -> Option<String> {
    let curve = entry.curve?;
    let value = Some(curve.levels.samples(&curve.prepared.recording).value(sample)).filter(|v| v.is_finite())?;
    match input.kind {
        // Its name takes the width of two.
        RowKind::LeftOver => (!narrow).then(|| format::significant(value, 2)),
        RowKind::Curves => Some(value_text(value, &input.drawn.unit, narrow)),
    }
}

fn value_text(value: f64, unit: &str, narrow: bool) -> String {
    let decimals = match unit {
        "mm" if narrow => usize::from(value.abs() < 100.0),
        "mm" | "N" | "N·m" => 2,
        "mm/s" | "°" | "°/s" | "N/s" => 1,
        "mm/s²" | "°/s²" => 0,
        _ => 3,
    };
    format::number(value, decimals)
}

fn dash(ui: &mut Ui, color: Color32, width: f32) {
    let (rect, _) = ui.allocate_exact_size(vec2(10.0, LINE), Sense::hover());
    ui.painter().hline(rect.x_range(), rect.center().y, Stroke::new(width, color));
}
