//! Where panels stand: tiles that can be resized, dragged into tabs, closed and brought back; one arrangement a workspace.
//!
//! As long as nothing was moved, columns keep widths that suit the window ([`layout`]); afterwards the shares are the user's.

mod behavior;
mod layout;
mod panes;

pub use panes::{Pane, Panels};

use super::session::{Session, Workspace};
use behavior::Tiling;
use egui::{Frame, Margin, Ui};
use egui_tiles::{TileId, Tree};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// The arrangement of one workspace.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Arrangement {
    tree: Tree<Pane>,
    /// Whether the user has moved anything.
    pub moved: bool,
}

/// The arrangements of all workspaces.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Dock {
    all: BTreeMap<Workspace, Arrangement>,
    /// Titles are shown on every panel, to drag and to close them.
    #[serde(skip)]
    pub arranging: bool,
}

impl Dock {
    /// Draws the panels of the open workspace.
    pub fn ui(&mut self, ui: &mut Ui, panels: &mut Panels, session: &mut Session) {
        let workspace = session.workspace;
        let arranging = self.arranging;
        let mine = self.of(workspace);
        mine.show_only_what_has_contents(session);
        let room = ui.available_size();
        if !mine.moved {
            layout::suit(&mut mine.tree, workspace, room, session);
        }
        let mut tiling = Tiling { panels, session, arranging, edited: false };
        Frame::new().inner_margin(Margin::same(layout::GAP as i8)).show(ui, |ui| mine.tree.ui(&mut tiling, ui));
        mine.moved |= tiling.edited;
    }

    fn of(&mut self, workspace: Workspace) -> &mut Arrangement {
        let new = || Arrangement { tree: layout::standard(workspace), moved: false };
        self.all.entry(workspace).or_insert_with(new)
    }

    /// Everything where it belongs again, in one workspace.
    pub fn reset(&mut self, workspace: Workspace) {
        self.all.remove(&workspace);
    }

    /// True when something was moved there.
    pub fn is_moved(&self, workspace: Workspace) -> bool {
        self.all.get(&workspace).is_some_and(|a| a.moved)
    }

    /// True when the panel stands somewhere in the workspace.
    pub fn has(&mut self, workspace: Workspace, pane: Pane) -> bool {
        self.of(workspace).find(pane).is_some()
    }

    /// Where the panel was drawn.
    pub fn rect(&mut self, workspace: Workspace, pane: Pane) -> Option<egui::Rect> {
        let mine = self.of(workspace);
        mine.tree.tiles.rect(mine.find(pane)?)
    }

    /// Brings a panel in, or takes it out.
    pub fn toggle(&mut self, workspace: Workspace, pane: Pane) {
        let mine = self.of(workspace);
        match mine.find(pane) {
            Some(tile) => drop(mine.tree.remove_recursively(tile)),
            None => mine.add(pane),
        }
        mine.moved = true;
    }

    /// Brings a panel to the front, and in where it is not there.
    pub fn bring(&mut self, workspace: Workspace, pane: Pane) {
        let mine = self.of(workspace);
        if mine.find(pane).is_none() {
            mine.add(pane);
            mine.moved = true;
        }
        mine.tree.make_active(|_, tile| matches!(tile, egui_tiles::Tile::Pane(p) if *p == pane));
    }
}

impl Arrangement {
    fn find(&self, pane: Pane) -> Option<TileId> {
        self.tree.tiles.find_pane(&pane)
    }

    /// At the right edge, or alone.
    fn add(&mut self, pane: Pane) {
        let tile = self.tree.tiles.insert_pane(pane);
        match self.tree.root() {
            None => self.tree.root = Some(tile),
            Some(root) => match self.tree.tiles.get_mut(root) {
                Some(egui_tiles::Tile::Container(container)) => container.add_child(tile),
                _ => self.tree.root = Some(self.tree.tiles.insert_horizontal_tile(vec![root, tile])),
            },
        }
    }

    /// The tabs that hold nothing but this tile, or the tile itself.
    fn alone_in(&self, tile: TileId) -> TileId {
        let Some(parent) = self.tree.tiles.parent_of(tile) else { return tile };
        match self.tree.tiles.get_container(parent) {
            Some(egui_tiles::Container::Tabs(tabs)) if tabs.children.len() == 1 => parent,
            _ => tile,
        }
    }

    /// Panels that have nothing to show yet leave their room to the others.
    fn show_only_what_has_contents(&mut self, session: &Session) {
        for pane in Pane::ALL {
            if let Some(tile) = self.find(pane) {
                // Alone, it hides its tabs as well: they would keep the room.
                self.tree.set_visible(tile, pane.has_contents(session));
                self.tree.set_visible(self.alone_in(tile), pane.has_contents(session));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn panels_are_taken_out_brought_in_and_put_back() {
        let mut dock = Dock::default();
        let at = Workspace::Calibrate;
        assert!(dock.has(at, Pane::Log) && !dock.has(at, Pane::Segments) && !dock.is_moved(at));
        dock.toggle(at, Pane::Log);
        dock.toggle(at, Pane::Segments);
        assert!(!dock.has(at, Pane::Log) && dock.has(at, Pane::Segments) && dock.is_moved(at));
        dock.bring(at, Pane::Log);
        assert!(dock.has(at, Pane::Log));
        dock.reset(at);
        assert!(!dock.has(at, Pane::Segments) && !dock.is_moved(at));
    }

    #[test]
    fn every_panel_can_be_taken_out_and_comes_back() {
        let mut dock = Dock::default();
        let at = Workspace::Calibrate;
        for pane in Pane::ALL {
            if dock.has(at, pane) {
                dock.toggle(at, pane);
            }
        }
        assert!(Pane::ALL.iter().all(|p| !dock.has(at, *p)));
        dock.bring(at, Pane::Results);
        dock.bring(at, Pane::Log);
        assert!(dock.has(at, Pane::Results) && dock.has(at, Pane::Log));
    }

    #[test]
    fn an_arrangement_survives_a_file() {
        let mut dock = Dock::default();
        dock.toggle(Workspace::Calibrate, Pane::Segments);
        let text = serde_json::to_string(&dock).expect("written");
        let mut again: Dock = serde_json::from_str(&text).expect("read");
        assert!(again.has(Workspace::Calibrate, Pane::Segments) && again.is_moved(Workspace::Calibrate));
    }
}
