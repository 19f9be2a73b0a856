//! Metadata of files of ours, and names and errors as the library has them.

/// Beginning of the writer's name in the files of this program.
pub(super) const CREATED_BY: &str = "touchstone ";

/// Keys of the file's metadata: the sidecar, the units by column, and whether the rows have a clock.
pub(super) const SIDECAR: &str = "touchstone.sidecar";

pub(super) const UNITS: &str = "units";

/// The first line of an error of the library.
pub(super) fn one_line(error: &impl std::fmt::Display) -> String {
    let text = error.to_string();
    text.lines().next().unwrap_or("malformed").chars().take(160).collect()
}

/// pandas keeps an index without a name.
pub(super) fn is_index(column: &str) -> bool {
    column.starts_with("__index_level_")
}
