//! Screen positions for mapping a foreign table and refitting with the mouse. The procedure runs in an invisible window
//! of the same size, and the clicks are recorded.

use crate::ui::headless::gallery::walk::{Walker, foreign_crank};
use anyhow::Context as _;
use egui::{Pos2, Rect, Role};
use egui_kittest::kittest::Queryable as _;
use std::path::{Path, PathBuf};

/// Positions in points, from the window's upper left corner.
#[derive(Clone, Debug)]
pub struct Places {
    /// Foreign table; nothing beside it explains its columns.
    pub table: PathBuf,
    /// Sidecar that the mapping will write.
    pub sidecar: PathBuf,
    /// Clicks from the dialog's first frame on: pairs of a list and one of its entries.
    pub chosen: Vec<[Pos2; 2]>,
    /// Button that saves and opens, clicked last.
    pub save: Rect,
    /// Checkbox for automatic refits, once the table is open.
    pub follow: Pos2,
    /// Button that refits, after a boundary was moved by hand.
    pub refit: Rect,
}

/// Writes a foreign table into a folder and runs through its mapping.
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
    // The recorded procedure maps it again.
    std::fs::remove_file(&sidecar).context("the sidecar could not be removed")?;
    Ok(Places { table, sidecar, chosen, save, follow, refit })
}
