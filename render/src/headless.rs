//! Pictures without a window: for tests, reports and the command line.

use crate::error::RenderError;
use crate::frame::Frame;
use crate::renderer::Renderer;
use crate::scene::SceneView;
use crate::target::TextureTarget;
use crate::texture_format::SAMPLES;
use image::RgbaImage;

const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

/// A device of its own, with everything that can be used again from picture to picture.
#[derive(Debug)]
pub struct Headless {
    device: wgpu::Device,
    queue: wgpu::Queue,
    adapter: String,
    renderer: Renderer,
    frame: Frame,
    target: TextureTarget,
    read_back: Option<wgpu::Buffer>,
}

impl Headless {
    /// On the fastest driver there is; the software driver if there is no other.
    pub fn new() -> Result<Self, RenderError> {
        Self::on(&best_adapter(rank)?)
    }

    /// On the software driver if there is one: the same pixels on every machine with the same driver version.
    pub fn software() -> Result<Self, RenderError> {
        Self::on(&best_adapter(|kind| u8::from(kind != wgpu::DeviceType::Cpu))?)
    }

    fn on(adapter: &wgpu::Adapter) -> Result<Self, RenderError> {
        let name = adapter.get_info().name;
        let request = adapter.request_device(&wgpu::DeviceDescriptor {
            label: Some("headless"),
            required_limits: wgpu::Limits::downlevel_defaults().using_resolution(adapter.limits()),
            ..wgpu::DeviceDescriptor::default()
        });
        let (device, queue) = pollster::block_on(request)
            .map_err(|error| RenderError::NoDevice { adapter: name.clone(), reason: error.to_string() })?;
        let renderer = Renderer::new(&device, FORMAT, SAMPLES);
        let frame = renderer.frame(&device);
        let target = TextureTarget::new(&device, FORMAT, SAMPLES, [1, 1]);
        tracing::debug!(adapter = name, "headless device opened");
        Ok(Self { device, queue, adapter: name, renderer, frame, target, read_back: None })
    }

    /// Name of the driver's device.
    pub fn adapter(&self) -> &str {
        &self.adapter
    }

    /// Its device and queue, to share with other drawing.
    pub fn device_and_queue(&self) -> (&wgpu::Device, &wgpu::Queue) {
        (&self.device, &self.queue)
    }

    /// Draws one picture.
    pub fn render(&mut self, view: &SceneView<'_>, width: u32, height: u32) -> Result<RgbaImage, RenderError> {
        self.draw(view, width, height)?;
        let picture = self.target.texture().clone();
        self.read(&picture)
    }

    /// Draws a series of pictures of one size, for instance the frames of a film.
    pub fn render_many<'a>(
        &mut self,
        views: impl IntoIterator<Item = SceneView<'a>>,
        width: u32,
        height: u32,
    ) -> Result<Vec<RgbaImage>, RenderError> {
        views.into_iter().map(|view| self.render(&view, width, height)).collect()
    }

    /// Draws one picture and waits for it, without copying it back: to measure the time a picture takes.
    pub fn draw(&mut self, view: &SceneView<'_>, width: u32, height: u32) -> Result<(), RenderError> {
        let limit = self.device.limits().max_texture_dimension_2d;
        if width == 0 || height == 0 || width > limit || height > limit {
            return Err(RenderError::Size { width, height, limit });
        }
        self.target.resize(&self.device, [width, height]);
        self.renderer.prepare(&self.device, &self.queue, &mut self.frame, view, [width, height]);
        let mut encoder = self.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        self.renderer.render(&mut encoder, &self.target, &mut self.frame);
        self.queue.submit([encoder.finish()]);
        self.wait()
    }

    fn wait(&self) -> Result<(), RenderError> {
        let polled = self.device.poll(wgpu::PollType::wait_indefinitely());
        polled.map(|_| ()).map_err(|error| RenderError::ReadBack(error.to_string()))
    }

    /// Copies a texture of this device back; it must hold four bytes a pixel and allow `COPY_SRC`.
    pub fn read(&mut self, texture: &wgpu::Texture) -> Result<RgbaImage, RenderError> {
        let (width, height) = (texture.width(), texture.height());
        let row = (4 * width).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let size = u64::from(row) * u64::from(height);
        let buffer = match self.read_back.take() {
            Some(buffer) if buffer.size() == size => buffer,
            _ => self.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("read back"),
                size,
                usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
                mapped_at_creation: false,
            }),
        };
        let mut encoder = self.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        encoder.copy_texture_to_buffer(
            texture.as_image_copy(),
            wgpu::TexelCopyBufferInfo {
                buffer: &buffer,
                layout: wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(row), rows_per_image: None },
            },
            wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        );
        self.queue.submit([encoder.finish()]);
        let (sender, receiver) = std::sync::mpsc::channel();
        buffer.map_async(wgpu::MapMode::Read, .., move |result| {
            // The receiver waits below; if it is gone the answer is not needed.
            let _ = sender.send(result);
        });
        self.wait()?;
        let failed = |reason: &dyn std::fmt::Display| RenderError::ReadBack(reason.to_string());
        receiver.recv().map_err(|e| failed(&e))?.map_err(|e| failed(&e))?;
        let mut pixels = Vec::with_capacity(4 * (width * height) as usize);
        {
            let mapped = buffer.slice(..).get_mapped_range().map_err(|e| failed(&e))?;
            for line in mapped.chunks_exact(row as usize) {
                pixels.extend_from_slice(&line[..4 * width as usize]);
            }
        }
        buffer.unmap();
        self.read_back = Some(buffer);
        RgbaImage::from_raw(width, height, pixels).ok_or_else(|| failed(&"too few pixels arrived"))
    }
}

/// Smaller is better.
fn rank(kind: wgpu::DeviceType) -> u8 {
    match kind {
        wgpu::DeviceType::DiscreteGpu => 0,
        wgpu::DeviceType::IntegratedGpu => 1,
        wgpu::DeviceType::VirtualGpu => 2,
        wgpu::DeviceType::Cpu => 3,
        wgpu::DeviceType::Other => 4,
    }
}

fn best_adapter(rank: impl Fn(wgpu::DeviceType) -> u8) -> Result<wgpu::Adapter, RenderError> {
    // OpenGL last: it may need a display server.
    for backends in [wgpu::Backends::PRIMARY, wgpu::Backends::GL] {
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor {
            backends,
            ..wgpu::InstanceDescriptor::new_without_display_handle()
        });
        let adapters = pollster::block_on(instance.enumerate_adapters(backends));
        let best = adapters.into_iter().min_by_key(|adapter| rank(adapter.get_info().device_type));
        if let Some(adapter) = best {
            return Ok(adapter);
        }
    }
    Err(RenderError::NoDriver)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pipeline::MapFormat;
    use crate::scene::ViewOptions;
    use haptics::world::{State, presets};

    #[test]
    fn maps_of_bytes_shade_as_those_of_numbers_do() {
        let Ok(mut plain) = Headless::software() else { return };
        let Ok(mut bytes) = Headless::software() else { return };
        bytes.renderer = Renderer::with_maps(&bytes.device, FORMAT, SAMPLES, MapFormat::Bytes);
        bytes.frame = bytes.renderer.frame(&bytes.device);
        let world = presets::named("stack").expect("it is built in");
        let (state, options) = (State::resting(&world), ViewOptions::default());
        let view = SceneView { world: &world, state: &state, options: &options };
        let [one, other] = [&mut plain, &mut bytes].map(|h| h.render(&view, 320, 240).expect("drawn"));
        let differ = |(a, b): (&u8, &u8)| a.abs_diff(*b) > 3;
        let apart = one.as_raw().iter().zip(other.as_raw()).filter(|pair| differ(*pair)).count();
        // A rounding decides at the rim of a shadow; that there are shadows at all is seen in the tests of pictures.
        assert!(apart * 1000 < one.as_raw().len(), "{apart} of {}", one.as_raw().len());
    }
}
