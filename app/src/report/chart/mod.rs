//! Pictures as SVG inside the page. Their colours are variables of the page's style, so light, dark and print differ
//! only in the style.

pub(crate) mod bad;
pub(crate) mod band;
pub(crate) mod cloud;
pub(crate) mod frame;
pub(crate) mod path;
pub(crate) mod signals;

pub use bad::holes;
pub use band::{band, legend};
pub use cloud::residuals;
pub use path::path;
pub use signals::{against_virtual, signals};
