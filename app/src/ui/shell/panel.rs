//! Panels: the trait that each implements, and the registration that tells the rest of the window about it.

use crate::ui::headless::gallery::sample::Sample;
use crate::ui::headless::picture_input::PictureInput;
use crate::ui::kit::icons::Icon;
use crate::ui::session::Session;
use crate::ui::shell::panel_id::PanelId;
use crate::ui::shell::workspace::Workspace;
use egui_tiles::ContainerKind;

/// A part of the window that shows and changes the session.
pub trait Panel {
    /// Draws the panel into the available space.
    fn ui(&mut self, ui: &mut egui::Ui, session: &mut Session);
}

/// Everything that the window knows of a panel before it is drawn. Each feature lists its own in `panels/mod.rs`.
pub struct Registration {
    /// Its name in layout files.
    pub id: PanelId,
    /// Its title.
    pub title: &'static str,
    /// Its icon.
    pub icon: Icon,
    /// The workspaces in which it makes sense, with its place in the menu of each.
    pub workspaces: &'static [(Workspace, u8)],
    /// Related panels, the nearest first, with the container for both, and true if the panel comes first in it.
    pub neighbours: &'static [(PanelId, ContainerKind, bool)],
    /// Without a neighbour it stands at the left edge, else at the right one.
    pub at_the_left: bool,
    /// False while it has nothing to show and others can use its room.
    pub has_contents: fn(&Session) -> bool,
    /// Pictures of it.
    pub pictures: &'static [&'static Picture],
    /// A new one.
    pub new: fn() -> Box<dyn Panel>,
}

impl Registration {
    /// A panel at the right edge of no workspace, without pictures.
    pub const fn new(id: PanelId, title: &'static str, icon: Icon, new: fn() -> Box<dyn Panel>) -> Self {
        Self {
            id,
            title,
            icon,
            workspaces: &[],
            neighbours: &[],
            at_the_left: false,
            has_contents: |_| true,
            pictures: &[],
            new,
        }
    }
}

/// A picture that can be drawn without a window: for the command line, the gallery and tests.
pub struct Picture {
    /// Its name on the command line, and of its files in the gallery.
    pub name: &'static str,
    /// Its place in lists.
    pub place: u8,
    /// Content of the picture, for the help of the command line.
    pub help: &'static str,
    /// Content of the picture, for the gallery.
    pub line: &'static str,
    /// Pixels in the gallery.
    pub size: [u32; 2],
    /// The recording or world in the gallery.
    pub sample: Sample,
    /// The session that is drawn.
    pub session: fn(&PictureInput) -> anyhow::Result<Session>,
    /// Part of the session that is drawn.
    pub framing: Framing,
}

/// Part of a session that is drawn.
#[derive(Clone, Copy)]
pub enum Framing {
    /// A panel with a margin around it.
    Panel(fn() -> Box<dyn Panel>),
    /// The same, of a panel that is meant to fill a page.
    LargePanel(fn() -> Box<dyn Panel>),
    /// The whole window.
    Page,
}

/// Pixels of whole pages, of panels, of columns and of scenes in the gallery.
pub const PAGE: [u32; 2] = [1280, 720];
/// A panel.
pub const PANEL: [u32; 2] = [640, 480];
/// A column at an edge.
pub const COLUMN: [u32; 2] = [440, 760];
/// A scene.
pub const SCENE: [u32; 2] = [720, 480];
