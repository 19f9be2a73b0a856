//! The window: top bar, messages, the panels of the workspace, keys, files dropped on it.

use crate::ui::document::opening;
use crate::ui::document::recovery;
use crate::ui::document::undo_actions;
use crate::ui::kit::icons::Icon;
use crate::ui::kit::theme;
use crate::ui::kit::theme::space;
use crate::ui::kit::widgets::{icon_button, segmented};
use crate::ui::session::Session;
use crate::ui::shell::actions::list::Action;
use crate::ui::shell::actions::search;
use crate::ui::shell::app::App;
use crate::ui::shell::command_palette::CommandPalette;
use crate::ui::shell::dispatch;
use crate::ui::shell::dock::arrangement::Dock;
use crate::ui::shell::dock::panes::Panels;
use crate::ui::shell::fit;
use crate::ui::shell::message_list::Tone;
use crate::ui::shell::tour_progress::Tour;
use crate::ui::shell::workspace::Workspace;
use crate::ui::shell::{menu, messages, palette, tour};
use crate::ui::train::trainer::live::Trainer;
use crate::ui::train::trainer::world_choice::WorldChoice;
use egui::{Align, CentralPanel, Frame, Layout, Margin, Panel as Side, RichText, Stroke, Ui};

impl App {
    /// A window over a session. It keeps nothing on the disk until [`App::keep`] says where.
    pub fn new(session: Session) -> Self {
        Self {
            session,
            dock: Dock::default(),
            palette: CommandPalette::default(),
            tour: Tour::default(),
            left_behind: None,
            autosave: None,
            panels: Panels::default(),
        }
    }

    /// Draws everything.
    pub fn show(&mut self, ui: &mut Ui) {
        let ctx = ui.ctx().clone();
        dispatch::poll(&mut self.session, &ctx);
        self.take_worlds();
        if let Some(pane) = self.session.wanted_pane.take() {
            self.dock.bring(self.session.workspace, pane);
        }
        // A dialog waits for an answer first.
        if self.session.mapping.is_none() && !self.palette.is_open() && !self.tour.is_on() && self.dock.naming.is_none()
        {
            search::keys(ui, self);
            crate::ui::shell::keys::handle(ui, self.session.workspace, &mut self.session.document);
        }
        dropped_files(&ctx, &mut self.session);
        self.session.document.advance(f64::from(ctx.input(|i| i.stable_dt)));
        self.top_bar(ui);
        crate::ui::train::recorder::unfinished(ui, &mut self.session.document, &mut self.session.jobs);
        recovery::offer(ui, self);
        messages::banners(ui, &mut self.session.messages);
        self.arranging(ui);
        if self.session.workspace != Workspace::Devices {
            // A test force is for the page that shows its button to stop.
            self.session.training.trainer.trial.abort();
        }
        if self.session.mapping.is_some() {
            rest(ui, &mut self.session.training.trainer);
            crate::ui::column_mapping::dialog::show(ui, &mut self.session);
        } else {
            if !matches!(self.session.workspace, Workspace::Train | Workspace::Devices) {
                rest(ui, &mut self.session.training.trainer);
            }
            CentralPanel::default().frame(Frame::new()).show(ui, |ui| {
                self.dock.ui(ui, &mut self.panels, &mut self.session);
            });
        }
        palette::show(ui, self);
        crate::ui::shell::dock::naming::show(ui, self);
        tour::show(ui, self);
        self.keep_state(&ctx);
        if self.session.document.playing {
            ctx.request_repaint();
        }
        drop_hint(&ctx);
    }

    /// While panels are arranged: how, and the way out.
    fn arranging(&mut self, ui: &mut Ui) {
        let arranging = self.dock.arranging;
        let mut done = false;
        messages::strip(ui, "arranging", usize::from(arranging), |ui| {
            let text = "Drag a title to put its panel elsewhere, or onto another's titles; × closes it, Menu, View brings it back.";
            messages::message(ui, Tone::Done, text, |ui| done = ui.small_button("Done").clicked());
        });
        self.dock.arranging = arranging && !done;
    }

    fn keep_state(&mut self, ctx: &egui::Context) {
        let Some(autosave) = &mut self.autosave else { return };
        if self.left_behind.is_none()
            && let Some(problem) = autosave.follow(ctx, &self.session, &self.dock, self.tour.seen)
        {
            self.session.messages.fail(problem);
        }
    }

    /// Worlds that were opened or asked for go to the trainer.
    fn take_worlds(&mut self) {
        let session = &mut self.session;
        let choice = if let Some(world) = session.training.opened_world.take() {
            session.workspace = Workspace::Train;
            // `--world crank`, or the file of a built-in world, stands in the list already.
            let built_in = WorldChoice::of(&world);
            if built_in.is_none() {
                session.training.trainer.file = Some(*world);
            }
            built_in.unwrap_or(WorldChoice::File)
        } else if std::mem::take(&mut session.training.train_calibrated) {
            session.training.trainer.calibrated = session.calibration.analysis.as_ref().map(|a| a.world.clone());
            WorldChoice::Calibrated
        } else {
            return;
        };
        if let Err(problem) = session.training.trainer.choose(choice) {
            session.messages.fail(problem);
        }
    }

    fn top_bar(&mut self, ui: &mut Ui) {
        let p = theme::palette(ui);
        let frame = Frame::new().fill(p.card).inner_margin(Margin::symmetric(space::L as i8, 8));
        Side::top("top bar").frame(frame).show_separator_line(true).show(ui, |ui| {
            ui.horizontal(|ui| {
                ui.set_min_height(32.0);
                logo(ui);
                ui.label(theme::title("Touchstone"));
                ui.add_space(space::S);
                // A dialog waits for an answer first.
                let free = self.session.mapping.is_none();
                if !free {
                    ui.disable();
                }
                menu::button(ui, self);
                segmented(ui, &mut self.session.workspace, &Workspace::CHOICES);
                ui.add_space(space::M);
                let subject = egui::Label::new(RichText::new(self.subject()).color(p.secondary));
                ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                    self.tools(ui);
                    ui.with_layout(Layout::left_to_right(Align::Center), |ui| ui.add(subject.truncate()));
                });
            });
        });
    }

    /// Name of the shown world or recording.
    fn subject(&self) -> String {
        match self.session.workspace {
            Workspace::Train | Workspace::Devices => self
                .session
                .training
                .trainer
                .scene()
                .map(|(_, w)| crate::text::format::capitalised(&w.name))
                .unwrap_or_default(),
            Workspace::Calibrate | Workspace::Diagnose => {
                self.session.document.prepared().map(|p| p.recording.name.clone()).unwrap_or_default()
            }
        }
    }

    fn tools(&mut self, ui: &mut Ui) {
        let ctx = ui.ctx().clone();
        let dark = ui.visuals().dark_mode;
        let (icon, name) = if dark { (Icon::Light, "Light") } else { (Icon::Dark, "Dark") };
        if icon_button(ui, icon, true, name).on_hover_text("Switch the theme").clicked() {
            Action::Theme.run(&ctx, self);
        }
        let free = self.session.mapping.is_none();
        let open = ui.add_enabled(free, egui::Button::new((Icon::Open, "Open log …")));
        if open.on_hover_text("Ctrl+O, or drop a file on the window").clicked() {
            Action::OpenLog.run(&ctx, self);
        }
        let find = ui.add_enabled(free, egui::Button::new((Icon::Find, "Find …")));
        if find.on_hover_text("Every command by its name (Ctrl+P)").clicked() {
            Action::Palette.run(&ctx, self);
        }
        self.undo_buttons(ui);
        self.progress(ui);
    }

    /// Undo and redo buttons, if there is a change to undo or redo.
    fn undo_buttons(&mut self, ui: &mut Ui) {
        let (undo, redo) = (
            undo_actions::can_undo(&self.session.document, &self.session.calibration, &self.session.plots),
            undo_actions::can_redo(&self.session.document, &self.session.calibration, &self.session.plots),
        );
        if !undo && !redo || self.session.workspace == Workspace::Train {
            return;
        }
        if icon_button(ui, Icon::Redo, redo, "Redo").on_hover_text("Redo (Ctrl+Shift+Z)").clicked() {
            undo_actions::redo(
                &mut self.session.document,
                &mut self.session.calibration,
                &mut self.session.plots,
                &mut self.session.messages,
            );
        }
        if icon_button(ui, Icon::Undo, undo, "Undo").on_hover_text("Undo (Ctrl+Z)").clicked() {
            undo_actions::undo(
                &mut self.session.document,
                &mut self.session.calibration,
                &mut self.session.plots,
                &mut self.session.messages,
            );
        }
    }

    /// Title and progress of the running job, and the button that cancels it.
    fn progress(&mut self, ui: &mut Ui) {
        let Some(progress) = self.session.jobs.progress() else {
            if self.session.jobs.is_busy() {
                ui.add(egui::Spinner::new().size(16.0));
                // In time for the bar.
                ui.ctx().request_repaint_after(std::time::Duration::from_millis(200));
            }
            return;
        };
        ui.ctx().request_repaint_after(std::time::Duration::from_millis(100));
        if ui.button((Icon::Close, "Cancel")).on_hover_text(format!("End this: {}", progress.title)).clicked() {
            self.session.give_up(ui.ctx(), progress.kind);
        }
        match progress.share {
            Some(share) => {
                let bar = egui::ProgressBar::new(share as f32).desired_width(120.0).desired_height(8.0);
                ui.add(bar.fill(theme::palette(ui).accent));
                ui.label(theme::caption(ui, format!("{:.0} %", 100.0 * share)));
            }
            None => drop(ui.add(egui::Spinner::new().size(16.0))),
        }
        let seconds = progress.elapsed.as_secs();
        let since = if seconds > 0 { format!(" · {seconds} s") } else { String::new() };
        ui.label(theme::caption(ui, format!("{} …{since}", progress.title)));
    }
}

impl eframe::App for App {
    fn ui(&mut self, ui: &mut Ui, _frame: &mut eframe::Frame) {
        fit::follow(ui.ctx());
        self.show(ui);
    }

    fn clear_color(&self, visuals: &egui::Visuals) -> [f32; 4] {
        visuals.panel_fill.to_normalized_gamma_f32()
    }

    fn persist_egui_memory(&self) -> bool {
        true
    }

    fn on_exit(&mut self) {
        if let Some(autosave) = &mut self.autosave {
            autosave.end(&self.session, &self.dock, self.tour.seen);
        }
    }
}

/// The trainer while the user looks elsewhere: a running recording goes on, everything else rests.
fn rest(ui: &Ui, trainer: &mut Trainer) {
    if trainer.is_recording() {
        trainer.update(f64::from(ui.input(|i| i.stable_dt)));
        ui.ctx().request_repaint_after(std::time::Duration::from_millis(200));
    } else {
        trainer.pause();
    }
}

/// A stone with a golden streak.
fn logo(ui: &mut Ui) {
    let (rect, _) = ui.allocate_exact_size(egui::vec2(22.0, 22.0), egui::Sense::hover());
    let dark = ui.visuals().dark_mode;
    let stone =
        if dark { egui::Color32::from_rgb(0x3A, 0x45, 0x54) } else { egui::Color32::from_rgb(0x2A, 0x33, 0x40) };
    ui.painter().rect_filled(rect.shrink(1.0), 5, stone);
    let gold = Stroke::new(2.6, egui::Color32::from_rgb(0xE3, 0xB3, 0x41));
    ui.painter()
        .line_segment([rect.left_bottom() + egui::vec2(6.0, -7.0), rect.right_top() + egui::vec2(-6.0, 7.0)], gold);
}

fn dropped_files(ctx: &egui::Context, session: &mut Session) {
    let paths: Vec<std::path::PathBuf> =
        ctx.input(|i| i.raw.dropped_files.iter().map(|f| f.path().to_path_buf()).collect());
    opening::open_dropped(session, ctx, &paths);
}

/// While a file hangs over the window.
fn drop_hint(ctx: &egui::Context) {
    if ctx.input(|i| i.raw.hovered_files.is_empty()) {
        return;
    }
    let painter = ctx.layer_painter(egui::LayerId::new(egui::Order::Foreground, egui::Id::unique("drop hint")));
    let rect = ctx.content_rect();
    painter.rect_filled(rect, 0, egui::Color32::from_black_alpha(170));
    let font = egui::FontId::new(22.0, theme::semibold());
    painter.text(
        rect.center(),
        egui::Align2::CENTER_CENTER,
        "Drop a log, a world or a sidecar",
        font,
        egui::Color32::WHITE,
    );
}
