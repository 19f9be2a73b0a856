//! The buffers of one view, refilled for every picture and grown when needed.

use crate::draw_data::{DrawData, Globals, Layer, LightGlobals};
use crate::maps::Maps;
use crate::mesh::MeshKind;
use crate::pipeline::Groups;
use crate::shape::Solid;
use bytemuck::Pod;
use std::ops::Range;

/// One view's share of device memory. Filled by [`crate::Renderer::prepare`], drawn by [`crate::Renderer::draw`].
#[derive(Debug)]
pub struct Frame {
    globals: wgpu::Buffer,
    pub(crate) bind_group: wgpu::BindGroup,
    pub(crate) maps: Maps,
    /// True if there is a table to be lit.
    pub(crate) has_table: bool,
    /// Input of the light maps: while it stays they stay, however the viewer moves.
    lit: Option<Lit>,
    /// True if the light maps must be made again.
    pub(crate) light_changed: bool,
    pub(crate) solids: Instances,
    pub(crate) strokes: Instances,
    pub(crate) overlay_strokes: Instances,
    /// Runs of solids that are drawn together.
    pub(crate) batches: Vec<(Layer, MeshKind, Range<u32>)>,
    pub(crate) size: [u32; 2],
}

impl Frame {
    pub(crate) fn new(device: &wgpu::Device, groups: &Groups) -> Self {
        let globals = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("globals"),
            size: size_of::<Globals>() as u64,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        Self {
            bind_group: groups.globals(device, &globals),
            globals,
            maps: Maps::new(device, groups),
            has_table: false,
            lit: None,
            light_changed: true,
            solids: Instances::new(device, "solids", 24 << 10),
            strokes: Instances::new(device, "strokes", 16 << 10),
            overlay_strokes: Instances::new(device, "overlay strokes", 64 << 10),
            batches: Vec::new(),
            size: [1, 1],
        }
    }

    /// Copies a scene to the device.
    pub fn upload(&mut self, device: &wgpu::Device, queue: &wgpu::Queue, data: &DrawData) {
        self.size = data.size.map(|n| n.max(1));
        queue.write_buffer(&self.globals, 0, bytemuck::bytes_of(&data.globals));
        let solids: Vec<Solid> = data.solids.iter().map(|(_, _, solid)| *solid).collect();
        self.solids.upload(device, queue, &solids);
        self.strokes.upload(device, queue, &data.strokes);
        self.overlay_strokes.upload(device, queue, &data.overlay_strokes);
        self.has_table = data.solids.iter().any(|(layer, _, _)| *layer == Layer::Table);
        let lit = Lit::of(data);
        // Maps that were requested and not drawn yet are still to be drawn.
        self.light_changed |= self.lit.as_ref() != Some(&lit);
        self.lit = Some(lit);
        self.batches.clear();
        for (index, (layer, mesh, _)) in (0_u32..).zip(&data.solids) {
            match self.batches.last_mut() {
                Some((of, kind, range)) if (&*of, &*kind) == (layer, mesh) => range.end = index + 1,
                _ => self.batches.push((*layer, *mesh, index..index + 1)),
            }
        }
    }
}

/// Everything that the light maps depend on.
#[derive(Debug, PartialEq)]
struct Lit {
    casters: Vec<(MeshKind, Solid)>,
    light: LightGlobals,
}

impl Lit {
    fn of(data: &DrawData) -> Self {
        let casters = data.solids.iter().filter(|(layer, _, _)| layer.casts_shadows());
        Self { casters: casters.map(|(_, mesh, solid)| (*mesh, *solid)).collect(), light: data.globals.of_light() }
    }
}

/// A growing vertex buffer with one entry for each shape.
#[derive(Debug)]
pub(crate) struct Instances {
    buffer: wgpu::Buffer,
    label: &'static str,
    bytes: u64,
    count: u32,
}

impl Instances {
    fn new(device: &wgpu::Device, label: &'static str, capacity: u64) -> Self {
        Self { buffer: buffer(device, label, capacity), label, bytes: 0, count: 0 }
    }

    fn upload<T: Pod>(&mut self, device: &wgpu::Device, queue: &wgpu::Queue, items: &[T]) {
        let bytes: &[u8] = bytemuck::cast_slice(items);
        self.bytes = bytes.len() as u64;
        self.count = items.len() as u32;
        if self.bytes > self.buffer.size() {
            self.buffer = buffer(device, self.label, self.bytes.next_power_of_two());
        }
        if self.count > 0 {
            queue.write_buffer(&self.buffer, 0, bytes);
        }
    }

    pub(crate) fn slice(&self) -> wgpu::BufferSlice<'_> {
        self.buffer.slice(..self.bytes.max(4))
    }

    /// Draws every entry as a rectangle.
    pub(crate) fn draw_quads(&self, pass: &mut wgpu::RenderPass<'_>, pipeline: &wgpu::RenderPipeline) {
        if self.count > 0 {
            pass.set_pipeline(pipeline);
            pass.set_vertex_buffer(0, self.slice());
            pass.draw(0..4, 0..self.count);
        }
    }
}

fn buffer(device: &wgpu::Device, label: &str, size: u64) -> wgpu::Buffer {
    device.create_buffer(&wgpu::BufferDescriptor {
        label: Some(label),
        size,
        usage: wgpu::BufferUsages::VERTEX | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    })
}
