//! Room that the content of a container may take in memory.

/// Memory that the table may take in any case, bytes.
const TABLE_BYTES: u64 = 256 << 20;
/// Memory that the table may take in multiples of the size of the file: real logs stay far below, packed nonsense does
/// not.
const TABLE_TIMES_FILE: u64 = 32;

/// Most bytes that the table of a file of `size` bytes may take.
pub fn limit(size: u64) -> u64 {
    TABLE_BYTES.max(size.saturating_mul(TABLE_TIMES_FILE))
}
