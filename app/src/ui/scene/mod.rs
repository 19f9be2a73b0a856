//! The pictures of the render crate inside the window.

mod callback;
pub mod layers;
mod legend;
mod likeness;
mod markers;
mod mechanism;
mod overlay;
mod rig;
mod vectors;
mod view;

pub use callback::{announce, picture, warm_up};
pub use legend::Legend;
pub use likeness::Likeness;
pub use mechanism::Mechanism;
pub use overlay::{camera_for, options_for, scene_world};
pub use rig::Rig;
pub use view::{Place, SceneResponse, Wheel, scene_view};
