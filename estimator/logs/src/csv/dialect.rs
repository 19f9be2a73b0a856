//! Delimiter, header and first row of a table.

/// Properties of a file told by its first bytes.
#[derive(Debug)]
pub struct Dialect {
    pub(super) delimiter: u8,
    /// Column names as they stand in the file, trimmed.
    pub headers: Vec<String>,
    /// Start of the first row, bytes.
    pub(super) start: u64,
    /// Line of the first row, from 1.
    pub(super) line: u64,
}
