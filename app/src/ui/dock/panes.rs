//! The panels of the window.

use crate::ui::icons::Icon;
use crate::ui::panels::Panel as _;
use crate::ui::panels::device_detail::DeviceDetail;
use crate::ui::panels::devices::DeviceList;
use crate::ui::panels::diagnose::DiagnosePanel;
use crate::ui::panels::diagnosis::DiagnosisPanel;
use crate::ui::panels::log::LogPanel;
use crate::ui::panels::progress::ProgressPanel;
use crate::ui::panels::recording::RecordingPanel;
use crate::ui::panels::results::ResultsPanel;
use crate::ui::panels::rules::RulesPanel;
use crate::ui::panels::scene::ScenePanel;
use crate::ui::panels::segments::SegmentsPanel;
use crate::ui::panels::sensitivity::SensitivityPanel;
use crate::ui::panels::trainer_side::TrainerSide;
use crate::ui::panels::trainer_view::TrainerView;
use crate::ui::panels::video::VideoPanel;
use crate::ui::session::{Session, Workspace};
use egui::Ui;
use serde::{Deserialize, Serialize};

/// Panel identifier.
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Default, strum::EnumIter, Serialize, Deserialize,
)]
#[serde(rename_all = "kebab-case")]
pub enum Pane {
    /// Choice of the recording, and fit options.
    #[default]
    Recording,
    /// 3D view of the recording, or the rules of its task.
    Scene,
    /// Plots with one time axis.
    Log,
    /// Results of the fit.
    Results,
    /// States and subtasks as a list.
    Segments,
    /// Sensitivity of the result to the parameters, and their correlations.
    Sensitivity,
    /// The video of the hand.
    Video,
    /// The virtual world.
    Trainer,
    /// Settings and readings of the trainer.
    TrainerSide,
    /// Progress of the trainee.
    Progress,
    /// Measured and modelled force.
    Diagnose,
    /// Diagnosed causes.
    Diagnosis,
    /// Choice of the device.
    Devices,
    /// Performance of the device.
    DeviceDetail,
}

impl Pane {
    /// Title for the user.
    pub fn title(self) -> &'static str {
        match self {
            Self::Recording => "Recording and fit",
            Self::Scene => "In space",
            Self::Log => "Plots",
            Self::Results => "Results",
            Self::Segments => "States",
            Self::Sensitivity => "Sensitivity",
            Self::Video => "Video of the hand",
            Self::Trainer => "Virtual world",
            Self::TrainerSide => "Trainer",
            Self::Progress => "Progress",
            Self::Diagnose => "Measured and modelled",
            Self::Diagnosis => "Diagnosis",
            Self::Devices => "Devices",
            Self::DeviceDetail => "Device",
        }
    }

    /// Icon of the panel.
    pub fn icon(self) -> Icon {
        match self {
            Self::Recording => Icon::Fit,
            Self::Scene => Icon::Scene,
            Self::Log => Icon::Curves,
            Self::Segments => Icon::States,
            Self::Sensitivity => Icon::Sensitivity,
            Self::Video => Icon::Video,
            Self::Trainer => Icon::World,
            Self::Progress => Icon::Progress,
            Self::Diagnosis => Icon::Diagnose,
            Self::Devices | Self::DeviceDetail => Icon::Device,
            Self::Results | Self::TrainerSide | Self::Diagnose => Icon::Panel,
        }
    }

    /// Panels available in a workspace.
    pub fn of(workspace: Workspace) -> &'static [Self] {
        match workspace {
            Workspace::Train => &[Self::Trainer, Self::TrainerSide, Self::Progress],
            Workspace::Calibrate => &[
                Self::Recording,
                Self::Scene,
                Self::Log,
                Self::Results,
                Self::Segments,
                Self::Sensitivity,
                Self::Video,
            ],
            Workspace::Diagnose => {
                &[Self::Diagnose, Self::Diagnosis, Self::Scene, Self::Log, Self::Segments, Self::Results, Self::Video]
            }
            Workspace::Devices => &[Self::Devices, Self::DeviceDetail],
        }
    }

    /// False while the panel has no content and others can use its space.
    pub(super) fn has_contents(self, session: &Session) -> bool {
        self != Self::Diagnosis || session.diagnosing.answer.is_some()
    }
}

/// All panels, each with its state.
#[derive(Default)]
pub struct Panels {
    log: LogPanel,
    recording: RecordingPanel,
    results: ResultsPanel,
    scene: ScenePanel,
    trainer: TrainerView,
    devices: DeviceList,
}

impl Panels {
    /// Draws a panel into the available space.
    pub fn ui(&mut self, pane: Pane, ui: &mut Ui, session: &mut Session) {
        match pane {
            Pane::Recording => self.recording.ui(ui, session),
            // The rules replace the picture, so that the states below are seen to follow.
            Pane::Scene if session.rules.is_some() => RulesPanel.ui(ui, session),
            Pane::Scene => self.scene.ui(ui, session),
            Pane::Log => self.log.ui(ui, session),
            Pane::Results => self.results.ui(ui, session),
            Pane::Segments => SegmentsPanel.ui(ui, session),
            Pane::Sensitivity => SensitivityPanel.ui(ui, session),
            Pane::Video => VideoPanel.ui(ui, session),
            Pane::Trainer => self.trainer.ui(ui, session),
            Pane::TrainerSide => TrainerSide.ui(ui, session),
            Pane::Progress => ProgressPanel.ui(ui, session),
            Pane::Diagnose => DiagnosePanel.ui(ui, session),
            Pane::Diagnosis => DiagnosisPanel.ui(ui, session),
            Pane::Devices => self.devices.ui(ui, session),
            Pane::DeviceDetail => DeviceDetail.ui(ui, session),
        }
    }
}
