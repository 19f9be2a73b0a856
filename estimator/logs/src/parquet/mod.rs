//! Parquet in and out, through the file format itself (no Arrow).

mod column;
mod footer;
mod guard;
mod metadata;
mod read;
mod sums;
mod write;

pub use read::{Columns, read};
pub use write::write;
