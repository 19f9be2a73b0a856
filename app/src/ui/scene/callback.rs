//! An egui paint callback that draws a scene into a texture of its own and copies it into egui's pass.

use egui_wgpu::{CallbackResources, CallbackTrait, ScreenDescriptor, wgpu};
use haptics::world::{State, World};
use render::{Blit, Frame, Renderer, SAMPLES, SceneView, TextureTarget, ViewOptions};
use std::collections::HashMap;
use std::sync::mpsc::{Receiver, TryRecvError, channel};
use std::sync::{Arc, Mutex};

/// Format of the texture that the scene is drawn into.
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

/// Format of egui's target: kept in the context so that every panel can draw.
#[derive(Clone, Copy)]
struct Surface(wgpu::TextureFormat);

fn surface_id() -> egui::Id {
    egui::Id::unique("touchstone surface format")
}

/// Tells the panels what the window is drawn to. Without it pictures are replaced by a sentence.
pub fn announce(ctx: &egui::Context, state: &egui_wgpu::RenderState) {
    ctx.data_mut(|data| data.insert_temp(surface_id(), Surface(state.target_format)));
}

/// Builds what draws scenes on a thread of its own, so that the window's first picture need not wait for it; until it is there scenes
/// are left out.
pub fn warm_up(ctx: &egui::Context, state: &egui_wgpu::RenderState) {
    let (sender, receiver) = channel();
    let (device, surface, ctx) = (state.device.clone(), state.target_format, ctx.clone());
    let spawned = std::thread::Builder::new().name("pipelines".to_owned()).spawn(move || {
        match Resources::tried(&device, surface) {
            // Nobody listens any more in a window that was closed at once.
            Some(made) => drop(sender.send(made)),
            // Panels say so in the picture's place.
            None => ctx.data_mut(|data| data.remove::<Surface>(surface_id())),
        }
        ctx.request_repaint();
    });
    if spawned.is_ok() {
        state.renderer.write().callback_resources.insert(Warming(Mutex::new(receiver)));
    }
}

/// Where what [`warm_up`] builds comes out.
struct Warming(Mutex<Receiver<Resources>>);

/// Draws a scene into `rect`; false when there is no graphics device. `view` tells apart several pictures in one window.
pub fn picture(
    ui: &egui::Ui,
    rect: egui::Rect,
    view: &'static str,
    world: Arc<World>,
    state: State,
    options: ViewOptions,
) -> bool {
    let Some(Surface(surface)) = ui.data(|data| data.get_temp(surface_id())) else { return false };
    let size = pixels(ui, rect);
    let callback = Picture { view, surface, size, world, state, options };
    ui.painter().add(egui_wgpu::Callback::new_paint_callback(rect, callback));
    true
}

/// Size of a rectangle in pixels.
pub fn pixels(ui: &egui::Ui, rect: egui::Rect) -> [u32; 2] {
    let size = rect.size() * ui.pixels_per_point();
    [size.x.round().max(1.0) as u32, size.y.round().max(1.0) as u32]
}

struct Picture {
    view: &'static str,
    surface: wgpu::TextureFormat,
    size: [u32; 2],
    world: Arc<World>,
    state: State,
    options: ViewOptions,
}

/// Lives in egui's renderer as long as the window.
struct Resources {
    renderer: Renderer,
    blit: Blit,
    views: HashMap<&'static str, ViewResources>,
}

struct ViewResources {
    frame: Frame,
    target: TextureTarget,
    bound: wgpu::BindGroup,
}

impl Warming {
    fn take(&self) -> Result<Resources, TryRecvError> {
        self.0.lock().map_or(Err(TryRecvError::Disconnected), |receiver| receiver.try_recv())
    }
}

impl Resources {
    /// `None` where the graphics driver lacks what the pictures need.
    fn tried(device: &wgpu::Device, surface: wgpu::TextureFormat) -> Option<Self> {
        let scope = device.push_error_scope(wgpu::ErrorFilter::Validation);
        let made = Self::new(device, surface);
        pollster::block_on(scope.pop()).is_none().then_some(made)
    }

    fn new(device: &wgpu::Device, surface: wgpu::TextureFormat) -> Self {
        Self {
            renderer: Renderer::new(device, FORMAT, SAMPLES),
            blit: Blit::new(device, surface),
            views: HashMap::new(),
        }
    }

    fn prepare(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        encoder: &mut wgpu::CommandEncoder,
        picture: &Picture,
    ) {
        let Self { renderer, blit, views } = self;
        let view = views.entry(picture.view).or_insert_with(|| {
            let target = TextureTarget::new(device, FORMAT, SAMPLES, picture.size);
            ViewResources { frame: renderer.frame(device), bound: blit.bind(device, &target), target }
        });
        if view.target.resize(device, picture.size) {
            view.bound = blit.bind(device, &view.target);
        }
        let scene = SceneView { world: &picture.world, state: &picture.state, options: &picture.options };
        renderer.prepare(device, queue, &mut view.frame, &scene, picture.size);
        renderer.render(encoder, &view.target, &mut view.frame);
    }
}

impl CallbackTrait for Picture {
    fn prepare(
        &self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        _screen: &ScreenDescriptor,
        encoder: &mut wgpu::CommandEncoder,
        resources: &mut CallbackResources,
    ) -> Vec<wgpu::CommandBuffer> {
        if !resources.contains::<Resources>() {
            match resources.get::<Warming>().map(Warming::take) {
                Some(Ok(warm)) => drop(resources.insert(warm)),
                // Not yet, or never.
                Some(Err(_)) => return Vec::new(),
                // Without a window there is no thread either.
                None => drop(resources.insert(Resources::new(device, self.surface))),
            }
        }
        if let Some(own) = resources.get_mut::<Resources>() {
            own.prepare(device, queue, encoder, self);
        }
        Vec::new()
    }

    fn paint(
        &self,
        _info: egui::PaintCallbackInfo,
        pass: &mut wgpu::RenderPass<'static>,
        resources: &CallbackResources,
    ) {
        let Some(own) = resources.get::<Resources>() else { return };
        if let Some(view) = own.views.get(self.view) {
            own.blit.draw(pass, &view.bound);
        }
    }
}
