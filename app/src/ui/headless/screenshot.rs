//! Panels and pages drawn without a window: for the command line, reports and tests.

use crate::ui::headless::gallery::sample::Sample;
use crate::ui::headless::picture_input::PictureInput;
use crate::ui::headless::stage;
use crate::ui::kit::theme;
use crate::ui::kit::theme::space;
use crate::ui::scene::callback;
use crate::ui::scene::view;
use crate::ui::session::Session;
use crate::ui::shell::app::App;
use crate::ui::shell::panel::{Framing, PAGE, Picture};
use crate::ui::shell::panel_list;
use crate::ui::shell::workspace::Workspace;
use crate::ui::train::trainer::live::Clock;
use anyhow::{Context as _, anyhow};
use clap::ValueEnum;
use clap::builder::PossibleValue;
use egui::{Frame, Ui, UiBuilder};
use egui_kittest::wgpu::WgpuTestRenderer;
use haptics::recording::Recording;
use std::sync::LazyLock;

const fn page(
    place: u8,
    [name, help, line]: [&'static str; 3],
    sample: Sample,
    session: fn(&PictureInput) -> anyhow::Result<Session>,
) -> Picture {
    Picture { name, place, help, line, size: PAGE, sample, session, framing: Framing::Page }
}

const STACK: Sample = Sample::World("stack");
const TABLE: Sample = Sample::World("table");

/// The rules of the task, open in the Calibrate workspace.
pub static RULES: Picture = page(
    40,
    [
        "rules",
        "The rules of the task, open in the Calibrate workspace",
        "Rules of a task, open beside the states that they find",
    ],
    Sample::Stack,
    stage::rules,
);
/// The whole Calibrate workspace.
pub static WORKBENCH: Picture = page(
    110,
    ["workbench", "The whole Calibrate workspace", "Calibrate: a recording of two blocks, segmented and fitted"],
    Sample::Stack,
    stage::fitted,
);
/// The whole Train workspace.
pub static TRAIN: Picture = page(
    120,
    ["train", "The whole Train workspace", "Train: the world, the forces, the servo's punctuality"],
    STACK,
    stage::trainer,
);
/// The list of lessons, in Train.
pub static LESSONS: Picture = page(
    130,
    ["lessons", "The list of lessons, in Train", "Lessons: from the first touch to the real task"],
    TABLE,
    stage::lessons,
);
/// A lesson that is practised with the mouse, half done.
pub static PRACTICE: Picture = page(
    140,
    [
        "practice",
        "A lesson that is practised with the mouse, half done",
        "A lesson is practised, beside an expert's ghost",
    ],
    TABLE,
    stage::practice,
);
/// Picture of the result of an attempt at a lesson.
pub static DEBRIEF: Picture = page(
    150,
    ["debrief", "What came of an attempt at a lesson", "What came of an attempt, beside the experts"],
    TABLE,
    stage::debrief,
);
/// The whole Devices page.
pub static DEVICES: Picture = page(
    160,
    ["devices", "The whole Devices page", "Devices: what moves the fingers, and how well"],
    STACK,
    stage::devices,
);
/// The whole Diagnose workspace, with its answer and the extended model.
pub static DIAGNOSE: Picture = page(
    170,
    [
        "diagnose",
        "The whole Diagnose workspace, with its answer and the extended model",
        "Diagnose: what the model gets wrong, and why",
    ],
    Sample::Crank,
    stage::diagnosed,
);
/// The dialog that maps the columns of the log.
pub static MAPPING: Picture = page(
    220,
    [
        "mapping",
        "The dialog that maps the columns of the log",
        "A foreign table: what its columns mean, with a preview",
    ],
    Sample::Foreign,
    stage::mapping,
);
/// A parameter looked at closely, another value of it tried.
pub static PARAMETER: Picture = page(
    240,
    [
        "parameter",
        "A parameter looked at closely, another value of it tried",
        "Another value of a parameter, tried on the replay",
    ],
    Sample::Crank,
    stage::parameter,
);
/// The Calibrate workspace while its panels are arranged.
pub static ARRANGE: Picture = page(
    245,
    [
        "arrange",
        "The Calibrate workspace while its panels are arranged",
        "Panels while they are arranged: drag a title, close, bring back",
    ],
    Sample::Stack,
    stage::fitted,
);
/// The command palette.
pub static COMMANDS: Picture = page(
    246,
    ["commands", "The command palette", "Every command by a few letters of its name"],
    Sample::Stack,
    stage::fitted,
);
/// A card of the tour.
pub static TOUR: Picture =
    page(247, ["tour", "A card of the tour", "Shown around, the first time"], Sample::Stack, stage::fitted);

/// Pictures of whole pages.
static PAGES: [&Picture; 13] = [
    &RULES, &WORKBENCH, &TRAIN, &LESSONS, &PRACTICE, &DEBRIEF, &DEVICES, &DIAGNOSE, &MAPPING, &PARAMETER, &ARRANGE,
    &COMMANDS, &TOUR,
];

static ALL: LazyLock<Vec<PictureName>> = LazyLock::new(|| {
    let of_panels = panel_list::panels().flat_map(|panel| panel.pictures.iter().copied());
    let mut all: Vec<PictureName> = of_panels.chain(PAGES).map(PictureName).collect();
    all.sort_by_key(|PictureName(picture)| picture.place);
    all
});

/// Every picture.
pub fn pictures() -> impl Iterator<Item = &'static Picture> {
    ALL.iter().map(|PictureName(picture)| *picture)
}

/// A picture as the command line names it.
#[derive(Clone, Copy)]
pub struct PictureName(pub &'static Picture);

impl ValueEnum for PictureName {
    fn value_variants<'a>() -> &'a [Self] {
        &ALL
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        Some(PossibleValue::new(self.0.name).help(self.0.help))
    }
}

/// Draws a picture in `size` pixels.
pub fn picture(
    input: &PictureInput,
    picture: &'static Picture,
    size: [u32; 2],
    dark: bool,
) -> anyhow::Result<image::RgbaImage> {
    draw((picture.session)(input)?, picture, size, dark)
}

/// Draws a picture of recordings in memory; the cursor stands at `time_s`.
pub fn recordings(
    recordings: Vec<Recording>,
    picture: &'static Picture,
    time_s: Option<f64>,
    size: [u32; 2],
    dark: bool,
) -> anyhow::Result<image::RgbaImage> {
    self::picture(&PictureInput { recordings, time_s, ..PictureInput::default() }, picture, size, dark)
}

/// Draws a session.
pub fn draw(
    session: Session,
    picture: &'static Picture,
    size: [u32; 2],
    dark: bool,
) -> anyhow::Result<image::RgbaImage> {
    // The renderer of the test kit panics without a driver; ours says what is missing.
    render::Headless::new().map(drop)?;
    let options = egui_wgpu::RendererOptions::default();
    let state = egui_kittest::wgpu::create_render_state(egui_kittest::wgpu::default_wgpu_setup(), options);
    let surface = state.clone();
    let mut app = app_for(session, picture);
    let mut contents = contents(picture);
    let mut harness = egui_kittest::Harness::builder()
        .with_size(egui::vec2(size[0] as f32, size[1] as f32))
        .with_theme(if dark { egui::Theme::Dark } else { egui::Theme::Light })
        .with_accessibility_check(false)
        .allow_missing_glyphs()
        .with_render_cursor(false)
        .with_context_setup(move |ctx| {
            theme::install(ctx);
            callback::announce(ctx, &surface);
        })
        .renderer(WgpuTestRenderer::from_render_state(state))
        .build_ui(move |ui| {
            in_whole_window(ui, |ui| contents(ui, &mut app));
        });
    harness.run_steps(4);
    harness.render().map_err(|error| anyhow!(error)).context("the panel could not be drawn")
}

/// The window that a picture is drawn of.
pub(crate) fn app_for(session: Session, picture: &'static Picture) -> App {
    let mut app = App::new(session);
    match picture.name {
        "arrange" => app.dock.arranging = true,
        "commands" => app.palette.open(),
        "tour" => app.tour.begin_at(4),
        _ => {}
    }
    app
}

/// Place of the trainer's view plane in a window of this size, points.
pub fn trainer_place(size: [f32; 2]) -> Option<view::Place> {
    let mut session = Session::new();
    session.training.trainer.clock = Clock::Manual;
    session.workspace = Workspace::Train;
    let mut harness = egui_kittest::Harness::builder()
        .with_size(egui::vec2(size[0], size[1]))
        .with_accessibility_check(false)
        .allow_missing_glyphs()
        .with_context_setup(theme::install)
        .build_ui_state(|ui, app: &mut App| in_whole_window(ui, |ui| app.show(ui)), App::new(session));
    harness.run_steps(4);
    harness.state().session.training.trainer_place
}

/// Draws over all of a window of the test kit, whose margin is not ours.
pub(crate) fn in_whole_window(ui: &mut Ui, contents: impl FnOnce(&mut Ui)) {
    let whole = ui.ctx().content_rect();
    ui.scope_builder(UiBuilder::new().max_rect(whole), |ui| {
        ui.set_clip_rect(whole);
        ui.painter().rect_filled(whole, 0, theme::palette(ui).window);
        contents(ui);
    });
}

/// Draws a panel of the window.
pub(crate) type Contents = Box<dyn FnMut(&mut Ui, &mut App)>;

/// Draws what a picture shows.
pub(crate) fn contents(picture: &'static Picture) -> Contents {
    match picture.framing {
        Framing::Panel(new) | Framing::LargePanel(new) => {
            let mut panel = new();
            Box::new(move |ui, app| {
                Frame::new().inner_margin(space::M).show(ui, |ui| panel.ui(ui, &mut app.session));
            })
        }
        Framing::Page => Box::new(|ui, app| app.show(ui)),
    }
}
