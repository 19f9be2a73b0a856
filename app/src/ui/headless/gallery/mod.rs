//! Every panel and every scene in light and dark: the pictures of `docs/gallery`, also used by the snapshot tests.

pub mod by_pointer;
pub mod filmed;
pub mod plates;
pub mod practice;
pub mod sample;
pub mod samples;
pub mod small_png;
pub mod walk;
