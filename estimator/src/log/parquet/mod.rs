//! Parquet in and out, through the file format itself (no Arrow).

mod column;
mod footer;
mod guard;
mod read;
mod sums;
mod write;

pub use read::{Columns, read};
pub use write::write;

/// Beginning of the writer's name in the files of this program.
const CREATED_BY: &str = "touchstone ";

/// Keys of the file's metadata: the sidecar, the units by column, and whether the rows have a clock.
const SIDECAR: &str = "touchstone.sidecar";
const UNITS: &str = "units";

/// The first line of an error of the library.
fn one_line(error: &impl std::fmt::Display) -> String {
    let text = error.to_string();
    text.lines().next().unwrap_or("malformed").chars().take(160).collect()
}

/// pandas keeps an index without a name.
fn is_index(column: &str) -> bool {
    column.starts_with("__index_level_")
}
