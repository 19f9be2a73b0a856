//! Time until the first curves of a large log are shown.

use super::frames::performance;
use super::table::{Figure, Wanted};
use super::whole::{WholeBench, long};
use estimator::log::preview::Preview;
use estimator::log::{Watch, load_watched, write};
use haptics::recording::Recording;
use haptics::world::presets;
use std::path::Path;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

/// Number of rows from which the size of a row is measured, bytes: enough for whole blocks of a compressed file.
const PROBE: usize = 200_000;
/// Number of pixel columns of the plot that waits for curves.
const PIXELS: usize = 1_000;

/// Measures a log of about 1 GB in each format; it is generated in the folder for temporary files.
pub(super) fn first_curves(wish: WholeBench) -> anyhow::Result<Vec<Figure>> {
    let bytes = if wish.quick { 20e6 } else { 1e9 };
    let once = performance("stack", &presets::stacking());
    let folder = tempfile::tempdir()?;
    let mut figures = Vec::new();
    for ending in ["csv", "mcap", "parquet"] {
        let path = folder.path().join("log").with_extension(ending);
        write(&[long(&once, PROBE)], &path, &[])?;
        let rows = (bytes / std::fs::metadata(&path)?.len() as f64 * PROBE as f64) as usize;
        write(&[long(&once, rows)], &path, &[])?;
        let megabytes = 1e-6 * std::fs::metadata(&path)?.len() as f64;
        let name = format!("first curves of a log of {megabytes:.0} MB, {ending}");
        figures.push(Figure::new(name, first_curves_s(&path)?, "s").wanted(Wanted::AtMost(2.0)));
        std::fs::remove_file(&path)?;
    }
    Ok(figures)
}

/// Reads until there is something to draw, and no further. Returns the duration, s.
fn first_curves_s(path: &Path) -> anyhow::Result<f64> {
    let (preview, first, enough) = (Preview::default(), OnceLock::new(), AtomicBool::new(false));
    let begun = Instant::now();
    let look = |_: f64| {
        if first.get().is_none() && !preview.curves(PIXELS).is_empty() {
            let _ = first.set(begun.elapsed().as_secs_f64());
            enough.store(true, Ordering::Relaxed);
        }
    };
    let watch = Watch { progress: &look, cancelled: &enough, preview: Some(&preview) };
    let read = load_watched(path, None, &watch).map(|all: Vec<Recording>| all.len());
    // It ends early on purpose; an unreadable file has no curves.
    match (first.get(), read) {
        (Some(first_s), _) => Ok(*first_s),
        (None, Err(error)) => Err(error.into()),
        (None, Ok(_)) => anyhow::bail!("no curves came before the whole log, {}", path.display()),
    }
}
