//! The texture that a scene is drawn into: multisampled colour and depth, resolved into one picture.

use crate::texture_format::DEPTH_FORMAT;

/// Colour, depth and resolved picture of one view; made again when the size changes.
#[derive(Debug)]
pub struct TextureTarget {
    size: [u32; 2],
    format: wgpu::TextureFormat,
    samples: u32,
    /// Absent when a pixel has one sample: then the picture is drawn directly.
    multisampled: Option<wgpu::TextureView>,
    depth: wgpu::TextureView,
    picture: wgpu::Texture,
    view: wgpu::TextureView,
}

impl TextureTarget {
    /// A target of `size` pixels, at least 1 × 1 and at most the limit of the device.
    pub fn new(device: &wgpu::Device, format: wgpu::TextureFormat, samples: u32, size: [u32; 2]) -> Self {
        let size = clamped(device, size);
        let attachment = wgpu::TextureUsages::RENDER_ATTACHMENT;
        let view_of = |format, samples| {
            let texture = texture(device, size, format, samples, attachment);
            texture.create_view(&wgpu::TextureViewDescriptor::default())
        };
        let shown = attachment | wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_SRC;
        let picture = texture(device, size, format, 1, shown);
        Self {
            size,
            format,
            samples,
            multisampled: (samples > 1).then(|| view_of(format, samples)),
            depth: view_of(DEPTH_FORMAT, samples),
            view: picture.create_view(&wgpu::TextureViewDescriptor::default()),
            picture,
        }
    }

    /// Takes another size; true when the textures were made again, so that views registered elsewhere are stale.
    pub fn resize(&mut self, device: &wgpu::Device, size: [u32; 2]) -> bool {
        let changed = clamped(device, size) != self.size;
        if changed {
            *self = Self::new(device, self.format, self.samples, size);
        }
        changed
    }

    /// Its size, pixels.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// The finished picture, to be sampled or registered with egui.
    pub fn view(&self) -> &wgpu::TextureView {
        &self.view
    }

    /// The finished picture, to be copied from.
    pub fn texture(&self) -> &wgpu::Texture {
        &self.picture
    }

    /// Begins a pass into this target, cleared.
    pub fn begin_pass<'e>(&self, encoder: &'e mut wgpu::CommandEncoder) -> wgpu::RenderPass<'e> {
        let (view, resolve_target) = match &self.multisampled {
            Some(multisampled) => (multisampled, Some(&self.view)),
            None => (&self.view, None),
        };
        let store = if resolve_target.is_some() { wgpu::StoreOp::Discard } else { wgpu::StoreOp::Store };
        encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("scene"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view,
                depth_slice: None,
                resolve_target,
                ops: wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::BLACK), store },
            })],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &self.depth,
                depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(1.0), store: wgpu::StoreOp::Discard }),
                stencil_ops: None,
            }),
            timestamp_writes: None,
            occlusion_query_set: None,
            multiview_mask: None,
        })
    }
}

fn clamped(device: &wgpu::Device, size: [u32; 2]) -> [u32; 2] {
    let limit = device.limits().max_texture_dimension_2d;
    size.map(|n| n.clamp(1, limit))
}

fn texture(
    device: &wgpu::Device,
    [width, height]: [u32; 2],
    format: wgpu::TextureFormat,
    sample_count: u32,
    usage: wgpu::TextureUsages,
) -> wgpu::Texture {
    device.create_texture(&wgpu::TextureDescriptor {
        label: Some("scene"),
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage,
        view_formats: &[],
    })
}
