//! A window that closes once its first picture stands: what `touchstone bench` measures the start by.

use crate::ui::shell::app::App;
use std::io::Write as _;

/// Said on standard output when the picture stands.
pub const SAID: &str = "the first picture stands";

/// The window, until then.
pub struct UntilFirstPicture {
    app: App,
    /// The number of the frame that draws the first picture; a frame may be laid out more than once.
    first: Option<u64>,
}

impl UntilFirstPicture {
    /// Of this window.
    pub fn new(app: App) -> Self {
        Self { app, first: None }
    }
}

impl eframe::App for UntilFirstPicture {
    fn ui(&mut self, ui: &mut egui::Ui, frame: &mut eframe::Frame) {
        let now = ui.ctx().cumulative_frame_nr();
        if now <= *self.first.get_or_insert(now) {
            self.app.ui(ui, frame);
            ui.ctx().request_repaint();
            return;
        }
        // The frame before has been handed to the graphics card: the picture stands when it has drawn it.
        if let Some(state) = frame.wgpu_render_state() {
            let _ = state.device.poll(wgpu::PollType::wait_indefinitely());
        }
        let mut out = std::io::stdout();
        // Whoever asked may be gone.
        let _ = writeln!(out, "{SAID}").and_then(|()| out.flush());
        ui.ctx().send_viewport_cmd(egui::ViewportCommand::Close);
    }

    fn clear_color(&self, visuals: &egui::Visuals) -> [f32; 4] {
        self.app.clear_color(visuals)
    }
}
