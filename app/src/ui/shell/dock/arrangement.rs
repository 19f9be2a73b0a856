//! Arrangements of panels, one a workspace.

use crate::ui::session::Session;
use crate::ui::shell::dock::behavior::Tiling;
use crate::ui::shell::dock::layout;
use crate::ui::shell::dock::name_field::Naming;
use crate::ui::shell::dock::named::Named;
use crate::ui::shell::dock::panes::Panels;
use crate::ui::shell::panel_id::PanelId;
use crate::ui::shell::panel_list;
use crate::ui::shell::workspace::Workspace;
use egui::{Frame, Margin, Ui};
use egui_tiles::{TileId, Tree};
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};

/// Layout of one workspace.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Arrangement {
    pub(crate) tree: Tree<PanelId>,
    /// True if the user has moved anything: the shares of the space are then left unchanged.
    pub moved: bool,
}

/// Layouts of all workspaces.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Dock {
    pub(crate) all: BTreeMap<Workspace, Arrangement>,
    /// Named layouts.
    #[serde(default)]
    pub(crate) named: BTreeMap<Workspace, Named>,
    /// Dialog for the name of a layout, while it is open.
    #[serde(skip)]
    pub naming: Option<Naming>,
    /// True if every panel shows its title, to drag and to close it.
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
            layout::suit(&mut mine.tree, workspace, room, &session.calibration, session.training.comfort);
        }
        let mut tiling = Tiling { panels, session, arranging, edited: false };
        Frame::new().inner_margin(Margin::same(layout::GAP as i8)).show(ui, |ui| mine.tree.ui(&mut tiling, ui));
        mine.moved |= tiling.edited;
    }

    pub(crate) fn of(&mut self, workspace: Workspace) -> &mut Arrangement {
        let new = || Arrangement { tree: layout::standard(workspace), moved: false };
        self.all.entry(workspace).or_insert_with(new)
    }

    /// Restores the standard layout of one workspace.
    pub fn reset(&mut self, workspace: Workspace) {
        self.all.remove(&workspace);
        self.choose_none(workspace);
    }

    /// True if a panel was moved, removed or added there.
    pub fn is_moved(&self, workspace: Workspace) -> bool {
        self.all.get(&workspace).is_some_and(|a| a.moved || a.panes() != layout::standard_panes(workspace))
    }

    /// True if the workspace contains the panel.
    pub fn has(&mut self, workspace: Workspace, pane: PanelId) -> bool {
        self.of(workspace).find(pane).is_some()
    }

    /// Rectangle of the panel in the last frame.
    pub fn rect(&mut self, workspace: Workspace, pane: PanelId) -> Option<egui::Rect> {
        let mine = self.of(workspace);
        mine.tree.tiles.rect(mine.find(pane)?)
    }

    /// Adds a panel, or removes it.
    pub fn toggle(&mut self, workspace: Workspace, pane: PanelId) {
        let mine = self.of(workspace);
        match mine.find(pane) {
            Some(tile) => drop(mine.tree.remove_recursively(tile)),
            None => mine.add(pane),
        }
    }

    /// Brings a panel to the front, and adds it if it is missing.
    pub fn bring(&mut self, workspace: Workspace, pane: PanelId) {
        let mine = self.of(workspace);
        if mine.find(pane).is_none() {
            mine.add(pane);
        }
        mine.tree.make_active(|_, tile| matches!(tile, egui_tiles::Tile::Pane(p) if *p == pane));
    }
}

impl Arrangement {
    /// Panels of the layout.
    fn panes(&self) -> BTreeSet<PanelId> {
        panel_list::ids().filter(|pane| self.find(*pane).is_some()).collect()
    }

    pub(crate) fn find(&self, pane: PanelId) -> Option<TileId> {
        self.tree.tiles.find_pane(&pane)
    }

    /// The tab container that holds only this tile, or the tile itself.
    fn alone_in(&self, tile: TileId) -> TileId {
        let Some(parent) = self.tree.tiles.parent_of(tile) else { return tile };
        match self.tree.tiles.get_container(parent) {
            Some(egui_tiles::Container::Tabs(tabs)) if tabs.children.len() == 1 => parent,
            _ => tile,
        }
    }

    /// Hides panels without content, so that others can use their space.
    fn show_only_what_has_contents(&mut self, session: &Session) {
        for pane in panel_list::ids() {
            if let Some(tile) = self.find(pane) {
                let has_contents = panel_list::registration(pane).is_none_or(|panel| (panel.has_contents)(session));
                // A panel alone hides its tabs as well: they would keep the space.
                self.tree.set_visible(tile, has_contents);
                self.tree.set_visible(self.alone_in(tile), has_contents);
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
        assert!(dock.has(at, PanelId::LOG) && !dock.has(at, PanelId::SEGMENTS) && !dock.is_moved(at));
        dock.toggle(at, PanelId::LOG);
        dock.toggle(at, PanelId::SEGMENTS);
        assert!(!dock.has(at, PanelId::LOG) && dock.has(at, PanelId::SEGMENTS) && dock.is_moved(at));
        dock.bring(at, PanelId::LOG);
        assert!(dock.has(at, PanelId::LOG));
        dock.reset(at);
        assert!(!dock.has(at, PanelId::SEGMENTS) && !dock.is_moved(at));
    }

    #[test]
    fn every_panel_can_be_taken_out_and_comes_back() {
        let mut dock = Dock::default();
        let at = Workspace::Calibrate;
        for pane in panel_list::ids() {
            if dock.has(at, pane) {
                dock.toggle(at, pane);
            }
        }
        assert!(panel_list::ids().all(|p| !dock.has(at, p)));
        dock.bring(at, PanelId::RESULTS);
        dock.bring(at, PanelId::LOG);
        assert!(dock.has(at, PanelId::RESULTS) && dock.has(at, PanelId::LOG));
    }

    #[test]
    fn a_panel_comes_in_beside_those_it_belongs_to_and_can_be_read() {
        let mut dock = Dock::default();
        let at = Workspace::Calibrate;
        for pane in [PanelId::VIDEO, PanelId("sensitivity"), PanelId::SEGMENTS] {
            dock.bring(at, pane);
        }
        for pane in [PanelId::RECORDING, PanelId::SCENE, PanelId::LOG] {
            dock.toggle(at, pane);
            dock.toggle(at, pane);
        }
        let mut session = Session::new();
        let (mut panels, mut rects) = (Panels::default(), Vec::new());
        let ctx = egui::Context::default();
        crate::ui::kit::theme::install(&ctx);
        let room = egui::Rect::from_min_size(egui::Pos2::ZERO, egui::vec2(1280.0, 680.0));
        let input = egui::RawInput { screen_rect: Some(room), ..Default::default() };
        let mut output = ctx.run_ui(input, |ui| {
            session.workspace = at;
            dock.ui(ui, &mut panels, &mut session);
        });
        output.textures_delta.clear();
        for pane in [PanelId::VIDEO, PanelId::SCENE, PanelId::SEGMENTS, PanelId::RECORDING, PanelId::LOG] {
            rects.push(dock.rect(at, pane).expect("drawn"));
        }
        assert!(rects.iter().all(|r| r.width() > 150.0 && r.height() > 100.0), "{rects:?}");
        let [video, scene, ..] = rects[..] else { unreachable!("five were asked for") };
        assert!(rects[3].right() <= scene.left() && scene.bottom() <= rects[4].top(), "as it was: {rects:?}");
        assert!(video.left() >= scene.right() && (video.top() - scene.top()).abs() < 1.0, "side by side: {rects:?}");
    }

    #[test]
    fn an_arrangement_survives_a_file() {
        let mut dock = Dock::default();
        dock.toggle(Workspace::Calibrate, PanelId::SEGMENTS);
        let text = serde_json::to_string(&dock).expect("written");
        let mut again: Dock = serde_json::from_str(&text).expect("read");
        assert!(again.has(Workspace::Calibrate, PanelId::SEGMENTS) && again.is_moved(Workspace::Calibrate));
    }
}
