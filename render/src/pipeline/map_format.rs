//! Format of the light maps: numbers, or bytes if a driver cannot draw numbers (OpenGL without targets of floats).

/// Format of the nearest surface at each place of a map.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum MapFormat {
    /// One number a place.
    Float,
    /// A number from 0 to 1 in three bytes: every driver can draw those and read them.
    Bytes,
}

impl MapFormat {
    /// The best that a device can draw into: it is tried, because a device does not tell the limits of its driver.
    pub(crate) fn of(device: &wgpu::Device) -> Self {
        let scope = device.push_error_scope(wgpu::ErrorFilter::Validation);
        let tried = device.create_texture(&wgpu::TextureDescriptor {
            label: Some("a map of floats"),
            size: wgpu::Extent3d { width: 4, height: 4, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: Self::Float.texture(),
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
            view_formats: &[],
        });
        let refused = pollster::block_on(scope.pop()).is_some();
        tried.destroy();
        if refused { Self::Bytes } else { Self::Float }
    }

    /// As the device knows it.
    pub(crate) fn texture(self) -> wgpu::TextureFormat {
        match self {
            Self::Float => wgpu::TextureFormat::R32Float,
            Self::Bytes => wgpu::TextureFormat::Rgba8Unorm,
        }
    }

    /// The functions of the shaders that write and read it.
    pub(crate) fn shader(self) -> &'static str {
        match self {
            Self::Float => include_str!("map_float.wgsl"),
            Self::Bytes => include_str!("map_bytes.wgsl"),
        }
    }
}
