//! The columns of the file, one per line: content, meaning, unit, sign, factor.

use crate::text::format;
use crate::ui::column_mapping::draft::{Draft, Role, Row};
use crate::ui::column_mapping::file_units::FileUnit;
use crate::ui::column_mapping::names::{dimension, find};
use crate::ui::kit::theme;
use crate::ui::kit::theme::palette;
use egui::{Align, ComboBox, DragValue, Label, Layout, RichText, Role as Accessible, Ui, WidgetInfo};
use egui_extras::{Column, TableBuilder};

/// Height of a line, points.
const LINE: f32 = 40.0;

/// Draws the table.
pub fn table(ui: &mut Ui, draft: &mut Draft) {
    let rest = 190.0 + 84.0 + 40.0 + 76.0 + 5.0 * ui.spacing().item_spacing.x + 14.0;
    let free = (ui.available_width() - rest).max(160.0);
    let columns = [0.60 * free, 0.40 * free, 190.0, 84.0, 40.0, 76.0].map(|w| Column::exact(w).clip(true));
    let mut builder = TableBuilder::new(ui).striped(true).cell_layout(Layout::left_to_right(Align::Center));
    for column in columns {
        builder = builder.column(column);
    }
    builder
        .header(20.0, |mut header| {
            for text in ["Column of the file", "Range", "Means", "Unit", "Sign", "Factor"] {
                header.col(|ui| drop(ui.label(theme::caption(ui, text))));
            }
        })
        .body(|body| {
            body.rows(LINE, draft.rows.len(), |mut line| {
                let at = line.index();
                line.col(|ui| name(ui, &draft.rows[at]));
                line.col(|ui| range(ui, &draft.rows[at]));
                line.col(|ui| means(ui, draft, at));
                let row = &mut draft.rows[at];
                let number = row.name().and_then(dimension).is_some();
                line.col(|ui| {
                    if number {
                        unit(ui, row);
                    }
                });
                line.col(|ui| {
                    if number {
                        sign(ui, row);
                    }
                });
                line.col(|ui| {
                    if number {
                        factor(ui, row);
                    }
                });
            });
        });
}

fn name(ui: &mut Ui, row: &Row) {
    let p = palette(ui);
    ui.vertical(|ui| {
        ui.spacing_mut().item_spacing.y = 1.0;
        ui.add_space(3.0);
        let shown = match &row.facts {
            facts if facts.header.is_empty() => "(no name)".to_owned(),
            facts if facts.source != facts.header => format!("{} ({})", facts.header, facts.source),
            facts => facts.header.clone(),
        };
        let color = if row.role == Role::Extra { p.secondary } else { p.text };
        ui.add(Label::new(theme::strong(shown).color(color)).truncate());
        let values = row.facts.first.join(", ") + ", …";
        ui.add(Label::new(RichText::new(values).size(11.0).color(p.faint)).truncate());
    });
}

fn range(ui: &mut Ui, row: &Row) {
    let text = match (row.facts.range, row.facts.numeric, &row.facts.distinct) {
        (Some((low, high)), true, _) => format!("{} … {}", short(low), short(high)),
        (_, _, Some(values)) => format!("{} value{}", values.len(), if values.len() == 1 { "" } else { "s" }),
        _ => "words".to_owned(),
    };
    ui.add(Label::new(theme::caption(ui, text)).truncate());
}

/// A number in a few characters.
fn short(value: f64) -> String {
    if value != 0.0 && !(1e-3..1e6).contains(&value.abs()) {
        return format!("{value:.2e}").replace('-', "−");
    }
    if value.fract() == 0.0 { format::number(value, 0) } else { format::significant(value, 4) }
}

fn means(ui: &mut Ui, draft: &mut Draft, at: usize) {
    let header = draft.rows[at].facts.header.clone();
    if header.is_empty() {
        ui.label(theme::caption(ui, "needs a name in the file"));
        return;
    }
    let twice = draft.rows[at].name().is_some_and(|n| draft.claimed_twice(n));
    let selected = said(&draft.rows[at].role);
    let color = if twice { palette(ui).danger } else { palette(ui).text };
    let mut chosen = draft.rows[at].role.clone();
    let offered = draft.offered(at);
    let response = ComboBox::from_id_salt(("means", at))
        .width(ui.available_width() - 2.0)
        .height(420.0)
        .selected_text(RichText::new(&selected).color(color))
        .truncate()
        .show_ui(ui, |ui| {
            ui.spacing_mut().item_spacing.y = 0.0;
            ui.selectable_value(&mut chosen, Role::Extra, said(&Role::Extra));
            for name in offered {
                let role = Role::Named(name.si.to_owned());
                let text = said(&role);
                ui.selectable_value(&mut chosen, role, text);
            }
        })
        .response;
    response.widget_info(|| WidgetInfo::labeled(Accessible::ComboBox, true, format!("Meaning of {header}")));
    if twice {
        response.on_hover_text("Another column has this meaning too; choose one of them.");
    }
    if chosen != draft.rows[at].role {
        draft.rows[at].set_role(chosen);
    }
}

/// Label of a role.
pub fn said(role: &Role) -> String {
    match role {
        Role::Extra => "extra channel".to_owned(),
        Role::Named(name) => find(name).map_or_else(|| name.clone(), |n| format!("{} · {}", n.si, n.words)),
    }
}

fn unit(ui: &mut Ui, row: &mut Row) {
    let Some(dimension) = row.name().and_then(dimension) else { return };
    let header = row.facts.header.clone();
    let hint = match row.unit {
        _ if row.unit_stated => "As the name says",
        Some(_) => "Told from the range of the numbers; please check",
        None => "This unit is not known; choose another, or state its factor",
    };
    let color = if row.unit_stated { palette(ui).text } else { palette(ui).caution };
    let shown = row.unit.map_or_else(|| row.facts.unit_text(dimension), |u| u.shown).to_owned();
    let before = row.unit;
    let response = ComboBox::from_id_salt(("unit", &header))
        .width(ui.available_width() - 2.0)
        .selected_text(RichText::new(shown).color(color))
        .show_ui(ui, |ui| {
            for unit in FileUnit::all_of(dimension) {
                ui.selectable_value(&mut row.unit, Some(unit), unit.shown);
            }
        })
        .response;
    response.widget_info(|| WidgetInfo::labeled(Accessible::ComboBox, true, format!("Unit of {header}")));
    response.on_hover_text(hint);
    row.unit_stated |= row.unit != before;
}

fn sign(ui: &mut Ui, row: &mut Row) {
    let text = if row.negative { "−" } else { "+" };
    let response = ui.add(egui::Button::new(text).min_size(egui::vec2(30.0, 24.0)));
    let label = format!("Sign of {}", row.facts.header);
    response.widget_info(|| WidgetInfo::selected(Accessible::CheckBox, true, row.negative, &label));
    if response.on_hover_text("Which way is positive; forces are those on the environment").clicked() {
        row.negative = !row.negative;
    }
}

fn factor(ui: &mut Ui, row: &mut Row) {
    let speed = 0.01 * row.scale.abs().max(1e-3);
    let mut value = row.scale;
    ui.scope(|ui| {
        if row.needs_a_factor() {
            ui.visuals_mut().override_text_color = Some(palette(ui).caution);
        }
        let response =
            ui.add_sized([ui.available_width() - 2.0, 24.0], DragValue::new(&mut value).speed(speed).max_decimals(9));
        let hint = if row.needs_a_factor() {
            "The column's own unit is unknown or measures something else: how much is one of it?"
        } else {
            "Times this, beside the unit"
        };
        response.on_hover_text(hint);
    });
    if value != 0.0 && value.is_finite() {
        row.scale = value;
    }
}
