//! The pipelines: how each kind of shape becomes pixels. Shaders stand beside this file.

use crate::mesh::Vertex;
use crate::renderer::DEPTH_FORMAT;
use crate::shape::{Shadow, Solid, Stroke};
use wgpu::vertex_attr_array as attributes;

const COMMON: &str = include_str!("common.wgsl");
const SOLID: &str = include_str!("solid.wgsl");
const STROKE: &str = include_str!("stroke.wgsl");
const SHADOW: &str = include_str!("shadow.wgsl");
const BACKGROUND: &str = include_str!("background.wgsl");

/// All pipelines of a target format.
#[derive(Debug)]
pub(crate) struct Pipelines {
    pub solid: wgpu::RenderPipeline,
    pub table: wgpu::RenderPipeline,
    /// Depth of translucent solids, so that only their nearest surface is seen.
    pub ghost_depth: wgpu::RenderPipeline,
    pub ghost: wgpu::RenderPipeline,
    pub shadow: wgpu::RenderPipeline,
    pub stroke: wgpu::RenderPipeline,
    pub overlay_stroke: wgpu::RenderPipeline,
    pub background: wgpu::RenderPipeline,
}

/// What is the same in every pipeline of one renderer.
struct Maker<'a> {
    device: &'a wgpu::Device,
    layout: wgpu::PipelineLayout,
    format: wgpu::TextureFormat,
    samples: u32,
}

/// What differs from pipeline to pipeline.
struct Spec<'a> {
    label: &'a str,
    module: &'a wgpu::ShaderModule,
    vertex: &'a str,
    fragment: &'a str,
    buffers: &'a [Option<wgpu::VertexBufferLayout<'a>>],
    topology: wgpu::PrimitiveTopology,
    ink: Ink,
    depth_write: bool,
    depth_compare: wgpu::CompareFunction,
    /// Positive: farther.
    depth_bias: i32,
}

/// What a pipeline does with the colour it computes.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Ink {
    Opaque,
    Translucent,
    /// Only depth is written.
    None,
}

impl Pipelines {
    pub(crate) fn new(
        device: &wgpu::Device,
        globals: &wgpu::BindGroupLayout,
        format: wgpu::TextureFormat,
        samples: u32,
    ) -> Self {
        let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("scene"),
            bind_group_layouts: &[Some(globals)],
            immediate_size: 0,
        });
        let make = Maker { device, layout, format, samples };
        let solid = make.module("solid", SOLID);
        let stroke = make.module("stroke", STROKE);
        let shadow = make.module("shadow", SHADOW);
        let background = make.module("background", BACKGROUND);

        let solid_buffers = [Some(vertex_layout()), Some(solid_layout())];
        let opaque = Spec {
            label: "solid",
            module: &solid,
            vertex: "vs_solid",
            fragment: "fs_solid",
            buffers: &solid_buffers,
            topology: wgpu::PrimitiveTopology::TriangleList,
            ink: Ink::Opaque,
            depth_write: true,
            depth_compare: wgpu::CompareFunction::Less,
            depth_bias: 0,
        };
        let see_through = wgpu::CompareFunction::LessEqual;
        let stroke_buffers = [Some(stroke_layout())];
        let strokes = Spec {
            label: "stroke",
            module: &stroke,
            vertex: "vs_stroke",
            fragment: "fs_stroke",
            buffers: &stroke_buffers,
            topology: wgpu::PrimitiveTopology::TriangleStrip,
            ink: Ink::Translucent,
            depth_write: false,
            depth_compare: see_through,
            ..opaque
        };
        Self {
            table: make.pipeline(&Spec { label: "table", fragment: "fs_table", ..opaque }),
            ghost_depth: make.pipeline(&ghost_depth(&opaque)),
            ghost: make.pipeline(&ghost(&opaque)),
            shadow: make.pipeline(&Spec {
                label: "shadow",
                module: &shadow,
                vertex: "vs_shadow",
                fragment: "fs_shadow",
                buffers: &[Some(shadow_layout())],
                ..strokes
            }),
            background: make.pipeline(&Spec {
                label: "background",
                module: &background,
                vertex: "vs_background",
                fragment: "fs_background",
                buffers: &[],
                depth_write: false,
                depth_compare: wgpu::CompareFunction::Always,
                topology: wgpu::PrimitiveTopology::TriangleStrip,
                ..opaque
            }),
            overlay_stroke: make.pipeline(&Spec {
                label: "overlay stroke",
                depth_compare: wgpu::CompareFunction::Always,
                ..strokes
            }),
            stroke: make.pipeline(&strokes),
            solid: make.pipeline(&opaque),
        }
    }
}

/// Steps of depth that a ghost is pushed back by, so that it does not fight with what it coincides with.
const GHOST_DEPTH_BIAS: i32 = 24;

/// First pass of a ghost: only depth, so that its own inner faces do not show through.
fn ghost_depth<'a>(opaque: &Spec<'a>) -> Spec<'a> {
    Spec { label: "ghost depth", fragment: "fs_depth", ink: Ink::None, depth_bias: GHOST_DEPTH_BIAS, ..*opaque }
}

/// Second pass of a ghost: its nearest faces, translucent.
fn ghost<'a>(opaque: &Spec<'a>) -> Spec<'a> {
    Spec {
        label: "ghost",
        ink: Ink::Translucent,
        depth_write: false,
        depth_compare: wgpu::CompareFunction::LessEqual,
        depth_bias: GHOST_DEPTH_BIAS,
        ..*opaque
    }
}

impl Maker<'_> {
    fn module(&self, label: &str, source: &str) -> wgpu::ShaderModule {
        self.device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some(label),
            source: wgpu::ShaderSource::Wgsl(format!("{COMMON}\n{source}").into()),
        })
    }

    fn pipeline(&self, spec: &Spec<'_>) -> wgpu::RenderPipeline {
        let constants = [("TARGET_IS_SRGB", f64::from(u8::from(self.format.is_srgb())))];
        // Strips are flat things that face the viewer by construction.
        let closed = spec.topology == wgpu::PrimitiveTopology::TriangleList;
        let blend = (spec.ink == Ink::Translucent).then_some(wgpu::BlendState::ALPHA_BLENDING);
        let write_mask = if spec.ink == Ink::None { wgpu::ColorWrites::empty() } else { wgpu::ColorWrites::ALL };
        self.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(spec.label),
            layout: Some(&self.layout),
            vertex: wgpu::VertexState {
                module: spec.module,
                entry_point: Some(spec.vertex),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                buffers: spec.buffers,
            },
            primitive: wgpu::PrimitiveState {
                topology: spec.topology,
                cull_mode: closed.then_some(wgpu::Face::Back),
                ..wgpu::PrimitiveState::default()
            },
            depth_stencil: Some(wgpu::DepthStencilState {
                format: DEPTH_FORMAT,
                depth_write_enabled: Some(spec.depth_write),
                depth_compare: Some(spec.depth_compare),
                stencil: wgpu::StencilState::default(),
                bias: wgpu::DepthBiasState { constant: spec.depth_bias, slope_scale: 0.0, clamp: 0.0 },
            }),
            multisample: wgpu::MultisampleState { count: self.samples, ..wgpu::MultisampleState::default() },
            fragment: Some(wgpu::FragmentState {
                module: spec.module,
                entry_point: Some(spec.fragment),
                compilation_options: wgpu::PipelineCompilationOptions {
                    constants: &constants,
                    ..wgpu::PipelineCompilationOptions::default()
                },
                targets: &[Some(wgpu::ColorTargetState { format: self.format, blend, write_mask })],
            }),
            multiview_mask: None,
            cache: None,
        })
    }
}

fn vertex_layout() -> wgpu::VertexBufferLayout<'static> {
    const ATTRIBUTES: [wgpu::VertexAttribute; 4] =
        attributes![0 => Float32x3, 1 => Float32x3, 2 => Float32x3, 9 => Float32x2];
    layout::<Vertex>(wgpu::VertexStepMode::Vertex, &ATTRIBUTES)
}

fn solid_layout() -> wgpu::VertexBufferLayout<'static> {
    const ATTRIBUTES: [wgpu::VertexAttribute; 6] =
        attributes![3 => Float32x4, 4 => Float32x4, 5 => Float32x4, 6 => Float32x4, 7 => Float32x4, 8 => Float32x4];
    layout::<Solid>(wgpu::VertexStepMode::Instance, &ATTRIBUTES)
}

fn stroke_layout() -> wgpu::VertexBufferLayout<'static> {
    const ATTRIBUTES: [wgpu::VertexAttribute; 4] =
        attributes![0 => Float32x4, 1 => Float32x4, 2 => Float32x4, 3 => Float32x2];
    layout::<Stroke>(wgpu::VertexStepMode::Instance, &ATTRIBUTES)
}

fn shadow_layout() -> wgpu::VertexBufferLayout<'static> {
    const ATTRIBUTES: [wgpu::VertexAttribute; 2] = attributes![0 => Float32x4, 1 => Float32x2];
    layout::<Shadow>(wgpu::VertexStepMode::Instance, &ATTRIBUTES)
}

fn layout<T>(
    step_mode: wgpu::VertexStepMode,
    attributes: &'static [wgpu::VertexAttribute],
) -> wgpu::VertexBufferLayout<'static> {
    wgpu::VertexBufferLayout { array_stride: size_of::<T>() as u64, step_mode, attributes }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Shaders are checked without a graphics device.
    #[test]
    fn shaders_are_valid() {
        let scene = [("solid", SOLID), ("stroke", STROKE), ("shadow", SHADOW), ("background", BACKGROUND)];
        let scene = scene.map(|(name, source)| (name, format!("{COMMON}\n{source}")));
        let blit = ("blit", crate::blit::SHADER.to_owned());
        for (name, source) in scene.into_iter().chain([blit]) {
            let module = match naga::front::wgsl::parse_str(&source) {
                Ok(module) => module,
                Err(error) => panic!("{name}.wgsl: {}", error.emit_to_string(&source)),
            };
            let capabilities = naga::valid::Capabilities::default();
            let mut validator = naga::valid::Validator::new(naga::valid::ValidationFlags::all(), capabilities);
            if let Err(error) = validator.validate(&module) {
                panic!("{name}.wgsl: {}", error.emit_to_string(&source));
            }
        }
    }
}
