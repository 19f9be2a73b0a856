//! The pipelines: each turns one kind of shape into pixels. Shaders stand beside this file.

mod groups;
mod map_format;

use crate::mesh::Vertex;
use crate::shape::{Solid, Stroke};
use crate::texture_format::DEPTH_FORMAT;
pub(crate) use groups::Groups;
pub(crate) use map_format::MapFormat;
use wgpu::vertex_attr_array as attributes;

const COMMON: &str = include_str!("common.wgsl");
const KEY_LIGHT: &str = include_str!("key_light.wgsl");
const MATERIAL: &str = include_str!("material.wgsl");
const SOLID: &str = include_str!("solid.wgsl");
const TABLE_LIGHT: &str = include_str!("table_light.wgsl");
const STROKE: &str = include_str!("stroke.wgsl");
const SKY: &str = include_str!("sky.wgsl");
const BACKGROUND: &str = include_str!("background.wgsl");

/// Every driver can draw into these and read them.
pub(crate) const TABLE_LIGHT_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::R8Unorm;

/// All pipelines of a target format.
#[derive(Debug)]
pub(crate) struct Pipelines {
    /// Solids as the key light sees them: their depth.
    pub cast: wgpu::RenderPipeline,
    /// Share of the key light that reaches the table.
    pub table_light: wgpu::RenderPipeline,
    /// Solids as the table sees them: how high they hang.
    pub under: wgpu::RenderPipeline,
    /// Share of the sky that they hide from it.
    pub sky: wgpu::RenderPipeline,
    pub solid: wgpu::RenderPipeline,
    pub table: wgpu::RenderPipeline,
    /// Depth of translucent solids, so that only their nearest surface is seen.
    pub ghost_depth: wgpu::RenderPipeline,
    pub ghost: wgpu::RenderPipeline,
    pub stroke: wgpu::RenderPipeline,
    pub overlay_stroke: wgpu::RenderPipeline,
    pub background: wgpu::RenderPipeline,
    /// Solids in front of everything.
    pub overlay: wgpu::RenderPipeline,
}

/// Inputs that are the same for every pipeline of one renderer.
struct Maker<'a> {
    device: &'a wgpu::Device,
    groups: &'a Groups,
}

/// Target of a pipeline.
#[derive(Clone, Copy)]
struct Into {
    format: wgpu::TextureFormat,
    samples: u32,
    /// Number of bind groups of its passes.
    groups: usize,
    depth: bool,
}

/// Inputs that differ from pipeline to pipeline.
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
    into: Into,
    /// Backs of closed solids are left out.
    culled: bool,
}

/// Use of the colour that a pipeline computes.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Ink {
    Opaque,
    Translucent,
    /// Only depth is written.
    None,
}

impl Pipelines {
    pub(crate) fn new(device: &wgpu::Device, groups: &Groups, format: wgpu::TextureFormat, samples: u32) -> Self {
        let make = Maker { device, groups };
        let solid = make.module("solid", &format!("{KEY_LIGHT}\n{MATERIAL}\n{SOLID}"));
        let table_light = make.module("table light", &format!("{KEY_LIGHT}\n{TABLE_LIGHT}"));
        let stroke = make.module("stroke", STROKE);
        let sky = make.module("sky", SKY);
        let background = make.module("background", BACKGROUND);

        let solid_buffers = [Some(vertex_layout()), Some(solid_layout())];
        let opaque = opaque(&solid, &solid_buffers, Into { format, samples, groups: 3, depth: true });
        let stroke_buffers = [Some(stroke_layout())];
        let strokes = strokes(&opaque, &stroke, &stroke_buffers);
        Self {
            cast: make.pipeline(&cast(&opaque, groups.map_format)),
            table_light: make.pipeline(&table_map(&opaque, &table_light, ["vs_table_light", "fs_table_light"])),
            under: make.pipeline(&Spec {
                label: "undersides",
                vertex: "vs_under",
                fragment: "fs_under",
                ..cast(&opaque, groups.map_format)
            }),
            sky: make.pipeline(&table_map(&opaque, &sky, ["vs_sky", "fs_sky"])),
            overlay: make.pipeline(&Spec { label: "overlay", fragment: "fs_overlay", ..opaque }),
            table: make.pipeline(&Spec { label: "table", fragment: "fs_table", ..opaque }),
            ghost_depth: make.pipeline(&ghost_depth(&opaque)),
            ghost: make.pipeline(&ghost(&opaque)),
            background: make.pipeline(&backdrop(&opaque, &background)),
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

/// Solids of the world.
fn opaque<'a>(
    module: &'a wgpu::ShaderModule,
    buffers: &'a [Option<wgpu::VertexBufferLayout<'a>>],
    into: Into,
) -> Spec<'a> {
    Spec {
        label: "solid",
        module,
        vertex: "vs_solid",
        fragment: "fs_solid",
        buffers,
        topology: wgpu::PrimitiveTopology::TriangleList,
        ink: Ink::Opaque,
        depth_write: true,
        depth_compare: wgpu::CompareFunction::Less,
        depth_bias: 0,
        into,
        culled: true,
    }
}

/// Lines that solids can hide.
fn strokes<'a>(
    opaque: &Spec<'a>,
    module: &'a wgpu::ShaderModule,
    buffers: &'a [Option<wgpu::VertexBufferLayout<'a>>],
) -> Spec<'a> {
    Spec {
        label: "stroke",
        module,
        vertex: "vs_stroke",
        fragment: "fs_stroke",
        buffers,
        topology: wgpu::PrimitiveTopology::TriangleStrip,
        ink: Ink::Translucent,
        depth_write: false,
        depth_compare: wgpu::CompareFunction::LessEqual,
        culled: false,
        ..*opaque
    }
}

/// The background, behind everything.
fn backdrop<'a>(opaque: &Spec<'a>, module: &'a wgpu::ShaderModule) -> Spec<'a> {
    Spec {
        label: "background",
        module,
        vertex: "vs_background",
        fragment: "fs_background",
        buffers: &[],
        depth_write: false,
        depth_compare: wgpu::CompareFunction::Always,
        topology: wgpu::PrimitiveTopology::TriangleStrip,
        culled: false,
        ..*opaque
    }
}

/// The shadow map: thin sheets and open shells cast from both sides.
fn cast<'a>(opaque: &Spec<'a>, map: MapFormat) -> Spec<'a> {
    Spec {
        label: "shadow map",
        vertex: "vs_cast",
        fragment: "fs_cast",
        into: Into { format: map.texture(), samples: 1, groups: 1, depth: true },
        culled: false,
        ..*opaque
    }
}

/// A map of the table's top.
fn table_map<'a>(opaque: &Spec<'a>, module: &'a wgpu::ShaderModule, [vertex, fragment]: [&'a str; 2]) -> Spec<'a> {
    Spec {
        label: "table map",
        module,
        vertex,
        fragment,
        buffers: &[],
        topology: wgpu::PrimitiveTopology::TriangleStrip,
        into: Into { format: TABLE_LIGHT_FORMAT, samples: 1, groups: 2, depth: false },
        culled: false,
        ..*opaque
    }
}

/// Steps of depth that a ghost is pushed back by, so that it does not fight with a coincident solid.
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
            source: wgpu::ShaderSource::Wgsl(format!("{COMMON}\n{}\n{source}", self.groups.map_format.shader()).into()),
        })
    }

    fn pipeline(&self, spec: &Spec<'_>) -> wgpu::RenderPipeline {
        let into = spec.into;
        let srgb = [("TARGET_IS_SRGB", f64::from(u8::from(into.format.is_srgb())))];
        // Light maps hold numbers, not colours; their shaders do not know the constant.
        let constants: &[_] = if into.groups == 3 { &srgb } else { &[] };
        let blend = (spec.ink == Ink::Translucent).then_some(wgpu::BlendState::ALPHA_BLENDING);
        let write_mask = if spec.ink == Ink::None { wgpu::ColorWrites::empty() } else { wgpu::ColorWrites::ALL };
        self.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(spec.label),
            layout: Some(&self.groups.pipeline_layout(self.device, into.groups)),
            vertex: wgpu::VertexState {
                module: spec.module,
                entry_point: Some(spec.vertex),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                buffers: spec.buffers,
            },
            primitive: wgpu::PrimitiveState {
                topology: spec.topology,
                cull_mode: spec.culled.then_some(wgpu::Face::Back),
                ..wgpu::PrimitiveState::default()
            },
            depth_stencil: into.depth.then(|| wgpu::DepthStencilState {
                format: DEPTH_FORMAT,
                depth_write_enabled: Some(spec.depth_write),
                depth_compare: Some(spec.depth_compare),
                stencil: wgpu::StencilState::default(),
                bias: wgpu::DepthBiasState { constant: spec.depth_bias, slope_scale: 0.0, clamp: 0.0 },
            }),
            multisample: wgpu::MultisampleState { count: into.samples, ..wgpu::MultisampleState::default() },
            fragment: Some(wgpu::FragmentState {
                module: spec.module,
                entry_point: Some(spec.fragment),
                compilation_options: wgpu::PipelineCompilationOptions {
                    constants,
                    ..wgpu::PipelineCompilationOptions::default()
                },
                targets: &[Some(wgpu::ColorTargetState { format: into.format, blend, write_mask })],
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
    const ATTRIBUTES: [wgpu::VertexAttribute; 7] = attributes![
        3 => Float32x4, 4 => Float32x4, 5 => Float32x4, 6 => Float32x4, 7 => Float32x4, 8 => Float32x4, 10 => Uint32
    ];
    layout::<Solid>(wgpu::VertexStepMode::Instance, &ATTRIBUTES)
}

fn stroke_layout() -> wgpu::VertexBufferLayout<'static> {
    const ATTRIBUTES: [wgpu::VertexAttribute; 4] =
        attributes![0 => Float32x4, 1 => Float32x4, 2 => Float32x4, 3 => Float32x2];
    layout::<Stroke>(wgpu::VertexStepMode::Instance, &ATTRIBUTES)
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
        let solid = format!("{KEY_LIGHT}\n{MATERIAL}\n{SOLID}");
        let table_light = format!("{KEY_LIGHT}\n{TABLE_LIGHT}");
        let scene = [
            ("solid", solid.as_str()),
            ("table_light", &table_light),
            ("stroke", STROKE),
            ("sky", SKY),
            ("background", BACKGROUND),
        ];
        let of = |map: MapFormat| scene.map(|(name, source)| (name, format!("{COMMON}\n{}\n{source}", map.shader())));
        let blit = ("blit", crate::blit::SHADER.to_owned());
        let (float, bytes) = (of(MapFormat::Float), of(MapFormat::Bytes));
        for (name, source) in float.into_iter().chain(bytes).chain([blit]) {
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
