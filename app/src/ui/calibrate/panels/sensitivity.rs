//! Sensitivity of the result to the parameters, and their correlations: bars, and a matrix.

use crate::text::format;
use crate::ui::calibrate::sensitivity::{CHANGE, Correlations, Effect, SENSITIVITY};
use crate::ui::calibrate::sensitivity_actions;
use crate::ui::calibrate::state::Calibration;
use crate::ui::headless::gallery::sample::Sample;
use crate::ui::headless::stage;
use crate::ui::kit::icons::Icon;
use crate::ui::kit::theme;
use crate::ui::kit::theme::{Palette, palette, space};
use crate::ui::kit::widgets::{bar, compact, empty_state, plain_card, remark};
use crate::ui::session::Session;
use crate::ui::shell::panel::{COLUMN, Framing, Panel, Picture, Registration};
use crate::ui::shell::panel_id::PanelId;
use crate::ui::shell::workspace::Workspace;
use egui::{Align, Align2, Color32, FontId, Layout, Pos2, Rect, RichText, ScrollArea, Sense, Ui, vec2};
use egui_tiles::ContainerKind;

/// Texts of this panel; a sentence with numbers is in the code that computes them.
mod words {
    pub const LOOKING_MORE: &str = "Every parameter is changed a little, and the motion replayed.";
    pub const NOTHING_FITTED_YET_MORE: &str =
        "Once there is a fit, this shows how much the force depends on each of its parameters.";
    pub const LOOKING: &str = "Looking …";
    pub const NOTHING_FITTED_YET: &str = "Nothing fitted yet";
    pub const WHAT_THE_FORCE: &str = "What the force depends on";
    pub const WHAT_GOES_TOGETHER: &str = "What goes together";
    pub const THE_REPLAY_OF_THIS_RECORDING: &str = "The replay of this recording does not depend on any of them.";
    pub const EVERY_PARAMETER_OF_THIS_FIT: &str = "Every parameter of this fit was found by itself.";
    pub const WHAT_GOES_TOGETHER_MORE: &str = "Where a cell is full, the recording shows only a mixture of the two.";
    pub const ONE_LESS_THE_OTHER: &str = "one less the other";
    pub const THEIR_SUM: &str = "their sum";
    pub const COULOMB: &str = "Coulomb";
}

/// Side of a cell of the matrix, points: maximum and minimum.
const CELL: (f32, f32) = (34.0, 16.0);
/// Absolute correlation above which two parameters are hardly distinguishable.
const ALIKE: f64 = 0.9;

/// The registration of this panel.
pub static REGISTRATION: Registration = Registration {
    workspaces: &[(Workspace::Calibrate, 5)],
    neighbours: &[(PanelId::RESULTS, ContainerKind::Tabs, false), (PanelId::DIAGNOSIS, ContainerKind::Tabs, false)],
    pictures: &[&SENSITIVITY_PICTURE],
    ..Registration::new(PanelId("sensitivity"), "Sensitivity", Icon::Sensitivity, || Box::new(SensitivityPanel))
};

/// Picture of the sensitivity of the force, and of the correlated parameters.
pub static SENSITIVITY_PICTURE: Picture = Picture {
    name: "sensitivity",
    place: 230,
    help: "What the force depends on, and which parameters go together",
    line: "Sensitivity: what the force depends on, and what goes together",
    size: COLUMN,
    sample: Sample::Crank,
    session: stage::sensitivity,
    framing: Framing::Panel(|| Box::new(SensitivityPanel)),
};

/// The sensitivity panel.
#[derive(Default)]
pub struct SensitivityPanel;

impl Panel for SensitivityPanel {
    fn ui(&mut self, ui: &mut Ui, session: &mut Session) {
        let ctx = ui.ctx().clone();
        sensitivity_actions::want_sensitivity(&session.document, &session.calibration, &mut session.jobs, &ctx);
        let Some(found) = session.calibration.sensitivity.clone().filter(|_| session.calibration.analysis.is_some())
        else {
            let busy = session.jobs.is_running(SENSITIVITY);
            let text = if busy { words::LOOKING_MORE } else { words::NOTHING_FITTED_YET_MORE };
            empty_state(
                ui,
                (Icon::Sensitivity, if busy { words::LOOKING } else { words::NOTHING_FITTED_YET }),
                text,
                |_| {},
            );
            return;
        };
        ScrollArea::vertical().id_salt("sensitivity").auto_shrink(false).show(ui, |ui| {
            ui.spacing_mut().item_spacing.y = space::S;
            plain_card(ui, words::WHAT_THE_FORCE, |ui| effects(ui, &mut session.calibration, &found.effects));
            plain_card(ui, words::WHAT_GOES_TOGETHER, |ui| together(ui, &found.groups));
        });
    }
}

fn effects(ui: &mut Ui, calibration: &mut Calibration, effects: &[Effect]) {
    let text =
        format!("Change of the simulated force when a parameter is {} % larger.", format::number(100.0 * CHANGE, 0));
    ui.label(theme::caption(ui, text));
    let most = effects.iter().map(|e| e.force_rms).fold(0.0, f64::max);
    if most <= 0.0 {
        ui.label(theme::caption(ui, words::THE_REPLAY_OF_THIS_RECORDING));
        return;
    }
    let p = palette(ui);
    for effect in effects {
        let response = compact(ui, |ui| {
            let name = ui.add(egui::Label::new(RichText::new(words(&effect.name)).size(12.0)).sense(Sense::click()));
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                ui.label(RichText::new(format!("{} N", format::significant(effect.force_rms, 2))).size(12.0));
            });
            name
        });
        bar(ui, effect.force_rms, most, None, p.accent);
        let uncertain = effect.by_its_error.map_or_else(String::new, |by| {
            format!("\nIts own error changes the force by {} N.", format::significant(by, 2))
        });
        let hint = format!("{}{uncertain}\nClick to try another value.", words(&effect.name));
        if response.on_hover_text(hint).clicked() {
            calibration.selected_parameter = Some(effect.name.clone());
        }
    }
}

fn together(ui: &mut Ui, groups: &[Correlations]) {
    if groups.is_empty() {
        ui.label(theme::caption(ui, words::EVERY_PARAMETER_OF_THIS_FIT));
        return;
    }
    ui.label(theme::caption(ui, words::WHAT_GOES_TOGETHER_MORE));
    for group in groups {
        ui.add_space(space::XS);
        matrix(ui, group);
        for (i, row) in group.values.iter().enumerate() {
            for (j, value) in row.iter().enumerate().skip(i + 1).filter(|(_, v)| v.abs() > ALIKE) {
                let how = if *value > 0.0 { words::ONE_LESS_THE_OTHER } else { words::THEIR_SUM };
                let text = format!(
                    "{} and {} go together ({}): {how} is known far better than each.",
                    words(&group.names[i]),
                    words(&group.names[j]).to_lowercase(),
                    format::number(*value, 2)
                );
                remark(ui, Icon::Doubt, text);
            }
        }
    }
}

/// Draws names to the left, the lower triangle of cells to their right, numbered below.
fn matrix(ui: &mut Ui, group: &Correlations) {
    let p = palette(ui);
    let n = group.names.len();
    let font = FontId::proportional(11.5);
    let names: Vec<String> = group.names.iter().map(|name| words(name)).collect();
    let galleys: Vec<_> =
        names.iter().map(|name| ui.painter().layout_no_wrap(name.clone(), font.clone(), p.secondary)).collect();
    let wide = galleys.iter().map(|g| g.size().x).fold(0.0, f32::max) + 22.0;
    let cell = ((ui.available_width() - wide) / n as f32).clamp(CELL.1, CELL.0);
    let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), cell * n as f32 + 16.0), Sense::hover());
    for (i, galley) in galleys.into_iter().enumerate() {
        let y = rect.top() + (i as f32 + 0.5) * cell;
        ui.painter().text(Pos2::new(rect.left(), y), Align2::LEFT_CENTER, (i + 1).to_string(), font.clone(), p.faint);
        ui.painter().galley(Pos2::new(rect.left() + 16.0, y - 0.5 * galley.size().y), galley, p.secondary);
        let below = Pos2::new(rect.left() + wide + (i as f32 + 0.5) * cell, rect.top() + cell * n as f32 + 8.0);
        ui.painter().text(below, Align2::CENTER_CENTER, (i + 1).to_string(), font.clone(), p.faint);
        for j in 0..=i {
            let corner = Pos2::new(rect.left() + wide + j as f32 * cell, rect.top() + i as f32 * cell);
            let at = Rect::from_min_size(corner, vec2(cell, cell)).shrink(1.0);
            ui.painter().rect_filled(at, 2, color(p, group.values[i][j]));
            let response = ui.interact(at, ui.scope_id().with(("cell", i, j)), Sense::hover());
            let value = format::number(group.values[i][j], 2);
            response.on_hover_text(format!("{} with {}: {value}", names[i], names[j].to_lowercase()));
            let ink = theme::ink_on(color(p, group.values[i][j]));
            let galley = ui.painter().layout_no_wrap(value, FontId::proportional(10.0), ink);
            if i != j && galley.size().x < at.width() {
                ui.painter().galley(at.center() - 0.5 * galley.size(), galley, ink);
            }
        }
    }
}

/// Colour of a correlation: accent if positive, caution if negative, none near zero.
fn color(p: &Palette, correlation: f64) -> Color32 {
    let end = if correlation >= 0.0 { p.accent } else { p.caution };
    theme::mix(p.sunken, end, correlation.abs() as f32)
}

/// `block-1.weight_N` → `Block 1 weight`.
fn words(full_name: &str) -> String {
    let Some((object, name)) = full_name.split_once('.') else { return full_name.to_owned() };
    let label = format::parameter(name, None).label.to_lowercase().replace("coulomb", words::COULOMB);
    format!("{} {label}", format::object(object))
}
