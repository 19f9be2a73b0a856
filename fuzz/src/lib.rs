//! Everything that the fuzz targets do; the targets themselves only hand over their bytes, so that ordinary tests can do the same.

pub mod targets;
#[cfg(feature = "window")]
pub mod window;
