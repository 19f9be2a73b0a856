//! Opening the window.

use crate::tasks::Chosen;
use crate::ui::document::opening;
use crate::ui::headless::first_picture;
use crate::ui::kit::theme;
use crate::ui::scene::callback;
use crate::ui::session::Session;
use crate::ui::shell::app;
use crate::ui::shell::fit;
use crate::ui::shell::start::failure::{self, Failure, Next, Surroundings};
use crate::ui::shell::start::{again, graphics, quietly, scale, wayland_socket, x_server};
use crate::ui::shell::workspace;
use crate::ui::train::recorder;
use crate::ui::train::trainees;
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
    let drawing = drawing()?;
    let unusable = unusable();
    if !unusable.is_empty() {
        return again::start(&unusable, &[]);
    }
    let viewport = egui::ViewportBuilder::default()
        .with_title("Touchstone")
        .with_app_id("touchstone")
        .with_inner_size([1480.0, 920.0])
        .with_min_inner_size(fit::LEAST)
        .with_drag_and_drop(true);
    let native = eframe::NativeOptions {
        viewport,
        renderer: eframe::Renderer::Wgpu,
        wgpu_options: drawing,
        ..Default::default()
    };
    let start = move |cc: &eframe::CreationContext<'_>| -> Result<Box<dyn eframe::App>, Box<dyn std::error::Error + Send + Sync>> {
        let app = create(cc, &options);
        Ok(if options.until_first_picture { Box::new(first_picture::UntilFirstPicture::new(app)) } else { Box::new(app) })
    };
    // The libraries below take variables away.
    let surroundings =
        Surroundings::of(|name| std::env::var_os(name).map(|value| value.to_string_lossy().into_owned()));
    let opened = quietly::opening(|| eframe::run_native("touchstone", native, Box::new(start)));
    let failure = match opened {
        Some(Ok(())) => return Ok(()),
        _ if quietly::is_open() => anyhow::bail!("the screen is gone, and the window with it; start again"),
        Some(Err(eframe::Error::Wgpu(_))) => Failure::NoGraphics,
        Some(Err(_)) | None => Failure::NoWindow,
    };
    go_on_after(failure, &surroundings)
}

/// Environment variables that the libraries below would panic at.
fn unusable() -> Vec<&'static str> {
    let mut found = Vec::new();
    if let Some(complaint) = std::env::var(scale::VARIABLE).ok().and_then(|text| scale::complaint(&text)) {
        eprintln!("{complaint}");
        found.push(scale::VARIABLE);
    }
    if std::env::var(wayland_socket::VARIABLE).is_ok_and(|text| !wayland_socket::is_open(&text)) {
        found.push(wayland_socket::VARIABLE);
    }
    found
}

/// Another start, if it may open a window; otherwise a sentence.
fn go_on_after(failure: Failure, surroundings: &Surroundings) -> anyhow::Result<()> {
    // Other systems have one window system and no variables that choose it.
    anyhow::ensure!(
        cfg!(all(unix, not(target_os = "macos"))) || failure == Failure::NoGraphics,
        "no window could be opened; start this where a user is logged in to a desktop"
    );
    match surroundings.after(failure, x_server::ask) {
        Next::WithoutWayland => again::start(&failure::WAYLAND, &[]),
        Next::AtUsualScale => again::start(&[], &[failure::AT_USUAL_SCALE]),
        Next::WithOpenGl => again::start(&[], &failure::OPEN_GL),
        Next::Refuse(sentence) => anyhow::bail!(sentence),
    }
}

/// The system's own interface alone: to look for OpenGL as well takes a tenth of a second on every start.
fn drawing() -> anyhow::Result<egui_wgpu::WgpuConfiguration> {
    let list = std::env::var_os(graphics::VARIABLE).unwrap_or_default();
    let chosen = graphics::chosen(&list, wgpu::Instance::enabled_backend_features())?;
    let mut setup = egui_wgpu::WgpuSetupCreateNew::without_display_handle();
    setup.instance_descriptor.backends = chosen.unwrap_or(wgpu::Backends::PRIMARY);
    Ok(egui_wgpu::WgpuConfiguration { wgpu_setup: setup.into(), ..Default::default() })
}

fn create(cc: &eframe::CreationContext<'_>, options: &RunOptions) -> app::App {
    quietly::opened();
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
