//! The list of actions: names, keys, groups, and reasons against them.

use crate::text::format;
use crate::ui::calibrate::manual_states::decides;
use crate::ui::calibrate::state::Calibration;
use crate::ui::document::state::Document;
use crate::ui::document::undo_actions;
use crate::ui::shell::app::App;
use crate::ui::shell::panel_id::PanelId;
use crate::ui::shell::panel_list;
use crate::ui::shell::workspace::Workspace;
use egui::{Key, KeyboardShortcut, Modifiers};
use std::path::PathBuf;
use strum::{EnumIter, IntoEnumIterator as _};

/// One action. Variants without arguments come first, in the order of the menus.
#[derive(Clone, Debug, PartialEq, EnumIter)]
pub enum Action {
    /// Chooses a log.
    OpenLog,
    /// Adds a recording to the open ones.
    AddLog,
    /// Chooses a video of the hand.
    AddVideo,
    /// Chooses a world.
    OpenWorld,
    /// Chooses a project.
    OpenProject,
    /// Saves the project to its file.
    SaveProject,
    /// Saves the project to another file.
    SaveProjectAs,
    /// Writes the shown recording.
    SaveLog,
    /// Writes the calibrated world.
    SaveWorld,
    /// Writes the calibrated world for another simulator.
    ExportWorld,
    /// Writes a report.
    Report,
    /// Reads the same files again.
    Reload,
    /// Opens the mapping dialog for the columns.
    MapColumns,
    /// Ends the program.
    Quit,
    /// Undoes the last change.
    Undo,
    /// Redoes it.
    Redo,
    /// Restores the detected states.
    ForgetStates,
    /// Clears the values that the user has set for parameters.
    ForgetStated,
    /// Fits with the current settings.
    Fit,
    /// Fits the visible time range only.
    FitShown,
    /// Fits the whole recording.
    FitWhole,
    /// Opens the rules of the task.
    Rules,
    /// Diagnoses what the base model misses.
    Diagnose,
    /// Adds the diagnosed causes to the model.
    Extend,
    /// Loads the base and the extended world into the trainer.
    Feel,
    /// Loads the calibrated world into the trainer.
    TrainCalibrated,
    /// Makes a lesson of the calibrated world.
    PractiseOnThis,
    /// Switches the assistant over the trainer's picture on or off.
    Assistant,
    /// Resets everything in Train to its start.
    StartOver,
    /// Starts the expert's demonstration of the open lesson.
    Watch,
    /// Starts practice of the open lesson.
    Practise,
    /// Starts the test of the open lesson.
    TakeTest,
    /// Starts or ends a recording.
    Record,
    /// Plays or pauses.
    Play,
    /// Moves the cursor to the start.
    ToStart,
    /// Moves the cursor to the end.
    ToEnd,
    /// Shows the whole recording.
    ShowAll,
    /// Opens a workspace.
    Open(Workspace),
    /// Shows a title on every panel, to move it.
    Arrange,
    /// Restores the standard layout.
    ResetLayout,
    /// Saves the layout under a name.
    SaveLayout,
    /// Renames the open layout.
    RenameLayout,
    /// Deletes the open layout's name.
    DeleteLayout,
    /// Shows or hides a panel.
    Panel(PanelId),
    /// Switches the theme.
    Theme,
    /// Enlarges the window's content.
    Larger,
    /// Shrinks the window's content.
    Smaller,
    /// Restores the system's zoom.
    UsualSize,
    /// Switches full screen.
    FullScreen,
    /// Opens the palette of all actions.
    Palette,
    /// Opens the tour.
    Tour,
    /// Opens a recent file.
    #[strum(disabled)]
    OpenRecent(PathBuf),
    /// Shows another recording.
    #[strum(disabled)]
    Select(usize),
    /// Moves the time cursor.
    #[strum(disabled)]
    GoTo {
        /// Name of the target.
        what: String,
        /// Start, s.
        from_s: f64,
        /// End, s.
        to_s: f64,
    },
    /// Answers the lesson's question.
    #[strum(disabled)]
    Answer(usize, String),
    /// Opens a lesson by its name.
    #[strum(disabled)]
    Lesson(String),
    /// Opens a layout by its name.
    #[strum(disabled)]
    Layout(String),
}

/// Menu of an action.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Group {
    /// Files.
    File,
    /// Changes and undo.
    Edit,
    /// Fit, diagnose, extend.
    Calibrate,
    /// Time.
    Time,
    /// Appearance.
    View,
    /// Help.
    Help,
    /// Positions in the recording: the palette only.
    Places,
}

impl Group {
    /// The menus.
    pub const MENUS: [Self; 6] = [Self::File, Self::Edit, Self::Calibrate, Self::Time, Self::View, Self::Help];

    /// Title for the user.
    pub fn title(self) -> &'static str {
        match self {
            Self::File => "File",
            Self::Edit => "Edit",
            Self::Calibrate => "Calibrate",
            Self::Time => "Time",
            Self::View => "View",
            Self::Help => "Help",
            Self::Places => "Go to",
        }
    }
}

impl Action {
    /// All actions that the window currently offers.
    pub fn all(app: &App) -> impl Iterator<Item = Self> + use<> {
        let session = &app.session;
        let layouts = app.dock.names(session.workspace).map(|name| Self::Layout(name.to_owned()));
        let panels = panel_list::of(session.workspace).into_iter().filter(|p| *p != PanelId::SEGMENTS).map(Self::Panel);
        let recent = session.document.recent.files().iter().map(|path| Self::OpenRecent(path.clone()));
        let recordings =
            (0..session.document.recordings.len()).filter(|i| *i != session.document.current).map(Self::Select);
        let known = !matches!(session.workspace, Workspace::Train | Workspace::Devices);
        let places = if known { places(&session.document, &session.calibration) } else { Vec::new() };
        let fixed = Self::iter().flat_map(|action| match action {
            Self::Open(_) => Workspace::CHOICES.map(|(workspace, ..)| Self::Open(workspace)).to_vec(),
            Self::Panel(_) => {
                if known {
                    vec![Self::Panel(PanelId::SEGMENTS)]
                } else {
                    Vec::new()
                }
            }
            other => vec![other],
        });
        let lessons = session.training.lessons.all.iter().map(|lesson| Self::Lesson(lesson.title.clone()));
        let answers =
            session.training.lessons.answers().into_iter().enumerate().map(|(k, words)| Self::Answer(k, words));
        let all: Vec<Self> = fixed
            .chain(answers)
            .chain(lessons)
            .chain(layouts)
            .chain(panels)
            .chain(recent)
            .chain(recordings)
            .chain(places)
            .collect();
        all.into_iter()
    }

    /// Title for the user.
    pub fn title(&self) -> String {
        match self {
            Self::OpenRecent(path) => {
                format!("Open {}", path.file_name().map(|n| n.to_string_lossy().into_owned()).unwrap_or_default())
            }
            Self::Select(index) => format!("Show recording {}", index + 1),
            Self::GoTo { what, .. } => format!("Go to: {what}"),
            Self::Open(workspace) => format!("Open {}", workspace.title()),
            Self::Panel(pane) => format!("Panel: {}", panel_list::registration(*pane).map_or("", |panel| panel.title)),
            Self::Lesson(title) => format!("Lesson: {title}"),
            Self::Answer(_, words) => format!("Answer: {words}"),
            Self::Layout(name) => format!("Arrangement: {name}"),
            other => other.fixed_title().to_owned(),
        }
    }

    fn fixed_title(&self) -> &'static str {
        match self {
            Self::OpenLog => "Open log …",
            Self::OpenWorld => "Open world …",
            Self::OpenProject => "Open project …",
            Self::AddLog => "Add recording …",
            Self::AddVideo => "Add video …",
            Self::SaveProject => "Save project",
            Self::SaveProjectAs => "Save project as …",
            Self::SaveLog => "Save recording as …",
            Self::SaveWorld => "Save calibrated world as …",
            Self::ExportWorld => "Export calibrated world (MuJoCo, URDF, SDF) …",
            Self::Report => "Write report …",
            Self::Reload => "Reload",
            Self::MapColumns => "Map columns …",
            Self::Quit => "Quit",
            Self::Undo => "Undo",
            Self::Redo => "Redo",
            Self::Fit => "Fit again",
            Self::Rules => "Rules of the task …",
            Self::ForgetStates => "Find states again",
            Self::ForgetStated => "Forget what is stated of parameters",
            Self::FitShown => "Fit only what is shown",
            Self::FitWhole => "Fit the whole recording",
            Self::Diagnose => "Diagnose",
            Self::Extend => "Extend the model",
            Self::Feel => "Feel before and after",
            Self::TrainCalibrated => "Train in the calibrated world",
            Self::PractiseOnThis => "Practise on this (a lesson in the calibrated world)",
            Self::Assistant => "Assistant on or off",
            Self::StartOver => "Start over in Train",
            Self::Watch => "Watch the lesson",
            Self::Practise => "Practise the lesson",
            Self::TakeTest => "Take the lesson's test",
            Self::Record => "Record, or stop",
            Self::Play => "Play or pause",
            Self::ToStart => "To the beginning",
            Self::ToEnd => "To the end",
            Self::ShowAll => "Show the whole recording",
            Self::Arrange => "Arrange panels",
            Self::ResetLayout => "Standard arrangement",
            Self::SaveLayout => "Save arrangement as …",
            Self::RenameLayout => "Rename arrangement …",
            Self::DeleteLayout => "Delete arrangement",
            Self::Theme => "Light or dark",
            Self::Larger => "Larger",
            Self::Smaller => "Smaller",
            Self::UsualSize => "Usual size",
            Self::FullScreen => "Full screen",
            Self::Palette => "All commands …",
            Self::Tour => "Show me around",
            Self::OpenRecent(_)
            | Self::Select(_)
            | Self::GoTo { .. }
            | Self::Lesson(_)
            | Self::Answer(..)
            | Self::Open(_)
            | Self::Panel(_)
            | Self::Layout(_) => "",
        }
    }

    /// Search text of the palette: the title and its synonyms.
    pub fn search_text(&self) -> String {
        let also = match self {
            Self::Fit => " refit estimate",
            Self::AddVideo => " camera film",
            Self::Theme => " theme colours",
            Self::Larger | Self::Smaller | Self::UsualSize => " zoom scale",
            Self::Diagnose => " cause wrong model",
            Self::Rules => " thresholds segmentation",
            Self::Tour => " help tour",
            Self::StartOver => " reset again anew",
            Self::SaveLayout | Self::RenameLayout | Self::DeleteLayout | Self::Layout(_) | Self::ResetLayout => {
                " layout panels"
            }
            _ => "",
        };
        self.title() + also
    }

    /// Keyboard shortcut.
    pub fn keys(&self) -> Option<KeyboardShortcut> {
        let ctrl = |key| Some(KeyboardShortcut::new(Modifiers::COMMAND, key));
        let more = |key| Some(KeyboardShortcut::new(Modifiers::COMMAND | Modifiers::SHIFT, key));
        let plain = |key| Some(KeyboardShortcut::new(Modifiers::NONE, key));
        match self {
            Self::OpenLog => ctrl(Key::O),
            Self::OpenProject => more(Key::O),
            Self::SaveProject => ctrl(Key::S),
            Self::SaveProjectAs => more(Key::S),
            Self::Reload => plain(Key::F5),
            Self::Quit => ctrl(Key::Q),
            Self::Undo => ctrl(Key::Z),
            Self::Redo => more(Key::Z),
            Self::Fit => ctrl(Key::Enter),
            Self::Diagnose => ctrl(Key::D),
            Self::Extend => ctrl(Key::E),
            Self::Play => plain(Key::Space),
            Self::ToStart => plain(Key::Home),
            Self::ToEnd => plain(Key::End),
            Self::ShowAll => ctrl(Key::Num0),
            Self::Open(Workspace::Train) => ctrl(Key::Num1),
            Self::Open(Workspace::Calibrate) => ctrl(Key::Num2),
            Self::Open(Workspace::Diagnose) => ctrl(Key::Num3),
            Self::Open(Workspace::Devices) => ctrl(Key::Num4),
            Self::FullScreen => plain(Key::F11),
            Self::Palette => ctrl(Key::P),
            Self::Tour => plain(Key::F1),
            Self::Assistant => plain(Key::H),
            Self::Record => plain(Key::R),
            Self::StartOver => plain(Key::N),
            _ => None,
        }
    }

    /// True if a text field does not use the shortcut.
    pub fn works_while_typing(&self) -> bool {
        matches!(self, Self::Reload | Self::FullScreen | Self::Tour)
    }

    /// Menu of the action.
    pub fn group(&self) -> Group {
        match self {
            Self::OpenLog
            | Self::OpenWorld
            | Self::OpenProject
            | Self::OpenRecent(_)
            | Self::AddLog
            | Self::AddVideo
            | Self::SaveProject
            | Self::SaveProjectAs
            | Self::SaveLog
            | Self::SaveWorld
            | Self::ExportWorld
            | Self::Report
            | Self::Reload
            | Self::MapColumns
            | Self::Quit => Group::File,
            Self::Undo | Self::Redo | Self::ForgetStates | Self::ForgetStated => Group::Edit,
            Self::Fit
            | Self::FitShown
            | Self::FitWhole
            | Self::Rules
            | Self::Diagnose
            | Self::Extend
            | Self::Feel
            | Self::TrainCalibrated
            | Self::PractiseOnThis
            | Self::Assistant
            | Self::StartOver
            | Self::Record => Group::Calibrate,
            Self::Play | Self::ToStart | Self::ToEnd | Self::ShowAll => Group::Time,
            Self::Select(_)
            | Self::GoTo { .. }
            | Self::Lesson(_)
            | Self::Answer(..)
            | Self::Watch
            | Self::Practise
            | Self::TakeTest => Group::Places,
            Self::Palette | Self::Tour => Group::Help,
            _ => Group::View,
        }
    }

    /// Reason against the action, as a sentence; `None` if it is available.
    pub fn why_not(&self, app: &App) -> Option<&'static str> {
        let session = &app.session;
        let loaded = !session.document.recordings.is_empty();
        let need = |there: bool, why: &'static str| (!there).then_some(why);
        let recording = || need(loaded, "Open a log first.");
        let fit = || need(session.calibration.analysis.is_some(), "There is no fit yet.");
        match self {
            Self::SaveLog | Self::MapColumns | Self::Fit | Self::Rules | Self::Diagnose => recording(),
            Self::AddLog | Self::SaveProject | Self::SaveProjectAs | Self::Reload => {
                need(session.document.path.is_some(), "Open a log first.")
            }
            Self::Report => need(session.document.path.is_some(), "Open or save a log first: a report is of files."),
            Self::AddVideo => recording().or_else(|| {
                need(session.document.prepared().is_some_and(|p| !p.clockless()), "This recording has no clock.")
            }),
            Self::SaveWorld | Self::ExportWorld => fit(),
            Self::TrainCalibrated | Self::PractiseOnThis => {
                fit().or_else(|| need(session.calibration.can_train(), "This world has nothing for the hand."))
            }
            Self::Undo => need(
                undo_actions::can_undo(&session.document, &session.calibration, &session.plots),
                "Nothing was changed.",
            ),
            Self::Redo => need(
                undo_actions::can_redo(&session.document, &session.calibration, &session.plots),
                "Nothing was taken back.",
            ),
            Self::ForgetStates => need(
                session.calibration.choice.segments.contains_key(&session.document.current),
                "No state was set by hand.",
            ),
            Self::ForgetStated => {
                need(!session.calibration.choice.stated.is_empty(), "Nothing is stated of parameters.")
            }
            Self::FitShown => recording().or_else(|| {
                need(session.document.prepared().is_some_and(|p| !p.clockless()), "This recording has no clock.")
            }),
            Self::FitWhole => {
                need(session.calibration.choice.only_s.is_some(), "The whole recording is fitted already.")
            }
            Self::Extend => need(session.diagnosing.answer.is_some(), "Diagnose first."),
            Self::Feel => need(session.diagnosing.worlds.is_some(), "Extend the model first."),
            Self::Play | Self::ToStart | Self::ToEnd | Self::ShowAll => recording().or_else(|| {
                need(session.workspace == Workspace::Calibrate || session.workspace == Workspace::Diagnose, "Not here.")
            }),
            Self::Assistant => need(session.workspace == Workspace::Train, "The assistant helps in Train."),
            Self::Watch | Self::Practise | Self::TakeTest => {
                need(session.training.lessons.open.is_some(), "Open a lesson first.")
            }
            Self::Record => need(session.workspace == Workspace::Train, "Recording is done in Train."),
            Self::StartOver => need(session.workspace == Workspace::Train, "There is nothing to start over here."),
            Self::ResetLayout => need(app.dock.is_moved(session.workspace), "Nothing was moved."),
            Self::RenameLayout | Self::DeleteLayout => {
                need(app.dock.chosen(session.workspace).is_some(), "Save this arrangement, or choose one.")
            }
            _ => None,
        }
    }

    /// State of a toggle; `None` for other actions.
    pub fn is_on(&self, app: &mut App) -> Option<bool> {
        match self {
            Self::Panel(pane) => Some(app.dock.has(app.session.workspace, *pane)),
            Self::Arrange => Some(app.dock.arranging),
            Self::Assistant => Some(app.session.training.assistant.on),
            Self::Layout(name) => Some(app.dock.chosen(app.session.workspace) == Some(name)),
            Self::Open(workspace) => Some(app.session.workspace == *workspace),
            _ => None,
        }
    }
}

/// Positions of subtasks, states and warnings of the shown recording.
fn places(document: &Document, calibration: &Calibration) -> Vec<Action> {
    let Some(segmentation) = calibration.segmentation(document.current) else { return Vec::new() };
    let mut places: Vec<Action> = Vec::new();
    let named = calibration.analysis.as_ref().is_some_and(|a| decides(a.task));
    for interval in segmentation.states.iter().filter(|_| named) {
        let Some(subtask) = &interval.subtask else { continue };
        let what = format::object(subtask).to_lowercase();
        let again = places.iter().any(|p| matches!(p, Action::GoTo { what: w, .. } if *w == what));
        if !again {
            places.push(Action::GoTo { what, from_s: interval.t0, to_s: interval.t1 });
        }
    }
    places
}
