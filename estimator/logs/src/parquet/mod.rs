//! Parquet in and out, through the file format itself (no Arrow).

mod arrow_schema;
mod column;
mod footer;
mod guard;
mod list;
mod metadata;
mod read;
mod shape;
mod sums;
mod write;

pub use read::{Columns, read};
pub use write::write;

#[cfg(test)]
mod tests;
