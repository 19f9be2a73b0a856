//! The pictures of the render crate inside the window.

mod callback;
mod mechanism;
mod overlay;
mod view;

pub use callback::{announce, picture};
pub use mechanism::mechanism_view;
pub use overlay::{camera_for, options_for, scene_world};
pub use view::{SceneResponse, Wheel, scene_view};
