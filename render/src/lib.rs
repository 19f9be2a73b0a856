//! The virtual two-fingered hand and its objects, drawn with wgpu: the same code in a window, in tests and without a screen.
//!
//! Lengths are metres in the world's vertical plane, x to the right, **y up**; z points towards the viewer and only gives the
//! planar objects a thickness. Everything inside is `f32`; [`camera::Camera`] is the seam to pixels.
//!
//! * [`SceneView`] borrows the things to be drawn: world, state, [`ViewOptions`].
//! * [`DrawData`] is the plain list of shapes made from it, one file per thing under [`drawable`].
//! * [`Renderer`] lives as long as the device: pipelines and meshes. A [`Frame`] holds one view's buffers.
//! * [`TextureTarget`] is the multisampled texture drawn into; [`Blit`] copies it into another pass (egui's).
//! * [`headless::Headless`] does all of it without a window.
#![forbid(unsafe_code)]

pub mod blit;
pub mod camera;
mod composition;
mod coordinates;
pub mod draw_data;
pub mod drawable;
pub mod error;
pub mod frame;
pub mod headless;
mod light;
mod maps;
pub mod material;
pub mod mesh;
mod pipeline;
pub mod renderer;
pub mod scene;
pub mod shape;
pub mod target;
mod texture_format;
pub mod theme;

pub use blit::Blit;
pub use camera::{Camera, Projection};
pub use draw_data::DrawData;
pub use error::RenderError;
pub use frame::Frame;
pub use headless::Headless;
pub use material::Material;
pub use renderer::Renderer;
pub use scene::{
    ArrowAnchor, ConstraintMarker, FingerStyle, ForceVector, SceneView, SolidRef, Trajectory, ViewOptions,
};
pub use target::TextureTarget;
pub use texture_format::{DEPTH_FORMAT, SAMPLES};
pub use theme::{Color, ColorRole, Theme};
