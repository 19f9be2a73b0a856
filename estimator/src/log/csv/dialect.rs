//! Delimiter, header and first row of a table.

/// What the first bytes of a file say about it.
#[derive(Debug)]
pub struct Dialect {
    pub(super) delimiter: u8,
    /// Column names as they stand in the file, trimmed.
    pub headers: Vec<String>,
    /// Where the first row starts, bytes.
    pub(super) start: u64,
    /// … and on which line, from 1.
    pub(super) line: u64,
}
