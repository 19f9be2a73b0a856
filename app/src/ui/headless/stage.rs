//! Sessions with everything computed, for pictures.

use crate::history::keeper::History;
use crate::ui::calibrate::refits;
use crate::ui::calibrate::rule_editing;
use crate::ui::calibrate::sensitivity_actions;
use crate::ui::calibrate::state::Calibration;
use crate::ui::calibrate::what_if_actions;
use crate::ui::column_mapping::state::Mapping;
use crate::ui::column_mapping::state::look_now;
use crate::ui::diagnose::experiment;
use crate::ui::diagnose::experiment_state;
use crate::ui::diagnose::guidance;
use crate::ui::diagnose::state::{Diagnosing, ask, extend};
use crate::ui::document::fit_choice::FitChoice;
use crate::ui::document::prepared::Prepared;
use crate::ui::document::state::Document;
use crate::ui::document::video_actions;
use crate::ui::headless::gallery::practice::practice as attempts;
use crate::ui::headless::picture_input::PictureInput;
use crate::ui::plots::choices::{LogView, PlotChoices, XyAxis};
use crate::ui::plots::curves::can_compare;
use crate::ui::session::Session;
use crate::ui::shell::panel_id::PanelId;
use crate::ui::shell::workspace::Workspace;
use crate::ui::train::lessons::pointer;
use crate::ui::train::lessons::practising;
use crate::ui::train::trainer::live::{Clock, Operator, Trainer};
use crate::ui::train::trainer::world_choice::WorldChoice;
use anyhow::{Context as _, anyhow};
use estimator::diagnose::Progress;
use estimator::signal::transform::Transform;
use haptics::teleop::Delay;
use haptics::world::World;
use std::path::PathBuf;
use std::sync::Arc;

/// Time of the practice in the picture, s.
const PRACTICE_S: f64 = 7.5;

fn new() -> Session {
    let mut session = Session::new();
    session.training.trainer.clock = Clock::Manual;
    session
}

/// The recordings of the input, fitted and replayed.
pub fn fitted(input: &PictureInput) -> anyhow::Result<Session> {
    fitted_then(input, |_, _| Ok(()))
}

/// The recordings of the input, fitted and replayed, and then changed.
fn fitted_then(
    input: &PictureInput,
    change: fn(&mut Session, &PictureInput) -> anyhow::Result<()>,
) -> anyhow::Result<Session> {
    let mut session = new();
    session.workspace = Workspace::Calibrate;
    let recordings = match &input.log {
        Some(path) if input.recordings.is_empty() => estimator::log::load(path, input.meta.as_deref())?,
        _ => input.recordings.clone(),
    };
    if recordings.is_empty() {
        return Ok(session);
    }
    session.show(recordings.into_iter().map(|r| Arc::new(Prepared::new(r))).collect());
    session.calibration.choice = FitChoice { task: input.task, ..FitChoice::default() };
    match refits::analyse(&session.document.recordings, &session.calibration.choice) {
        Ok(analysis) => {
            session.calibration.replays = refits::replay_all(&analysis.world, &session.document.recordings);
            session.calibration.enough = refits::judge(&analysis, &session.document.recordings);
            session.calibration.analysis = Some(Arc::new(analysis));
            session.calibration.refits.answered(&session.calibration.choice.clone());
        }
        Err(problem) => {
            session.calibration.fit_problem = Some(problem.clone());
            session.messages.fail(problem);
        }
    }
    change(&mut session, input)?;
    let (first, last) = session.document.prepared().map_or(session.document.view_s, |prepared| prepared.span());
    session.document.seek(input.time_s.unwrap_or(first + 0.4 * (last - first)));
    Ok(session)
}

/// One signal against another: the lifting force over the height, where both are known.
pub fn xy(input: &PictureInput) -> anyhow::Result<Session> {
    fitted_then(input, |session, _| {
        against_each_other(&session.document, &mut session.plots);
        Ok(())
    })
}

/// The residuals of the model and of the extended model.
pub fn left_over(input: &PictureInput) -> anyhow::Result<Session> {
    fitted_then(input, |session, _| {
        diagnose(&mut session.workspace, &session.document, &session.calibration, &mut session.diagnosing);
        session.workspace = Workspace::Calibrate;
        what_is_left(&mut session.document, &session.calibration, &mut session.plots);
        Ok(())
    })
}

/// A diagnosis with its extended model.
pub fn diagnosed(input: &PictureInput) -> anyhow::Result<Session> {
    fitted_then(input, |session, _| {
        diagnose(&mut session.workspace, &session.document, &session.calibration, &mut session.diagnosing);
        Ok(())
    })
}

/// The atlas of a diagnosis.
pub fn atlas(input: &PictureInput) -> anyhow::Result<Session> {
    fitted_then(input, |session, _| {
        diagnose(&mut session.workspace, &session.document, &session.calibration, &mut session.diagnosing);
        session.diagnosing.shows_atlas = true;
        Ok(())
    })
}

/// A diagnosis with the rehearsal of the experiment that it asks for.
pub fn rehearsed(input: &PictureInput) -> anyhow::Result<Session> {
    fitted_then(input, |session, _| rehearse(session))
}

/// The requested experiment, half done by hand.
pub fn guided(input: &PictureInput) -> anyhow::Result<Session> {
    fitted_then(input, |session, _| half_done_by_hand(session))
}

/// The sensitivity of the force to the parameters.
pub fn sensitivity(input: &PictureInput) -> anyhow::Result<Session> {
    fitted_then(input, |session, _| {
        sensitivity_actions::look_at_sensitivity(&session.document, &mut session.calibration);
        Ok(())
    })
}

/// Another value of a parameter, tried.
pub fn parameter(input: &PictureInput) -> anyhow::Result<Session> {
    fitted_then(input, |session, _| {
        try_another_value(&session.document, &mut session.calibration);
        Ok(())
    })
}

/// A video of the hand.
pub fn video(input: &PictureInput) -> anyhow::Result<Session> {
    fitted_then(input, |session, input| {
        with_video(&mut session.document, &mut session.wanted_pane, input);
        Ok(())
    })
}

/// The open rules of the task.
pub fn rules(input: &PictureInput) -> anyhow::Result<Session> {
    fitted_then(input, |session, _| {
        session.calibration.rules = rule_editing::open(&session.document, &session.calibration, &mut session.messages);
        Ok(())
    })
}

/// The dialog over a log, with its preview.
pub fn mapping(input: &PictureInput) -> anyhow::Result<Session> {
    let mut session = new();
    session.workspace = Workspace::Calibrate;
    let path = input.log.clone().context("name a log with --log: the dialog maps its columns")?;
    let looked = look_now(path, input.meta.clone(), None).map_err(|problem| anyhow!(problem))?;
    let mut mapping = Mapping::from(looked);
    mapping.preview.read_now(&mapping.path, mapping.draft.sidecar());
    session.mapping = Some(Box::new(mapping));
    Ok(session)
}

/// The made-up history of a trainee.
pub fn progress(_: &PictureInput) -> anyhow::Result<Session> {
    let mut session = new();
    let folder = tempfile::tempdir().context("there is no room for temporary files")?;
    let history = History::start(folder.path().join("history.sqlite"), || {}).map_err(|problem| anyhow!(problem))?;
    session.training.learning.keep_in(history);
    session.experiments.scratch = Some(folder);
    session.training.learning.trainees = vec!["Ada".to_owned(), "Grace".to_owned()];
    session.training.learning.trainee = Some("Ada".to_owned());
    session.training.learning.experts.insert("pinch".to_owned(), 92.0);
    session.training.learning.take(attempts());
    Ok(session)
}

/// The list of lessons.
pub fn lessons(_: &PictureInput) -> anyhow::Result<Session> {
    with_lessons()
}

/// A lesson that is practised with the mouse, half done.
pub fn practice(_: &PictureInput) -> anyhow::Result<Session> {
    let mut session = in_lesson()?;
    practising::practise_lesson(&mut session.training, &mut session.messages);
    pointer::follow_expert(&mut session.training, PRACTICE_S);
    Ok(session)
}

/// The result of an attempt at a lesson.
pub fn debrief(_: &PictureInput) -> anyhow::Result<Session> {
    let mut session = in_lesson()?;
    practising::test_lesson(&mut session.training, &mut session.messages);
    pointer::follow_expert(&mut session.training, 60.0);
    practising::end_lesson_now(&mut session.training, &mut session.messages, None);
    Ok(session)
}

fn with_lessons() -> anyhow::Result<Session> {
    let mut session = new();
    let folder = tempfile::tempdir()?;
    session.training.trainer.recordings_folder = Some(folder.path().to_path_buf());
    session.experiments.scratch = Some(folder);
    session.workspace = Workspace::Train;
    session.training.lessons.shown = true;
    // Lessons of the user who makes the picture do not belong in it.
    session.training.lessons.folder = Some(PathBuf::new());
    session.training.lessons.load();
    Ok(session)
}

fn in_lesson() -> anyhow::Result<Session> {
    let mut session = with_lessons()?;
    let lesson = session.training.lessons.all.iter().find(|lesson| lesson.id == "stack-two").cloned();
    practising::open_lesson_now(
        &mut session.training,
        &mut session.messages,
        &lesson.context("the lesson of two blocks is missing")?,
    );
    Ok(session)
}

/// The virtual world.
pub fn trainer(input: &PictureInput) -> anyhow::Result<Session> {
    const TELLING_S: f64 = 6.3;
    performing(input, Trainer::default(), TELLING_S)
}

/// The virtual world over half a second, on a model.
pub fn delay(input: &PictureInput) -> anyhow::Result<Session> {
    let mut delayed = Trainer::default();
    delayed.script.level = "expert";
    delayed.set_delay(Delay::of(0.5, true)).map_err(|problem| anyhow!(problem))?;
    performing(input, delayed, 6.3)
}

/// The assistant over the virtual world, at the moment when the cable pulls.
pub fn assistant(input: &PictureInput) -> anyhow::Result<Session> {
    let world = Some(unknown_barrel().map_err(|problem| anyhow!(problem))?);
    performing(&PictureInput { world, ..input.clone() }, Trainer::default(), 8.6)
}

/// The devices, with the virtual world behind them.
pub fn devices(input: &PictureInput) -> anyhow::Result<Session> {
    let mut session = trainer(input)?;
    session.workspace = Workspace::Devices;
    Ok(session)
}

/// The scripted operator in the middle of its task, or a person before it.
fn performing(input: &PictureInput, mut trainer: Trainer, usual_s: f64) -> anyhow::Result<Session> {
    (trainer.clock, trainer.operator) = (Clock::Manual, if input.by_hand { Operator::You } else { Operator::Scripted });
    if let Some(world) = &input.world {
        trainer.file = Some(world.clone());
        trainer.choice = WorldChoice::File;
    }
    trainer.ensure_running().map_err(|problem| anyhow!(problem))?;
    trainer.advance(input.time_s.unwrap_or(usual_s));
    let mut session = new();
    session.training.trainer = trainer;
    Ok(session)
}

/// The barrel of the lesson, full.
fn unknown_barrel() -> Result<World, String> {
    const FULL: usize = 1;
    let (lessons, _) = crate::lessons::all(None);
    let barrel = lessons.iter().find(|lesson| lesson.id == "barrel").ok_or("the lesson of the barrel is missing")?;
    barrel.world(FULL).map_err(|error| crate::text::sentence::sentence(&error.to_string()))
}

/// The video that is named, or that belongs to the log.
fn with_video(document: &mut Document, wanted_pane: &mut Option<PanelId>, input: &PictureInput) {
    *wanted_pane = Some(PanelId::VIDEO);
    match (&input.video, &input.log) {
        (Some(source), _) => document.videos.sources.push(source.clone()),
        (None, Some(log)) => document.videos.of_log(log, &document.recordings),
        (None, None) => {}
    }
    video_actions::read_video_now(document);
}

/// The lifting force over the height, where both are known; else what the window begins with.
fn against_each_other(document: &Document, plots: &mut PlotChoices) {
    plots.view = LogView::Xy;
    let Some(prepared) = document.prepared().cloned() else { return };
    let axis = |name: &str| {
        let group = prepared.groups.iter().find(|g| g.traces.iter().any(|t| t.name == name))?;
        Some(XyAxis { group: group.key(), name: name.to_owned(), transform: Transform::None })
    };
    (plots.xy.x, plots.xy.y) = (axis("y1_m"), axis("net_y_N"));
}

/// One plot of the residual for each quantity that the model predicts.
fn what_is_left(document: &mut Document, calibration: &Calibration, plots: &mut PlotChoices) {
    let Some(prepared) = document.prepared().cloned() else { return };
    for group in &prepared.groups {
        let comparable = can_compare(what_if_actions::shown_curves(document, calibration), group);
        let choice = plots.of(group);
        (choice.shown, choice.left_over) = (Some(comparable), comparable);
    }
    // A tenth of the way, in which single curves can be told apart.
    let (first, last) = document.view_s;
    document.view_s = (first + 0.36 * (last - first), first + 0.46 * (last - first));
}

/// The first parameter with a good value a fifth larger.
fn try_another_value(document: &Document, calibration: &mut Calibration) {
    let Some(analysis) = calibration.analysis.clone() else { return };
    let known = |p: &&estimator::estimate::Parameter| p.identified && p.value.is_some_and(|v| v != 0.0);
    let weight = analysis.fit.parameters.iter().find(|p| p.name == "weight_N").filter(known);
    let Some(parameter) = weight.or_else(|| analysis.fit.parameters.iter().find(known)) else { return };
    let name = parameter.full_name();
    what_if_actions::try_value(calibration, &name, parameter.value.map(|v| 1.2 * v));
    calibration.selected_parameter = Some(name);
    what_if_actions::try_now(document, calibration);
}

/// Diagnoses and extends the model at once, without the window's jobs.
fn diagnose(workspace: &mut Workspace, document: &Document, calibration: &Calibration, diagnosing: &mut Diagnosing) {
    *workspace = Workspace::Diagnose;
    let from = diagnosing.from;
    match ask(&document.recordings, &calibration.choice, from, Progress::default()) {
        Ok(answer) => {
            match extend(&document.recordings, &calibration.choice, from, &answer) {
                Ok(worlds) => {
                    diagnosing.replays = refits::replay_forces(&worlds.after, &document.recordings);
                    diagnosing.worlds = Some(Arc::new(worlds));
                }
                Err(problem) => diagnosing.worlds_problem = Some(problem),
            }
            diagnosing.answer = Some(Arc::new(answer));
        }
        Err(problem) => diagnosing.problem = Some(problem),
    }
}

/// The experiment that is asked for, rehearsed.
fn rehearse(session: &mut Session) -> anyhow::Result<()> {
    diagnose(&mut session.workspace, &session.document, &session.calibration, &mut session.diagnosing);
    let answer = session.diagnosing.answer.clone().context("these recordings cannot be diagnosed")?;
    let made = experiment_state::rehearse_now(
        &session.document.recordings,
        &session.calibration.choice,
        &answer,
        experiment_state::ROUNDS,
        &|_| true,
    );
    session.experiments.shows_plan = true;
    session.diagnosing.rehearsal = Some(Arc::new(made.map_err(|problem| anyhow!(problem.unwrap_or_default()))?));
    Ok(())
}

/// The experiment that is asked for, half done by hand.
fn half_done_by_hand(session: &mut Session) -> anyhow::Result<()> {
    diagnose(&mut session.workspace, &session.document, &session.calibration, &mut session.diagnosing);
    let answer = session.diagnosing.answer.clone().context("these recordings cannot be diagnosed")?;
    let asked = answer.diagnosis.next_experiment.as_ref().context("nothing is open in these recordings")?;
    let first = asked.separates.first().cloned().unwrap_or_default();
    let guided =
        experiment_state::guided_as_if(&session.document.recordings, &session.calibration.choice, &answer, &first);
    experiment::take_guided(
        &mut session.workspace,
        &mut session.experiments,
        &mut session.training.trainer,
        &mut session.messages,
        guided,
    );
    let folder = tempfile::tempdir().context("there is no room for temporary files")?;
    session.training.trainer.recordings_folder = Some(folder.path().to_path_buf());
    guidance::begin_experiment(&mut session.experiments, &mut session.training.trainer, &mut session.messages);
    guidance::follow_rings(&session.experiments, &mut session.training.trainer, 8.2);
    session.experiments.scratch = Some(folder);
    Ok(())
}
