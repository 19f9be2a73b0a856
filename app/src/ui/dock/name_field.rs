//! A name of an arrangement that is being written.

use crate::ui::workspace::Workspace;

/// Width of the dialog, points.
pub(crate) const WIDTH: f32 = 360.0;

/// A name that is being written.
#[derive(Clone, Debug, PartialEq)]
pub struct Naming {
    pub(crate) workspace: Workspace,
    /// The arrangement that is renamed; a new one is saved when absent.
    pub(crate) renamed: Option<String>,
    pub(crate) name: String,
    /// The field has been given the keys.
    pub(crate) begun: bool,
}

impl Naming {
    /// Of the arrangement as it is, to be kept; `name` is proposed.
    pub fn to_save(workspace: Workspace, name: Option<&str>) -> Self {
        Self { workspace, renamed: None, name: name.unwrap_or_default().to_owned(), begun: false }
    }

    /// Of one that has a name.
    pub fn to_rename(workspace: Workspace, old: &str) -> Self {
        Self { workspace, renamed: Some(old.to_owned()), name: old.to_owned(), begun: false }
    }
}
