//! A name of an arrangement that is being written.

use crate::ui::shell::workspace::Workspace;

/// Width of the dialog, points.
pub(crate) const WIDTH: f32 = 360.0;

/// Name that is being typed.
#[derive(Clone, Debug, PartialEq)]
pub struct Naming {
    pub(crate) workspace: Workspace,
    /// Layout that is renamed; `None` if a new one is saved.
    pub(crate) renamed: Option<String>,
    pub(crate) name: String,
    /// True once the field has received the focus.
    pub(crate) begun: bool,
}

impl Naming {
    /// Dialog to save the current layout; `name` is proposed.
    pub fn to_save(workspace: Workspace, name: Option<&str>) -> Self {
        Self { workspace, renamed: None, name: name.unwrap_or_default().to_owned(), begun: false }
    }

    /// Dialog to rename a layout.
    pub fn to_rename(workspace: Workspace, old: &str) -> Self {
        Self { workspace, renamed: Some(old.to_owned()), name: old.to_owned(), begun: false }
    }
}
