//! Resources that live as long as the device: pipelines and unit meshes. One renderer draws any number of [`Frame`]s.

use crate::draw_data::{DrawData, Layer};
use crate::frame::Frame;
use crate::mesh::MeshKind;
use crate::pipeline::{Groups, MapFormat, Pipelines};
use crate::scene::SceneView;
use crate::target::TextureTarget;
use wgpu::util::DeviceExt;

/// Nearest part of the depth range, reserved for shapes in front of everything.
const OVERLAY_DEPTH: f32 = 0.05;

/// Cells of the background; see `background.wgsl`.
const BACKGROUND_CELLS: u32 = 16 * 12;

/// Pipelines and meshes for one target format. Made once for a device.
#[derive(Debug)]
pub struct Renderer {
    pipelines: Pipelines,
    meshes: Vec<GpuMesh>,
    groups: Groups,
    format: wgpu::TextureFormat,
    samples: u32,
}

#[derive(Debug)]
struct GpuMesh {
    vertices: wgpu::Buffer,
    indices: wgpu::Buffer,
    count: u32,
}

impl Renderer {
    /// For a target of the given colour format and samples a pixel; its depth buffer must be [`DEPTH_FORMAT`].
    ///
    /// Colours are written for direct display (gamma-encoded), as egui does: prefer `Rgba8Unorm`. sRGB formats work too.
    pub fn new(device: &wgpu::Device, format: wgpu::TextureFormat, samples: u32) -> Self {
        Self::with_maps(device, format, samples, MapFormat::of(device))
    }

    /// The same with maps of a kind.
    pub(crate) fn with_maps(
        device: &wgpu::Device,
        format: wgpu::TextureFormat,
        samples: u32,
        map_format: MapFormat,
    ) -> Self {
        let groups = Groups::new(device, map_format);
        Self {
            pipelines: Pipelines::new(device, &groups, format, samples),
            meshes: MeshKind::ALL.iter().map(|kind| GpuMesh::new(device, *kind)).collect(),
            groups,
            format,
            samples,
        }
    }

    /// Colour format that it draws to.
    pub fn format(&self) -> wgpu::TextureFormat {
        self.format
    }

    /// Samples a pixel.
    pub fn samples(&self) -> u32 {
        self.samples
    }

    /// The buffers of one view. Two views on the screen at once need a frame each.
    pub fn frame(&self, device: &wgpu::Device) -> Frame {
        Frame::new(device, &self.groups)
    }

    /// Fills `frame` with the shapes of `view` in a picture of `size` pixels.
    pub fn prepare(
        &self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        frame: &mut Frame,
        view: &SceneView<'_>,
        size: [u32; 2],
    ) {
        frame.upload(device, queue, &DrawData::new(view, size));
    }

    /// Draws a prepared frame into `target`: shadow map, light of the table, picture, in a pass each.
    pub fn render(&self, encoder: &mut wgpu::CommandEncoder, target: &TextureTarget, frame: &mut Frame) {
        if std::mem::take(&mut frame.light_changed) {
            self.light(encoder, frame);
        }
        let mut pass = target.begin_pass(encoder);
        self.draw(&mut pass, frame);
    }

    /// Records the passes that find the surfaces lit by the key light.
    fn light(&self, encoder: &mut wgpu::CommandEncoder, frame: &Frame) {
        let mut pass = frame.maps.begin_cast(encoder);
        pass.set_bind_group(0, &frame.bind_group, &[]);
        self.draw_solids(&mut pass, frame, Layer::World, &self.pipelines.cast);
        drop(pass);
        if frame.has_table {
            let mut pass = frame.maps.begin_table(encoder);
            pass.set_bind_group(0, &frame.bind_group, &[]);
            pass.set_bind_group(1, &frame.maps.nearest_group, &[]);
            pass.set_pipeline(&self.pipelines.table_light);
            pass.draw(0..4, 0..1);
            drop(pass);
            self.sky(encoder, frame);
        }
    }

    /// Records the passes that find the share of the sky that reaches the table.
    fn sky(&self, encoder: &mut wgpu::CommandEncoder, frame: &Frame) {
        let mut pass = frame.maps.begin_undersides(encoder);
        pass.set_bind_group(0, &frame.bind_group, &[]);
        self.draw_solids(&mut pass, frame, Layer::World, &self.pipelines.under);
        drop(pass);
        let mut pass = frame.maps.begin_sky(encoder);
        pass.set_bind_group(0, &frame.bind_group, &[]);
        pass.set_bind_group(1, &frame.maps.undersides_group, &[]);
        pass.set_pipeline(&self.pipelines.sky);
        pass.draw(0..4, 0..1);
    }

    fn draw(&self, pass: &mut wgpu::RenderPass<'_>, frame: &Frame) {
        let [width, height] = frame.size.map(|n| n as f32);
        pass.set_bind_group(0, &frame.bind_group, &[]);
        pass.set_bind_group(1, &frame.maps.nearest_group, &[]);
        pass.set_bind_group(2, &frame.maps.table_group, &[]);
        pass.set_viewport(0.0, 0.0, width, height, OVERLAY_DEPTH, 1.0);
        pass.set_pipeline(&self.pipelines.background);
        pass.draw(0..4, 0..BACKGROUND_CELLS);
        self.draw_solids(pass, frame, Layer::World, &self.pipelines.solid);
        self.draw_solids(pass, frame, Layer::Table, &self.pipelines.table);
        frame.strokes.draw_quads(pass, &self.pipelines.stroke);
        self.draw_solids(pass, frame, Layer::Ghost, &self.pipelines.ghost_depth);
        self.draw_solids(pass, frame, Layer::Ghost, &self.pipelines.ghost);
        pass.set_viewport(0.0, 0.0, width, height, 0.0, OVERLAY_DEPTH);
        self.draw_solids(pass, frame, Layer::Glass, &self.pipelines.ghost);
        frame.overlay_strokes.draw_quads(pass, &self.pipelines.overlay_stroke);
        self.draw_solids(pass, frame, Layer::Overlay, &self.pipelines.overlay);
    }

    fn draw_solids(&self, pass: &mut wgpu::RenderPass<'_>, frame: &Frame, layer: Layer, with: &wgpu::RenderPipeline) {
        for (_, kind, range) in frame.batches.iter().filter(|(of, _, _)| *of == layer) {
            let mesh = &self.meshes[*kind as usize];
            pass.set_pipeline(with);
            pass.set_vertex_buffer(0, mesh.vertices.slice(..));
            pass.set_vertex_buffer(1, frame.solids.slice());
            pass.set_index_buffer(mesh.indices.slice(..), wgpu::IndexFormat::Uint16);
            pass.draw_indexed(0..mesh.count, 0, range.clone());
        }
    }
}

impl GpuMesh {
    fn new(device: &wgpu::Device, kind: MeshKind) -> Self {
        let mesh = kind.build();
        let buffer = |contents: &[u8], usage| {
            device.create_buffer_init(&wgpu::util::BufferInitDescriptor { label: Some("unit mesh"), contents, usage })
        };
        Self {
            vertices: buffer(bytemuck::cast_slice(&mesh.vertices), wgpu::BufferUsages::VERTEX),
            // Padded to whole words as the copy demands.
            indices: buffer(bytemuck::cast_slice(&padded(&mesh.indices)), wgpu::BufferUsages::INDEX),
            count: mesh.indices.len() as u32,
        }
    }
}

fn padded(indices: &[u16]) -> Vec<u16> {
    let mut indices = indices.to_vec();
    if indices.len() % 2 == 1 {
        indices.push(0);
    }
    indices
}
