//! The standard layouts, and column widths for the window.

use crate::ui::calibrate::state::Calibration;
use crate::ui::shell::panel_id::PanelId;
use crate::ui::shell::panel_list;
use crate::ui::shell::workspace::Workspace;
use crate::ui::train::comfort::Comfort;
use egui::Vec2;
use egui_tiles::{Container, Linear, LinearDir, Tile, TileId, Tiles, Tree};
use std::collections::BTreeSet;

/// Gap between panels, and around them, points.
pub const GAP: f32 = 12.0;
/// Height of readable plots, points.
const PLOTS: f32 = 446.0;
/// Width of the trainer's side, points.
const TRAINER_SIDE: f32 = 312.0;

/// Standard layout of a workspace.
pub fn standard(workspace: Workspace) -> Tree<PanelId> {
    let mut tiles = Tiles::default();
    let root = match workspace {
        Workspace::Calibrate => {
            let [recording, scene, log, results] =
                [PanelId::RECORDING, PanelId::SCENE, PanelId::LOG, PanelId::RESULTS].map(|p| tiles.insert_pane(p));
            let middle = tiles.insert_vertical_tile(vec![scene, log]);
            tiles.insert_horizontal_tile(vec![recording, middle, results])
        }
        Workspace::Train => side_by_side(&mut tiles, [PanelId::TRAINER, PanelId::TRAINER_SIDE]),
        Workspace::Diagnose => side_by_side(&mut tiles, [PanelId::DIAGNOSE, PanelId::DIAGNOSIS]),
        Workspace::Devices => side_by_side(&mut tiles, [PanelId::DEVICES, PanelId::DEVICE_DETAIL]),
    };
    Tree::new(egui::Id::unique(("dock", workspace)), root, tiles)
}

/// Panels of the standard layout.
pub fn standard_panes(workspace: Workspace) -> BTreeSet<PanelId> {
    let tree = standard(workspace);
    panel_list::ids().filter(|pane| tree.tiles.find_pane(pane).is_some()).collect()
}

fn side_by_side(tiles: &mut Tiles<PanelId>, panes: [PanelId; 2]) -> TileId {
    let children = panes.map(|p| tiles.insert_pane(p)).to_vec();
    tiles.insert_horizontal_tile(children)
}

/// Sets the columns of an unmodified layout to widths for the available space.
pub fn suit(tree: &mut Tree<PanelId>, workspace: Workspace, room: Vec2, calibration: &Calibration, comfort: Comfort) {
    let wide = room.x - 2.0 * GAP;
    match workspace {
        Workspace::Calibrate => {
            let (left, right) = ((0.18 * wide).clamp(208.0, 240.0), (0.25 * wide).clamp(356.0, 372.0));
            columns(tree, LinearDir::Horizontal, &[Some(left), None, Some(right)], wide);
            // The rules need more space than the picture.
            let upper = if calibration.rules.is_some() {
                0.48 * room.y
            } else {
                (0.40 * room.y).min(room.y - PLOTS).max(150.0)
            };
            columns(tree, LinearDir::Vertical, &[Some(upper), None], room.y - 2.0 * GAP);
        }
        Workspace::Train => {
            let left = comfort.left_handed;
            side_first(tree, left);
            let [side, picture] = [Some(TRAINER_SIDE), None];
            columns(tree, LinearDir::Horizontal, &if left { [side, picture] } else { [picture, side] }, wide);
        }
        Workspace::Diagnose => {
            columns(tree, LinearDir::Horizontal, &[None, Some((0.28 * wide).clamp(332.0, 396.0))], wide);
        }
        Workspace::Devices => {
            columns(tree, LinearDir::Horizontal, &[Some((0.36 * wide).clamp(306.0, 356.0)), None], wide);
        }
    }
}

/// Puts the trainer's controls left or right of its picture.
fn side_first(tree: &mut Tree<PanelId>, left: bool) {
    let (Some(pane), Some(root)) = (tree.tiles.find_pane(&PanelId::TRAINER_SIDE), tree.root()) else { return };
    // A pane is in the row itself, or in a tab container there.
    let holder = tree.tiles.parent_of(pane).filter(|holder| *holder != root);
    if let Some(Tile::Container(Container::Linear(linear))) = tree.tiles.get_mut(root) {
        let is_side = |child: &TileId| *child == pane || Some(*child) == holder;
        linear.children.sort_by_key(|child| is_side(child) != left);
    }
}

/// Sets the shares of the outermost columns, or of the rows within one: given sizes, and one that takes the rest.
/// Shares stay as they are where panels were added or removed.
fn columns(tree: &mut Tree<PanelId>, dir: LinearDir, widths: &[Option<f32>], room: f32) {
    let gaps = GAP * (widths.len() as f32 - 1.0);
    let rest = (room - gaps - widths.iter().flatten().sum::<f32>()).max(1.0);
    let root = tree.root();
    let outer = root.and_then(|root| tree.tiles.get_container(root)).map(Container::children_vec).unwrap_or_default();
    let asked = |tree: &Tree<PanelId>, tile: TileId| {
        tree.tiles.get_container(tile).is_some_and(
            |container| matches!(container, Container::Linear(l) if l.dir == dir && l.children.len() == widths.len()),
        )
    };
    let found = root.into_iter().chain(outer).find(|tile| asked(tree, *tile));
    if let Some(Tile::Container(Container::Linear(linear))) = found.and_then(|tile| tree.tiles.get_mut(tile)) {
        let Linear { children, shares, .. } = linear;
        for (child, width) in children.iter().zip(widths) {
            shares.set_share(*child, width.unwrap_or(rest));
        }
    }
}
