//! One view's light maps: the depths that the key light sees, and what of it reaches the table.

use crate::light::{MAP_TEXELS, TABLE_TEXELS};
use crate::pipeline::{Groups, MAP_FORMAT, TABLE_LIGHT_FORMAT};
use crate::renderer::DEPTH_FORMAT;

/// Textures and how the shaders read them.
#[derive(Debug)]
pub(crate) struct Maps {
    nearest: wgpu::TextureView,
    depth: wgpu::TextureView,
    table: wgpu::TextureView,
    pub(crate) nearest_group: wgpu::BindGroup,
    pub(crate) table_group: wgpu::BindGroup,
}

impl Maps {
    pub(crate) fn new(device: &wgpu::Device, groups: &Groups) -> Self {
        let read = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING;
        let nearest = texture(device, [MAP_TEXELS; 2], MAP_FORMAT, read);
        let table = texture(device, TABLE_TEXELS, TABLE_LIGHT_FORMAT, read);
        Self {
            depth: texture(device, [MAP_TEXELS; 2], DEPTH_FORMAT, wgpu::TextureUsages::RENDER_ATTACHMENT),
            nearest_group: groups.map(device, &nearest),
            table_group: groups.table_light(device, &table),
            nearest,
            table,
        }
    }

    /// Begins the pass that records depths from the key light; where nothing is, they are those of the far end.
    pub(crate) fn begin_cast<'e>(&self, encoder: &'e mut wgpu::CommandEncoder) -> wgpu::RenderPass<'e> {
        let depth = wgpu::RenderPassDepthStencilAttachment {
            view: &self.depth,
            depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(1.0), store: wgpu::StoreOp::Discard }),
            stencil_ops: None,
        };
        // Nothing there: farther away than anything.
        begin(encoder, "shadow map", &self.nearest, wgpu::Color { r: 1e3, ..wgpu::Color::WHITE }, Some(depth))
    }

    /// Begins the pass that lights the table.
    pub(crate) fn begin_table<'e>(&self, encoder: &'e mut wgpu::CommandEncoder) -> wgpu::RenderPass<'e> {
        begin(encoder, "table light", &self.table, wgpu::Color::WHITE, None)
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
