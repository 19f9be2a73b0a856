//! The window: top bar, messages, the two workspaces, keys, files dropped on it.

use super::files;
use super::jobs::Purpose;
use super::panels::Panel as _;
use super::panels::device_detail::DeviceDetail;
use super::panels::devices::DeviceList;
use super::panels::diagnose::DiagnosePanel;
use super::panels::diagnosis::DiagnosisPanel;
use super::panels::log::LogPanel;
use super::panels::recording::RecordingPanel;
use super::panels::results::ResultsPanel;
use super::panels::rules::RulesPanel;
use super::panels::scene::ScenePanel;
use super::panels::trainer_side::TrainerSide;
use super::panels::trainer_view::TrainerView;
use super::session::{Session, Workspace};
use super::theme::{self, palette, space};
use super::trainer::WorldChoice;
use super::widgets::segmented;
use egui::{Align, CentralPanel, Frame, Layout, Margin, Panel as Side, RichText, Stroke, Ui};

/// The application.
pub struct App {
    /// What it knows.
    pub session: Session,
    log: LogPanel,
    recording: RecordingPanel,
    results: ResultsPanel,
    scene: ScenePanel,
    rules: RulesPanel,
    trainer_view: TrainerView,
    trainer_side: TrainerSide,
    device_list: DeviceList,
    device_detail: DeviceDetail,
    diagnose: DiagnosePanel,
    diagnosis: DiagnosisPanel,
}

impl App {
    /// A window over a session.
    pub fn new(session: Session) -> Self {
        Self {
            session,
            log: LogPanel::default(),
            recording: RecordingPanel::default(),
            results: ResultsPanel::default(),
            scene: ScenePanel::default(),
            rules: RulesPanel,
            trainer_view: TrainerView::default(),
            trainer_side: TrainerSide,
            device_list: DeviceList::default(),
            device_detail: DeviceDetail,
            diagnose: DiagnosePanel,
            diagnosis: DiagnosisPanel,
        }
    }

    /// Draws everything.
    pub fn show(&mut self, ui: &mut Ui) {
        let ctx = ui.ctx().clone();
        self.session.poll(&ctx);
        self.take_worlds();
        if self.session.mapping.is_none() {
            super::keys::handle(ui, &mut self.session);
        }
        dropped_files(&ctx, &mut self.session);
        self.session.advance(f64::from(ctx.input(|i| i.stable_dt)));
        self.top_bar(ui);
        super::recorder::unfinished(ui, &mut self.session);
        super::messages::banners(ui, &mut self.session);
        if self.session.workspace != Workspace::Devices {
            // A test force is for the page that shows its button to stop.
            self.session.trainer.trial.abort();
        }
        match self.session.workspace {
            _ if self.session.mapping.is_some() => self.mapping(ui),
            Workspace::Train => self.train(ui),
            Workspace::Calibrate => self.calibrate(ui),
            Workspace::Diagnose => self.diagnose(ui),
            Workspace::Devices => self.devices(ui),
        }
        if self.session.playing {
            ctx.request_repaint();
        }
        drop_hint(&ctx);
    }

    /// Worlds that were opened or asked for go to the trainer.
    fn take_worlds(&mut self) {
        let session = &mut self.session;
        let choice = if let Some(world) = session.opened_world.take() {
            session.workspace = Workspace::Train;
            // `--world crank`, or the file of a built-in world, stands in the list already.
            let built_in = WorldChoice::of(&world);
            if built_in.is_none() {
                session.trainer.file = Some(*world);
            }
            built_in.unwrap_or(WorldChoice::File)
        } else if std::mem::take(&mut session.train_calibrated) {
            session.trainer.calibrated = session.analysis.as_ref().map(|a| a.world.clone());
            WorldChoice::Calibrated
        } else {
            return;
        };
        if let Err(problem) = session.trainer.choose(choice) {
            session.fail(problem);
        }
    }

    fn top_bar(&mut self, ui: &mut Ui) {
        let p = palette(ui);
        let frame = Frame::new().fill(p.card).inner_margin(Margin::symmetric(space::L as i8, 8));
        Side::top("top bar").frame(frame).show_separator_line(true).show(ui, |ui| {
            ui.horizontal(|ui| {
                logo(ui);
                ui.label(theme::title("Touchstone"));
                ui.add_space(space::L);
                let choices = [
                    (Workspace::Train, "Train", "Touch a virtual world (Ctrl+1)"),
                    (Workspace::Calibrate, "Calibrate", "Measure a real one from a log (Ctrl+2)"),
                    (Workspace::Diagnose, "Diagnose", "What the model gets wrong, and why (Ctrl+3)"),
                    (Workspace::Devices, "Devices", "What moves the fingers, and how well (Ctrl+4)"),
                ];
                // A dialog waits for an answer first.
                let free = self.session.mapping.is_none();
                ui.add_enabled_ui(free, |ui| segmented(ui, &mut self.session.workspace, &choices));
                ui.add_space(space::L);
                ui.label(RichText::new(self.subject()).color(p.secondary));
                ui.with_layout(Layout::right_to_left(Align::Center), |ui| self.tools(ui));
            });
        });
    }

    /// What is being looked at.
    fn subject(&self) -> String {
        match self.session.workspace {
            Workspace::Train | Workspace::Devices => {
                self.session.trainer.scene().map(|(_, w)| super::format::capitalised(&w.name)).unwrap_or_default()
            }
            Workspace::Calibrate | Workspace::Diagnose => {
                self.session.prepared().map(|p| p.recording.name.clone()).unwrap_or_default()
            }
        }
    }

    fn tools(&mut self, ui: &mut Ui) {
        let dark = ui.visuals().dark_mode;
        if ui.button(if dark { "Light" } else { "Dark" }).on_hover_text("Switch the theme").clicked() {
            ui.ctx().set_theme(if dark { egui::Theme::Light } else { egui::Theme::Dark });
        }
        let free = self.session.mapping.is_none();
        if ui
            .add_enabled(free, egui::Button::new("Open log …"))
            .on_hover_text("Ctrl+O, or drop a file on the window")
            .clicked()
        {
            files::ask(ui.ctx(), &mut self.session.jobs, Purpose::OpenLog);
        }
        self.progress(ui);
    }

    /// What takes its time, how far it is, and the way to end it.
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
        if ui.button("Cancel").on_hover_text(format!("End this: {}", progress.what)).clicked() {
            self.session.give_up(progress.kind);
        }
        match progress.share {
            Some(share) => {
                let text = RichText::new(format!("{:.0} %", 100.0 * share)).size(11.5);
                ui.add(egui::ProgressBar::new(share as f32).desired_width(120.0).text(text));
            }
            None => drop(ui.add(egui::Spinner::new().size(16.0))),
        }
        let seconds = progress.elapsed.as_secs();
        let since = if seconds > 0 { format!(" · {seconds} s") } else { String::new() };
        ui.label(theme::caption(ui, format!("{} …{since}", progress.what)));
    }

    fn mapping(&mut self, ui: &mut Ui) {
        if self.session.trainer.is_recording() {
            self.session.trainer.update(f64::from(ui.input(|i| i.stable_dt)));
        } else {
            self.session.trainer.pause();
        }
        super::mapping::dialog::show(ui, &mut self.session);
    }

    fn train(&mut self, ui: &mut Ui) {
        let session = &mut self.session;
        let plain = Frame::new().inner_margin(Margin::same(space::M as i8));
        Side::right("trainer side").frame(plain).show_separator_line(false).resizable(false).exact_size(336.0).show(
            ui,
            |ui| {
                self.trainer_side.ui(ui, session);
            },
        );
        let frame = Frame::new().inner_margin(Margin { left: 12, right: 0, top: 12, bottom: 12 });
        CentralPanel::default().frame(frame).show(ui, |ui| self.trainer_view.ui(ui, session));
    }

    fn devices(&mut self, ui: &mut Ui) {
        let session = &mut self.session;
        let plain = Frame::new().inner_margin(Margin::same(space::M as i8));
        let width = (0.36 * ui.available_width()).clamp(330.0, 380.0);
        Side::left("device list").frame(plain).show_separator_line(false).resizable(false).exact_size(width).show(
            ui,
            |ui| {
                self.device_list.ui(ui, session);
            },
        );
        let frame = Frame::new().inner_margin(Margin { left: 0, right: 12, top: 12, bottom: 12 });
        CentralPanel::default().frame(frame).show(ui, |ui| self.device_detail.ui(ui, session));
    }

    fn diagnose(&mut self, ui: &mut Ui) {
        let session = &mut self.session;
        rest(ui, session);
        if session.diagnosing.answer.is_some() {
            let plain = Frame::new().inner_margin(Margin::same(space::M as i8));
            let width = (0.28 * ui.available_width()).clamp(356.0, 420.0);
            Side::right("diagnosis").frame(plain).show_separator_line(false).resizable(false).exact_size(width).show(
                ui,
                |ui| {
                    self.diagnosis.ui(ui, session);
                },
            );
        }
        let right = if session.diagnosing.answer.is_some() { 0 } else { 12 };
        let frame = Frame::new().inner_margin(Margin { left: 12, right, top: 12, bottom: 12 });
        CentralPanel::default().frame(frame).show(ui, |ui| self.diagnose.ui(ui, session));
    }

    fn calibrate(&mut self, ui: &mut Ui) {
        let session = &mut self.session;
        rest(ui, session);
        let width = ui.available_width();
        let plain = Frame::new().inner_margin(Margin::same(space::M as i8));
        Side::left("recording")
            .frame(plain)
            .show_separator_line(false)
            .resizable(false)
            .exact_size((0.18 * width).clamp(220.0, 264.0))
            .show(ui, |ui| {
                self.recording.ui(ui, session);
            });
        Side::right("results")
            .frame(plain)
            .show_separator_line(false)
            .resizable(false)
            .exact_size((0.26 * width).clamp(362.0, 384.0))
            .show(ui, |ui| {
                self.results.ui(ui, session);
            });
        let height = ui.available_height();
        let upper = Frame::new().inner_margin(Margin { left: 0, right: 0, top: 12, bottom: 6 });
        // The rules need more room than the picture, and keep their own.
        let rules = session.rules.is_some();
        Side::top(if rules { "rules" } else { "scene" })
            .frame(upper)
            .show_separator_line(false)
            .resizable(true)
            .default_size(if rules { 0.48 } else { 0.40 } * height)
            .size_range(120.0..=0.75 * height)
            .show(ui, |ui| {
                // The rules take the place of the picture, so that the states below are seen to follow.
                if session.rules.is_some() { self.rules.ui(ui, session) } else { self.scene.ui(ui, session) }
            });
        let lower = Frame::new().inner_margin(Margin { left: 0, right: 0, top: 6, bottom: 12 });
        CentralPanel::default().frame(lower).show(ui, |ui| self.log.ui(ui, session));
    }
}

impl eframe::App for App {
    fn ui(&mut self, ui: &mut Ui, _frame: &mut eframe::Frame) {
        self.show(ui);
    }

    fn clear_color(&self, visuals: &egui::Visuals) -> [f32; 4] {
        visuals.panel_fill.to_normalized_gamma_f32()
    }

    fn persist_egui_memory(&self) -> bool {
        true
    }
}

/// The trainer while the user looks elsewhere: a running recording goes on, everything else rests.
fn rest(ui: &Ui, session: &mut Session) {
    if session.trainer.is_recording() {
        session.trainer.update(f64::from(ui.input(|i| i.stable_dt)));
        ui.ctx().request_repaint_after(std::time::Duration::from_millis(200));
    } else {
        session.trainer.pause();
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
    session.open_dropped(ctx, &paths);
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
