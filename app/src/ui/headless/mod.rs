//! Pictures of the window without a window, and their cost.

pub mod first_picture;
pub mod frame_costs;
pub mod gallery;
pub mod picture_input;
pub mod screenshot;
pub mod stage;
