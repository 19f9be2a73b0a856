//! Position of a restored panel: that of the standard layout, or beside related panels.

use crate::ui::shell::dock::arrangement::Arrangement;
use crate::ui::shell::panel_id::PanelId;
use crate::ui::shell::panel_list;
use egui_tiles::{Container, ContainerKind, Tile, TileId};

impl Arrangement {
    /// Adds a panel: beside its neighbour, otherwise at its edge, otherwise alone.
    pub(super) fn add(&mut self, pane: PanelId) {
        let tile = self.tree.tiles.insert_pane(pane);
        let panel = panel_list::registration(pane);
        let neighbours = panel.map_or(&[][..], |panel| panel.neighbours);
        let beside = neighbours.iter().find_map(|(other, kind, first)| Some((self.find(*other)?, *kind, *first)));
        match (beside, self.tree.root()) {
            (Some((other, ContainerKind::Tabs, _)), _) => self.share_tabs(other, tile),
            (Some((other, kind, first)), _) => {
                let other = self.whole(other, kind);
                self.split(other, kind, if first { vec![tile, other] } else { vec![other, tile] });
            }
            (None, Some(root)) => self.at_the_edge(root, tile, panel.is_some_and(|panel| panel.at_the_left)),
            (None, None) => self.tree.root = Some(tile),
        }
        self.tree.make_active(|id, _| id == tile);
    }

    /// Tile to split for a panel beside this one: its tab container, or its row if the new panel goes below.
    fn whole(&self, tile: TileId, kind: ContainerKind) -> TileId {
        let tile = self.tabs_of(tile).unwrap_or(tile);
        let row = self.tree.tiles.parent_of(tile).filter(|parent| self.tree.root() != Some(*parent));
        let is_row =
            |t: &TileId| self.tree.tiles.get_container(*t).map(Container::kind) == Some(ContainerKind::Horizontal);
        row.filter(is_row).filter(|_| kind == ContainerKind::Vertical).unwrap_or(tile)
    }

    /// Tab container of a panel.
    fn tabs_of(&self, tile: TileId) -> Option<TileId> {
        let parent = self.tree.tiles.parent_of(tile)?;
        (self.tree.tiles.get_container(parent)?.kind() == ContainerKind::Tabs).then_some(parent)
    }

    fn share_tabs(&mut self, old: TileId, new: TileId) {
        let tabs = self.tabs_of(old);
        match tabs.and_then(|tabs| self.tree.tiles.get_mut(tabs)) {
            Some(Tile::Container(container)) => container.add_child(new),
            _ => self.split(old, ContainerKind::Tabs, vec![old, new]),
        }
    }

    /// Replaces `old` by a container of both, with the same share of the space.
    fn split(&mut self, old: TileId, kind: ContainerKind, both: Vec<TileId>) {
        let parent = self.tree.tiles.parent_of(old);
        let both = self.tree.tiles.insert_container(Container::new(kind, both));
        match parent.and_then(|parent| self.tree.tiles.get_mut(parent)) {
            Some(Tile::Container(container)) => drop(container.replace_child(old, both)),
            _ => self.tree.root = Some(both),
        }
    }

    /// Adds a column of its own, of the average width of the others.
    fn at_the_edge(&mut self, root: TileId, tile: TileId, first: bool) {
        match self.tree.tiles.get_mut(root) {
            Some(Tile::Container(Container::Linear(linear))) => {
                let shares = linear.children.iter().map(|child| linear.shares[*child]).sum::<f32>();
                let mean = shares / linear.children.len().max(1) as f32;
                linear.children.insert(if first { 0 } else { linear.children.len() }, tile);
                linear.shares.set_share(tile, mean);
            }
            Some(Tile::Container(container)) => container.add_child(tile),
            _ => {
                let both = if first { vec![tile, root] } else { vec![root, tile] };
                self.tree.root = Some(self.tree.tiles.insert_horizontal_tile(both));
            }
        }
    }
}
