//! Pictures as SVG inside the page. Their colours are variables of the page's style, so that light, dark and print differ by the style alone.

pub mod bad;
pub mod band;
pub mod cloud;
pub mod frame;
pub mod path;
pub mod signals;
