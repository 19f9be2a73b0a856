//! Opening the window.

use crate::tasks::Chosen;
use crate::ui::document::opening;
use crate::ui::headless::first_picture;
use crate::ui::kit::theme;
use crate::ui::scene::callback;
use crate::ui::session::Session;
use crate::ui::shell::app;
use crate::ui::shell::fit;
use crate::ui::shell::workspace;
use crate::ui::train::recorder;
use crate::ui::train::trainees;
use anyhow::Context as _;
use std::path::PathBuf;

/// Options that the window opens with.
#[derive(Clone, Debug, Default)]
pub struct RunOptions {
    /// A log to calibrate from.
    pub log: Option<PathBuf>,
    /// Its sidecar, where it is not beside the log.
    pub meta: Option<PathBuf>,
    /// A world to train in.
    pub world: Option<PathBuf>,
    /// The task of the log.
    pub task: Option<Chosen>,
    /// Light or dark; the system's choice when absent.
    pub dark: Option<bool>,
    /// Close when the first picture stands.
    pub until_first_picture: bool,
}

/// Opens the window; returns when it is closed.
pub fn run(options: RunOptions) -> anyhow::Result<()> {
    let viewport = egui::ViewportBuilder::default()
        .with_title("Touchstone")
        .with_app_id("touchstone")
        .with_inner_size([1480.0, 920.0])
        .with_min_inner_size(fit::LEAST)
        .with_drag_and_drop(true);
    let native = eframe::NativeOptions {
        viewport,
        renderer: eframe::Renderer::Wgpu,
        wgpu_options: graphics(),
        ..Default::default()
    };
    let start = move |cc: &eframe::CreationContext<'_>| -> Result<Box<dyn eframe::App>, Box<dyn std::error::Error + Send + Sync>> {
        let app = create(cc, &options);
        Ok(if options.until_first_picture { Box::new(first_picture::UntilFirstPicture::new(app)) } else { Box::new(app) })
    };
    match eframe::run_native("touchstone", native, Box::new(start)) {
        Err(eframe::Error::Wgpu(_)) if std::env::var_os(BACKEND).is_none() => with_open_gl(),
        opened => opened.map_err(|error| {
            anyhow::anyhow!("the window could not be opened ({error}); is there a display and a graphics driver?")
        }),
    }
}

/// Environment variable that chooses the graphics interface of wgpu.
const BACKEND: &str = "WGPU_BACKEND";

/// The system's own interface alone: to look for OpenGL as well takes a tenth of a second on every start.
fn graphics() -> egui_wgpu::WgpuConfiguration {
    let mut setup = egui_wgpu::WgpuSetupCreateNew::without_display_handle();
    setup.instance_descriptor.backends = wgpu::Backends::from_env().unwrap_or(wgpu::Backends::PRIMARY);
    egui_wgpu::WgpuConfiguration { wgpu_setup: setup.into(), ..Default::default() }
}

/// Starts again with OpenGL, where there is nothing else: a window system can be opened once a process.
fn with_open_gl() -> anyhow::Result<()> {
    let again = std::process::Command::new(std::env::current_exe()?)
        .args(std::env::args_os().skip(1))
        .env(BACKEND, "gl")
        .status()
        .context("the window could not be opened, and neither with OpenGL")?;
    // The child process has printed its own error.
    anyhow::ensure!(
        again.success(),
        "there is no graphics driver but OpenGL's, and the window did not stay open with that one"
    );
    Ok(())
}

fn create(cc: &eframe::CreationContext<'_>, options: &RunOptions) -> app::App {
    theme::install(&cc.egui_ctx);
    if let Some(dark) = options.dark {
        cc.egui_ctx.set_theme(if dark { egui::Theme::Dark } else { egui::Theme::Light });
    }
    if let Some(state) = &cc.wgpu_render_state {
        callback::announce(&cc.egui_ctx, state);
        callback::warm_up(&cc.egui_ctx, state);
    }
    let mut session = Session::new();
    session.document.meta.clone_from(&options.meta);
    session.document.task_hint.clone_from(&options.task);
    recorder::look_for_unfinished(&cc.egui_ctx, &session.training.trainer, &mut session.jobs);
    if let Some(world) = &options.world {
        opening::open_world(&mut session.jobs, &cc.egui_ctx, world);
    }
    if let Some(log) = &options.log {
        session.workspace = workspace::Workspace::Calibrate;
        opening::open(&mut session.document, &mut session.jobs, &cc.egui_ctx, log);
    }
    let mut app = app::App::new(session);
    if let Some(folder) = eframe::storage_dir("touchstone") {
        let fresh = options.log.is_none() && options.world.is_none();
        app.keep(&folder, fresh);
        if let Some(database) = crate::history::attempt::of_user() {
            trainees::open_history(
                &mut app.session.training.learning,
                &mut app.session.messages,
                &cc.egui_ctx,
                database,
            );
        }
    }
    app
}
