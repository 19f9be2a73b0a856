//! The way into a window: draw into a texture of one's own, copy it into another pass.

use haptics::world::{State, World};
use render::{Blit, Frame, Headless, RenderError, Renderer, SAMPLES, SceneView, TextureTarget, ViewOptions};
use std::io::Write;

const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;
const SIZE: [u32; 2] = [320, 180];

/// egui keeps them in a map that demands it.
#[test]
fn everything_can_be_sent_to_another_thread() {
    fn sendable<T: Send + Sync + 'static>() {}
    sendable::<Renderer>();
    sendable::<Frame>();
    sendable::<TextureTarget>();
    sendable::<Blit>();
    sendable::<ViewOptions>();
}

#[test]
fn a_blitted_picture_is_the_picture() {
    let mut headless = match Headless::new() {
        Ok(headless) => headless,
        Err(error @ (RenderError::NoDriver | RenderError::NoDevice { .. })) => {
            let _ = writeln!(std::io::stderr(), "skipped: {error}");
            return;
        }
        Err(error) => panic!("{error}"),
    };
    let world = World::empty("test");
    let state = State::resting(&world);
    let options = ViewOptions::default();
    let view = SceneView { world: &world, state: &state, options: &options };
    let expected = headless.render(&view, SIZE[0], SIZE[1]).expect("drawn");

    let window = window(headless.device_and_queue().0);
    draw_as_in_a_window(&headless, &view, &window);
    assert_eq!(headless.read(&window).expect("read back"), expected);
}

/// Stands for the window's surface.
fn window(device: &wgpu::Device) -> wgpu::Texture {
    device.create_texture(&wgpu::TextureDescriptor {
        label: Some("window"),
        size: wgpu::Extent3d { width: SIZE[0], height: SIZE[1], depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: FORMAT,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    })
}

fn draw_as_in_a_window(headless: &Headless, view: &SceneView<'_>, window: &wgpu::Texture) {
    let (device, queue) = headless.device_and_queue();
    let renderer = Renderer::new(device, FORMAT, SAMPLES);
    let blit = Blit::new(device, FORMAT);
    let mut frame = renderer.frame(device);
    let mut target = TextureTarget::new(device, FORMAT, SAMPLES, [1, 1]);
    assert!(target.resize(device, SIZE), "the size changes");
    assert!(!target.resize(device, SIZE), "the size stays");
    let picture = blit.bind(device, &target);

    renderer.prepare(device, queue, &mut frame, view, SIZE);
    let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    renderer.render(&mut encoder, &target, &mut frame);
    let surface = window.create_view(&wgpu::TextureViewDescriptor::default());
    let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view: &surface,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations::default(),
        })],
        ..wgpu::RenderPassDescriptor::default()
    });
    blit.draw(&mut pass, &picture);
    drop(pass);
    queue.submit([encoder.finish()]);
}
