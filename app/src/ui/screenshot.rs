//! Panels and workspaces drawn without a window: for the command line, reports and tests.

use super::app::App;
use super::dock::Pane;
use super::mapping::Mapping;
use super::panels::diagnose::DiagnosePanel;
use super::panels::diagnosis::DiagnosisPanel;
use super::panels::log::LogPanel;
use super::panels::parameters::ParametersPanel;
use super::panels::progress::ProgressPanel;
use super::panels::results::ResultsPanel;
use super::panels::scene::ScenePanel;
use super::panels::segments::SegmentsPanel;
use super::panels::sensitivity::SensitivityPanel;
use super::panels::trainer_view::TrainerView;
use super::plots::choices::XyAxis;
use super::plots::{LogView, can_compare};
use super::prepare::Prepared;
use super::session::{FitChoice, Session, Workspace};
use super::theme::{self, space};
use super::trainer::{Clock, Operator, Trainer, WorldChoice};
use super::{diagnosing, experimenting, fitting, scene};
use crate::history::History;
use crate::video::VideoSource;
use anyhow::{Context as _, anyhow};
use egui::{Frame, Ui, UiBuilder};
use egui_kittest::wgpu::WgpuTestRenderer;
use estimator::diagnose::Progress;
use estimator::signal::transform::Transform;
use haptics::recording::{Recording, Task};
use haptics::teleop::Delay;
use haptics::world::World;
use std::path::PathBuf;
use std::sync::Arc;

/// What can be drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Panel {
    /// Plots, band and time slider.
    Log,
    /// One signal against another.
    Xy,
    /// What the models leave of the measured forces.
    LeftOver,
    /// States and subtasks.
    Segments,
    /// The rules of the task, open in the Calibrate workspace.
    Rules,
    /// The parameter table.
    Parameters,
    /// Parameters, constraints and warnings.
    Results,
    /// The recording in space.
    Scene,
    /// The virtual world.
    Trainer,
    /// The virtual world over half a second, on a model.
    Delay,
    /// The assistant over the virtual world.
    Assistant,
    /// The whole Calibrate workspace.
    Workbench,
    /// The whole Train workspace.
    Train,
    /// The list of lessons, in Train.
    Lessons,
    /// A lesson that is practised with the mouse, half done.
    Practice,
    /// What came of an attempt at a lesson.
    Debrief,
    /// The whole Devices page.
    Devices,
    /// The whole Diagnose workspace, with its answer and the extended model.
    Diagnose,
    /// The residual atlas.
    Atlas,
    /// What a diagnosis answers, with what to record next, rehearsed.
    Experiment,
    /// That experiment done by hand in the virtual world, half done.
    Guided,
    /// How a trainee gets better, from a made-up history.
    Progress,
    /// The dialog that maps the columns of the log.
    Mapping,
    /// What the force depends on, and which parameters go together.
    Sensitivity,
    /// A parameter looked at closely, another value of it tried.
    Parameter,
    /// The Calibrate workspace while its panels are arranged.
    Arrange,
    /// The command palette.
    Commands,
    /// A card of the tour.
    Tour,
    /// The Calibrate workspace with a video of the hand; the log's, or the one that is named.
    Video,
}

/// What is shown.
#[derive(Clone, Debug, Default)]
pub struct PanelInput {
    /// A log to load.
    pub log: Option<PathBuf>,
    /// Its sidecar, where it is not beside the log.
    pub meta: Option<PathBuf>,
    /// Recordings in memory, instead of a log.
    pub recordings: Vec<Recording>,
    /// The task; told from the recording when absent.
    pub task: Option<Task>,
    /// The world of the trainer; the two blocks when absent.
    pub world: Option<World>,
    /// A video of the hand.
    pub video: Option<VideoSource>,
    /// A person at the mouse instead of the scripted operator.
    pub by_hand: bool,
    /// Where the cursor stands, s (in the trainer: how far the scripted operator is); two fifths of the way when absent.
    pub time_s: Option<f64>,
}

/// How far the practice of the picture is, s.
const PRACTICE_S: f64 = 7.5;

/// Draws a panel in `size` pixels.
pub fn panel(input: &PanelInput, panel: Panel, size: [u32; 2], dark: bool) -> anyhow::Result<image::RgbaImage> {
    let session = session_for(input, panel)?;
    draw(session, panel, size, dark)
}

/// Draws a panel over recordings in memory; the cursor stands at `time_s`.
pub fn recordings(
    recordings: Vec<Recording>,
    panel: Panel,
    time_s: Option<f64>,
    size: [u32; 2],
    dark: bool,
) -> anyhow::Result<image::RgbaImage> {
    self::panel(&PanelInput { recordings, time_s, ..PanelInput::default() }, panel, size, dark)
}

/// A session with everything computed, for a picture.
pub(super) fn session_for(input: &PanelInput, panel: Panel) -> anyhow::Result<Session> {
    let mut session = Session::new();
    session.trainer.clock = Clock::Manual;
    if matches!(panel, Panel::Lessons | Panel::Practice | Panel::Debrief) {
        lesson(&mut session, panel)?;
        return Ok(session);
    }
    if matches!(panel, Panel::Trainer | Panel::Train | Panel::Devices | Panel::Delay | Panel::Assistant) {
        session.trainer = performing(input, panel).map_err(|problem| anyhow!(problem))?;
        if panel == Panel::Devices {
            session.workspace = Workspace::Devices;
        }
        return Ok(session);
    }
    if panel == Panel::Progress {
        let folder = tempfile::tempdir().context("there is no room for temporary files")?;
        let history =
            History::start(folder.path().join("history.sqlite"), || {}).map_err(|problem| anyhow!(problem))?;
        session.learning.keep_in(history);
        session.experiments.scratch = Some(folder);
        session.learning.trainees = vec!["Ada".to_owned(), "Grace".to_owned()];
        session.learning.trainee = Some("Ada".to_owned());
        session.learning.experts.insert("pinch".to_owned(), 92.0);
        session.learning.take(super::gallery::samples::practice());
        return Ok(session);
    }
    session.workspace = Workspace::Calibrate;
    if panel == Panel::Mapping {
        session.mapping = Some(Box::new(mapping(input)?));
        return Ok(session);
    }
    let recordings = match &input.log {
        Some(path) if input.recordings.is_empty() => estimator::log::load(path, input.meta.as_deref())?,
        _ => input.recordings.clone(),
    };
    if recordings.is_empty() {
        return Ok(session);
    }
    session.show(recordings.into_iter().map(|r| Arc::new(Prepared::new(r))).collect());
    session.choice = FitChoice { task: input.task, ..FitChoice::default() };
    match fitting::analyse(&session.recordings, &session.choice) {
        Ok(analysis) => {
            session.replays = fitting::replay_all(&analysis.world, &session.recordings);
            session.enough = fitting::judge(&analysis, &session.recordings);
            session.analysis = Some(Arc::new(analysis));
            session.refits.answered(&session.choice.clone());
        }
        Err(problem) => {
            session.fit_problem = Some(problem.clone());
            session.fail(problem);
        }
    }
    match panel {
        Panel::Diagnose => diagnosed(&mut session),
        Panel::Atlas => {
            diagnosed(&mut session);
            session.diagnosing.shows_atlas = true;
        }
        Panel::Experiment | Panel::Guided => experiment(&mut session, panel)?,
        Panel::Xy => against_each_other(&mut session),
        Panel::LeftOver => {
            diagnosed(&mut session);
            session.workspace = Workspace::Calibrate;
            what_is_left(&mut session);
        }
        Panel::Sensitivity => session.look_at_sensitivity(),
        Panel::Parameter => try_another_value(&mut session),
        Panel::Video => with_video(&mut session, input),
        _ => {}
    }
    if panel == Panel::Rules {
        session.rules = super::rules::Rules::open(&mut session);
    }
    let (first, last) = session.prepared().map_or(session.view_s, |prepared| prepared.span());
    session.seek(input.time_s.unwrap_or(first + 0.4 * (last - first)));
    Ok(session)
}

/// The list of lessons, or one of them with a hand on the mouse.
fn lesson(session: &mut Session, panel: Panel) -> anyhow::Result<()> {
    let folder = tempfile::tempdir()?;
    session.trainer.recordings_folder = Some(folder.path().to_path_buf());
    session.experiments.scratch = Some(folder);
    session.workspace = Workspace::Train;
    session.lessons.shown = true;
    // Those of whoever makes the picture do not belong into it.
    session.lessons.folder = Some(PathBuf::new());
    session.lessons.load();
    let wanted = session.lessons.all.iter().find(|lesson| lesson.id == "stack-two").cloned();
    let (Some(lesson), false) = (wanted, panel == Panel::Lessons) else { return Ok(()) };
    session.open_lesson_now(&lesson);
    if panel == Panel::Practice {
        session.practise_lesson();
        session.follow_expert(PRACTICE_S);
        return Ok(());
    }
    session.test_lesson();
    session.follow_expert(60.0);
    session.end_lesson_now(None);
    Ok(())
}

/// The video that is named, or that belongs to the log.
fn with_video(session: &mut Session, input: &PanelInput) {
    session.wanted_pane = Some(Pane::Video);
    match (&input.video, &input.log) {
        (Some(source), _) => session.videos.sources.push(source.clone()),
        (None, Some(log)) => session.videos.of_log(log, &session.recordings),
        (None, None) => {}
    }
    session.read_video_now();
}

/// The lifting force over the height, where both are known; else what the window begins with.
fn against_each_other(session: &mut Session) {
    session.plots.view = LogView::Xy;
    let Some(prepared) = session.prepared().cloned() else { return };
    let axis = |name: &str| {
        let group = prepared.groups.iter().find(|g| g.traces.iter().any(|t| t.name == name))?;
        Some(XyAxis { group: group.key(), name: name.to_owned(), transform: Transform::None })
    };
    (session.plots.xy.x, session.plots.xy.y) = (axis("y1_m"), axis("net_y_N"));
}

/// A plot of what is left over of every quantity that the model predicts, and only those quantities.
fn what_is_left(session: &mut Session) {
    let Some(prepared) = session.prepared().cloned() else { return };
    for group in &prepared.groups {
        let comparable = can_compare(session.shown_curves(), group);
        let choice = session.plots.of(group);
        (choice.shown, choice.left_over) = (Some(comparable), comparable);
    }
    // A tenth of the way, in which single curves can be told apart.
    let (first, last) = session.view_s;
    session.view_s = (first + 0.36 * (last - first), first + 0.46 * (last - first));
}

/// The first parameter with a good value a fifth larger.
fn try_another_value(session: &mut Session) {
    let Some(analysis) = session.analysis.clone() else { return };
    let known = |p: &&estimator::estimate::Parameter| p.identified && p.value.is_some_and(|v| v != 0.0);
    let weight = analysis.fit.parameters.iter().find(|p| p.name == "weight_N").filter(known);
    let Some(parameter) = weight.or_else(|| analysis.fit.parameters.iter().find(known)) else { return };
    let name = parameter.full_name();
    session.try_value(&name, parameter.value.map(|v| 1.2 * v));
    session.selected_parameter = Some(name);
    session.try_now();
}

/// What the window's jobs would bring.
fn diagnosed(session: &mut Session) {
    session.workspace = Workspace::Diagnose;
    let from = session.diagnosing.from;
    match diagnosing::ask(&session.recordings, &session.choice, from, Progress::default()) {
        Ok(answer) => {
            match diagnosing::extend(&session.recordings, &session.choice, from, &answer) {
                Ok(worlds) => {
                    session.diagnosing.replays = fitting::replay_forces(&worlds.after, &session.recordings);
                    session.diagnosing.worlds = Some(Arc::new(worlds));
                }
                Err(problem) => session.diagnosing.worlds_problem = Some(problem),
            }
            session.diagnosing.answer = Some(Arc::new(answer));
        }
        Err(problem) => session.diagnosing.problem = Some(problem),
    }
}

/// The experiment that is asked for: rehearsed, or half done by hand.
fn experiment(session: &mut Session, panel: Panel) -> anyhow::Result<()> {
    diagnosed(session);
    let answer = session.diagnosing.answer.clone().context("these recordings cannot be diagnosed")?;
    let (recordings, choice) = (session.recordings.clone(), session.choice.clone());
    if panel == Panel::Experiment {
        let made = experimenting::rehearse_now(&recordings, &choice, &answer, experimenting::ROUNDS, &|_| true);
        session.experiments.shows_plan = true;
        session.diagnosing.rehearsal = Some(Arc::new(made.map_err(|problem| anyhow!(problem.unwrap_or_default()))?));
        return Ok(());
    }
    let asked = answer.diagnosis.next_experiment.as_ref().context("nothing is open in these recordings")?;
    let first = asked.separates.first().cloned().unwrap_or_default();
    let guided = experimenting::guided_as_if(&recordings, &choice, &answer, &first);
    session.guided(guided.map(Box::new));
    let folder = tempfile::tempdir().context("there is no room for temporary files")?;
    session.trainer.recordings_folder = Some(folder.path().to_path_buf());
    session.begin_experiment();
    session.follow_rings(8.2);
    session.experiments.scratch = Some(folder);
    Ok(())
}

/// The dialog over a log, with its preview.
fn mapping(input: &PanelInput) -> anyhow::Result<Mapping> {
    let path = input.log.clone().context("name a log with --log: the dialog maps its columns")?;
    let looked = super::mapping::look_now(path, input.meta.clone(), None).map_err(|problem| anyhow!(problem))?;
    let mut mapping = Mapping::from(looked);
    mapping.preview.read_now(&mapping.path, mapping.draft.sidecar());
    Ok(mapping)
}

/// The barrel of the lesson, full.
fn unknown_barrel() -> Result<World, String> {
    const FULL: usize = 1;
    let (lessons, _) = crate::lessons::all(None);
    let barrel = lessons.iter().find(|lesson| lesson.id == "barrel").ok_or("the lesson of the barrel is missing")?;
    barrel.world(FULL).map_err(|error| crate::text::sentence::sentence(&error.to_string()))
}

/// The scripted operator in the middle of its task, or a person before it.
fn performing(input: &PanelInput, panel: Panel) -> Result<Trainer, String> {
    let mut trainer = Trainer::default();
    if panel == Panel::Delay {
        trainer.script.level = "expert";
        trainer.set_delay(Delay::of(0.5, true))?;
    }
    (trainer.clock, trainer.operator) = (Clock::Manual, if input.by_hand { Operator::You } else { Operator::Scripted });
    let of_lesson = if panel == Panel::Assistant { Some(unknown_barrel()?) } else { None };
    if let Some(world) = of_lesson.as_ref().or(input.world.as_ref()) {
        trainer.file = Some(world.clone());
        trainer.choice = WorldChoice::File;
    }
    trainer.ensure_running()?;
    // The assistant's when the cable pulls.
    let usual_s = if panel == Panel::Assistant { 8.6 } else { 6.3 };
    trainer.advance(input.time_s.unwrap_or(usual_s));
    Ok(trainer)
}

/// Draws a session's panel.
pub fn draw(session: Session, panel: Panel, size: [u32; 2], dark: bool) -> anyhow::Result<image::RgbaImage> {
    // The renderer of the test kit panics without a driver; ours says what is missing.
    render::Headless::new().map(drop)?;
    let options = egui_wgpu::RendererOptions::default();
    let state = egui_kittest::wgpu::create_render_state(egui_kittest::wgpu::default_wgpu_setup(), options);
    let surface = state.clone();
    let mut app = app_for(session, panel);
    let mut contents = contents(panel);
    let mut harness = egui_kittest::Harness::builder()
        .with_size(egui::vec2(size[0] as f32, size[1] as f32))
        .with_theme(if dark { egui::Theme::Dark } else { egui::Theme::Light })
        .with_accessibility_check(false)
        .allow_missing_glyphs()
        .with_render_cursor(false)
        .with_context_setup(move |ctx| {
            theme::install(ctx);
            scene::announce(ctx, &surface);
        })
        .renderer(WgpuTestRenderer::from_render_state(state))
        .build_ui(move |ui| {
            in_whole_window(ui, |ui| contents(ui, &mut app));
        });
    harness.run_steps(4);
    harness.render().map_err(|error| anyhow!(error)).context("the panel could not be drawn")
}

/// The window that a panel is drawn in.
pub(super) fn app_for(session: Session, panel: Panel) -> App {
    let mut app = App::new(session);
    match panel {
        Panel::Arrange => app.dock.arranging = true,
        Panel::Commands => app.palette.open(),
        Panel::Tour => app.tour.begin_at(4),
        _ => {}
    }
    app
}

/// Where a window of this size (points) shows the plane of the trainer's world.
pub fn trainer_place(size: [f32; 2]) -> Option<scene::Place> {
    let mut session = Session::new();
    session.trainer.clock = Clock::Manual;
    session.workspace = Workspace::Train;
    let mut harness = egui_kittest::Harness::builder()
        .with_size(egui::vec2(size[0], size[1]))
        .with_accessibility_check(false)
        .allow_missing_glyphs()
        .with_context_setup(theme::install)
        .build_ui_state(|ui, app: &mut App| in_whole_window(ui, |ui| app.show(ui)), App::new(session));
    harness.run_steps(4);
    harness.state().session.trainer_place
}

/// Draws over all of a window of the test kit, whose margin is not ours.
pub(super) fn in_whole_window(ui: &mut Ui, contents: impl FnOnce(&mut Ui)) {
    let whole = ui.ctx().content_rect();
    ui.scope_builder(UiBuilder::new().max_rect(whole), |ui| {
        ui.set_clip_rect(whole);
        ui.painter().rect_filled(whole, 0, theme::palette(ui).window);
        contents(ui);
    });
}

/// Draws a panel of the window.
pub(super) type Contents = Box<dyn FnMut(&mut Ui, &mut App)>;

/// What draws a panel.
pub(super) fn contents(panel: Panel) -> Contents {
    fn framed(mut panel: impl super::panels::Panel + 'static) -> Contents {
        Box::new(move |ui, app| {
            Frame::new().inner_margin(space::M).show(ui, |ui| panel.ui(ui, &mut app.session));
        })
    }
    match panel {
        Panel::Log | Panel::Xy | Panel::LeftOver => framed(LogPanel::default()),
        Panel::Segments => framed(SegmentsPanel),
        Panel::Parameters => framed(ParametersPanel),
        Panel::Results => framed(ResultsPanel::default()),
        Panel::Scene => framed(ScenePanel::default()),
        Panel::Trainer | Panel::Guided | Panel::Delay | Panel::Assistant => framed(TrainerView::default()),
        Panel::Sensitivity => framed(SensitivityPanel),
        Panel::Progress => framed(ProgressPanel),
        Panel::Atlas => framed(DiagnosePanel),
        Panel::Experiment => framed(DiagnosisPanel),
        Panel::Rules
        | Panel::Workbench
        | Panel::Train
        | Panel::Lessons
        | Panel::Practice
        | Panel::Debrief
        | Panel::Devices
        | Panel::Diagnose
        | Panel::Mapping
        | Panel::Parameter
        | Panel::Arrange
        | Panel::Commands
        | Panel::Tour
        | Panel::Video => Box::new(|ui, app| app.show(ui)),
    }
}
