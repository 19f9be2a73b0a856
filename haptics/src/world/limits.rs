//! Limits of worlds: the newest file format, and the sizes of buffers that never grow.

/// Version of the file format.
pub const SCHEMA: u32 = 1;

/// Most blocks that a world may hold: the state's buffers are sized once, the servo never allocates.
pub const MAX_BLOCKS: usize = 256;
