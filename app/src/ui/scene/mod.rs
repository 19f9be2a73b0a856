//! The pictures of the render crate inside the window.

pub mod callback;
pub mod layers;
pub mod legend;
pub mod likeness;
pub mod markers;
pub mod mechanism;
pub mod overlay;
pub mod rig;
pub mod vectors;
pub mod view;
