//! The pictures of the render crate inside the window.

pub mod callback;
pub mod camera_rig;
pub mod layers;
pub mod legend;
pub mod markers;
pub mod mechanism;
pub mod overlay;
pub mod path_extent;
pub mod similarity;
pub mod vectors;
pub mod view;
