//! What every fuzz target does with its bytes: most write them as a file, load it, and look at what that cost.
//!
//! `tests/tests/fuzz.rs` runs the same over the seeds, without a fuzzer.

pub mod documents;
pub mod log;
pub mod mat;
pub mod mcap;
pub mod parquet;
pub mod serial;
pub mod sidecar;
pub mod udp;
pub mod world;

use peak_alloc::PeakAlloc;
use std::path::{Path, PathBuf};

#[global_allocator]
static MEMORY: PeakAlloc = PeakAlloc;

/// Memory that loading may take whatever the size of the file, bytes: blocks in flight, tables of the decompressors.
const BASE: usize = 48 << 20;
/// … and what a container may unpack to before it is refused.
const UNPACKED: usize = 256 << 20;
/// Bytes of one sample in memory; a digit and a comma in the file become these.
const SAMPLE: usize = 8;

/// The file to load, in a folder of this process.
pub fn file(name: &str) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("touchstone-fuzz-{}", std::process::id()));
    let _ = std::fs::create_dir(&folder);
    folder.join(name)
}

/// Writes `bytes` and loads them as a log: a recording or one sentence with the file's name at its end, and no more memory than
/// twice the file's size or twice the samples' own.
pub fn load(bytes: &[u8], path: &Path) {
    std::fs::write(path, bytes).expect("the temporary folder is writable");
    MEMORY.reset_peak_usage();
    let before = MEMORY.current_usage();
    let loaded = estimator::log::load(path, None);
    let used = MEMORY.peak_usage().saturating_sub(before);
    let samples = loaded.as_ref().map_or(0, |all| all.iter().map(|r| r.len() * (r.channels.len() + 1)).sum());
    let text = path.extension().is_some_and(|e| e == "csv");
    let allowed = BASE + if text { 0 } else { UNPACKED } + 2 * bytes.len().max(SAMPLE * samples);
    assert!(used <= allowed, "{used} bytes for a file of {} with {samples} samples", bytes.len());
    if let Err(error) = loaded {
        let (text, name) = (error.to_string(), path.display().to_string());
        assert!(text.ends_with(&name) && !text.contains('\n'), "{text:?}");
    }
}
