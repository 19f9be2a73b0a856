//! Bind groups of the shaders beside their vertices: numbers of the scene, the shadow map or that of undersides, the
//! table's light maps.

use super::map_format::MapFormat;

/// Layouts of the bind groups, by number.
#[derive(Debug)]
pub(crate) struct Groups {
    layouts: [wgpu::BindGroupLayout; 3],
    /// Format of the maps in group 1.
    pub(crate) map_format: MapFormat,
}

impl Groups {
    pub(crate) fn new(device: &wgpu::Device, map_format: MapFormat) -> Self {
        use wgpu::ShaderStages as Stages;
        let uniform = wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Uniform,
            has_dynamic_offset: false,
            min_binding_size: None,
        };
        let texture = |filterable| wgpu::BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Float { filterable },
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled: false,
        };
        let sampler = wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering);
        let layout = |label, types: &[wgpu::BindingType], visibility| {
            let entry = |(binding, ty): (u32, &wgpu::BindingType)| wgpu::BindGroupLayoutEntry {
                binding,
                visibility,
                ty: *ty,
                count: None,
            };
            let entries: Vec<_> = (0..).zip(types).map(entry).collect();
            device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some(label), entries: &entries })
        };
        Self {
            map_format,
            layouts: [
                layout("globals", &[uniform], Stages::VERTEX_FRAGMENT),
                layout("shadow map", &[texture(false)], Stages::FRAGMENT),
                layout("table light", &[texture(true), sampler, texture(true)], Stages::FRAGMENT),
            ],
        }
    }

    /// The layout of a pipeline that has the first `count` groups.
    pub(crate) fn pipeline_layout(&self, device: &wgpu::Device, count: usize) -> wgpu::PipelineLayout {
        let layouts: Vec<_> = self.layouts[..count].iter().map(Some).collect();
        device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("scene"),
            bind_group_layouts: &layouts,
            immediate_size: 0,
        })
    }

    /// Group 0.
    pub(crate) fn globals(&self, device: &wgpu::Device, buffer: &wgpu::Buffer) -> wgpu::BindGroup {
        self.bind(device, 0, &[buffer.as_entire_binding()])
    }

    /// Group 1.
    pub(crate) fn map(&self, device: &wgpu::Device, map: &wgpu::TextureView) -> wgpu::BindGroup {
        self.bind(device, 1, &[wgpu::BindingResource::TextureView(map)])
    }

    /// Group 2.
    pub(crate) fn table_light(
        &self,
        device: &wgpu::Device,
        light: &wgpu::TextureView,
        sky: &wgpu::TextureView,
    ) -> wgpu::BindGroup {
        let sampler = device.create_sampler(&wgpu::SamplerDescriptor {
            label: Some("table light"),
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            ..wgpu::SamplerDescriptor::default()
        });
        let texture = wgpu::BindingResource::TextureView;
        self.bind(device, 2, &[texture(light), wgpu::BindingResource::Sampler(&sampler), texture(sky)])
    }

    fn bind(&self, device: &wgpu::Device, group: usize, resources: &[wgpu::BindingResource<'_>]) -> wgpu::BindGroup {
        let entries: Vec<_> = (0..)
            .zip(resources)
            .map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource: resource.clone() })
            .collect();
        device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("scene"),
            layout: &self.layouts[group],
            entries: &entries,
        })
    }
}
