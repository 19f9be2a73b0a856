//! Where a panel comes in when it is brought back: beside those that it belongs to.

use super::{Arrangement, Pane};
use egui_tiles::{Container, ContainerKind, Tile, TileId};

/// The panel that it belongs to, and how the two then stand.
fn neighbour(pane: Pane) -> Option<(Pane, ContainerKind)> {
    match pane {
        Pane::Video => Some((Pane::Scene, ContainerKind::Horizontal)),
        Pane::Segments | Pane::Sensitivity => Some((Pane::Results, ContainerKind::Tabs)),
        _ => None,
    }
}

impl Arrangement {
    /// Brings a panel in: beside its neighbour, else at the right edge, else alone.
    pub(super) fn add(&mut self, pane: Pane) {
        let tile = self.tree.tiles.insert_pane(pane);
        let beside = neighbour(pane).and_then(|(other, kind)| Some((self.find(other)?, kind)));
        match (beside, self.tree.root()) {
            (Some((other, kind)), Some(_)) => self.split(other, tile, kind),
            (None, Some(root)) => self.at_the_edge(root, tile),
            (_, None) => self.tree.root = Some(tile),
        }
        self.tree.make_active(|id, _| id == tile);
    }

    /// Puts `new` where `old` stands, together with it.
    fn split(&mut self, old: TileId, new: TileId, kind: ContainerKind) {
        // A panel that stands among tabs shares them all.
        let parent = self.tree.tiles.parent_of(old);
        let tabs =
            parent.filter(|p| self.tree.tiles.get_container(*p).is_some_and(|c| c.kind() == ContainerKind::Tabs));
        if let Some(Tile::Container(container)) =
            tabs.filter(|_| kind == ContainerKind::Tabs).and_then(|p| self.tree.tiles.get_mut(p))
        {
            container.add_child(new);
            return;
        }
        let old = tabs.unwrap_or(old);
        let parent = self.tree.tiles.parent_of(old);
        let both = self.tree.tiles.insert_container(Container::new(kind, vec![old, new]));
        match parent.and_then(|p| self.tree.tiles.get_mut(p)) {
            Some(Tile::Container(container)) => {
                // Its share of the room goes along.
                let _ = container.replace_child(old, both);
            }
            _ => self.tree.root = Some(both),
        }
    }

    /// As wide as the others are on the average.
    fn at_the_edge(&mut self, root: TileId, tile: TileId) {
        match self.tree.tiles.get_mut(root) {
            Some(Tile::Container(Container::Linear(linear))) => {
                let mean = linear.children.iter().map(|c| linear.shares[*c]).sum::<f32>()
                    / linear.children.len().max(1) as f32;
                linear.add_child(tile);
                linear.shares.set_share(tile, mean);
            }
            Some(Tile::Container(container)) => container.add_child(tile),
            _ => self.tree.root = Some(self.tree.tiles.insert_horizontal_tile(vec![root, tile])),
        }
    }
}
