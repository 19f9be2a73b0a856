//! Pictures as SVG inside the page. Their colours are variables of the page's style, so light, dark and print differ
//! only in the style.

pub mod bad;
pub mod band;
pub mod cloud;
pub mod frame;
pub mod path;
pub mod signals;
