//! Execution of the actions.

use crate::ui::calibrate::fitting;
use crate::ui::calibrate::manual_states;
use crate::ui::calibrate::rule_editing;
use crate::ui::diagnose::actions;
use crate::ui::document::files;
use crate::ui::document::fit_choice::Stated;
use crate::ui::document::opening;
use crate::ui::document::project_files;
use crate::ui::document::state::Document;
use crate::ui::document::undo_actions;
use crate::ui::session::Session;
use crate::ui::shell::actions::list::Action;
use crate::ui::shell::app::App;
use crate::ui::shell::dialogs;
use crate::ui::shell::dispatch;
use crate::ui::shell::dock::name_field::Naming;
use crate::ui::shell::fit;
use crate::ui::shell::message_list::Tone;
use crate::ui::shell::workspace::Workspace;
use crate::ui::train::lessons::practising;
use crate::ui::train::restart;
use egui::{Context, ViewportCommand};

/// Step of the zoom.
const SIZE_STEP: f32 = 0.1;
/// Minimum and maximum zoom.
const SIZES: (f32, f32) = (0.6, 3.0);

impl Action {
    /// Runs the action.
    pub fn run(&self, ctx: &Context, app: &mut App) {
        match self {
            Self::Panel(pane) => app.dock.toggle(app.session.workspace, *pane),
            Self::Arrange => app.dock.arranging = !app.dock.arranging,
            Self::ResetLayout => app.dock.reset(app.session.workspace),
            Self::SaveLayout | Self::Layout(_) | Self::RenameLayout | Self::DeleteLayout => with_layouts(self, app),
            Self::Palette => app.palette.open(),
            Self::Tour => app.tour.begin(),
            Self::Theme => {
                let dark = ctx.global_style().visuals.dark_mode;
                ctx.set_theme(if dark { egui::Theme::Light } else { egui::Theme::Dark });
            }
            Self::Larger => resize(ctx, SIZE_STEP),
            Self::Smaller => resize(ctx, -SIZE_STEP),
            Self::UsualSize => ctx.set_zoom_factor(fit::applied(ctx)),
            Self::FullScreen => {
                let full = ctx.input(|i| i.viewport().fullscreen.unwrap_or(false));
                ctx.send_viewport_cmd(ViewportCommand::Fullscreen(!full));
            }
            Self::Quit => ctx.send_viewport_cmd(ViewportCommand::Close),
            other => with_session(other, ctx, &mut app.session),
        }
    }
}

fn with_layouts(action: &Action, app: &mut App) {
    let workspace = app.session.workspace;
    let chosen = app.dock.chosen(workspace).map(str::to_owned);
    match (action, chosen) {
        (Action::SaveLayout, chosen) => app.dock.naming = Some(Naming::to_save(workspace, chosen.as_deref())),
        (Action::RenameLayout, Some(name)) => app.dock.naming = Some(Naming::to_rename(workspace, &name)),
        (Action::DeleteLayout, Some(name)) if app.dock.delete(workspace, &name) => {
            app.session
                .messages
                .say(Tone::Done, format!("The arrangement “{name}” is deleted; panels stay where they are."));
        }
        (Action::Layout(name), _) => {
            app.dock.choose(workspace, name);
        }
        _ => {}
    }
}

fn with_session(action: &Action, ctx: &Context, session: &mut Session) {
    match action {
        Action::Open(workspace) => session.workspace = *workspace,
        Action::Diagnose => {
            session.workspace = Workspace::Diagnose;
            actions::diagnose(&session.document, &session.calibration, &mut session.diagnosing, &mut session.jobs, ctx);
        }
        Action::Extend => {
            actions::extend_model(&session.document, &session.calibration, &session.diagnosing, &mut session.jobs, ctx);
        }
        Action::Feel => actions::feel(
            &mut session.workspace,
            &session.diagnosing,
            &mut session.training.trainer,
            &mut session.messages,
        ),
        Action::Fit => fitting::refit(&session.document, &mut session.calibration, &mut session.jobs, ctx),
        Action::Rules => {
            session.calibration.rules =
                rule_editing::open(&session.document, &session.calibration, &mut session.messages);
        }
        Action::ForgetStates => {
            manual_states::forget_states(&session.document, &mut session.calibration, &mut session.jobs, ctx);
        }
        Action::ForgetStated => session.calibration.choice.stated = Stated::default(),
        Action::FitShown => session.calibration.choice.only_s = Some(session.document.view_s),
        Action::FitWhole => session.calibration.choice.only_s = None,
        Action::Undo => {
            undo_actions::undo(
                &mut session.document,
                &mut session.calibration,
                &mut session.plots,
                &mut session.messages,
            );
        }
        Action::Redo => {
            undo_actions::redo(
                &mut session.document,
                &mut session.calibration,
                &mut session.plots,
                &mut session.messages,
            );
        }
        Action::Play | Action::ToStart | Action::ToEnd | Action::ShowAll | Action::Select(_) | Action::GoTo { .. } => {
            with_document(action, &mut session.document);
        }
        Action::TrainCalibrated
        | Action::Assistant
        | Action::StartOver
        | Action::Answer(..)
        | Action::Lesson(_)
        | Action::Watch
        | Action::Practise
        | Action::TakeTest
        | Action::PractiseOnThis
        | Action::Record => with_training(action, ctx, session),
        _ => with_files(action, ctx, session),
    }
}

fn with_files(action: &Action, ctx: &Context, session: &mut Session) {
    match action {
        Action::OpenLog => files::ask(ctx, &mut session.jobs, dialogs::OPEN_LOG),
        Action::AddLog => files::ask(ctx, &mut session.jobs, dialogs::ADD_LOG),
        Action::AddVideo => files::ask(ctx, &mut session.jobs, dialogs::OPEN_VIDEO),
        Action::OpenWorld => files::ask(ctx, &mut session.jobs, dialogs::OPEN_WORLD),
        Action::OpenProject => files::ask(ctx, &mut session.jobs, dialogs::OPEN_PROJECT),
        Action::OpenRecent(path) => opening::open_any(
            &mut session.document,
            &mut session.wanted_pane,
            &mut session.messages,
            &mut session.jobs,
            ctx,
            path,
        ),
        Action::SaveProject => project_files::save_project(session, ctx),
        Action::SaveProjectAs => files::ask(ctx, &mut session.jobs, project_files::SAVE_PROJECT),
        Action::SaveLog => files::ask(ctx, &mut session.jobs, dialogs::SAVE_LOG),
        Action::SaveWorld => files::ask(ctx, &mut session.jobs, dialogs::SAVE_WORLD),
        Action::ExportWorld => files::ask(ctx, &mut session.jobs, dialogs::EXPORT_WORLD),
        Action::Report => files::ask(ctx, &mut session.jobs, dialogs::SAVE_REPORT),
        Action::Reload => dispatch::reload(session, ctx),
        Action::MapColumns => opening::map_columns(&session.document, &mut session.jobs, ctx, None),
        // Actions of the window.
        _ => {}
    }
}

fn with_document(action: &Action, document: &mut Document) {
    match action {
        Action::Play => document.toggle_play(),
        Action::ToStart => document.seek(f64::NEG_INFINITY),
        Action::ToEnd => document.seek(f64::INFINITY),
        Action::ShowAll => {
            if let Some(prepared) = document.prepared() {
                document.view_s = prepared.span();
            }
        }
        Action::Select(index) => document.select(*index),
        Action::GoTo { from_s, to_s, .. } => document.look_at(*from_s, *to_s),
        _ => {}
    }
}

fn with_training(action: &Action, ctx: &Context, session: &mut Session) {
    match action {
        Action::TrainCalibrated => {
            session.training.train_calibrated = true;
            session.workspace = Workspace::Train;
        }
        Action::Assistant => session.training.assistant.on = !session.training.assistant.on,
        Action::StartOver => {
            restart::start_over(&mut session.experiments, &mut session.training, &mut session.messages);
        }
        Action::Answer(index, _) => practising::end_lesson(&mut session.training, &mut session.jobs, ctx, Some(*index)),
        Action::Lesson(title) => practising::open_lesson_titled(
            &mut session.workspace,
            &mut session.training,
            &mut session.messages,
            &mut session.jobs,
            ctx,
            title,
        ),
        Action::Watch => practising::watch_lesson(&mut session.training, &mut session.messages),
        Action::Practise => practising::practise_lesson(&mut session.training, &mut session.messages),
        Action::TakeTest => practising::test_lesson(&mut session.training, &mut session.messages),
        Action::PractiseOnThis => practising::practise_on_this(&session.calibration, &mut session.jobs, ctx),
        Action::Record if session.training.trainer.is_recording() => crate::ui::train::recorder::stop_and_open(
            ctx,
            &mut session.document,
            &mut session.training.trainer,
            &mut session.messages,
            &mut session.jobs,
        ),
        Action::Record => crate::ui::train::recorder::start(&mut session.training.trainer, &mut session.messages),
        _ => {}
    }
}

fn resize(ctx: &Context, by: f32) {
    ctx.set_zoom_factor((ctx.zoom_factor() + by).clamp(SIZES.0, SIZES.1));
}
