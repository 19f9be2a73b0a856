//! The dialog's frame: heading, columns on the left, preview on the right, actions below.

use crate::text::file_name::name_of;
use crate::ui::background::jobs::Jobs;
use crate::ui::column_mapping::actions::save;
use crate::ui::column_mapping::preview::PREVIEW;
use crate::ui::column_mapping::state::Mapping;
use crate::ui::column_mapping::{options, plot, table};
use crate::ui::document::files::SAVE;
use crate::ui::kit::icons::Icon;
use crate::ui::kit::theme;
use crate::ui::kit::theme::{palette, space};
use crate::ui::kit::widgets::{plain_card, primary_button, remark, sheet};
use crate::ui::session::Session;
use egui::{Align, CentralPanel, Frame, Key, Layout, Margin, Panel as Side, RichText, Ui};

/// User's decision in the dialog.
enum Done {
    Save,
    Cancel,
}

/// Draws the dialog into the available space.
pub fn show(ui: &mut Ui, session: &mut Session) {
    let Some(mut mapping) = session.mapping.take() else { return };
    let ctx = ui.ctx().clone();
    let about = (mapping.path.as_path(), &mapping.draft);
    mapping.preview.follow(&ctx, &mut session.jobs, about, |session: &mut Session| {
        session.mapping.as_mut().map(|mapping| &mut mapping.preview)
    });
    let width = ui.available_width();
    let frame = |left, right, top, bottom| Frame::new().inner_margin(Margin { left, right, top, bottom });
    Side::top("mapping head").frame(frame(12, 12, 10, 0)).show_separator_line(false).resizable(false).show(ui, |ui| {
        head(ui, &mapping);
    });
    let mut done = Side::bottom("mapping foot")
        .frame(frame(12, 12, 0, 12))
        .show_separator_line(false)
        .resizable(false)
        .show(ui, |ui| foot(ui, &mut mapping, &session.jobs))
        .inner;
    Side::right("mapping preview")
        .frame(frame(0, 12, 10, 10))
        .show_separator_line(false)
        .resizable(false)
        .exact_size((0.34 * width).clamp(360.0, 560.0))
        .show(ui, |ui| plot::preview(ui, &mut mapping, &session.jobs));
    CentralPanel::default().frame(frame(12, 12, 10, 10)).show(ui, |ui| {
        ui.spacing_mut().item_spacing.y = space::S;
        plain_card(ui, "Recording", |ui| options::options(ui, &mut mapping.draft));
        sheet(ui).inner_margin(space::M).show(ui, |ui| {
            ui.set_min_size(ui.available_size());
            table::table(ui, &mut mapping.draft);
        });
    });
    if ctx.input(|i| i.key_pressed(Key::Escape)) && !ctx.egui_wants_keyboard_input() && !egui::Popup::is_any_open(&ctx)
    {
        done = Some(Done::Cancel);
    }
    match done {
        Some(Done::Cancel) => {
            session.jobs.cancel(PREVIEW);
            // The file is still not open, for the same reason.
            if let Some(why) = mapping.why.filter(|_| session.document.path.as_ref() != Some(&mapping.path)) {
                session.messages.fail(why);
            }
        }
        Some(Done::Save) => {
            session.jobs.cancel(PREVIEW);
            save(&ctx, &mut session.jobs, &mapping);
            session.mapping = Some(mapping);
        }
        None => session.mapping = Some(mapping),
    }
}

fn head(ui: &mut Ui, mapping: &Mapping) {
    let p = palette(ui);
    ui.horizontal(|ui| {
        ui.label(theme::title("Map columns"));
        ui.label(RichText::new(name_of(&mapping.path)).color(p.secondary));
        let rows = mapping.file.rows;
        let seen = if mapping.file.whole_file { "" } else { "first " };
        ui.label(theme::caption(ui, format!("{} columns, {seen}{rows} rows", mapping.file.columns.len())));
    });
    if let Some(why) = &mapping.why {
        remark(ui, Icon::Doubt, why);
    }
}

fn foot(ui: &mut Ui, mapping: &mut Mapping, jobs: &Jobs<Session>) -> Option<Done> {
    let mut done = None;
    ui.horizontal(|ui| {
        let saving = jobs.is_running(SAVE);
        let loads = matches!(mapping.preview.seen, Some(Ok(_)));
        let ready = loads && !saving && !mapping.preview.is_stale(jobs);
        let hint = "A mapping is saved when the log can be read with it";
        if primary_button(ui, ready, (Icon::Save, "Save sidecar and open")).on_disabled_hover_text(hint).clicked() {
            done = Some(Done::Save);
        }
        if ui.button("Cancel").on_hover_text("Changes nothing (Esc)").clicked() {
            done = Some(Done::Cancel);
        }
        ui.add_space(space::S);
        if ui
            .button((Icon::Reload, "Guess again"))
            .on_hover_text("From names, units and ranges, over what is chosen now")
            .clicked()
        {
            mapping.draft.guess();
        }
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            let target = name_of(&mapping.sidecar);
            ui.label(theme::caption(ui, format!("writes {target}; the log itself stays as it is")))
                .on_hover_text(mapping.sidecar.display().to_string());
        });
    });
    done
}
