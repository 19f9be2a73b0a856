//! One view's light maps: the depths that the key light sees, and the share of it that reaches the table; the height of
//! things over the table, and the share of the sky that they leave it.

use crate::light::{MAP_TEXELS, SKY_TEXELS, TABLE_TEXELS};
use crate::pipeline::{Groups, TABLE_LIGHT_FORMAT};
use crate::texture_format::DEPTH_FORMAT;

/// Textures and how the shaders read them.
#[derive(Debug)]
pub(crate) struct Maps {
    nearest: Depths,
    undersides: Depths,
    table: wgpu::TextureView,
    sky: wgpu::TextureView,
    pub(crate) nearest_group: wgpu::BindGroup,
    pub(crate) undersides_group: wgpu::BindGroup,
    pub(crate) table_group: wgpu::BindGroup,
}

/// Map of the nearest surface at each place, and the buffer that finds it.
#[derive(Debug)]
struct Depths {
    nearest: wgpu::TextureView,
    depth: wgpu::TextureView,
}

const READ: wgpu::TextureUsages = wgpu::TextureUsages::RENDER_ATTACHMENT.union(wgpu::TextureUsages::TEXTURE_BINDING);

impl Maps {
    pub(crate) fn new(device: &wgpu::Device, groups: &Groups) -> Self {
        let nearest = Depths::new(device, [MAP_TEXELS; 2], groups.map_format.texture());
        let undersides = Depths::new(device, TABLE_TEXELS, groups.map_format.texture());
        let table = texture(device, TABLE_TEXELS, TABLE_LIGHT_FORMAT, READ);
        let sky = texture(device, SKY_TEXELS, TABLE_LIGHT_FORMAT, READ);
        Self {
            nearest_group: groups.map(device, &nearest.nearest),
            undersides_group: groups.map(device, &undersides.nearest),
            table_group: groups.table_light(device, &table, &sky),
            nearest,
            undersides,
            table,
            sky,
        }
    }

    /// Begins the pass that records depths from the key light; where nothing is, they are those of the far end.
    pub(crate) fn begin_cast<'e>(&self, encoder: &'e mut wgpu::CommandEncoder) -> wgpu::RenderPass<'e> {
        self.nearest.begin(encoder, "shadow map")
    }

    /// Begins the pass that records how high the lowest thing hangs over the table.
    pub(crate) fn begin_undersides<'e>(&self, encoder: &'e mut wgpu::CommandEncoder) -> wgpu::RenderPass<'e> {
        self.undersides.begin(encoder, "undersides")
    }

    /// Begins the pass that lights the table.
    pub(crate) fn begin_table<'e>(&self, encoder: &'e mut wgpu::CommandEncoder) -> wgpu::RenderPass<'e> {
        begin(encoder, "table light", &self.table, wgpu::Color::WHITE, None)
    }

    /// Begins the pass that hides the sky from the table.
    pub(crate) fn begin_sky<'e>(&self, encoder: &'e mut wgpu::CommandEncoder) -> wgpu::RenderPass<'e> {
        begin(encoder, "sky", &self.sky, wgpu::Color::BLACK, None)
    }
}

impl Depths {
    fn new(device: &wgpu::Device, size: [u32; 2], format: wgpu::TextureFormat) -> Self {
        Self {
            nearest: texture(device, size, format, READ),
            depth: texture(device, size, DEPTH_FORMAT, wgpu::TextureUsages::RENDER_ATTACHMENT),
        }
    }

    fn begin<'e>(&self, encoder: &'e mut wgpu::CommandEncoder, label: &str) -> wgpu::RenderPass<'e> {
        let depth = wgpu::RenderPassDepthStencilAttachment {
            view: &self.depth,
            depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(1.0), store: wgpu::StoreOp::Discard }),
            stencil_ops: None,
        };
        // Nothing there: farther away than anything.
        begin(encoder, label, &self.nearest, wgpu::Color { r: 1e3, ..wgpu::Color::WHITE }, Some(depth))
    }
}

fn begin<'e>(
    encoder: &'e mut wgpu::CommandEncoder,
    label: &str,
    view: &wgpu::TextureView,
    clear: wgpu::Color,
    depth_stencil_attachment: Option<wgpu::RenderPassDepthStencilAttachment<'_>>,
) -> wgpu::RenderPass<'e> {
    let load = wgpu::LoadOp::Clear(clear);
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some(label),
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations { load, store: wgpu::StoreOp::Store },
        })],
        depth_stencil_attachment,
        timestamp_writes: None,
        occlusion_query_set: None,
        multiview_mask: None,
    })
}

fn texture(
    device: &wgpu::Device,
    [width, height]: [u32; 2],
    format: wgpu::TextureFormat,
    usage: wgpu::TextureUsages,
) -> wgpu::TextureView {
    let texture = device.create_texture(&wgpu::TextureDescriptor {
        label: Some("light"),
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage,
        view_formats: &[],
    });
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}
