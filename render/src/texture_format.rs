//! Formats of the textures that pictures are drawn into.

/// Format of the depth buffer.
pub const DEPTH_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// Samples a pixel: every driver can do four.
pub const SAMPLES: u32 = 4;
