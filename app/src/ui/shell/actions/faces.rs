//! Appearance of the actions in menus and in the palette.

use crate::ui::kit::icons::Icon;
use crate::ui::shell::actions::list::Action;
use crate::ui::shell::panel_list;

impl Action {
    /// Icon of the action; an entry of a list has the icon of the list.
    pub fn icon(&self) -> Option<Icon> {
        Some(match self {
            Self::OpenLog | Self::OpenRecent(_) | Self::OpenProject => Icon::Open,
            Self::OpenWorld => Icon::World,
            Self::AddLog => Icon::Add,
            Self::AddVideo => Icon::Video,
            Self::SaveProject | Self::SaveLog | Self::SaveWorld => Icon::Save,
            Self::SaveProjectAs => Icon::SaveAs,
            Self::ExportWorld => Icon::Export,
            Self::Report => Icon::Report,
            Self::Reload => Icon::Reload,
            Self::MapColumns => Icon::Columns,
            Self::Quit => Icon::Quit,
            Self::Undo => Icon::Undo,
            Self::Redo => Icon::Redo,
            Self::ForgetStates => Icon::FindStates,
            Self::ForgetStated => Icon::Forget,
            Self::Fit => Icon::Fit,
            Self::FitShown => Icon::Shown,
            Self::FitWhole | Self::ShowAll => Icon::Whole,
            Self::Rules => Icon::Rules,
            Self::Diagnose => Icon::Diagnose,
            Self::Extend => Icon::Extend,
            Self::Feel => Icon::Feel,
            Self::TrainCalibrated => Icon::Touch,
            Self::PractiseOnThis | Self::Lesson(_) | Self::Practise => Icon::Lesson,
            Self::Watch | Self::Play => Icon::Play,
            Self::TakeTest => Icon::Check,
            Self::Assistant => Icon::Assistant,
            Self::StartOver => Icon::Reset,
            Self::Record => Icon::Record,
            Self::ToStart => Icon::ToStart,
            Self::ToEnd => Icon::ToEnd,
            Self::Open(workspace) => workspace.icon(),
            Self::Panel(pane) => panel_list::registration(*pane).map_or(Icon::Panel, |panel| panel.icon),
            Self::Arrange | Self::Layout(_) => Icon::Arrange,
            Self::Theme => Icon::Theme,
            Self::Larger => Icon::Larger,
            Self::Smaller => Icon::Smaller,
            Self::FullScreen => Icon::FullScreen,
            Self::Palette => Icon::Find,
            Self::Tour => Icon::Help,
            Self::Select(_) => Icon::Curves,
            Self::GoTo { .. } => Icon::GoTo,
            Self::Answer(..) => Icon::Answer,
            Self::DeleteLayout => Icon::Remove,
            Self::ResetLayout | Self::SaveLayout | Self::RenameLayout | Self::UsualSize => return None,
        })
    }
}
