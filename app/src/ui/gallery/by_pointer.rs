//! Where a hand on the mouse finds what it needs to map a foreign table and to fit again: the way is gone in a window of the same size that
//! nobody sees, and what was clicked is noted.

use super::walk::{Walker, foreign_crank};
use anyhow::Context as _;
use egui::{Pos2, Rect, Role};
use egui_kittest::kittest::Queryable as _;
use std::path::{Path, PathBuf};

/// Places in points, from the window's upper left corner.
#[derive(Clone, Debug)]
pub struct Places {
    /// The foreign table; nothing beside it says what its columns mean.
    pub table: PathBuf,
    /// The sidecar that mapping it will write.
    pub sidecar: PathBuf,
    /// What is clicked from the dialog's first picture on: a list, then an entry of it, again and again …
    pub chosen: Vec<[Pos2; 2]>,
    /// … and in the end the button that saves and opens.
    pub save: Rect,
    /// The tick that lets the fit follow every change, once the table is open.
    pub follow: Pos2,
    /// The button that fits again, after a boundary was set by hand.
    pub refit: Rect,
}

/// Writes a foreign table into a folder and goes through its mapping.
pub fn places(folder: &Path, size: [u32; 2]) -> anyhow::Result<Places> {
    let table = foreign_crank(folder)?;
    let mut walker = Walker::new(size, false, false)?;
    walker.drop_it(&table)?;
    let chosen = walker.clicked.chunks_exact(2).map(|pair| [pair[0], pair[1]]).collect();
    let sidecar = walker.harness.state().session.mapping.as_ref().context("nothing is mapped")?.sidecar.clone();
    let rect = |walker: &Walker, role, label: &str| {
        let node = walker.harness.query_by_role_and_label(role, label);
        node.map(|node| node.rect()).with_context(|| format!("there is no `{label}`"))
    };
    let save = rect(&walker, Role::Button, "Save sidecar and open")?;
    walker.accept_mapping()?;
    let follow = rect(&walker, Role::CheckBox, "Follow every change")?.left_center() + egui::vec2(8.0, 0.0);
    walker.drag_a_boundary()?;
    let refit = rect(&walker, Role::Button, "Refit")?;
    // Whoever goes the same way afterwards maps it again.
    std::fs::remove_file(&sidecar).context("the sidecar could not be removed")?;
    Ok(Places { table, sidecar, chosen, save, follow, refit })
}
